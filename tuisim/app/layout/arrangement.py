"""Which panels are shown, and where: the presets, and the forms of the screen that they choose from by its size."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import field
from enum import StrEnum
from typing import Any

from tuisim.app.layout.forms import (
    COLUMN_COLS,
    DISCS_COLS,
    LOW_COLS,
    LOW_ROWS,
    MAX_TAKEN_ROWS,
    MIN_LARGE_COLS,
    Form,
    build_below,
    build_board,
    build_halves,
    build_low,
    classify_size,
    count_tight_rows,
    is_single,
    is_tall,
    select_panels,
)
from tuisim.app.layout.tree import (
    EDGES,
    TIME_BAR_ROWS,
    Axis,
    Node,
    PanelBox,
    PanelLayout,
    count_fair_rows,
    count_min_columns,
    count_min_rows,
    join_nodes,
    list_panels,
    place,
)
from tuisim.app.panels import PANELS, PanelPlace, TerminalSize
from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.settings.preferences import get_preference, keep

_MIN_CODE_COLS = 120
"""In a narrower area, the standard preset shows no code, and beside the debug panel neither chart nor arrays."""
_MIN_EDITOR_COLS = 110
"""From this width of the area on, the code stands beside the world while the user types in it."""
_MIN_STRIP_COLS = 190
"""From this width of the area on, the bottom strip may take up to `MAX_TAKEN_ROWS` rows from the world."""
EDITOR_COLS = 86
"""Width in columns of a code panel that shows lines of 79 characters whole."""
_MAX_WASTE = 0.3
"""A form that leaves a larger share of the world's panel empty around the mat has its score multiplied by `_POOR`."""
_POOR = 0.7
_MIN_FILLED = 0.6
"""Minimum share of the world's panel that the mat must fill, so that a form after the preset's first is chosen."""


class Preset(StrEnum):
    """A set of panels for one purpose, such as debugging, with the possible arrangements of these panels."""

    STANDARD = "standard"
    DRIVE = "drive"
    DEBUG = "debug"
    ANALYSE = "analyse"


def is_low(preset: Preset, width: int, height: int) -> bool:
    """Return whether an area is so low that the panels of a preset are arranged by `build_low`.

    Such an area has room for the world in its whole width, or for one panel with long lines.
    """
    shows_board = (
        preset == Preset.STANDARD and classify_size(width, height + 1) != TerminalSize.SMALL
    )
    is_small = width < LOW_COLS and height < LOW_ROWS and not is_tall(width, height)
    return is_small and not shows_board


@dataclass(frozen=True, slots=True)
class _Plan:
    """What a preset consists of: the panels that it shows, and functions (forms) that arrange panels in an area."""

    core: tuple[str, ...]
    """Ids of the panels that the preset always shows, the most important first."""
    fill: tuple[str, ...]
    """Ids of the panels that fill the remaining space, as far as they fit."""
    forms: tuple[Form, ...]
    low: tuple[str, ...]
    """Ids of the panels that a low terminal shows instead of `core`, the most important first."""
    beside: tuple[str, ...] = ()
    """Ids of further panels: the wider the area, the more of them it shows, one more for each `COLUMN_COLS` columns."""
    compact: bool = True
    """Whether the form with the larger world is chosen even if other panels then show less than everything."""


_SHOWN = tuple(info.id for info in PANELS.values() if info.sizes)

_PLANS: Mapping[Preset, _Plan] = {
    Preset.STANDARD: _Plan(
        (),
        _SHOWN,
        (build_board, build_below),
        ("world", "instrumentation", "output"),
        compact=False,
    ),
    Preset.DRIVE: _Plan(
        ("world", "instrumentation", "positioning"),
        ("arrays", "output", "chart", "controls"),
        (
            build_halves(
                ("world", "positioning", "output"), ("instrumentation", "arrays", "controls"), 0.0
            ),
            build_below,
        ),
        ("world", "instrumentation", "output"),
        beside=("arrays", "output"),
    ),
    Preset.DEBUG: _Plan(
        ("code", "debug", "world", "output"),
        ("instrumentation", "arrays"),
        (build_halves(("code", "output"), ("world", "instrumentation", "debug"), 0.55),),
        ("code", "debug", "world", "instrumentation"),
    ),
    Preset.ANALYSE: _Plan(
        ("chart", "arrays", "world"),
        ("instrumentation", "output"),
        (build_halves(("chart",), ("world", "arrays", "instrumentation", "output"), 0.58),),
        ("chart", "world", "instrumentation", "output"),
    ),
}


