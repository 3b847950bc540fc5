"""What a terminal with pixels shows, and what the app has drawn for it."""

from __future__ import annotations

from typing import Any

import numpy as np
from textual.pilot import Pilot

from tests.app.app_help import ready, until
from tests.app.wires import until_quiet, wire_of
from tests.terminal.decoder import PixelTerminal
from tuisim.app.plot_view import PlotView
from tuisim.terminal.cell_view import PixelView
from tuisim.terminal.picture_options import Protocol
from tuisim.terminal.queries import TerminalAnswered, parse_facts

CELL_PX = 8, 16
ANSWERS = {
    Protocol.SIXEL: "\x1bP>|XTerm(379)\x1b\\\x1b[6;16;8t\x1b[?63;4c",
    Protocol.ITERM: "\x1bP>|iTerm2 3.5.4\x1b\\\x1b[6;16;8t\x1b[?64;4c",
    Protocol.KITTY: "\x1bP>|kitty(0.36.4)\x1b\\\x1b[6;16;8t\x1b[?62;52;c\x1b_Gi=31;OK\x1b\\",
}


def seen_on(pilot: Pilot[Any]) -> PixelTerminal:
    terminal = PixelTerminal(40, 120, CELL_PX)
    terminal.feed("".join(wire_of(pilot).sent))
    return terminal


def part_of(terminal: PixelTerminal, view: PixelView | PlotView) -> np.ndarray[Any, Any]:
    x, y, width, height = view.content_region
    return terminal.pixels[y * 16 : (y + height) * 16, x * 8 : (x + width) * 8]


def drawn_by(view: PixelView | PlotView, protocol: Protocol) -> np.ndarray[Any, Any]:
    assert view._tiles is not None
    points = view._tiles._points
    return (
        np.rint(np.rint(points * (100 / 255)) * 255 / 100).astype(np.uint8)
        if protocol == "sixel"
        else points
    )


async def sharp(pilot: Pilot[Any], view: PixelView) -> None:
    """Wait until a picture is drawn with pixels: while it moves and the link may be slow, it need not be."""
    await until(pilot, lambda: view._tiles is not None and not view._tiles.is_coarse)
    await until_quiet(pilot)


async def answered(pilot: Pilot[Any], answers: str) -> None:
    await ready(pilot)
    await until_quiet(pilot)
    pilot.app.post_message(TerminalAnswered(parse_facts(answers)))
    await until_quiet(pilot)


def on_canvas(view: PlotView, points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return what an image of the view shows where it has a chart."""
    rows = [
        points[y * 16 : y * 16 + 16, 8 * left : 8 * right]
        for y, (left, right) in view._spans.items()
    ]
    return np.concatenate(rows)
