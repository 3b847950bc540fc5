"""The container of the panels: mounts them when first shown, and lays them out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from typing import TYPE_CHECKING, Generic, TypeVar, cast

from textual import events
from textual.containers import Container
from textual.message import Message
from textual.widget import Widget

from tuisim.app.panels import PANELS, NextRunPanel, Panel, PanelPlace, TerminalSize
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import Snapshot
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

if TYPE_CHECKING:
    from tuisim.app.panels.brick import Brick
    from tuisim.app.panels.chart import Chart
    from tuisim.app.panels.code import Code
    from tuisim.app.panels.controls import Controls
    from tuisim.app.panels.debug import Debug
    from tuisim.app.panels.goals import Goals
    from tuisim.app.panels.lesson import LessonPanel
    from tuisim.app.panels.obstacles import Obstacles
    from tuisim.app.panels.output import Output
    from tuisim.app.panels.world import World

PanelWidget = TypeVar("PanelWidget", bound=Widget)


class _Mounted(Generic[PanelWidget]):
    """An attribute that is a panel, or None until that is mounted."""

    def __init__(self, panel: str) -> None:
        self._panel = panel

    def __get__(self, area: PanelArea | None, owner: type[PanelArea]) -> PanelWidget | None:
        return cast("PanelWidget | None", area.panels.get(self._panel) if area is not None else None)


class PanelArea(Container):
    """The area of all panels.

    Args:
        on: Ids of panels shown whatever the size.
        off: Ids of panels hidden whatever the size.
    """

    class Rearranged(Message):
        """Posted when panels were shown, hidden or moved."""

    @dataclass
    class Added(Message):
        """Posted when a panel was mounted."""

        panel: str

    def __init__(self, on: frozenset[str], off: frozenset[str]) -> None:
        super().__init__(id="panel-area")
        self.panels: dict[str, Widget] = {}
        """The panels that have been mounted, by id."""
        asked = {**dict.fromkeys(on, True), **dict.fromkeys(off, False)}
        self._asked = {panel: asked[panel] for panel in PANELS if panel in asked}
        """Panels that were asked for, the latest last."""
        self.alone = ""
        """Id of the maximized panel, empty for none."""
        self._roomy: tuple[str, int, int] | None = None
        """The panel that needs a number of columns and rows."""

    # A hidden panel is still fed; one that was never shown is None.

    world: _Mounted[World] = _Mounted("world")
    output: _Mounted[Output] = _Mounted("output")
    chart: _Mounted[Chart] = _Mounted("chart")
    code: _Mounted[Code] = _Mounted("code")
    controls: _Mounted[Controls] = _Mounted("controls")
    debug: _Mounted[Debug] = _Mounted("debug")
    brick: _Mounted[Brick] = _Mounted("brick")
    obstacles: _Mounted[Obstacles] = _Mounted("obstacles")
    goals: _Mounted[Goals] = _Mounted("goals")
    lesson: _Mounted[LessonPanel] = _Mounted("lesson")

    def shown(self, panel: str) -> bool:
        """Return whether a panel is on the screen."""
        return panel in self.panels and self.panels[panel].display

    def clear_log(self) -> None:
        """Clear the logged output and traces from the panels."""
        if self.output:
            self.output.clear()
        if self.chart:
            self.chart.clear()

    def on_screen(self) -> list[Panel]:
        """Return the panels on the screen."""
        return [cast(Panel, widget) for widget in self.panels.values() if widget.display]

    def toggle(self, panel: str) -> None:
        """Show or hide a panel."""
        show = not self.shown(panel) or bool(self.alone)
        self.alone, self._roomy = "", None
        self.request({panel: show})

    def request(self, wanted: Mapping[str, bool | None]) -> None:
        """Show and hide panels. Later requests get room first; None leaves a panel to the size of the terminal."""
        for panel, show in wanted.items():
            self._asked.pop(panel, None)
            if show is not None:
                self._asked[panel] = show
        before = [panel for panel in PANELS if self.shown(panel)]
        self.lay_out()
        asked = [panel for panel, show in wanted.items() if show and not self.alone]
        for panel in asked:
            if not self.shown(panel):
                self.app.notify(f"{PANELS[panel].title} does not fit here: hide another panel or enlarge the terminal")
        gone = [PANELS[panel] for panel in before if panel not in wanted and not self.shown(panel)]
        came = " and ".join(PANELS[panel].title for panel in asked if self.shown(panel))
        if gone and came:
            names = ", ".join(f"{info.title} ({info.key})" for info in gone)
            self.app.notify(f"{came} replaces {names}")

    def maximize(self, panel: str) -> None:
        """Maximize one panel; an empty id restores the others."""
        if panel != self.alone or self._roomy:
            self.alone, self._roomy = panel, None
            self.lay_out()

    def make_room(self, panel: str, columns: int, rows: int) -> None:
        """Give a panel of the bottom strip the whole strip, or the whole area if that is still too small."""
        if panel != self.alone:
            self._roomy = panel, columns, rows
            self.lay_out()

    def _wanted(self) -> list[str]:
        """Return the ids of the panels to show, by priority."""
        if self._roomy:
            panel, columns, rows = self._roomy
            wanted = with_room(panel, self._usually_wanted(), (columns, rows), (self.size.width, self.size.height))
            self.alone = panel if wanted == [panel] else ""
            return wanted
        return [self.alone] if self.alone else self._usually_wanted()

    def _usually_wanted(self) -> list[str]:
        size = size_class(self.size.width, self.size.height + 1)
        asked = [panel for panel, on in reversed(self._asked.items()) if on]
        rest = [info.id for info in PANELS.values() if size in info.sizes and info.id not in self._asked]
        return asked + rest

    def lay_out(self) -> None:
        """Lay out every panel."""
        if not self.size:
            return
        arrangement = arrange(self._wanted(), self.size.width, self.size.height)
        with self.app.batch_update():
            for panel, widget in self.panels.items():
                widget.display = panel in arrangement.boxes
            for panel, box in arrangement.boxes.items():
                styles = self._panel(panel).styles
                styles.width, styles.height = box.width, box.height
                styles.offset = (box.x, box.y)
        self.post_message(self.Rearranged())

    def _panel(self, panel: str) -> Widget:
        if panel not in self.panels:
            widget = cast(Widget, PANELS[panel].load()())
            widget.border_title = PANELS[panel].title
            widget.add_class("panel")
            self.panels[panel] = widget
            self.mount(widget)
            self.post_message(self.Added(panel))
        return self.panels[panel]

    def show_next_run(self, plan: NextRun) -> None:
        """Update the panels that edit the plan of the next run, on the screen or not."""
        for widget in self.panels.values():
            if isinstance(widget, NextRunPanel):
                widget.show_next_run(plan)

    def focus_world(self) -> None:
        """Focus the world if it is shown; the focus of a dialog above the panels stays."""
        self.screen.set_focus(self.world if self.shown("world") else None)

    def attend(self, panel: str) -> None:
        """Focus a panel that has been opened, if it can have the focus; the world if it was closed."""
        widget = self.panels.get(panel)
        if not self.shown(panel) or widget is None:
            self.focus_world()
        elif not widget.is_mounted:
            # It is still being mounted.
            widget.call_later(self.attend, panel)
        elif hasattr(widget, "begin"):
            widget.begin()
        else:
            inside = (child for child in widget.walk_children(Widget, with_self=True) if child.focusable)
            if first := next(inside, None):
                first.focus()

    def ensure(self, *panels: str) -> None:
        """Mount the panels that need data from the start, shown or not."""
        for panel in panels:
            if panel not in self.panels:
                self._panel(panel).display = False

    def on_resize(self, event: events.Resize) -> None:
        self.lay_out()

    def on_descendant_focus(self, event: events.DescendantFocus) -> None:
        """Mark the panel that has the focus.

        By a class, which changes only when the focus moves to another panel: `:focus-within` would make Textual restyle
        every field of a form at each move from one field to the next.
        """
        self._mark(event.widget)

    def on_descendant_blur(self) -> None:
        if self.screen.focused is None:
            self._mark(None)

    def _mark(self, focused: Widget | None) -> None:
        around = focused.ancestors_with_self if focused else []
        for panel in self.panels.values():
            panel.set_class(panel in around, "-focused")

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment in every panel on the screen."""
        for panel in self.on_screen():
            if cast(Widget, panel).is_attached:
                panel.show(snapshot)


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


def size_class(width: int, height: int) -> TerminalSize:
    """Return the size of a terminal: small, medium or large."""
    if width >= 170 and height >= 50:
        return TerminalSize.LARGE
    if width >= 112 and height >= 34:
        return TerminalSize.MEDIUM
    return TerminalSize.SMALL


_LEAST_TEXT, _MOST_TEXT = 40, 58
"""Columns for text to read, if that is at most half of the screen."""


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
    return 42 if width < 170 else 46


def _in_place(panels: Sequence[str], place: str) -> list[str]:
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
    side, strip, main = (_in_place(panels, place) for place in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN))
    if sum(PANELS[panel].min_rows for panel in side) > height:
        return False
    left = width - (side_width(width, side) if side and (strip or main) else 0)
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
    side, strip, main = (_in_place(kept, place) for place in (PanelPlace.SIDE, PanelPlace.BOTTOM, PanelPlace.MAIN))
    boxes: dict[str, PanelBox] = {}
    left = width
    if side:
        left = width - side_width(width, side) if strip or main else 0
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
