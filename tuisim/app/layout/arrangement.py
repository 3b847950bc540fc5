"""Which panels are shown, and where: the presets, and the forms of the screen that they choose from by its size."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from enum import StrEnum
from math import ceil
from typing import Any

from tuisim.app.layout.tree import (
    EDGES,
    TIME_BAR_ROWS,
    Axis,
    Node,
    PanelBox,
    PanelLayout,
    Split,
    fair_rows,
    ideal_columns,
    ideal_rows,
    joined,
    least_columns,
    least_rows,
    panels_of,
    place,
)
from tuisim.app.panels import PANELS, PanelPlace, TerminalSize
from tuisim.config.preferences import keep, preference
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.data_class import dataclass

MIN_STRIP_COLS = 36
"""A panel of the bottom strip is not made narrower than this to fit another one next to it."""
_SINGLE_COLS, _SINGLE_ROWS = 60, 15
"""Below this size one panel is shown at a time."""
_TALL_ROWS = 30
"""From this height on, narrow panels stand below each other, as on a phone with large text."""
_LOW_COLS, _LOW_ROWS = 112, 33
"""Below both, the panels share the screen as in a terminal of 80×24."""
_MIN_LARGE_COLS, _MIN_LARGE_ROWS = 170, 50
_BOARD_COLS, _BOARD_ROWS = 100, 30
"""From this size of terminal on, world, readings, sensor arrays and chart are shown at once."""
_CODE_FROM_COLS = 120
"""From this width on, code is shown beside them."""
_EDITOR_FROM_COLS = 110
"""From this width on, the code that is typed in stands beside the world."""
_EDITOR_COLS = 86
"""Columns in which lines of 79 characters are whole."""
_DISCS_COLS = 42
"""Columns of the side column in which two sensor discs fit side by side."""
_READINGS_COLS, _TEXT_COLS = 48, 32
"""Columns of the readings in three lines, and of the output beside them."""
_MAX_SIDE_COLS = 46
_CODE_COLS = 64
"""Columns in which most lines of code are whole, with the values beside them."""
_ERROR_ROWS = 8
"""Rows of the panels below it, so that *Output* shows an error with its traceback."""
_COLUMN_COLS = 40
"""Columns below the world are not made narrower."""
_LEAST_TEXT, _MOST_TEXT = 40, 58
"""Columns for text to read, if that is at most half of the screen."""
_MAX_WASTE = 0.3
"""A panel with more empty space beside its mat counts as a poor form."""
_POOR = 0.7
_LEAST_FILLED = 0.6
"""A form other than the first of a preset is not chosen if the mat fills less of the world's panel."""


class Preset(StrEnum):
    """An arrangement of panels for a purpose."""

    STANDARD = "standard"
    DRIVE = "drive"
    DEBUG = "debug"
    ANALYSE = "analyse"


Form = Callable[[Sequence[str], int, int], Node]
"""Returns the tree of some panels for a number of columns and rows."""


def size_class(width: int, height: int) -> TerminalSize:
    """Return the size of a terminal: small, medium or large."""
    if width >= _MIN_LARGE_COLS and height >= _MIN_LARGE_ROWS:
        return TerminalSize.LARGE
    if width >= _BOARD_COLS and height >= _BOARD_ROWS:
        return TerminalSize.MEDIUM
    return TerminalSize.SMALL


def is_single(width: int, height: int) -> bool:
    """Return whether the area of the panels is so small that it shows one panel at a time."""
    return height < _SINGLE_ROWS - 1 or (width < _SINGLE_COLS and height < _TALL_ROWS)


def is_tall(width: int, height: int) -> bool:
    """Return whether an area is higher than wide, as it looks."""
    return height * 1.6 >= width


def is_low(preset: Preset, width: int, height: int) -> bool:
    """Return whether an area has room for few panels: the world in its whole width, or one with long lines or a chart.

    A lower area shows one panel only.
    """
    shows_board = preset == Preset.STANDARD and size_class(width, height + 1) != TerminalSize.SMALL
    is_small = width < _LOW_COLS and height < _LOW_ROWS and not is_tall(width, height)
    return is_small and not shows_board