def find_core_panels(preset: Preset, width: int, height: int) -> tuple[str, ...]:
    """Return the panels that a preset always shows in an area of this size.

    The standard preset has none, unless the area is low.
    """
    plan = _PLANS[preset]
    return plan.low if is_low(preset, width, height) else plan.core


def choose_panels(
    preset: Preset, switched: Mapping[str, bool], width: int, height: int
) -> tuple[list[str], list[str]]:
    """Return the panels to show, the most important first, and panels that fill the rest of the area.

    Args:
        preset: The preset of the screen.
        switched: Panels that the user has shown (True) or hidden, the latest last.
        width: Columns of the area.
        height: Rows of the area.
    """
    plan = _PLANS[preset]
    size = classify_size(width, height + 1)
    columns = max(0, width // COLUMN_COLS - len(plan.core) + 1)
    usual = plan.core + plan.beside[:columns] or tuple(
        panel
        for panel in _SHOWN
        if size in PANELS[panel].sizes and not _gives_way(panel, switched, width)
    )
    if is_low(preset, width, height):
        usual = plan.low
    latest = [panel for panel, on in reversed(list(switched.items())) if on]
    rest = [panel for panel in usual if panel not in switched]
    # A lesson and the world keep their places, however many panels are asked for.
    places = {"lesson": 0, "world": 1}
    panels = sorted(latest + rest, key=lambda panel: places.get(panel, 2))
    fill = [panel for panel in plan.fill if panel not in switched and panel not in panels]
    if preset == Preset.STANDARD and is_tall(width, height):
        fill.sort(key=lambda panel: [*_READ_FIRST, panel].index(panel))
    if is_low(preset, width, height):
        return panels, []
    if preset == Preset.STANDARD and not is_tall(width, height):
        # The strip below a wide world gets no more panels, which would be too narrow. The arrangement of `build_board`
        # also has no room for a side column.
        is_board = size == TerminalSize.MEDIUM and "chart" in panels
        fill = [] if is_board else select_panels(fill, PanelPlace.SIDE)
    return panels, fill


_READ_FIRST = ("code", "chart", "arrays")
"""Ids of the panels to read; in a tall area they come before the panels with which the user sets up a run."""


def _gives_way(panel: str, switched: Mapping[str, bool], width: int) -> bool:
    """Return whether a panel is hidden at the start because the area is too narrow to show it with the others.

    Args:
        panel: Id of the panel.
        switched: Panels that the user has shown (True) or hidden.
        width: Columns of the area.
    """
    is_narrow = width < _MIN_CODE_COLS
    match panel:
        case "code":
            return is_narrow
        case "chart" if switched.get("lesson", False):
            return width < MIN_LARGE_COLS
        case "chart" | "arrays":
            return is_narrow and switched.get("debug", False)
        case _:
            return False


def _fit_panels(
    form: Form, panels: Sequence[str], fill: Sequence[str], width: int, height: int
) -> list[str]:
    """Return the panels that fit into an area.

    Args:
        form: Arranges panels in the area.
        panels: Panels that fit if there is room for their minimum size.
        fill: Further panels. One of them fits only if all panels then still have enough rows to be read easily.
        width: Columns.
        height: Rows.
    """
    fitting: list[str] = []
    for panel in panels:
        node = form([*fitting, panel], width, height)
        if count_min_rows(node) <= height and count_min_columns(node) <= width:
            fitting.append(panel)
    for panel in fill:
        node = form([*fitting, panel], width, height)
        rows = count_fair_rows(node, width)
        if panel in _READ_FIRST and is_tall(width, height) and width < 2 * COLUMN_COLS:
            rows = sum(count_tight_rows([*fitting, panel], width))
        if rows <= height and count_min_columns(node) <= width:
            fitting.append(panel)
    return fitting


def measure_mat(box: PanelBox) -> float:
    """Return the area of the mat, in cells, in a world panel with the size of a box."""
    width, height = box.width - EDGES, box.height - EDGES - TIME_BAR_ROWS
    return (
        min(width, 2 * height * FIELD_WIDTH_MM / FIELD_HEIGHT_MM) ** 2
        * FIELD_HEIGHT_MM
        / FIELD_WIDTH_MM
        / 2
    )


def _is_filled(layout: PanelLayout, share: float) -> bool:
    """Return whether the mat fills at least a share of the world panel's area."""
    box = layout.boxes.get("world")
    return box is None or measure_mat(box) >= share * (box.width - EDGES) * (box.height - EDGES)


def _score(layout: PanelLayout, panel_count: int, crowded: bool) -> tuple[int, float]:
    box = layout.boxes.get("world")
    cells = measure_mat(box) if box else 0.0
    return panel_count, cells * (1.0 if _is_filled(layout, 1 - _MAX_WASTE) else _POOR) * (
        _POOR**2 if crowded else 1.0
    )


def arrange(
    panels: Sequence[str],
    width: int,
    height: int,
    fill: Sequence[str] = (),
    preset: Preset = Preset.STANDARD,
) -> PanelLayout:
    """Return the boxes of panels on a screen, arranged so that the world is as large as possible.

    Args:
        panels: Ids, the most wanted first.
        width: Columns.
        height: Rows.
        fill: Ids of panels that fill the rest of the screen.
        preset: The preset. It has the forms to choose from: functions that arrange panels in an area.

    Returns:
        Boxes that fill the screen without overlap, without the panels that do not fit.
    """
    if is_single(width, height):
        panels, left_out = panels[:1], tuple(panels[1:])
        boxes = {panel: PanelBox(0, 0, width, height) for panel in panels}
        return PanelLayout(boxes, left_out=left_out)
    best: tuple[tuple[int, float], Node] | None = None
    for score, node in _score_forms(panels, fill, preset, width, height):
        if best is None or score > best[0]:
            best = score, node
    if best is None:
        return PanelLayout(left_out=tuple(panels))
    placed = list_panels(best[1])
    layout = PanelLayout(
        left_out=tuple(panel for panel in panels if panel not in placed), wanted=panels
    )
    place(best[1], PanelBox(0, 0, width, height), layout)
    return layout


_STEPPED = ("world", "instrumentation", "debug", "output", "code")
"""The panels that a user who steps through a program looks at."""


def _is_cramped(width: int, height: int) -> bool:
    """Return whether an area has too little room for code and variables beside the world, and also below the world."""
    fits_below = is_tall(width, height) and sum(count_tight_rows(_STEPPED, width)) <= height
    return width < _MIN_CODE_COLS and not fits_below


def _score_forms(
    panels: Sequence[str], fill: Sequence[str], preset: Preset, width: int, height: int
) -> Iterator[tuple[tuple[int, float], Node]]:
    """Yield the panels of a preset in each possible arrangement, as (score, tree); the highest score is the best."""
    plan = _PLANS[preset]
    is_standard = preset == Preset.STANDARD
    is_cramped = is_standard and "debug" in panels and _is_cramped(width, height)
    is_medium = classify_size(width, height + 1) == TerminalSize.MEDIUM
    if is_cramped or is_low(preset, width, height):
        forms: tuple[Form, ...] = (build_low,)
    elif is_standard and is_medium and "chart" in panels and not is_tall(width, height):
        # No other form is tried: a larger world would leave too little to the chart.
        forms = (build_board,)
    else:
        forms = plan.forms
    for form in forms:
        if not (fitting := _fit_panels(form, panels, fill, width, height)):
            continue
        node = form(fitting, width, height)
        layout = PanelLayout(wanted=panels)
        place(node, PanelBox(0, 0, width, height), layout)
        if form is not forms[0] and not _is_filled(layout, _MIN_FILLED):
            continue
        room = height + (MAX_TAKEN_ROWS if width >= _MIN_STRIP_COLS else 0)
        crowded = not plan.compact and count_fair_rows(node, width) > room
        yield _score(layout, sum(panel in fitting for panel in panels), crowded), node


def stack_panels(upper: str, lower: str, width: int, height: int) -> PanelLayout:
    """Return the boxes of two panels, one above the other; the upper one is a little higher."""
    rows = height * 11 // 20
    boxes = {upper: PanelBox(0, 0, width, rows), lower: PanelBox(0, rows, width, height - rows)}
    return PanelLayout(boxes, wanted=(upper, lower))


def arrange_beside_world(
    panel: str, panels: Sequence[str], width: int, height: int
) -> PanelLayout | None:
    """Return boxes with a panel beside the world, and as many other panels below the world as fit.

    The result is None if the screen is too narrow, the world is hidden, or a lesson is shown.

    Args:
        panel: The panel that gets most of the width.
        panels: The other panels, the most wanted first.
        width: Columns.
        height: Rows.
    """
    if width < _MIN_EDITOR_COLS or "world" not in panels or "lesson" in panels:
        return None
    wide = min(EDITOR_COLS, width - DISCS_COLS)
    right = ["world"]
    for other in ("output", "instrumentation", "arrays", "chart"):
        if (
            other in panels
            and count_fair_rows(join_nodes(Axis.ROWS, [*right, other]), width - wide) <= height
        ):
            right.append(other)
    share = wide / width
    node = join_nodes(
        Axis.COLUMNS, [panel, join_nodes(Axis.ROWS, right)], shares=(share, 1 - share)
    )
    layout = PanelLayout(wanted=(panel, *right))
    place(node, PanelBox(0, 0, width, height), layout)
    return layout


def make_room(
    panel: str,
    panels: Sequence[str],
    min_size: tuple[int, int],
    size: tuple[int, int],
    preset: Preset = Preset.STANDARD,
) -> list[str]:
    """Return the panels to show so that one panel gets a minimum size.

    The result is the first of these choices in which the panel gets that size: all panels; the panel and those that
    have their place in other areas of the screen; the panel alone, whatever its size.

    Args:
        panel: The panel that needs room.
        panels: Ids of all panels, the most wanted first.
        min_size: Minimum columns and rows of `panel`.
        size: Columns and rows of the screen.
        preset: The preset of the arrangement.
    """
    others = [other for other in panels if other != panel]
    elsewhere = [other for other in others if PANELS[other].place != PANELS[panel].place]
    for beside in (others, elsewhere):
        box = arrange([panel, *beside], *size, preset=preset).boxes[panel]
        if box.width >= min_size[0] and box.height >= min_size[1]:
            return [panel, *beside]
    return [panel]


_NAME = "layout"


@dataclass
class KeptLayout:
    """The preset and the shown panels that are stored for a size of the terminal."""

    preset: Preset = Preset.STANDARD
    asked: dict[str, bool] = field(default_factory=dict)
    """Panels that the user has shown (True) or hidden by their keys, by id, the latest last."""


def load_layout(size: TerminalSize) -> KeptLayout:
    """Return the stored preset and panels for a size of the terminal, without damaged or unknown parts.

    If nothing is stored, return the standard preset, as if the user had never shown or hidden a panel.
    """
    size_table = _check_table(get_preference(_NAME)).get(size)
    layout_table = _check_table(size_table)
    layout = KeptLayout()
    with suppress(ValueError):
        layout.preset = Preset(str(layout_table.get("preset", "")))
    rows = layout_table.get("panels")
    for row in rows if isinstance(rows, list) else []:
        match row:
            case [str(panel), bool(on)] if panel in PANELS:
                layout.asked[panel] = on
            case _:
                pass
    return layout


def save_layout(size: TerminalSize, layout: KeptLayout) -> None:
    """Store a preset and panels for a size of the terminal.

    If the folder cannot be written, they last until the app ends.
    """
    # The panels are stored as a list, since their order counts and the file sorts the keys of tables.
    panels = [[panel, on] for panel, on in layout.asked.items()]
    with suppress(OSError):
        keep(
            _NAME,
            {
                **_check_table(get_preference(_NAME)),
                size: {"preset": layout.preset.value, "panels": panels},
            },
        )


def _check_table(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
