"""The layout of the panels: a pure function from the size of the terminal to boxes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

from tuisim.app.panels import BOTTOM, LARGE, MAIN, MEDIUM, PANELS, SIDE, SMALL
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

BORDER = 2
"""Rows or columns that the two edges of a border take."""
MIN_STRIP_COLS = 36
"""A panel of the bottom strip is not made narrower than this to fit another one next to it."""


@dataclass(frozen=True, slots=True)
class PanelBox:
    """The box of a panel, in cells from the upper left corner."""

    x: int
    y: int
    width: int
    height: int


@dataclass(frozen=True, slots=True)
class PanelLayout:
    """Boxes by panel id, and the panels that did not fit."""

    boxes: dict[str, PanelBox]
    left_out: tuple[str, ...] = ()


def size_class(width: int, height: int) -> str:
    """Return the size of a terminal: small, medium or large."""
    if width >= 170 and height >= 50:
        return LARGE
    if width >= 112 and height >= 34:
        return MEDIUM
    return SMALL


def side_width(width: int) -> int:
    """Return the width of the side column: two sensor discs fit side by side from 112 columns on."""
    if width < 112:
        return max(26, min(34, width * 28 // 80))
    return 42 if width < 170 else 46


def _in_place(panels: Sequence[str], place: str) -> list[str]:
    """Return the panels of one area, in the order of the table."""
    return [info.id for info in PANELS.values() if info.place == place and info.id in panels]


def _share(panels: Sequence[str], wanted: Sequence[str], rows: int) -> list[int]:
    """Divide `rows` among stacked panels: the minimum, then preferred heights by priority, the rest to the topmost."""
    heights = {panel: PANELS[panel].min_rows for panel in panels}
    spare = rows - sum(heights.values())
    for panel in sorted(panels, key=wanted.index):
        more = min(spare, PANELS[panel].good_rows - heights[panel])
        heights[panel] += more
        spare -= more
    heights[panels[0]] += spare
    return list(heights.values())


def _strip_rows(strip: Sequence[str], width: int) -> list[list[str]]:
    """Cut the bottom strip into rows of panels that are side by side."""
    if not strip:
        return []
    columns = max(1, min(len(strip), width // MIN_STRIP_COLS))
    count = ceil(len(strip) / columns)
    return [list(strip[row::count]) for row in range(count)]


def _row_least(row: Sequence[str]) -> int:
    return max(PANELS[panel].min_rows for panel in row)


def _strip_least(rows: list[list[str]]) -> int:
    return sum(map(_row_least, rows))


def _fits(panels: Sequence[str], width: int, height: int) -> bool:
    side, strip, main = (_in_place(panels, place) for place in (SIDE, BOTTOM, MAIN))
    if sum(PANELS[panel].min_rows for panel in side) > height:
        return False
    left = width - (side_width(width) if side and (strip or main) else 0)
    need = _strip_least(_strip_rows(strip, left)) + sum(PANELS[panel].min_rows for panel in main)
    return need <= height


def _main_rows(width: int, height: int, strip_least: int) -> int:
    """Return the rows for the world: as many as its shape needs, if the strip below keeps its minimum."""
    # A cell is two half blocks high, and a half block is roughly square.
    ideal = ceil((width - BORDER) * FIELD_HEIGHT_MM / FIELD_WIDTH_MM / 2) + BORDER
    return min(ideal, height - strip_least)


def _place_strip(boxes: dict[str, PanelBox], rows: list[list[str]], top: int, width: int, height: int) -> None:
    # Rows of panels share the height as panels in a column do, except that the rest goes to all of them.
    least = [_row_least(row) for row in rows]
    good = [max(PANELS[panel].good_rows for panel in row) for row in rows]
    spare = height - sum(least)
    for at, row in enumerate(rows):
        extra = spare * good[at] // sum(good[at:])
        spare -= extra
        rows_high = least[at] + extra
        x = 0
        shares = sum(PANELS[panel].weight for panel in row)
        for panel in row:
            across = (width - x) * PANELS[panel].weight // shares
            boxes[panel] = PanelBox(x, top, across, rows_high)
            x += across
            shares -= PANELS[panel].weight
        top += rows_high


def arrange(panels: Sequence[str], width: int, height: int) -> PanelLayout:
    """Place panels on a screen.

    Args:
        panels: Ids, the most wanted first.
        width: Columns.
        height: Rows.

    Returns:
        Boxes that fill the screen without overlap; panels that found no room are left out.
    """
    kept: list[str] = []
    left_out: list[str] = []
    for panel in panels:
        (kept if _fits([*kept, panel], width, height) else left_out).append(panel)
    side, strip, main = (_in_place(kept, place) for place in (SIDE, BOTTOM, MAIN))
    boxes: dict[str, PanelBox] = {}
    left = width
    if side:
        left = width - side_width(width) if strip or main else 0
        y = 0
        for panel, rows_high in zip(side, _share(side, kept, height), strict=True):
            boxes[panel] = PanelBox(left, y, width - left, rows_high)
            y += rows_high
    rows = _strip_rows(strip, left)
    top = 0
    if main:
        top = _main_rows(left, height, _strip_least(rows)) if strip else height
        boxes[main[0]] = PanelBox(0, 0, left, top)
    if strip:
        _place_strip(boxes, rows, top, left, height - top)
    return PanelLayout(boxes, tuple(left_out))


def with_room(panel: str, panels: Sequence[str], least: tuple[int, int], size: tuple[int, int]) -> list[str]:
    """Return the panels to show so that one has room: as they are, else without those beside it, else it alone.

    Args:
        panel: The one.
        panels: Ids, the most wanted first.
        least: Columns and rows that are room enough.
        size: Columns and rows of the screen.
    """
    others = [other for other in panels if other != panel]
    elsewhere = [other for other in others if PANELS[other].place != PANELS[panel].place]
    for beside in (others, elsewhere):
        box = arrange([panel, *beside], *size).boxes[panel]
        if box.width >= least[0] and box.height >= least[1]:
            return [panel, *beside]
    return [panel]
