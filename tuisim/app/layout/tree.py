"""The screen as a tree: panels one above the other or side by side, and the borders between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import accumulate

from tuisim.app.panels import PANELS
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

EDGES = 2
"""Rows or columns that the two edges of a panel take."""
TIME_BAR_ROWS = 1
MIN_COLS = 24
"""A panel beside another one is not made narrower."""
_CELL_ASPECT = 2
"""Height of a cell, in widths of a cell."""


class Axis(StrEnum):
    """The direction in which the parts of a split follow each other."""

    ROWS = "/"
    """One above the other."""
    COLUMNS = "|"
    """Side by side."""


@dataclass(frozen=True, slots=True)
class Split:
    """A part of the screen that is divided; its parts are panels or divided again."""

    axis: Axis
    parts: tuple[Node, ...]
    shares: tuple[float, ...] = ()
    """Share of the width of each part, for parts side by side; the sum is 1."""
    least_rows: int = 0
    """Rows that it gets before the world gets what its shape needs."""


Node = str | Split
"""The id of a panel, or a split."""


@dataclass(frozen=True, slots=True)
class PanelBox:
    """The box of a panel, in cells from the upper left corner."""

    x: int
    y: int
    width: int
    height: int

    def contains(self, x: int, y: int) -> bool:
        """Return whether a cell is in the box."""
        return self.x <= x < self.x + self.width and self.y <= y < self.y + self.height


@dataclass(frozen=True, slots=True)
class Border:
    """A border between two parts, which can be moved."""

    name: str
    """The panels that it separates: `world|output`, or `world/output` if one is above the other."""
    axis: Axis
    at: int
    """Column or row of the first cell of the second part."""
    box: PanelBox
    """The box of the split that it belongs to."""
    low: int
    """The smallest `at`."""
    high: int
    before: tuple[str, ...]
    """The panels of the part before it."""
    after: tuple[str, ...]

    def touches(self, x: int, y: int) -> bool:
        """Return whether a cell is one of the two edges at this border."""
        along = x if self.axis == Axis.COLUMNS else y
        return along in (self.at - 1, self.at) and self.box.contains(x, y)

    def share_at(self, at: int) -> float:
        """Return a position as a share of the split, within what the panels need."""
        start, extent = _along(self.box, self.axis)
        return (min(max(at, self.low), self.high) - start) / extent


@dataclass
class PanelLayout:
    """Where everything is, and what did not fit."""

    boxes: dict[str, PanelBox] = field(default_factory=dict)
    """By panel."""
    borders: list[Border] = field(default_factory=list)
    left_out: tuple[str, ...] = ()
    wanted: Sequence[str] = ()
    """Panels that get rows first, the most wanted first; the world is before them."""

    def rank(self, node: Node) -> int:
        """Return the place of a node in the order in which rows are given."""
        panels = panels_of(node)
        ranks = [self.wanted.index(panel) for panel in panels if panel in self.wanted]
        return -1 if "world" in panels else min(ranks, default=len(self.wanted))


def ideal_rows(width: int) -> int:
    """Return the rows that a world panel of this width needs, so that the mat fills it."""
    return round((width - EDGES) * FIELD_HEIGHT_MM / FIELD_WIDTH_MM / _CELL_ASPECT) + EDGES + TIME_BAR_ROWS


def joined(axis: Axis, parts: Sequence[Node], least_rows: int = 0, shares: Sequence[float] = ()) -> Node:
    """Return parts as one node; a single part stays as it is."""
    if len(parts) == 1:
        return parts[0]
    if axis == Axis.COLUMNS and not shares:
        weights = [_weight(part) for part in parts]
        shares = [weight / sum(weights) for weight in weights]
    return Split(axis, tuple(parts), tuple(shares), least_rows)


def panels_of(node: Node) -> tuple[str, ...]:
    """Return the panels in a node."""
    return (node,) if isinstance(node, str) else tuple(panel for part in node.parts for panel in panels_of(part))


def _weight(node: Node) -> int:
    return max(PANELS[panel].weight for panel in panels_of(node))


def _grows(node: Node) -> bool:
    return any(PANELS[panel].grows for panel in panels_of(node))


def least_columns(node: Node) -> int:
    """Return the columns that a node needs at least."""
    if isinstance(node, str):
        return MIN_COLS
    needed = [least_columns(part) for part in node.parts]
    return sum(needed) if node.axis == Axis.COLUMNS else max(needed)


def least_rows(node: Node) -> int:
    """Return the rows that a node needs at least."""
    if isinstance(node, str):
        return PANELS[node].min_rows
    needed = [least_rows(part) for part in node.parts]
    return max(node.least_rows, sum(needed) if node.axis == Axis.ROWS else max(needed))


def fair_rows(node: Node, width: int) -> int:
    """Return the rows with which everything in a node is shown well."""
    return _wished(node, width, lambda panel: PANELS[panel].fair_rows)


def _good_rows(node: Node, width: int) -> int:
    return _wished(node, width, lambda panel: PANELS[panel].good_rows)


def _wished(node: Node, width: int, rows_of: Callable[[str], int]) -> int:
    if isinstance(node, str):
        return ideal_rows(width) if node == "world" else rows_of(node)
    if node.axis == Axis.ROWS:
        return max(node.least_rows, sum(_wished(part, width, rows_of) for part in node.parts))
    parts = zip(node.parts, _columns(node, width), strict=True)
    return max(node.least_rows, *(_wished(part, columns, rows_of) for part, columns in parts))


def _columns(split: Split, width: int) -> list[int]:
    ends = [round(share * width) for share in accumulate(split.shares)]
    return [end - start for start, end in zip([0, *ends[:-1]], ends, strict=True)]


def _rows(split: Split, width: int, height: int, rank: Callable[[Node], int]) -> list[int]:
    """Divide rows: what each part needs, then the world's shape, what is fair, what is good; the rest to what grows."""
    rows = [least_rows(part) for part in split.parts]
    spare = height - sum(rows)
    order = sorted(range(len(rows)), key=lambda at: rank(split.parts[at]))
    for wish in (fair_rows, _good_rows):
        for at in order:
            more = max(0, min(spare, wish(split.parts[at], width) - rows[at]))
            rows[at] += more
            spare -= more
    growing = [at for at in order if _grows(split.parts[at])] or order
    weights = [_weight(split.parts[at]) for at in growing]
    for count, at in enumerate(growing):
        more = spare * weights[count] // sum(weights[count:])
        rows[at] += more
        spare -= more
    return rows