def side_width(width: int, panels: Sequence[str] = ()) -> int:
    """Return the width of the side column: two sensor discs fit side by side from 112 columns on.

    Args:
        width: Columns of the screen.
        panels: The panels in the column; a lesson gets up to half of the screen.
    """
    if "lesson" in panels:
        return min(width // 2, max(_LEAST_TEXT, min(_MOST_TEXT, width * 3 // 8)))
    if width < 112:
        return max(26, min(34, width * 28 // 80))
    return _DISCS_COLS if width < _MIN_LARGE_COLS else _MAX_SIDE_COLS


def _in(panels: Sequence[str], where: PanelPlace) -> list[str]:
    return [info.id for info in PANELS.values() if info.place == where and info.id in panels]


def _stacks(columns: Sequence[Sequence[str]], fixed: Mapping[int, int], width: int) -> Node:
    """Return columns of stacked panels; those in `fixed` get that many columns, the others the rest."""
    nodes = [joined(Axis.ROWS, column) for column in columns if column]
    free = [at for at in range(len(nodes)) if at not in fixed]
    if not free or len(nodes) == 1:
        return joined(Axis.COLUMNS, nodes, shares=[1 / len(nodes)] * len(nodes))
    rest = 1 - sum(fixed.values()) / width
    weights = {at: max(PANELS[panel].weight for panel in columns[at]) for at in free}
    shares = [
        fixed[at] / width if at in fixed else rest * weights[at] / sum(weights.values())
        for at in range(len(nodes))
    ]
    return joined(Axis.COLUMNS, nodes, shares=shares)


def _strip(panels: Sequence[str], width: int, height: int) -> list[Node]:
    """Return the bottom strip: panels side by side, as many as fit, the others below the first ones.

    Code that would be narrow has the whole width, above the others, if all of them are high enough.
    """
    if not panels:
        return []
    columns = max(1, min(len(panels), width // MIN_STRIP_COLS))
    others = [panel for panel in panels if panel != "code"]
    if others != panels and others and width < columns * _CODE_COLS:
        stacked = ["code", *_strip(others, width, height)]
        if sum(fair_rows(node, width) for node in stacked) <= height:
            return [
                Split(Axis.ROWS, tuple(stacked), least=(0, *(_ERROR_ROWS for _ in stacked[1:])))
            ]
    count = ceil(len(panels) / columns)
    stacks = [
        joined(Axis.ROWS, panels[first : first + count]) for first in range(0, len(panels), count)
    ]
    return [joined(Axis.COLUMNS, stacks)]


def _wide(panels: Sequence[str], width: int, height: int) -> Node:
    """The world above the bottom strip, and a column beside both."""
    side, strip, main = (
        _in(panels, where) for where in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN)
    )
    if not strip and not main:
        return joined(Axis.ROWS, side)
    beside = side_width(width, side) if side else 0
    wide = width - beside
    left = joined(
        Axis.ROWS, [*main, *_strip(strip, wide, height - (ideal_rows(wide) if main else 0))]
    )
    if not side:
        return left
    shares = (1 - beside / width, beside / width)
    return joined(Axis.COLUMNS, [left, joined(Axis.ROWS, side)], shares=shares)


_STRIP_ROWS, _CODE_STRIP_ROWS = 12, 16
"""Rows of the strip below the board: for chart and output beside each other, and beside code."""
_CHART_ROWS = 10
_CHART_SHARE = 5 / 8
"""Of the width, beside the output."""
_MAX_EMPTY_ROWS = 3
"""The readings beside the world make it so much higher than its shape at most."""


def _board(panels: Sequence[str], width: int, height: int) -> Node:
    """The world with readings beside it, and below both a strip with the chart; the wide form without these three."""
    side, main = _in(panels, PanelPlace.SIDE), _in(panels, PanelPlace.MAIN)
    roomy = [panel for panel in ("code", "brick") if panel in panels]
    fits = size_class(width, height + 1) == TerminalSize.MEDIUM and width >= MIN_STRIP_COLS * (
        len(roomy) + 1
    )
    if not (fits and main and side and "chart" in panels and "lesson" not in panels):
        return _wide(panels, width, height)
    world_cols = width - _DISCS_COLS
    share = world_cols / width
    above = joined(Axis.COLUMNS, [*main, joined(Axis.ROWS, side)], shares=(share, 1 - share))
    below = _board_strip(roomy, "output" in panels, height)
    highest = ideal_rows(world_cols) + _MAX_EMPTY_ROWS
    rows = min(
        max(ideal_rows(world_cols), fair_rows(above, width)),
        height - (_CODE_STRIP_ROWS if roomy and height >= 3 * _STRIP_ROWS else _STRIP_ROWS),
        highest,
    )
    rows = max(rows, least_rows(above))
    if rows > highest or rows + least_rows(below) > height:
        return _wide(panels, width, height)
    return Split(Axis.ROWS, (above, below), least=(rows, height - rows))


def _board_strip(roomy: Sequence[str], has_output: bool, height: int) -> Node:
    """Return the chart with the output beside it, or below it if there are panels that need the width."""
    if not roomy:
        parts = ["chart", "output"] if has_output else ["chart"]
        return joined(Axis.COLUMNS, parts, shares=(_CHART_SHARE, 1 - _CHART_SHARE))
    chart_rows = _CHART_ROWS if height >= 3 * _STRIP_ROWS else 0
    last: Node = (
        Split(Axis.ROWS, ("chart", "output"), least=(chart_rows, 0)) if has_output else "chart"
    )
    return joined(Axis.COLUMNS, [*roomy, last])


def beside_world(panel: str, panels: Sequence[str], width: int, height: int) -> PanelLayout | None:
    """Place a panel beside the world, with others below that as far as they fit; None where there is no room.

    Args:
        panel: The one that gets most of the width.
        panels: The others, the most wanted first.
        width: Columns.
        height: Rows.
    """
    if width < _EDITOR_FROM_COLS or "world" not in panels or "lesson" in panels:
        return None
    wide = min(_EDITOR_COLS, width - _DISCS_COLS)
    right = ["world"]
    for other in ("output", "instrumentation", "arrays", "chart"):
        if (
            other in panels
            and fair_rows(joined(Axis.ROWS, [*right, other]), width - wide) <= height
        ):
            right.append(other)
    share = wide / width
    node = joined(Axis.COLUMNS, [panel, joined(Axis.ROWS, right)], shares=(share, 1 - share))
    layout = PanelLayout(wanted=(panel, *right))
    place(node, PanelBox(0, 0, width, height), layout)
    return layout


_TIGHT_ROWS: Mapping[str, int] = {
    "instrumentation": 5,
    "output": 4,
    "code": 9,
    "chart": 10,
    "arrays": 9,
}
"""Rows in which these panels are read on a narrow and high screen."""


def _tight_rows(panels: Sequence[str], width: int) -> list[int]:
    return [
        ideal_rows(width) if panel == "world" else _TIGHT_ROWS.get(panel, PANELS[panel].fair_rows)
        for panel in panels
    ]


def _column(panels: Sequence[str], width: int, height: int) -> Node:
    """Return panels one above the other, each with the rows in which it is read if there are so many."""
    tight = _tight_rows(panels, width)
    if len(panels) == 1 or sum(tight) > height:
        return joined(Axis.ROWS, panels)
    return Split(Axis.ROWS, tuple(panels), least=tuple(tight))


def _under(panels: Sequence[str], width: int, height: int) -> Node:
    """The world in the whole width, and everything else in columns below it."""
    side, strip, main = (
        _in(panels, where) for where in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN)
    )
    most = max(1, width // _COLUMN_COLS)
    if most == 1 or not side + strip:
        return _column([*main, *side, *strip], width, height)
    high = max(height - (ideal_rows(width) if main else 0), 1)
    packed: list[list[str]] = []
    for panel in side:
        column = next((one for one in packed if _fair([*one, panel]) <= high), None)
        if column is None:
            packed.append([panel])
        else:
            column.append(panel)
    growing = [[panel] for panel in strip]
    if growing and packed and len(packed[-1]) == 1 and 3 * _fair(packed[-1]) < 2 * high:
        growing[0] = [*packed.pop(), *growing[0]]
    for columns in (growing, packed):
        while len(columns) > 1 and len(growing) + len(packed) > most:
            columns[-2:] = [columns[-2] + columns[-1]]
    columns = growing + packed
    fixed = min(side_width(width, side), width // len(columns))
    below = _stacks(
        columns, {len(growing) + at: fixed for at in range(len(packed))} if growing else {}, width
    )
    return joined(Axis.ROWS, [*main, below])


_ROOMY = ("code", "chart", "brick")
"""Panels that get the whole width of a low screen."""
_FAIR_ROWS = 22
"""From this height on, such a panel shows enough beside a world, even if others find no room."""


def _low(panels: Sequence[str], width: int, height: int) -> Node:
    """The world in the whole width, or above a panel that needs it; readings and output below or beside it."""
    roomy = [panel for panel in _ROOMY if panel in panels]
    beside = [panel for panel in (*_in(panels, PanelPlace.SIDE), "output") if panel in panels]
    if "lesson" in panels or (not roomy and not {"instrumentation", "output"}.issuperset(beside)):
        return _wide(panels, width, height)
    main = _in(panels, PanelPlace.MAIN)
    if not roomy:
        return joined(Axis.ROWS, [*main, _line_of(beside, width)] if beside else main)
    fair = max(_fair(roomy), height // 2)
    above = height - fair
    if not main or not beside:
        top: list[Node] = [*main] or ([joined(Axis.ROWS, beside)] if beside else [])
    else:
        share = (
            min(max(ideal_columns(above), PANELS["world"].min_cols), width - MIN_STRIP_COLS) / width
        )
        top = [joined(Axis.COLUMNS, [*main, _with_pose(beside, above)], shares=(share, 1 - share))]
    below = joined(Axis.ROWS, roomy)
    if not top:
        return below
    is_fair = height >= _FAIR_ROWS or least_rows(top[0]) <= above
    return Split(Axis.ROWS, (*top, below), least=(0, fair) if is_fair else ())


def _with_pose(panels: Sequence[str], height: int) -> Node:
    """Return stacked panels; the readings get a row more than they need, if there is one, for the pose."""
    column = joined(Axis.ROWS, panels)
    if isinstance(column, str) or least_rows(column) >= height:
        return column
    least = tuple(PANELS[panel].min_rows + (panel == "instrumentation") for panel in panels)
    return Split(Axis.ROWS, column.parts, least=least)


def _line_of(panels: Sequence[str], width: int) -> Node:
    """Return output and readings side by side, the output where notices appear."""
    share = max(1 / 2, min(_READINGS_COLS, width - _TEXT_COLS) / width)
    order = [panel for panel in ("output", "instrumentation") if panel in panels]
    return joined(Axis.COLUMNS, order, shares=(1 - share, share))


def _fair(panels: Sequence[str]) -> int:
    return sum(PANELS[panel].fair_rows for panel in panels)


def _halves(first: Sequence[str], second: Sequence[str], share: float) -> Form:
    """Return the form with two columns, of these panels in this order; further ones go below them."""

    def form(panels: Sequence[str], width: int, height: int) -> Node:
        if is_tall(width, height) and width < 2 * _COLUMN_COLS:
            return joined(
                Axis.ROWS,
                [
                    panel
                    for panel in dict.fromkeys(("world", *first, *second, *panels))
                    if panel in panels
                ],
            )
        rest = [panel for panel in panels if panel not in {*first, *second}]
        left = [panel for panel in first if panel in panels] + _in(rest, PanelPlace.BOTTOM)
        right = [panel for panel in second if panel in panels] + _in(rest, PanelPlace.SIDE)
        wide = share or 1 - side_width(width, right) / width
        columns = [
            joined(Axis.ROWS, _paired(column, round((1 - wide) * width)))
            for column in (left, right)
            if column
        ]
        return joined(Axis.COLUMNS, columns, shares=(wide, 1 - wide)[: len(columns)])

    return form


def _paired(panels: Sequence[str], width: int) -> list[Node]:
    """Return stacked panels, with small ones that follow each other side by side if there is room."""
    nodes: list[Node] = []
    for panel in panels:
        last = nodes[-1] if nodes else None
        pair = (
            isinstance(last, str)
            and _is_small(last)
            and _is_small(panel)
            and width >= 2 * side_width(112)
        )
        if pair and last is not None:
            nodes[-1] = joined(Axis.COLUMNS, [last, panel])
        else:
            nodes.append(panel)
    return nodes


def _is_small(panel: str) -> bool:
    return PANELS[panel].place == PanelPlace.SIDE and not PANELS[panel].grows


@dataclass(frozen=True, slots=True)
class _Plan:
    """What a preset shows."""

    core: tuple[str, ...]
    """Panels that it is made for, the most important first."""
    fill: tuple[str, ...]
    """Panels for what space is left."""
    forms: tuple[Form, ...]
    low: tuple[str, ...]
    """What a low terminal shows instead, the most important first."""
    beside: tuple[str, ...] = ()
    """Further panels, one for each column that the terminal has beyond those of `core`."""
    compact: bool = True
    """Whether a larger world is worth panels that show less than everything."""


_SHOWN = tuple(info.id for info in PANELS.values() if info.sizes)

_PLANS: Mapping[Preset, _Plan] = {
    Preset.STANDARD: _Plan(
        (), _SHOWN, (_board, _under), ("world", "instrumentation", "output"), compact=False
    ),
    Preset.DRIVE: _Plan(
        ("world", "instrumentation", "positioning"),
        ("arrays", "output", "chart", "controls"),
        (
            _halves(
                ("world", "positioning", "output"), ("instrumentation", "arrays", "controls"), 0.0
            ),
            _under,
        ),
        ("world", "instrumentation", "output"),
        beside=("arrays", "output"),
    ),
    Preset.DEBUG: _Plan(
        ("code", "debug", "world", "output"),
        ("instrumentation", "arrays"),
        (_halves(("code", "output"), ("world", "instrumentation", "debug"), 0.55),),
        ("code", "debug", "world", "instrumentation"),
    ),
    Preset.ANALYSE: _Plan(
        ("chart", "arrays", "world"),
        ("instrumentation", "output"),
        (_halves(("chart",), ("world", "arrays", "instrumentation", "output"), 0.58),),
        ("chart", "world", "instrumentation", "output"),
    ),
}


def core_panels(preset: Preset, width: int, height: int) -> tuple[str, ...]:
    """Return the panels that a preset is made for, in an area of that size; none for the standard of a large one."""
    plan = _PLANS[preset]
    return plan.low if is_low(preset, width, height) else plan.core


def wanted_panels(
    preset: Preset, asked: Mapping[str, bool], width: int, height: int
) -> tuple[list[str], list[str]]:
    """Return the panels to show, by priority, and those for what space is left.

    Args:
        preset: The arrangement.
        asked: Panels that were shown or hidden by the user, the latest last.
        width: Columns of the area.
        height: Rows of the area.
    """
    plan, size = _PLANS[preset], size_class(width, height + 1)
    columns = max(0, width // _COLUMN_COLS - len(plan.core) + 1)
    usual = plan.core + plan.beside[:columns] or tuple(
        panel
        for panel in _SHOWN
        if size in PANELS[panel].sizes and not _yields(panel, asked, width)
    )
    if is_low(preset, width, height):
        usual = plan.low
    latest = [panel for panel, on in reversed(list(asked.items())) if on]
    rest = [panel for panel in usual if panel not in asked]
    # A lesson and the world keep their places, however many panels are asked for.
    places = {"lesson": 0, "world": 1}
    wanted = sorted(latest + rest, key=lambda panel: places.get(panel, 2))
    fill = [panel for panel in plan.fill if panel not in asked and panel not in wanted]
    if preset == Preset.STANDARD and is_tall(width, height):
        fill.sort(key=lambda panel: [*_READ_FIRST, panel].index(panel))
    if is_low(preset, width, height):
        return wanted, []
    if preset == Preset.STANDARD and not is_tall(width, height):
        # The strip below a wide world gets no fuller: its panels would be too narrow. A board has no room beside it.
        is_board = size == TerminalSize.MEDIUM and "chart" in wanted
        fill = [] if is_board else _in(fill, PanelPlace.SIDE)
    return wanted, fill


_READ_FIRST = ("code", "chart", "arrays")
"""Panels that fill a tall terminal before those that set up a run."""


def _yields(panel: str, asked: Mapping[str, bool], width: int) -> bool:
    """Return whether a panel leaves its room to others: to code and variables in a narrow terminal, to a lesson."""
    is_narrow = width < _CODE_FROM_COLS
    match panel:
        case "code":
            return is_narrow
        case "chart" if asked.get("lesson", False):
            return width < _MIN_LARGE_COLS
        case "chart" | "arrays":
            return is_narrow and asked.get("debug", False)
        case _:
            return False


def _kept(
    form: Form, panels: Sequence[str], fill: Sequence[str], width: int, height: int
) -> list[str]:
    """Return the panels that fit: the wanted ones with what they need, the others where all are shown well."""
    kept: list[str] = []
    for panel in panels:
        node = form([*kept, panel], width, height)
        if least_rows(node) <= height and least_columns(node) <= width:
            kept.append(panel)
    for panel in fill:
        node = form([*kept, panel], width, height)
        rows = fair_rows(node, width)
        if panel in _READ_FIRST and is_tall(width, height) and width < 2 * _COLUMN_COLS:
            rows = sum(_tight_rows([*kept, panel], width))
        if rows <= height and least_columns(node) <= width:
            kept.append(panel)
    return kept


def mat_cells(box: PanelBox) -> float:
    """Return the area of the mat in a world panel, in cells."""
    width, height = box.width - EDGES, box.height - EDGES - TIME_BAR_ROWS
    return (
        min(width, 2 * height * FIELD_WIDTH_MM / FIELD_HEIGHT_MM) ** 2
        * FIELD_HEIGHT_MM
        / FIELD_WIDTH_MM
        / 2
    )


def _fills(layout: PanelLayout, share: float) -> bool:
    """Return whether the mat fills this share of the world's panel."""
    box = layout.boxes.get("world")
    return box is None or mat_cells(box) >= share * (box.width - EDGES) * (box.height - EDGES)


def _score(layout: PanelLayout, wanted: int, crowded: bool) -> tuple[int, float]:
    box = layout.boxes.get("world")
    cells = mat_cells(box) if box else 0.0
    return wanted, cells * (1.0 if _fills(layout, 1 - _MAX_WASTE) else _POOR) * (
        _POOR**2 if crowded else 1.0
    )


def arrange(
    panels: Sequence[str],
    width: int,
    height: int,
    fill: Sequence[str] = (),
    preset: Preset = Preset.STANDARD,
) -> PanelLayout:
    """Place panels on a screen, in the form in which the world is largest.

    Args:
        panels: Ids, the most wanted first.
        width: Columns.
        height: Rows.
        fill: Panels for what space is left.
        preset: Which forms there are.

    Returns:
        Boxes that fill the screen without overlap; panels that found no room are left out.
    """
    if is_single(width, height):
        panels, left_out = panels[:1], tuple(panels[1:])
        boxes = {panel: PanelBox(0, 0, width, height) for panel in panels}
        return PanelLayout(boxes, left_out=left_out)
    best: tuple[tuple[int, float], Node] | None = None
    for score, node in _scored(panels, fill, preset, width, height):
        if best is None or score > best[0]:
            best = score, node
    if best is None:
        return PanelLayout(left_out=tuple(panels))
    shown = panels_of(best[1])
    layout = PanelLayout(
        left_out=tuple(panel for panel in panels if panel not in shown), wanted=panels
    )
    place(best[1], PanelBox(0, 0, width, height), layout)
    return layout


def _scored(
    panels: Sequence[str], fill: Sequence[str], preset: Preset, width: int, height: int
) -> Iterator[tuple[tuple[int, float], Node]]:
    """Yield the tree in each form, and how good that is."""
    plan = _PLANS[preset]
    is_cramped = preset == Preset.STANDARD and "debug" in panels and width < _CODE_FROM_COLS
    forms = (_low,) if is_cramped or is_low(preset, width, height) else plan.forms
    for form in forms:
        if not (kept := _kept(form, panels, fill, width, height)):
            continue
        node = form(kept, width, height)
        layout = PanelLayout(wanted=panels)
        place(node, PanelBox(0, 0, width, height), layout)
        if form is not forms[0] and not _fills(layout, _LEAST_FILLED):
            continue
        crowded = not plan.compact and fair_rows(node, width) > height
        yield _score(layout, sum(panel in kept for panel in panels), crowded), node


def stacked(upper: str, lower: str, width: int, height: int) -> PanelLayout:
    """Place two panels one above the other; the upper one is a little higher."""
    rows = height * 11 // 20
    boxes = {upper: PanelBox(0, 0, width, rows), lower: PanelBox(0, rows, width, height - rows)}
    return PanelLayout(boxes, wanted=(upper, lower))


def with_room(
    panel: str,
    panels: Sequence[str],
    least: tuple[int, int],
    size: tuple[int, int],
    preset: Preset = Preset.STANDARD,
) -> list[str]:
    """Return the panels to show so that one has room: as they are, else without those beside it, else it alone.

    Args:
        panel: The one.
        panels: Ids, the most wanted first.
        least: Columns and rows that are room enough.
        size: Columns and rows of the screen.
        preset: The arrangement.
    """
    others = [other for other in panels if other != panel]
    elsewhere = [other for other in others if PANELS[other].place != PANELS[panel].place]
    for beside in (others, elsewhere):
        box = arrange([panel, *beside], *size, preset=preset).boxes[panel]
        if box.width >= least[0] and box.height >= least[1]:
            return [panel, *beside]
    return [panel]


_NAME = "layout"


@dataclass
class KeptLayout:
    """The arrangement for a size of the terminal."""

    preset: Preset = Preset.STANDARD
    asked: dict[str, bool] = field(default_factory=dict)
    """Panels that were shown or hidden by their keys, the latest last."""


def load_layout(size: TerminalSize) -> KeptLayout:
    """Return what was kept for a size; what is damaged or unknown is left out."""
    found = _table(preference(_NAME)).get(size)
    kept = _table(found)
    layout = KeptLayout()
    with suppress(ValueError):
        layout.preset = Preset(str(kept.get("preset", "")))
    rows = kept.get("panels")
    for row in rows if isinstance(rows, list) else []:
        match row:
            case [str(panel), bool(on)] if panel in PANELS:
                layout.asked[panel] = on
            case _:
                pass
    return layout


def save_layout(size: TerminalSize, layout: KeptLayout) -> None:
    """Keep an arrangement; without a writable folder it lasts until the app ends."""
    # A list: the order counts, and the file sorts the keys of tables.
    panels = [[panel, on] for panel, on in layout.asked.items()]
    with suppress(OSError):
        keep(
            _NAME,
            {**_table(preference(_NAME)), size: {"preset": layout.preset.value, "panels": panels}},
        )


def _table(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
