"""Pictures that are sent as pixels arrive as they are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
import pytest

from tests.cases import cases
from tests.terminal.decoder import PixelTerminal
from tuisim.terminal import kitty, sixel
from tuisim.terminal.picture import Graphics, Rectangle, TilePicture, find_rectangles
from tuisim.terminal.picture_options import Protocol

ROWS = 11
COLS = 21
CELL_PX = 6, 13
"""Neither a multiple of a sixel nor of a tile."""

Pixels = npt.NDArray[np.uint8]


def _disc(x_px: int, y_px: int, width: int = COLS * 6, height: int = ROWS * 13) -> Pixels:
    rows, cols = np.indices((height, width))
    picture = np.full((height, width, 3), (240, 250, 230), np.uint8)
    picture[:, ::40] = 10, 20, 200
    distance = np.hypot(rows - y_px, cols - x_px)
    picture[distance < 20] = np.stack([np.rint(distance * 10)] * 3, -1)[distance < 20].astype(
        np.uint8
    )
    return picture


def _draw(
    terminal: PixelTerminal,
    picture: TilePicture,
    runs: list[tuple[int, int, int]],
    shown: bool = True,
) -> int:
    cells = [
        (row + 1, col + 2, picture.row(row)[col])
        for row, first, count in runs
        for col in range(first, first + count)
    ]
    codes = picture.draw(cells, lambda row, col: shown)
    terminal.feed(codes)
    return len(codes)


def _seen(points: Pixels, protocol: Protocol) -> Pixels:
    """Return what a terminal shows of a picture: channels of sixel are percentages."""
    return (
        np.rint(np.rint(points * (100 / 255)) * 255 / 100).astype(np.uint8)
        if protocol is Protocol.SIXEL
        else points
    )


@pytest.mark.slow_cases("sixel-tmux", "kitty-tmux")
@pytest.mark.parametrize("in_tmux", [False, True], ids=["", "tmux"])
@pytest.mark.parametrize("protocol", Protocol)
def test_each_protocol_shows_a_moving_picture_with_its_exact_pixels(
    protocol: Protocol, in_tmux: bool
) -> None:
    picture = TilePicture(Graphics(protocol, CELL_PX, in_tmux))
    terminal = PixelTerminal(ROWS + 2, COLS + 3, CELL_PX)
    sent = []
    for step in range(6):
        points = _disc(20 + 9 * step, 30 + 13 * step)
        sent.append(_draw(terminal, picture, picture.put(points)))
        shown = terminal.pixels[13 : 13 + len(points), 12 : 12 + points.shape[1]]
        assert np.array_equal(shown, _seen(points, protocol))
    assert not picture.put(points)
    points = points.copy()
    points[0, 0] = 0
    assert _draw(terminal, picture, picture.put(points)) < sent[0] / 3


@pytest.mark.parametrize("protocol", Protocol)
def test_a_picture_of_another_size_is_sent_whole(protocol: Protocol) -> None:
    picture = TilePicture(Graphics(protocol, CELL_PX))
    terminal = PixelTerminal(ROWS + 2, COLS + 3, CELL_PX)
    _draw(terminal, picture, picture.put(_disc(30, 30)))
    points = _disc(30, 30, 6 * 9, 13 * 5)
    _draw(terminal, picture, picture.put(points))
    assert np.array_equal(
        terminal.pixels[13 : 13 + len(points), 12 : 12 + points.shape[1]], _seen(points, protocol)
    )


def _moved(terminal: PixelTerminal, picture: TilePicture) -> None:
    for step in range(8):
        _draw(terminal, picture, picture.put(_disc(20 + 9 * step, 40)))


def _made_smaller(terminal: PixelTerminal, picture: TilePicture) -> None:
    _draw(terminal, picture, picture.put(_disc(20, 40)))
    _draw(terminal, picture, picture.put(_disc(20, 40, 6 * 9, 13 * 5)))


def _sent_again(terminal: PixelTerminal, picture: TilePicture) -> None:
    for x_px in (20, 29):
        _draw(terminal, picture, picture.put(_disc(x_px, 40)))
    picture.forget()
    _draw(terminal, picture, [(row, 0, COLS) for row in range(ROWS)])


def _gone(terminal: PixelTerminal, picture: TilePicture) -> None:
    _draw(terminal, picture, picture.put(_disc(20, 40)))
    terminal.feed(picture.build_deletion()())


KEPT = {
    "moved": (_moved, 3 * 3),
    "made smaller": (_made_smaller, 2 * 2),
    "sent again": (_sent_again, 3 * 3),
    "gone": (_gone, 0),
}


@pytest.mark.parametrize("in_tmux", [False, True], ids=["", "tmux"])
@cases("draw, expected", KEPT)
def test_kitty_images_that_are_no_longer_visible_are_deleted(
    draw: Callable[[PixelTerminal, TilePicture], None], expected: int, in_tmux: bool
) -> None:
    picture = TilePicture(Graphics(Protocol.KITTY, CELL_PX, in_tmux))
    terminal = PixelTerminal(ROWS + 2, COLS + 3, CELL_PX)
    draw(terminal, picture)
    assert len(terminal.images) == expected


def test_the_command_that_deletes_all_images_leaves_none_in_kitty() -> None:
    picture = TilePicture(Graphics(Protocol.KITTY, CELL_PX))
    terminal = PixelTerminal(ROWS + 2, COLS + 3, CELL_PX)
    _draw(terminal, picture, picture.put(_disc(20, 40)))
    terminal.feed(kitty.DELETE_ALL)
    assert not terminal.images


@pytest.mark.parametrize("protocol", [Protocol.SIXEL, Protocol.ITERM])
def test_a_picture_is_not_drawn_over_the_text_that_covers_it(protocol: Protocol) -> None:
    picture = TilePicture(Graphics(protocol, CELL_PX))
    terminal = PixelTerminal(ROWS + 2, COLS + 3, CELL_PX)
    _draw(terminal, picture, picture.put(_disc(30, 40)))
    terminal.feed("\x1b[6;8H####")
    covered = {(5, col) for col in range(7, 11)}
    changed = [
        (row + 1, col + 2, picture.row(row)[col])
        for row, first, count in picture.put(_disc(45, 50))
        for col in range(first, first + count)
        if (row + 1, col + 2) not in covered
    ]
    terminal.feed(picture.draw(changed, lambda row, col: (row, col) not in covered))
    assert set(terminal.texts) == covered


def test_pictures_with_many_colors_are_sent_in_the_nearest() -> None:
    points = np.random.default_rng(1).integers(0, 256, (24, 60, 3), np.uint8)
    terminal = PixelTerminal(3, 11, CELL_PX)
    terminal.feed(sixel.encode(points))
    difference = terminal.pixels[:24, :60].astype(int) - points
    assert np.abs(difference).mean() < 40
    assert len(np.unique(terminal.pixels.reshape(-1, 3), axis=0)) <= sixel.MAX_COLORS + 1


@pytest.mark.parametrize(
    "rows, expected",
    [
        (["....", "...."], []),
        ([".##.", ".##."], [(0, 1, 2, 3)]),
        (["#.....", ".....#"], [(0, 0, 1, 1), (1, 5, 2, 6)]),
        ([".##.", "####", ".##."], [(0, 0, 3, 4)]),
    ],
    ids=["nothing", "block", "far apart", "nearly a block"],
)
def test_changed_cells_of_a_picture_are_joined_to_rectangles(
    rows: list[str], expected: list[tuple[int, ...]]
) -> None:
    changed = np.array([[mark == "#" for mark in row] for row in rows])
    assert find_rectangles(changed, lambda _: True) == [Rectangle(*one) for one in expected]


def test_rectangles_are_not_joined_across_covered_cells() -> None:
    changed = np.array([[True, False, True]])
    assert len(find_rectangles(changed, lambda _: True)) == 1
    assert len(find_rectangles(changed, lambda _: False)) == 2
