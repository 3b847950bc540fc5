"""Screenshots: the cells of the whole screen, and their files."""

from __future__ import annotations

import io
from itertools import count
from pathlib import Path
from typing import Any

from textual.app import App

from tuisim.logs.export import check_place
from tuisim.pictures.charts.files import write_whole
from tuisim.terminal.cell_image import CellGrid, draw_cells, draw_cells_svg, split_cells
from tuisim.terminal.textual_internals import render_screen


def collect_cells(app: App[Any]) -> CellGrid:
    """Return the cells of the whole screen of an app, with its dialogs and notices."""
    width = app.screen.size.width
    runs = (
        [(text, style) for text, style, control in strip if not control]
        for strip in render_screen(app)
    )
    return [split_cells(row, width) for row in runs]


def save_screenshot(grid: CellGrid, folder: Path) -> tuple[Path, Path]:
    """Write the cells of a screen to new files, as SVG and as PNG; return their paths.

    Raises:
        ExportError: they cannot be written.
    """
    names = (
        (folder / f"tuisim-{number}.svg", folder / f"tuisim-{number}.png") for number in count(1)
    )
    svg, png = next(pair for pair in names if not any(path.exists() for path in pair))
    for path in (svg, png):
        check_place(path)
    content = io.BytesIO()
    draw_cells(grid).save(content, "png", optimize=True)
    write_whole(svg, draw_cells_svg(grid, "tuisim").encode())
    write_whole(png, content.getvalue())
    return svg, png