def _along(box: PanelBox, axis: Axis) -> tuple[int, int]:
    return (box.x, box.width) if axis == Axis.COLUMNS else (box.y, box.height)


def _names(split: Split) -> Iterator[str]:
    for before, after in zip(split.parts, split.parts[1:], strict=False):
        yield f"{panels_of(before)[0]}{split.axis}{panels_of(after)[0]}"


def _sizes(
    split: Split, box: PanelBox, moved: Mapping[str, float], rank: Callable[[Node], int]
) -> tuple[list[int], list[int]]:
    """Return the extent of each part, with the borders that were moved where they are wanted, and the least extents."""
    rows = split.axis == Axis.ROWS
    needs = [least_rows(part) if rows else least_columns(part) for part in split.parts]
    extent = box.height if rows else box.width
    natural = _rows(split, box.width, box.height, rank) if rows else _columns(split, box.width)
    wanted = [
        round(moved[name] * extent) if name in moved else end
        for name, end in zip(_names(split), accumulate(natural[:-1]), strict=True)
    ]
    low, ends = 0, []
    for at, end in enumerate(wanted):
        low = min(max(end, low + needs[at]), extent - sum(needs[at + 1 :]))
        ends.append(low)
    ends.append(extent)
    return [end - start for start, end in zip([0, *ends[:-1]], ends, strict=True)], needs


def place(node: Node, box: PanelBox, moved: Mapping[str, float], layout: PanelLayout) -> None:
    """Put the panels of a node into a box.

    Args:
        node: What to place.
        box: Where; large enough for what its panels need.
        moved: Borders that the user has moved: share of their split, by name.
        layout: Gets the boxes and borders.
    """
    if isinstance(node, str):
        layout.boxes[node] = box
        return
    sizes, needs = _sizes(node, box, moved, layout.rank)
    start, extent = _along(box, node.axis)
    at = start
    names = [*_names(node), ""]
    for index, (part, size) in enumerate(zip(node.parts, sizes, strict=True)):
        inner = (
            PanelBox(at, box.y, size, box.height) if node.axis == Axis.COLUMNS else PanelBox(box.x, at, box.width, size)
        )
        place(part, inner, moved, layout)
        at += size
        if names[index]:
            low, high = start + sum(needs[: index + 1]), start + extent - sum(needs[index + 1 :])
            after = panels_of(node.parts[index + 1])
            layout.borders.append(Border(names[index], node.axis, at, box, low, high, panels_of(part), after))
