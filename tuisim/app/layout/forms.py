"""Forms of the screen: how panels are laid out for its size, as trees."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import ceil

from tuisim.app.layout.tree import (
    Axis,
    Node,
    Split,
    compute_ideal_columns,
    compute_ideal_rows,
    count_fair_rows,
    count_min_rows,
    join_nodes,
    list_panels,
)
from tuisim.app.panels import PANELS, PanelPlace, TerminalSize

MIN_STRIP_COLS = 36
"""Minimum width of a panel in the bottom strip; in a narrower strip, panels stand one above the other."""
_SINGLE_COLS, _SINGLE_ROWS = 60, 15
"""In a lower area, or in a narrower one of fewer than `_TALL_ROWS` rows, one panel is shown at a time."""
_TALL_ROWS = 30
"""A narrow area of at least so many rows shows panels below each other, as on a phone with large text."""
LOW_COLS, LOW_ROWS = 112, 33
"""In a terminal with fewer columns and fewer rows than these, panels share the screen as in one of 80×24."""
MIN_LARGE_COLS, _MIN_LARGE_ROWS = 170, 50
_BOARD_COLS, _BOARD_ROWS = 100, 30
"""A terminal of at least this size is medium: it shows world, readings, sensor arrays and chart at once."""
DISCS_COLS = 42
"""Columns of the side column in which two sensor discs fit side by side."""
_READINGS_COLS, _TEXT_COLS = 48, 32
"""Columns that the readings need for three lines, and columns that are left to the output beside the readings."""
_MAX_SIDE_COLS = 46
_CODE_COLS = 64
"""If the strip has less than this for each panel, code stands above the others, so that most lines are whole."""
_CHART_COLS = 80
_LEAST_CODE_COLS = 46
"""A chart beside code in the bottom strip gets `_CHART_COLS` columns if at least `_LEAST_CODE_COLS` are left to the
code."""
_LINE_COLS = 80
_LEAST_CHART_COLS = 64
"""Code gets `_LINE_COLS` columns, in which lines of an example are whole, if `_LEAST_CHART_COLS` are left to a chart
beside it with the output below."""
_STACKED_ROWS = 14, 7
"""Minimum rows of a chart beside the code, and of the output below that chart."""
MAX_TAKEN_ROWS = 7
"""Maximum number of rows that a strip with code, chart and output takes from the world above it."""
_ERROR_ROWS = 8
"""Minimum rows of each panel below code in the whole width, so that *Output* shows an error with its traceback."""
COLUMN_COLS = 40
"""Minimum width of a column of panels below the world; if the area is too narrow, there are fewer columns."""
_LEAST_TEXT, _MOST_TEXT = 40, 58
"""Minimum and maximum columns of a side column with a lesson; it never has more than half of the screen."""


Form = Callable[[Sequence[str], int, int], Node]
"""A function that arranges panels: it returns their tree for an area of a number of columns and rows."""


def classify_size(width: int, height: int) -> TerminalSize:
    """Return the class of a terminal's size in columns and rows: small, medium or large."""
    if width >= MIN_LARGE_COLS and height >= _MIN_LARGE_ROWS:
        return TerminalSize.LARGE
    if width >= _BOARD_COLS and height >= _BOARD_ROWS:
        return TerminalSize.MEDIUM
    return TerminalSize.SMALL


def is_single(width: int, height: int) -> bool:
    """Return whether an area of columns and rows is so small that it shows one panel at a time."""
    return height < _SINGLE_ROWS - 1 or (width < _SINGLE_COLS and height < _TALL_ROWS)


def is_tall(width: int, height: int) -> bool:
    """Return whether an area of columns and rows looks higher than wide; a row is as high as 1.6 columns are wide."""
    return height * 1.6 >= width


