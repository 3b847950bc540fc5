"""Screenshots: the cells of the whole screen, and their files."""

from __future__ import annotations

import io
from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

from rich.cells import split_graphemes
from rich.color import Color
from rich.segment import Segment
from rich.style import Style
from textual._context import visible_screen_stack
from textual.app import App

from tuisim.charts.cell_image import PLAIN, Cell, CellGrid, Look, image_of_cells, svg_of_cells
from tuisim.charts.files import write_whole
from tuisim.core.css_colors import Rgb
from tuisim.logs.export import check_place

_DIM = 0.5
"""Share of its own colour that dim text keeps."""


def screen_cells(app: App[Any]) -> CellGrid:
    """Return the cells of an app's screen, with its dialogs and notices."""
    # As Textual's own `export_screenshot` does.
    visible_screen_stack.set(app._background_screens)
    strips = app.screen._compositor.render_strips()
    width = app.screen.size.width
    rows = [[cell for segment in strip for cell in _cells(segment)][:width] for strip in strips]
    return [row + [(" ", PLAIN)] * (width - len(row)) for row in rows]


def _cells(segment: Segment) -> Iterator[Cell]:
    text, style, control = segment
    if control:
        return
    look = _look(style) if style else PLAIN
    for start, end, width in split_graphemes(text)[0]:
        if width:
            yield text[start:end], look
            yield from [("", look)] * (width - 1)


def _look(style: Style) -> Look:
    ink, ground = _rgb(style.color, PLAIN.ink), _rgb(style.bgcolor, PLAIN.ground)
    if style.reverse:
        ink, ground = ground, ink
    if style.dim:
        red, green, blue = (round(_DIM * one + (1 - _DIM) * other) for one, other in zip(ink, ground, strict=True))
        ink = red, green, blue
    flags = (style.bold, style.italic, style.underline, style.strike)
    return Look(ink, ground, *map(bool, flags))


def _rgb(color: Color | None, default: Rgb) -> Rgb:
    return default if color is None or color.is_default else color.get_truecolor()


def save_screenshot(grid: CellGrid, folder: Path) -> tuple[Path, Path]:
    """Write a screen as SVG and PNG; return the two files, which are new.

    Raises:
        ExportError: they cannot be written.
    """
    names = ((folder / f"tuisim-{number}.svg", folder / f"tuisim-{number}.png") for number in count(1))
    svg, png = next(pair for pair in names if not any(path.exists() for path in pair))
    for path in (svg, png):
        check_place(path)
    content = io.BytesIO()
    image_of_cells(grid).save(content, "png", optimize=True)
    write_whole(svg, svg_of_cells(grid, "tuisim").encode())
    write_whole(png, content.getvalue())
    return svg, png
