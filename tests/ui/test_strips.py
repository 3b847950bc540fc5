"""Strips of our own: what they send, and that the terminal shows what was meant."""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO
from typing import Any

import numpy as np
import pyte
import pytest
from rich.console import Console
from rich.style import Style
from textual._compositor import ChopsUpdate
from textual.app import App, ComposeResult

from tuisim.ui.cellview import LinesView, PixelView
from tuisim.ui.render.cells import to_cells
from tuisim.ui.strips import CellStrip, TextStrip, use_exact_crops

WIDTH, ROWS = 60, 12


@pytest.fixture(autouse=True)
def textual_own_way() -> Iterator[None]:
    """Begin and end with what Textual does by itself."""
    use_exact_crops(False)
    yield
    use_exact_crops(False)


def console(system: Any = "truecolor") -> Console:
    return Console(file=StringIO(), force_terminal=True, color_system=system, _environ={})


def photo() -> np.ndarray[Any, np.dtype[np.uint8]]:
    return np.random.default_rng(3).integers(0, 256, (2 * ROWS, WIDTH, 3), np.uint8)


class Picture(App[None]):
    CSS = "PixelView { width: 60; height: 12; } LinesView { width: 60; height: 3; }"

    def __init__(self) -> None:
        super().__init__()
        self.view, self.lines = PixelView(), LinesView()

    def compose(self) -> ComposeResult:
        yield self.view
        yield self.lines


def update_bytes(app: Picture) -> str:
    """What a partial update sends for what is dirty now."""
    update = app.screen._compositor.render_partial_update()
    assert update is not None
    return update.render_segments(console())


def make_dirty(app: Picture, x: int) -> None:
    region = app.view.region
    app.screen._compositor._dirty_regions = {type(region)(region.x + x, region.y, 1, 1)}


async def test_one_cell_costs_one_cell_wherever_it_is() -> None:
    app = Picture()
    async with app.run_test(size=(80, 24)) as pilot:
        app.view.set_picture(photo())
        await pilot.pause()
        use_exact_crops()

        sizes = []
        for x in (0, 30, 59):
            make_dirty(app, x)
            sizes.append(len(update_bytes(app)))

    assert max(sizes) < 60


async def test_without_the_remedy_textual_sends_from_the_left_edge() -> None:
    """If this fails, Textual crops on both sides by itself and the remedy can go."""
    app = Picture()
    async with app.run_test(size=(80, 24)) as pilot:
        app.view.set_picture(photo())
        await pilot.pause()
        use_exact_crops(False)
        make_dirty(app, 59)

        assert len(update_bytes(app)) > 600


async def test_text_is_sent_in_part() -> None:
    app = Picture()
    async with app.run_test(size=(80, 24)) as pilot:
        app.lines.set_lines([[("x" * 55, Style()), ("1", Style())]])
        await pilot.pause()
        use_exact_crops()
        region = app.lines.region
        app.screen._compositor._dirty_regions = {type(region)(region.x + 55, region.y, 1, 1)}

        assert len(update_bytes(app)) < 60


@pytest.mark.parametrize("exact", [True, False], ids=["exact", "textual"])
async def test_the_terminal_shows_the_picture_after_partial_updates(exact: bool) -> None:
    app = Picture()
    screen = pyte.Screen(80, 24)
    stream = pyte.Stream(screen)
    picture = photo()
    rng = np.random.default_rng(4)
    async with app.run_test(size=(80, 24)) as pilot:
        app.view.set_picture(picture)
        await pilot.pause()
        use_exact_crops(exact)
        compositor = app.screen._compositor
        stream.feed(compositor.render_full_update().render_segments(console()).replace("\n", "\r\n"))
        for _ in range(5):
            picture = picture.copy()
            for y, x in zip(rng.integers(0, 2 * ROWS, 12), rng.integers(0, WIDTH, 12), strict=True):
                picture[y, x] = rng.integers(0, 256, 3)
            old = to_cells(app.view._shown)
            app.view.set_picture(picture)
            rows, cols = np.nonzero(old != to_cells(app.view._shown))
            region = app.view.region
            compositor._dirty_regions = {
                type(region)(region.x + int(x), region.y + int(y), 1, 1) for y, x in zip(rows, cols, strict=True)
            }
            stream.feed(update_bytes(app).replace("\n", "\r\n"))

    # The picture in the colours of this terminal, whichever it is.
    picture, region = app.view._shown, app.view.region
    for y in range(ROWS):
        for x in range(WIDTH):
            char = screen.buffer[region.y + y][region.x + x]
            top, bottom = picture[2 * y, x], picture[2 * y + 1, x]
            assert char.bg == "".join(f"{channel:02x}" for channel in bottom)
            assert char.data == " " or char.fg == "".join(f"{channel:02x}" for channel in top)


def test_a_cell_strip_writes_a_colour_once() -> None:
    red = 0xFF0000_FF0000

    assert CellStrip([red] * 3).render(console()) == "\x1b[48;2;255;0;0m   \x1b[0m"
    assert CellStrip([0xFF0000_0000FF] * 2).render(console()) == "\x1b[38;2;255;0;0;48;2;0;0;255m▀▀\x1b[0m"


@pytest.mark.parametrize(
    ("system", "codes"),
    [("256", "38;5;196;48;5;21"), ("standard", "31;44")],
)
def test_a_cell_strip_in_fewer_colours(system: str, codes: str) -> None:
    assert CellStrip([0xFF0000_0000FF]).render(console(system)) == f"\x1b[{codes}m▀\x1b[0m"


def test_cropping_and_dividing_make_strips_of_the_same_kind() -> None:
    cells = CellStrip(list(range(10)))
    text = TextStrip(CellStrip([1, 2, 3, 4])._segments, 4)

    assert [piece.cell_length for piece in cells.divide([3, 10])] == [3, 7]
    assert all(isinstance(piece, CellStrip) for piece in [cells.crop(2, 5), *cells.divide([3, 10])])
    assert all(isinstance(piece, TextStrip) for piece in [text.crop(1, 3), *text.divide([2, 4])])
    assert cells.crop(20, 30).cell_length == 0


def test_a_cell_strip_works_where_segments_are_asked_for() -> None:
    strip = CellStrip([0xFF0000_0000FF, 0x00FF00_00FF00])

    assert strip.text == "▀ "
    assert strip.adjust_cell_length(4, Style()).cell_length == 4
    assert strip.crop_extend(0, 3, Style()).cell_length == 3
    assert strip.apply_style(Style(bold=True)).text == "▀ "
    assert bool(strip)
    assert not CellStrip([])


def test_missing_private_names_leave_textual_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    import textual._compositor as compositor

    own = ChopsUpdate.render_segments
    monkeypatch.delattr(compositor, "ChopsUpdate")

    assert not use_exact_crops()
    assert ChopsUpdate.render_segments is own


def test_it_can_be_switched_off_again() -> None:
    own = ChopsUpdate.render_segments

    assert use_exact_crops()
    assert ChopsUpdate.render_segments is not own
    assert not use_exact_crops(False)
    assert ChopsUpdate.render_segments is own