def measure_side(width: int, panels: Sequence[str] = ()) -> int:
    """Return the width of the side column in columns; on screens of 112 columns or more, two sensor discs fit into it.

    Args:
        width: Columns of the screen.
        panels: The panels in the column; a lesson gets up to half of the screen.
    """
    if "lesson" in panels:
        return min(width // 2, max(_LEAST_TEXT, min(_MOST_TEXT, width * 3 // 8)))
    if width < 112:
        return max(26, min(34, width * 28 // 80))
    return DISCS_COLS if width < MIN_LARGE_COLS else _MAX_SIDE_COLS


def select_panels(panels: Sequence[str], where: PanelPlace) -> list[str]:
    """Return those panels that belong in the area `where` of the screen, in the order of `PANELS`."""
    return [info.id for info in PANELS.values() if info.place == where and info.id in panels]


def _build_stacks(columns: Sequence[Sequence[str]], fixed: Mapping[int, int], width: int) -> Node:
    """Return columns of stacked panels, side by side, as a tree of panels.

    Args:
        columns: The panels of each column, from the top.
        fixed: Widths of some columns, by index; the others share the rest.
        width: Width of all columns.
    """
    nodes = [join_nodes(Axis.ROWS, column) for column in columns if column]
    free = [index for index in range(len(nodes)) if index not in fixed]
    if not free or len(nodes) == 1:
        return join_nodes(Axis.COLUMNS, nodes, shares=[1 / len(nodes)] * len(nodes))
    rest = 1 - sum(fixed.values()) / width
    weights = {index: max(PANELS[panel].weight for panel in columns[index]) for index in free}
    shares = [
        fixed[index] / width if index in fixed else rest * weights[index] / sum(weights.values())
        for index in range(len(nodes))
    ]
    return join_nodes(Axis.COLUMNS, nodes, shares=shares)


def _strip(panels: Sequence[str], width: int, height: int) -> list[Node]:
    """Return the columns of the bottom strip, each a panel or a tree of stacked panels; empty without panels.

    If the code would be narrow, and the strip is high enough, the code has the whole width above the other panels.
    """
    if not panels:
        return []
    columns = max(1, min(len(panels), width // MIN_STRIP_COLS))
    others = [panel for panel in panels if panel != "code"]
    if others != panels and others and width < columns * _CODE_COLS:
        stacked = ["code", *_strip(others, width, height)]
        if sum(count_fair_rows(node, width) for node in stacked) <= height:
            return [
                Split(Axis.ROWS, tuple(stacked), least=(0, *(_ERROR_ROWS for _ in stacked[1:])))
            ]
    if _needs_stack(panels, width, height):
        return [_build_output_stack(width)]
    count = ceil(len(panels) / columns)
    stacks = [
        join_nodes(Axis.ROWS, panels[first : first + count])
        for first in range(0, len(panels), count)
    ]
    return [join_nodes(Axis.COLUMNS, stacks, _find_strip_shares(stacks, width))]


def _needs_stack(panels: Sequence[str], width: int, height: int) -> bool:
    """Return whether to put the output below the chart, beside the code, so that whole lines of code are visible."""
    beside = _LINE_COLS + _CHART_COLS + PANELS["output"].min_cols
    return (
        set(panels) == {"output", "code", "chart"}
        and _LINE_COLS + _LEAST_CHART_COLS <= width < beside
        and sum(_STACKED_ROWS) <= height + MAX_TAKEN_ROWS
    )


def _build_output_stack(width: int) -> Node:
    """Return a tree of panels: the code beside the chart, and the output below the chart."""
    code = max(_LINE_COLS, width - _CHART_COLS) / width
    stack = Split(Axis.ROWS, ("chart", "output"), least=_STACKED_ROWS)
    return join_nodes(Axis.COLUMNS, ["code", stack], shares=(code, 1 - code))


def _find_strip_shares(stacks: Sequence[Node], width: int) -> list[float]:
    """Return the share of the width for each column of a strip, so that a chart beside code is wide enough.

    The list is empty if the usual widths are enough, or if the strip has other panels.
    """
    if not {"chart", "code"}.issubset(stacks) or not {"chart", "code", "output"}.issuperset(stacks):
        return []
    columns = {"chart": _CHART_COLS, "output": PANELS["output"].min_cols}
    weights = {panel: PANELS[panel].weight for panel in list_panels(join_nodes(Axis.ROWS, stacks))}
    rest = width - sum(columns[panel] for panel in weights if panel in columns)
    is_wide = width * weights["chart"] >= _CHART_COLS * sum(weights.values())
    if is_wide or rest < _LEAST_CODE_COLS:
        return []
    return [columns.get(panel, rest) / width for panel in weights]


def _split_side(side: Sequence[str], height: int) -> tuple[list[str], list[str]]:
    """Return the panels that stay in the side column, and those that must leave it because a lesson needs its rows."""
    side_panels: list[str] = []
    for panel in side:
        rows = sum(PANELS[one].fair_rows for one in (*side_panels, panel))
        fits = panel == "instrumentation" and rows <= height
        if "lesson" not in side or panel == "lesson" or fits:
            side_panels.append(panel)
    return side_panels, [panel for panel in side if panel not in side_panels]


def build_wide(panels: Sequence[str], width: int, height: int) -> Node:
    """Return a tree of panels: the world above the bottom strip, and a column beside both.

    If a lesson is in the column, other panels move from there to the strip as far as they fit.
    """
    side, strip, main = (
        select_panels(panels, where)
        for where in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN)
    )
    side_panels, lowered = _split_side(side, height)
    if main and lowered:
        world_cols = width - measure_side(width, side_panels)
        below = _strip([*strip, *lowered], world_cols, height)
        if 3 * compute_ideal_rows(world_cols) // 4 + sum(map(count_min_rows, below)) <= height:
            side = side_panels
            strip = [*strip, *lowered]
    return _place_wide(side, strip, main, width, height)


def _place_wide(
    side: Sequence[str], strip: Sequence[str], main: Sequence[str], width: int, height: int
) -> Node:
    if not strip and not main:
        return join_nodes(Axis.ROWS, side)
    beside = measure_side(width, side) if side else 0
    wide = width - beside
    left = join_nodes(
        Axis.ROWS, [*main, *_strip(strip, wide, height - (compute_ideal_rows(wide) if main else 0))]
    )
    if not side:
        return left
    shares = (1 - beside / width, beside / width)
    return join_nodes(Axis.COLUMNS, [left, join_nodes(Axis.ROWS, side)], shares=shares)


_STRIP_ROWS = 12
_LOW_CODE_STRIP_ROWS = 13
_CODE_STRIP_ROWS = 17
"""Rows of the strip below the world: `_STRIP_ROWS` for chart and output only; with code or brick,
`_LOW_CODE_STRIP_ROWS` on a low screen, and `_CODE_STRIP_ROWS` on a high one."""
_CHART_ROWS = 11
_CHART_SHARE = 5 / 8
"""Share of the strip's width, from 0 to 1, that the chart gets if only the output is beside it."""
_MAX_EMPTY_ROWS = 3
"""Maximum number of rows by which the world may exceed what its mat needs, so that the readings beside it fit."""


def build_board(panels: Sequence[str], width: int, height: int) -> Node:
    """Return a tree of panels: the world and the readings side by side, above a strip with the chart.

    The tree of `build_wide` is returned instead if the area is too narrow or not of medium size, if one of these panels
    is hidden, or if a lesson is shown.
    """
    side = select_panels(panels, PanelPlace.SIDE)
    main = select_panels(panels, PanelPlace.MAIN)
    roomy = [panel for panel in ("code", "brick") if panel in panels]
    fits = classify_size(width, height + 1) == TerminalSize.MEDIUM and width >= MIN_STRIP_COLS * (
        len(roomy) + 1
    )
    if not (fits and main and side and "chart" in panels and "lesson" not in panels):
        return build_wide(panels, width, height)
    world_cols = width - DISCS_COLS
    share = world_cols / width
    above = join_nodes(
        Axis.COLUMNS, [*main, join_nodes(Axis.ROWS, side)], shares=(share, 1 - share)
    )
    below = _build_board_strip(roomy, "output" in panels, height)
    highest = compute_ideal_rows(world_cols) + _MAX_EMPTY_ROWS
    rows = min(
        max(compute_ideal_rows(world_cols), count_fair_rows(above, width)),
        height - _find_strip_rows(height) if roomy else height - _STRIP_ROWS,
        highest,
    )
    rows = max(rows, count_min_rows(above))
    if rows > highest or rows + count_min_rows(below) > height:
        return build_wide(panels, width, height)
    return Split(Axis.ROWS, (above, below), least=(rows, height - rows))


def _find_strip_rows(height: int) -> int:
    """Return the height in rows of a strip with code or brick, which is below the world in an area of `height` rows."""
    return _CODE_STRIP_ROWS if height >= 3 * _STRIP_ROWS else _LOW_CODE_STRIP_ROWS


def _build_board_strip(roomy: Sequence[str], has_output: bool, height: int) -> Node:
    """Return a tree of panels for a strip with the chart and the output, side by side.

    If code or brick is shown, it is at the left, and the output is below the chart.

    Args:
        roomy: `code` and `brick`, as far as they are shown.
        has_output: Whether the output is shown; if not, the chart is alone.
        height: Rows of the area.
    """
    if not roomy:
        parts = ["chart", "output"] if has_output else ["chart"]
        return join_nodes(Axis.COLUMNS, parts, shares=(_CHART_SHARE, 1 - _CHART_SHARE))
    chart_rows = _CHART_ROWS if height >= 3 * _STRIP_ROWS else 0
    last: Node = (
        Split(Axis.ROWS, ("chart", "output"), least=(chart_rows, 0)) if has_output else "chart"
    )
    return join_nodes(Axis.COLUMNS, [*roomy, last])


_TIGHT_ROWS: Mapping[str, int] = {
    "instrumentation": 5,
    "output": 5,
    "code": 9,
    "chart": 10,
    "arrays": 9,
}
"""Rows with which a panel can just be read in a narrow and high area, by id; other panels need their `fair_rows`."""


def count_tight_rows(panels: Sequence[str], width: int) -> list[int]:
    """Return for each panel how many rows it needs so that it can be read in a narrow and high area."""
    return [
        compute_ideal_rows(width)
        if panel == "world"
        else _TIGHT_ROWS.get(panel, PANELS[panel].fair_rows)
        for panel in panels
    ]


def _build_column(panels: Sequence[str], width: int, height: int) -> Node:
    """Return a tree of stacked panels; if they fit, each has at least the rows that it needs to be read."""
    tight = count_tight_rows(panels, width)
    if len(panels) == 1 or sum(tight) > height:
        return join_nodes(Axis.ROWS, panels)
    return Split(Axis.ROWS, tuple(panels), least=tuple(tight))


def build_below(panels: Sequence[str], width: int, height: int) -> Node:
    """Return a tree of panels: the world in the whole width, and all other panels in columns below it."""
    side, strip, main = (
        select_panels(panels, where)
        for where in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN)
    )
    max_columns = width // COLUMN_COLS
    if max_columns <= 1 or not side + strip:
        return _build_column([*main, *side, *strip], width, height)
    high = max(height - (compute_ideal_rows(width) if main else 0), 1)
    packed: list[list[str]] = []
    for panel in side:
        column = next(
            (
                column_panels
                for column_panels in packed
                if _sum_fair_rows([*column_panels, panel]) <= high
            ),
            None,
        )
        if column is None:
            packed.append([panel])
        else:
            column.append(panel)
    growing = [[panel] for panel in strip]
    if growing and packed and len(packed[-1]) == 1 and 3 * _sum_fair_rows(packed[-1]) < 2 * high:
        growing[0] = [*packed.pop(), *growing[0]]
    for columns in (growing, packed):
        while len(columns) > 1 and len(growing) + len(packed) > max_columns:
            columns[-2:] = [columns[-2] + columns[-1]]
    columns = growing + packed
    fixed = min(measure_side(width, side), width // len(columns))
    below = _build_stacks(
        columns,
        {len(growing) + index: fixed for index in range(len(packed))} if growing else {},
        width,
    )
    return join_nodes(Axis.ROWS, [*main, below])


_LINE_ROWS = 5
"""Rows of the output and the readings side by side below the world: three lines and the edges."""
_ROOMY = ("code", "chart", "brick")
"""Ids of the panels that get the whole width of a low area."""
_MAX_YIELDED_ROWS = 2
"""Maximum number of rows that the panels of `_ROOMY` give up if the panels beside the world need them."""
_FAIR_ROWS = 22
"""From this height of an area on, a panel of `_ROOMY` keeps its rows, even if the panels above it get too few."""


def build_low(panels: Sequence[str], width: int, height: int) -> Node:
    """Return a tree of panels for a low area.

    The world has the whole width, above the readings and the output. If a panel such as the code needs the whole width,
    it is below the world, and the readings and the output are beside the world.
    """
    roomy = [panel for panel in _ROOMY if panel in panels]
    beside = [
        panel for panel in (*select_panels(panels, PanelPlace.SIDE), "output") if panel in panels
    ]
    if "lesson" in panels or (not roomy and not {"instrumentation", "output"}.issuperset(beside)):
        return build_wide(panels, width, height)
    main = select_panels(panels, PanelPlace.MAIN)
    if not roomy:
        if not main or not beside:
            return join_nodes(Axis.ROWS, main or beside)
        return Split(Axis.ROWS, (*main, _build_line(beside, width)), least=(0, _LINE_ROWS))
    fair = _find_roomy_rows(roomy, beside, height)
    above = height - fair
    if not main or not beside:
        top: list[Node] = [*main] or ([join_nodes(Axis.ROWS, beside)] if beside else [])
    else:
        share = (
            min(max(compute_ideal_columns(above), PANELS["world"].min_cols), width - MIN_STRIP_COLS)
            / width
        )
        top = [
            join_nodes(
                Axis.COLUMNS, [*main, _stack_readings(beside, above)], shares=(share, 1 - share)
            )
        ]
    below = join_nodes(Axis.ROWS, roomy)
    if not top:
        return below
    is_fair = height >= _FAIR_ROWS or count_min_rows(top[0]) <= above
    return Split(Axis.ROWS, (*top, below), least=(0, fair) if is_fair else ())


def _find_roomy_rows(roomy: Sequence[str], beside: Sequence[str], height: int) -> int:
    """Return the height in rows for the panels that have the whole width of a low area.

    Above them are the world and the panels beside the world.

    Args:
        roomy: The panels with the whole width.
        beside: The panels beside the world.
        height: Rows of the area.
    """
    fair = max(_sum_fair_rows(roomy), height // 2)
    return max(fair - _MAX_YIELDED_ROWS, min(fair, height - sum(_list_read_rows(beside))))


def _list_read_rows(panels: Sequence[str]) -> tuple[int, ...]:
    """Return the height in rows of each panel that is beside a small world.

    This is the minimum height of the panel, and one row more for the panel with the readings.
    """
    return tuple(PANELS[panel].min_rows + (panel == "instrumentation") for panel in panels)


def _stack_readings(panels: Sequence[str], height: int) -> Node:
    """Return a tree of stacked panels; if there is room, the readings get a further row for the pose."""
    column = join_nodes(Axis.ROWS, panels)
    if isinstance(column, str) or count_min_rows(column) >= height:
        return column
    return Split(Axis.ROWS, column.parts, least=_list_read_rows(panels))


def _build_line(panels: Sequence[str], width: int) -> Node:
    """Return a tree with the output and the readings side by side; the output is at the left, where notices appear."""
    share = max(1 / 2, min(_READINGS_COLS, width - _TEXT_COLS) / width)
    order = [panel for panel in ("output", "instrumentation") if panel in panels]
    return join_nodes(Axis.COLUMNS, order, shares=(1 - share, share))


def _sum_fair_rows(panels: Sequence[str]) -> int:
    return sum(PANELS[panel].fair_rows for panel in panels)


def build_halves(first: Sequence[str], second: Sequence[str], share: float) -> Form:
    """Return a function that arranges panels in two columns; panels that belong to neither column go below both.

    Args:
        first: Panels of the left column, from the top.
        second: Panels of the right column, from the top.
        share: The left column's share of the width; 0 gives the right one the width of the side column.
    """

    def build_form(panels: Sequence[str], width: int, height: int) -> Node:
        if is_tall(width, height) and width < 2 * COLUMN_COLS:
            return join_nodes(
                Axis.ROWS,
                [
                    panel
                    for panel in dict.fromkeys(("world", *first, *second, *panels))
                    if panel in panels
                ],
            )
        rest = [panel for panel in panels if panel not in {*first, *second}]
        left = [panel for panel in first if panel in panels] + select_panels(
            rest, PanelPlace.BOTTOM
        )
        right = [panel for panel in second if panel in panels] + select_panels(
            rest, PanelPlace.SIDE
        )
        wide = share or 1 - measure_side(width, right) / width
        columns = [
            join_nodes(Axis.ROWS, _pair_panels(column, round((1 - wide) * width)))
            for column in (left, right)
            if column
        ]
        return join_nodes(Axis.COLUMNS, columns, shares=(wide, 1 - wide)[: len(columns)])

    return build_form


def _pair_panels(panels: Sequence[str], width: int) -> list[Node]:
    """Return the parts of a stack of panels; if there is room, two small neighbours are one part, side by side."""
    nodes: list[Node] = []
    for panel in panels:
        last = nodes[-1] if nodes else None
        pair = (
            isinstance(last, str)
            and _is_small(last)
            and _is_small(panel)
            and width >= 2 * measure_side(112)
        )
        if pair and last is not None:
            nodes[-1] = join_nodes(Axis.COLUMNS, [last, panel])
        else:
            nodes.append(panel)
    return nodes


def _is_small(panel: str) -> bool:
    return PANELS[panel].place == PanelPlace.SIDE and not PANELS[panel].grows
