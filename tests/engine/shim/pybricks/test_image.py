"""`Image` of `pybricks.media.ev3dev`, and the screen: what is drawn is what the recording shows."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.pybricks import image
from tuisim.engine.shim.pybricks.font import Font
from tuisim.engine.shim.pybricks.image import Image
from tuisim.engine.shim.pybricks.media import ImageFile
from tuisim.engine.shim.pybricks.parameters import Color

BLACK = (0, 0, 0)
WHITE = (255, 255, 255)


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Lab:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(image, "SCREEN", image.Canvas(178, 128, shown=True))
    return Lab(MotorLaw.PYBRICKS, {})


def dark(picture: Image) -> set[tuple[int, int]]:
    """The pixels that are not white."""
    pixels = picture._pixels()
    return {
        (x, y)
        for x in range(picture.width)
        for y in range(picture.height)
        if pixels.getpixel((x, y)) != WHITE
    }


def test_boxes_lines_and_pixels_are_drawn_where_asked(lab: Lab) -> None:
    box = Image.empty(10, 10)
    box.draw_box(1, 1, 4, 3)
    assert dark(box) == {(x, y) for x in range(1, 5) for y in range(1, 4)} - {(2, 2), (3, 2)}
    box.draw_box(4, 3, 1, 1, fill=True, color=Color.RED)
    assert box._pixels().getpixel((2, 2)) == (255, 0, 0)
    box.clear()
    box.draw_pixel(9, 9)
    box.draw_pixel(50, 50)
    box.draw_line(0, 0, 3, 0, color=Color.WHITE)
    assert dark(box) == {(9, 9)}
    circle = Image.empty(21, 21)
    circle.draw_circle(10, 10, 8)
    assert (2, 10) in dark(circle) and (10, 10) not in dark(circle)
    round_box = Image.empty(21, 21)
    round_box.draw_box(0, 0, 20, 20, r=6, fill=True)
    assert (0, 0) not in dark(round_box) and (10, 0) in dark(round_box)


def test_a_part_shares_its_pixels_and_a_copy_does_not(lab: Lab) -> None:
    whole = Image.empty(20, 10)
    part = Image(whole, sub=True, x1=5, y1=2, x2=9, y2=6)
    copy = Image(whole)
    part.draw_pixel(0, 0)
    assert (part.width, part.height) == (5, 5)
    assert (Image(part).width, Image(part).height) == (5, 5)
    assert dark(whole) == {(5, 2)} and dark(copy) == set()
    with pytest.raises(ValueError, match="Invalid"):
        Image(whole, sub=True, x1=5, x2=20)
    with pytest.raises(ValueError, match="Invalid"):
        Image.empty(0, 5)


def test_images_are_copied_without_the_transparent_colour(lab: Lab) -> None:
    source = Image.empty(4, 4)
    target = Image.empty(8, 8)
    source.draw_pixel(1, 1)
    target.draw_box(0, 0, 7, 7, fill=True, color=Color.BLUE)
    target.draw_image(2, 2, source, transparent=Color.WHITE)
    assert target._pixels().getpixel((3, 3)) == BLACK
    assert target._pixels().getpixel((2, 2)) == (0, 0, 255)
    target.load_image(source)
    assert dark(target) == {(3, 3)}


def test_images_are_saved_and_loaded_as_png_without_naming_the_suffix(
    lab: Lab, tmp_path: Path
) -> None:
    picture = Image.empty(6, 6)
    picture.draw_pixel(2, 3)
    picture.save("own")
    assert (tmp_path / "own.png").exists()
    assert dark(Image("own")) == {(2, 3)}
    with pytest.raises(FileNotFoundError):
        Image("missing")


def test_a_built_in_image_is_drawn_as_a_stand_in_and_noted_once(
    lab: Lab, capsys: pytest.CaptureFixture[str]
) -> None:
    one = Image(vars(ImageFile)["ANGRY"])
    other = Image(vars(ImageFile)["UP"])
    assert (one.width, one.height) == (178, 128) and dark(one) != dark(other)
    assert lab.brick.said == {"images"}


def test_the_screen_is_recorded_when_it_changes(lab: Lab) -> None:
    screen = Image(image.THE_SCREEN)
    assert (screen.width, screen.height) == (178, 128)
    screen.draw_text(10, 20, 7, background_color=Color.YELLOW)
    screen.draw_pixel(500, 500)
    rows = [row for row, stream in lab.shown if stream is Stream.DISPLAY]
    assert len(set(rows)) == 1
    screen.clear()
    assert len({row for row, _ in lab.shown}) == 2


def test_drawing_takes_a_millisecond(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    charged: list[int] = []
    monkeypatch.setattr(lab, "charge", charged.append)
    Image(image.THE_SCREEN).draw_line(0, 0, 9, 9)
    assert charged == [1_000_000]


def test_screen_print_keeps_its_own_cursor_and_scrolls(lab: Lab) -> None:
    screen = Image(image.THE_SCREEN)
    screen.set_font(Font(size=24))
    lines = screen.height // screen._font.height
    for at in range(lines):
        screen.print(at, "x", sep="", end="" if at + 1 == lines else "\n")
    before = dark(screen)
    screen.print("", "\n", end="")
    screen.print("last")
    shifted = {(x, y - screen._font.height) for x, y in before if y >= 2 * screen._font.height}
    assert shifted & dark(screen)
    assert dark(screen) != before
