"""The screen as a tree: panels one above the other or side by side."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from enum import StrEnum
from itertools import accumulate, pairwise

from tuisim.app.panels import PANELS
from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

EDGES = 2
"""Number of rows, and also of columns, that the two opposite edges of a panel take."""
TIME_BAR_ROWS = 1
_CELL_ASPECT = 2
"""Height of a cell of the terminal, in widths of a cell."""


class Axis(StrEnum):
    """The direction in which the parts of a split are arranged."""

    ROWS = "/"
    """The parts of the split stand one above the other."""
    COLUMNS = "|"
    """The parts of the split stand side by side."""


@dataclass(frozen=True, slots=True)
class Split:
    """A node of the tree: a part of the screen that is divided into panels or further splits, along an axis."""

    axis: Axis
    parts: tuple[Node, ...]
    shares: tuple[float, ...] = ()
    """Share of the width, from 0 to 1, of each part, for parts side by side; empty for parts one above the other."""
    least: tuple[int, ...] = ()
    """Minimum rows of each part, for parts one above the other; empty for the minimum rows of their panels."""


Node = str | Split
"""The id of a panel, or a split."""


@dataclass(frozen=True, slots=True)
class PanelBox:
    """The position and the size of a panel, in cells from the upper left corner."""

    x: int
    y: int
    width: int
    height: int


@dataclass
class PanelLayout:
    """A layout of panels: the boxes of those that fit, and the ids of those that do not."""

    boxes: dict[str, PanelBox] = field(default_factory=dict)
    """The boxes of the panels on the screen, by the id of the panel."""
    left_out: tuple[str, ...] = ()
    wanted: Sequence[str] = ()
    """Ids of the panels in the order in which they get rows; the world gets its rows before them."""

    def rank(self, node: Node) -> int:
        """Return the rank of a node: nodes with lower ranks get their rows first.

        The rank is -1 if the node contains the world, else the index of its most wanted panel.
        """
        panels = list_panels(node)
        ranks = [self.wanted.index(panel) for panel in panels if panel in self.wanted]
        return -1 if "world" in panels else min(ranks, default=len(self.wanted))


def compute_ideal_rows(width: int) -> int:
    """Return the height in rows at which the mat fills a world panel of a width in columns."""
    return (
        round((width - EDGES) * FIELD_HEIGHT_MM / FIELD_WIDTH_MM / _CELL_ASPECT)
        + EDGES
        + TIME_BAR_ROWS
    )


def compute_ideal_columns(rows: int) -> int:
    """Return the width in columns at which the mat fills a world panel of a height in rows."""
    inside = rows - EDGES - TIME_BAR_ROWS
    return round(inside * _CELL_ASPECT * FIELD_WIDTH_MM / FIELD_HEIGHT_MM) + EDGES


def join_nodes(axis: Axis, parts: Sequence[Node], shares: Sequence[float] = ()) -> Node:
    """Return nodes side by side or above each other as one node; a single node is returned unchanged.

    Args:
        axis: The direction.
        parts: The nodes.
        shares: The share of the width or height for each node; empty for the usual shares.
    """
    if len(parts) == 1:
        return parts[0]
    if axis == Axis.COLUMNS and not shares:
        weights = [_find_weight(part) for part in parts]
        shares = [weight / sum(weights) for weight in weights]
    return Split(axis, tuple(parts), tuple(shares))


def list_panels(node: Node) -> tuple[str, ...]:
    """Return the ids of the panels in a node."""
    return (
        (node,)
        if isinstance(node, str)
        else tuple(panel for part in node.parts for panel in list_panels(part))
    )


def _find_weight(node: Node) -> int:
    return max(PANELS[panel].weight for panel in list_panels(node))


def _can_grow(node: Node) -> bool:
    return any(PANELS[panel].grows for panel in list_panels(node))


def count_min_columns(node: Node) -> int:
    """Return the minimum width of a node, in columns."""
    if isinstance(node, str):
        return PANELS[node].min_cols
    needed = [count_min_columns(part) for part in node.parts]
    return sum(needed) if node.axis == Axis.COLUMNS else max(needed)


def count_min_rows(node: Node) -> int:
    """Return the minimum height of a node, in rows."""
    if isinstance(node, str):
        return PANELS[node].min_rows
    needed = _list_min_rows(node)
    return sum(needed) if node.axis == Axis.ROWS else max(needed)


def _list_min_rows(split: Split) -> list[int]:
    needed = [count_min_rows(part) for part in split.parts]
    return [max(rows) for rows in zip(needed, split.least, strict=True)] if split.least else needed


def count_fair_rows(node: Node, width: int) -> int:
    """Return the height in rows at which every panel in a node is shown well, at a width in columns."""
    return _count_wished_rows(node, width, lambda panel: PANELS[panel].fair_rows)


def _count_good_rows(node: Node, width: int) -> int:
    return _count_wished_rows(node, width, lambda panel: PANELS[panel].good_rows)


def _count_wished_rows(node: Node, width: int, rows_of: Callable[[str], int]) -> int:
    if isinstance(node, str):
        return compute_ideal_rows(width) if node == "world" else rows_of(node)
    if node.axis == Axis.ROWS:
        return sum(_count_wished_rows(part, width, rows_of) for part in node.parts)
    parts = zip(node.parts, _divide_columns(node, width), strict=True)
    return max(_count_wished_rows(part, columns, rows_of) for part, columns in parts)


def _divide_columns(split: Split, width: int) -> list[int]:
    ends = [round(share * width) for share in accumulate(split.shares)]
    return [end - start for start, end in zip([0, *ends[:-1]], ends, strict=True)]


def _divide_rows(split: Split, width: int, height: int, rank: Callable[[Node], int]) -> list[int]:
    """Return the height in rows of each part of a split.

    First each part gets its minimum height. The remaining rows are then given in the order of the ranks: until each
    part is shown well, then until it has all rows that it can use. What is left goes to the part with the largest
    weight.
    """
    rows = _list_min_rows(split)
    spare = height - sum(rows)
    order = sorted(range(len(rows)), key=lambda index: rank(split.parts[index]))
    for wish in (count_fair_rows, _count_good_rows):
        for index in order:
            more = max(0, min(spare, wish(split.parts[index], width) - rows[index]))
            rows[index] += more
            spare -= more
    growing = [index for index in order if _can_grow(split.parts[index])] or order
    max_weight = max(_find_weight(split.parts[index]) for index in growing)
    growing = [index for index in growing if _find_weight(split.parts[index]) == max_weight]
    for count, index in enumerate(growing):
        more = spare // (len(growing) - count)
        rows[index] += more
        spare -= more
    return rows


def _divide_extent(split: Split, box: PanelBox, rank: Callable[[Node], int]) -> list[int]:
    """Divide the rows or columns of a box between the parts of a split; each part gets at least its minimum."""
    rows = split.axis == Axis.ROWS
    needs = _list_min_rows(split) if rows else [count_min_columns(part) for part in split.parts]
    extent = box.height if rows else box.width
    natural = (
        _divide_rows(split, box.width, box.height, rank)
        if rows
        else _divide_columns(split, box.width)
    )
    ends = [0]
    for index, end in enumerate(accumulate(natural[:-1])):
        ends.append(min(max(end, ends[-1] + needs[index]), extent - sum(needs[index + 1 :])))
    return [end - start for start, end in pairwise([*ends, extent])]


def place(node: Node, box: PanelBox, layout: PanelLayout) -> None:
    """Divide a box between the panels of a node.

    Args:
        node: The node.
        box: The box, not smaller than the minimum size of the node.
        layout: Gets the boxes of the panels.
    """
    if isinstance(node, str):
        layout.boxes[node] = box
        return
    x, y = box.x, box.y
    for part, size in zip(node.parts, _divide_extent(node, box, layout.rank), strict=True):
        if node.axis == Axis.COLUMNS:
            place(part, PanelBox(x, y, size, box.height), layout)
            x += size
        else:
            place(part, PanelBox(x, y, box.width, size), layout)
            y += size


def free_rows(boxes: Mapping[str, PanelBox], rows: int) -> dict[str, PanelBox]:
    """Return boxes of panels that leave the last rows of their area free.

    A horizontal line is drawn through the area where the panels on it have most rows to spare. These panels become
    lower, and the panels below the line move up. If no line lets each panel keep its minimum height, the boxes are
    returned unchanged.

    Args:
        boxes: The boxes of panels that fill the area.
        rows: The number of rows.
    """
    if rows < 1:
        return dict(boxes)
    best, line = 0, -1
    for y in range(max((box.y + box.height for box in boxes.values()), default=0) - rows + 1):
        cut = [panel for panel, box in boxes.items() if box.y < y + rows and y < box.y + box.height]
        heights = {panel: boxes[panel].height - rows for panel in cut}
        is_inside = all(0 <= y - boxes[panel].y <= height for panel, height in heights.items())
        if not is_inside or any(
            height < PANELS[panel].min_rows for panel, height in heights.items()
        ):
            continue
        spare = min(height - PANELS[panel].fair_rows for panel, height in heights.items())
        if line < 0 or spare >= best:
            best, line = spare, y
    return {
        panel: box
        if line < 0 or box.y + box.height <= line
        else replace(box, height=box.height - rows)
        if box.y <= line
        else replace(box, y=box.y - rows)
        for panel, box in boxes.items()
    }
