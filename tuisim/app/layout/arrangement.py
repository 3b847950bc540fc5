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
    build_board,
    build_halves,
    build_low,
    build_under,
    count_tight_rows,
    is_single,
    is_tall,
    select_panels,
    size_class,
)
from tuisim.app.layout.tree import (
    EDGES,
    TIME_BAR_ROWS,
    Axis,
    Node,
    PanelBox,
    PanelLayout,
    fair_rows,
    joined,
    least_columns,
    least_rows,
    panels_of,
    place,
)
from tuisim.app.panels import PANELS, PanelPlace, TerminalSize
from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.settings.preferences import get_preference, keep

_CODE_FROM_COLS = 120
"""From this width on, code is shown beside them."""
_EDITOR_FROM_COLS = 110
"""From this width on, the code that is typed in stands beside the world."""
_STRIP_FROM_COLS = 190
"""From this width on, the world may give rows to what is below it."""
EDITOR_COLS = 86
"""Columns in which lines of 79 characters are whole."""
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


def is_low(preset: Preset, width: int, height: int) -> bool:
    """Return whether an area has room for few panels: the world in its whole width, or one with long lines or a chart.

    A lower area shows one panel only.
    """
    shows_board = preset == Preset.STANDARD and size_class(width, height + 1) != TerminalSize.SMALL
    is_small = width < LOW_COLS and height < LOW_ROWS and not is_tall(width, height)
    return is_small and not shows_board


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
        (),
        _SHOWN,
        (build_board, build_under),
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
            build_under,
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
    columns = max(0, width // COLUMN_COLS - len(plan.core) + 1)
    usual = plan.core + plan.beside[:columns] or tuple(
        panel
        for panel in _SHOWN
        if size in PANELS[panel].sizes and not _gives_way(panel, asked, width)
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
        fill = [] if is_board else select_panels(fill, PanelPlace.SIDE)
    return wanted, fill


_READ_FIRST = ("code", "chart", "arrays")
"""Panels that fill a tall terminal before those that set up a run."""


def _gives_way(panel: str, asked: Mapping[str, bool], width: int) -> bool:
    """Return whether a panel leaves its room to others: to code and variables in a narrow terminal, to a lesson."""
    is_narrow = width < _CODE_FROM_COLS
    match panel:
        case "code":
            return is_narrow
        case "chart" if asked.get("lesson", False):
            return width < MIN_LARGE_COLS
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
        if panel in _READ_FIRST and is_tall(width, height) and width < 2 * COLUMN_COLS:
            rows = sum(count_tight_rows([*kept, panel], width))
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


_STEPPED = ("world", "instrumentation", "debug", "output", "code")
"""What somebody who steps looks at."""


def _is_cramped(width: int, height: int) -> bool:
    """Return whether code and variables have no room below a world in the whole width, nor beside it."""
    fits_below = is_tall(width, height) and sum(count_tight_rows(_STEPPED, width)) <= height
    return width < _CODE_FROM_COLS and not fits_below


def _scored(
    panels: Sequence[str], fill: Sequence[str], preset: Preset, width: int, height: int
) -> Iterator[tuple[tuple[int, float], Node]]:
    """Yield the tree in each form, and how good that is."""
    plan = _PLANS[preset]
    is_standard = preset == Preset.STANDARD
    is_cramped = is_standard and "debug" in panels and _is_cramped(width, height)
    is_medium = size_class(width, height + 1) == TerminalSize.MEDIUM
    if is_cramped or is_low(preset, width, height):
        forms: tuple[Form, ...] = (build_low,)
    elif is_standard and is_medium and "chart" in panels and not is_tall(width, height):
        # A larger world would leave too little to the chart.
        forms = (build_board,)
    else:
        forms = plan.forms
    for form in forms:
        if not (kept := _kept(form, panels, fill, width, height)):
            continue
        node = form(kept, width, height)
        layout = PanelLayout(wanted=panels)
        place(node, PanelBox(0, 0, width, height), layout)
        if form is not forms[0] and not _fills(layout, _LEAST_FILLED):
            continue
        room = height + (MAX_TAKEN_ROWS if width >= _STRIP_FROM_COLS else 0)
        crowded = not plan.compact and fair_rows(node, width) > room
        yield _score(layout, sum(panel in kept for panel in panels), crowded), node


def stacked(upper: str, lower: str, width: int, height: int) -> PanelLayout:
    """Place two panels one above the other; the upper one is a little higher."""
    rows = height * 11 // 20
    boxes = {upper: PanelBox(0, 0, width, rows), lower: PanelBox(0, rows, width, height - rows)}
    return PanelLayout(boxes, wanted=(upper, lower))


def arrange_beside_world(
    panel: str, panels: Sequence[str], width: int, height: int
) -> PanelLayout | None:
    """Place a panel beside the world, with others below that as far as they fit; None where there is no room.

    Args:
        panel: The one that gets most of the width.
        panels: The others, the most wanted first.
        width: Columns.
        height: Rows.
    """
    if width < _EDITOR_FROM_COLS or "world" not in panels or "lesson" in panels:
        return None
    wide = min(EDITOR_COLS, width - DISCS_COLS)
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
    found = _table(get_preference(_NAME)).get(size)
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
            {
                **_table(get_preference(_NAME)),
                size: {"preset": layout.preset.value, "panels": panels},
            },
        )


def _table(value: object) -> dict[str, Any]:
    return value if isinstance(value, dict) else {}
