"""The container of the panels: mounts them when first shown, and lays them out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Generic, TypeVar, cast

from textual import events
from textual.containers import Container
from textual.dom import DOMNode
from textual.message import Message
from textual.widget import Widget

from tuisim.app.action import fill_keys, label_of_key
from tuisim.app.layout.arrangement import (
    KeptLayout,
    Preset,
    arrange,
    arrange_beside_world,
    choose_panels,
    find_core_panels,
    load_layout,
    make_room,
    save_layout,
    stack_panels,
)
from tuisim.app.layout.forms import classify_size, is_single
from tuisim.app.layout.tree import PanelLayout, free_rows
from tuisim.app.panels import PANELS, NextRunPanel, Panel, TerminalSize
from tuisim.app.panels.titles import build_title
from tuisim.base.data_class import dataclass
from tuisim.terminal.pacer import Throttle

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
    from tuisim.app.setup.next_run import NextRun
    from tuisim.app.snapshot import Snapshot

PanelWidget = TypeVar("PanelWidget", bound=Widget)
_READINGS_ROWS = 36
"""In an area of at least so many rows, maximized readings leave room for the world above them."""
_STACKED_ROWS = 18
"""Minimum rows of an area in which a lesson has room below a panel that needs the whole width."""


_READINGS = ("instrumentation", "arrays", "positioning")
"""Ids of the panels with values at the instant in view; they are updated together, so that they agree."""
_READINGS_PERIOD_S = 0.1
"""Seconds between two updates of the panels in `_READINGS`: values that change faster cannot be read."""
_ARRAYS_PERIOD_S = 0.25
"""The same while the sensor arrays are shown, whose pixels may all change: a slow link carries no more."""


class _Mounted(Generic[PanelWidget]):
    """A descriptor of `PanelArea`: reads the widget of one panel, or None while that is not mounted."""

    def __init__(self, panel: str) -> None:
        self._find_panel = panel

    def __get__(self, area: PanelArea | None, owner: type[PanelArea]) -> PanelWidget | None:
        return cast(
            "PanelWidget | None", area.panels.get(self._find_panel) if area is not None else None
        )


class PanelArea(Container):
    """The area of all panels.

    Args:
        on: Ids of panels that are shown at the start, whatever the size of the terminal.
        off: Ids of panels that are hidden at the start, whatever the size of the terminal.
    """

    ALLOW_SELECT = False

    class Rearranged(Message):
        """Posted after panels were shown, hidden or moved."""

    @dataclass
    class Added(Message):
        """Posted when a panel was mounted."""

        panel: str

    def __init__(self, on: frozenset[str], off: frozenset[str]) -> None:
        super().__init__(id="panel-area")
        self.panels: dict[str, Widget] = {}
        """The panels that have been mounted, by id; a panel that was never shown need not be among them."""
        self.arrangement = PanelLayout()
        """The boxes of the panels on the screen."""
        switched = {**dict.fromkeys(on, True), **dict.fromkeys(off, False)}
        self._given = {panel: switched[panel] for panel in PANELS if panel in switched}
        """Panels that options of the command line have shown (True) or hidden; not stored with the arrangement."""
        self._asked = dict(self._given)
        """Panels that options, keys or lessons have shown (True) or hidden, by id, the latest last."""
        self._chosen: dict[str, bool] = {}
        """Panels that the user has shown (True) or hidden by their keys, by id; they can be stored with the preset."""
        self.preset = Preset.STANDARD
        self.alone = ""
        """Id of the panel that is maximized; empty for none."""
        self.clicked = ""
        """Id of the panel that was clicked last, if it cannot have the focus; empty once another one gets the focus."""
        self.front = "world"
        """Id of the panel that was shown or focused last; where only one panel has room, it is this one."""
        self._is_loaded = False
        """Whether the user's stored arrangement of panels has been loaded."""
        self.is_stacked = False
        """Whether two panels fill the area, one above the other, such as the code above a lesson."""
        self.is_beside = False
        """Whether a panel that needs much room, such as the code while the user types, stands beside the world."""
        self._snapshot: Snapshot | None = None
        self._throttle = Throttle(self, _READINGS_PERIOD_S, self._show_readings)
        self._roomy: tuple[str, int, int] | None = None
        """The panel that needs much room now, with the columns and rows that it needs; None for none."""
        self._free_rows = 0
        """Number of rows below the panels that are left free for a notice."""

    # A hidden panel still gets data; a panel that was never shown is None.

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

    def is_shown(self, panel: str) -> bool:
        """Return whether a panel is on the screen."""
        return panel in self.panels and self.panels[panel].display

    def clear_log(self) -> None:
        """Remove the output and the logged traces from the panels."""
        if self.output:
            self.output.clear()
        if self.chart:
            self.chart.clear()

    def on_screen(self) -> list[Panel]:
        """Return the widgets of the panels that are on the screen."""
        return [cast(Panel, widget) for widget in self.panels.values() if widget.display]

    @property
    def is_single(self) -> bool:
        """Whether the area is so small that it shows one panel at a time."""
        return is_single(self.size.width, self.size.height)

    def toggle(self, panel: str) -> None:
        """Show a hidden panel, or hide a shown panel.

        In an area with room for only one panel, show the panel instead of the present one; if it is shown, show the
        world.
        """
        show = self.is_single or not self.is_shown(panel) or bool(self.alone)
        self.alone = ""
        self._roomy = None
        if self.is_single:
            self.front = panel if panel != self.front else "world"
            self.lay_out()
            return
        self.request({panel: show})
        if show:
            self.front = panel
        self._chosen.pop(panel, None)
        self._chosen[panel] = show

    def can_take_focus(self, panel: str) -> bool:
        """Return whether the key of a panel should move the focus to it.

        This is so if the panel can have the focus, is beside other panels, and is not the panel that was opened or
        focused last.
        """
        beside = self.is_shown(panel) and not self.alone and not self.is_single
        return beside and panel != self.front and self._can_focus(panel)

    def open(self, panel: str) -> None:
        """Show a panel for this session only: the next start of the app does not show it for this reason."""
        if self.is_single:
            self.front = panel
            self.lay_out()
        elif not self.is_shown(panel):
            self.request({panel: True})

    def show_next_panel(self, by: int) -> str:
        """Return the id of the panel that is `by` panels after the focused one; empty if no panel can have the focus.

        In an area with room for only one panel, start from the shown panel instead, and show the panel that is
        returned.
        """
        if self.is_single:
            usual = choose_panels(self.preset, self._asked, self.size.width, self.size.height)
            panels = list(dict.fromkeys([*usual[0], *usual[1], self.front]))
            self.front = panels[(panels.index(self.front) + by) % len(panels)]
            self.lay_out()
            return self.front
        panels = [panel for panel in self.arrangement.boxes if self._can_focus(panel)]
        focused = self.find_focused_panel()
        if focused in panels:
            index = panels.index(focused)
        else:
            index = -1 if by > 0 else 0
        return panels[(index + by) % len(panels)] if panels else ""

    def _can_focus(self, panel: str) -> bool:
        return any(
            child.focusable for child in self.panels[panel].walk_children(Widget, with_self=True)
        )

    def find_focused_panel(self) -> str:
        """Return the id of the panel that has the focus; empty if none has it."""
        return self.find_owner(self.screen.focused)

    def find_owner(self, widget: Widget | None) -> str:
        """Return the id of the panel around a widget; empty if the widget is in no panel."""
        around = widget.ancestors_with_self if widget else []
        return next((name for name, panel in self.panels.items() if panel in around), "")

    def find_pointed_panel(self) -> str:
        """Return the id of the panel that the user works with.

        This is the panel that was clicked last, if it cannot have the focus; else it is the panel with the focus. The
        result is empty if no such panel was clicked, and none has the focus.
        """
        if self.clicked and self.is_shown(self.clicked):
            return self.clicked
        return self.find_focused_panel()

    def list_focused_widgets(self) -> list[DOMNode]:
        """Return the focused widget and the widgets around it, up to its panel; empty if no widget has the focus."""
        around = self.screen.focused.ancestors_with_self if self.screen.focused else []
        panel = self.panels.get(self.find_focused_panel())
        return [widget for widget in around if panel in widget.ancestors_with_self]

    def choose_preset(self, preset: Preset) -> Preset:
        """Show the panels of a preset and return it; if this preset is shown already, show and return the standard one.

        This changes only the shown panels, never the run.
        """
        unchanged = self.preset == preset and self._asked in ({}, self._given)
        self.preset = Preset.STANDARD if unchanged else preset
        self._asked = dict(self._given) if self.preset == Preset.STANDARD else {}
        self._chosen = {}
        self.alone, self._roomy, self.front = (
            "",
            None,
            (*find_core_panels(self.preset, *self.size), "world")[0],
        )
        self.lay_out()
        return self.preset

    def show_next_preset(self) -> None:
        """Show the next preset that differs from the present one in its panels or in their arrangement.

        After the last preset comes the first.
        """
        before = self.arrangement.boxes
        presets = list(Preset)
        index = presets.index(self.preset)
        for preset in presets[index + 1 :] + presets[: index + 1]:
            if preset == self.preset:
                break
            self.choose_preset(preset)
            if self.arrangement.boxes != before:
                break

    def keep_panels(self) -> None:
        """Store the preset and the panels that the user has shown or hidden, for terminals of this size class.

        The next start of the app in such a terminal uses them.
        """
        save_layout(self._find_size(), KeptLayout(self.preset, self._chosen))

    def _find_size(self) -> TerminalSize:
        return classify_size(self.size.width, self.size.height + 1)

    def _load(self) -> None:
        """Load the arrangement that is stored for this size of the terminal."""
        self._is_loaded = True
        layout = load_layout(self._find_size())
        self.preset = layout.preset
        self._chosen = layout.asked
        self._asked = {
            **{panel: on for panel, on in layout.asked.items() if panel not in self._given},
            **self._given,
        }

    def request(self, panels: Mapping[str, bool | None]) -> None:
        """Show and hide panels, and show a notice about panels that have no room or were hidden to make room.

        Args:
            panels: Panels by id: True shows one, False hides it, None leaves that to the size of the terminal. If there
                is not enough room for all, the panels of later requests are shown first.
        """
        for panel, show in panels.items():
            self._asked.pop(panel, None)
            if show is not None:
                self._asked[panel] = show
        before = [panel for panel in PANELS if self.is_shown(panel)]
        self.lay_out()
        panels_to_show = [panel for panel, show in panels.items() if show and not self.alone]
        for panel in panels_to_show:
            if not self.is_shown(panel):
                self.app.notify(
                    f"No room for {PANELS[panel].title}: hide another panel or enlarge the terminal"
                )
        gone = [
            PANELS[panel] for panel in before if panel not in panels and not self.is_shown(panel)
        ]
        came = " and ".join(PANELS[panel].title for panel in panels_to_show if self.is_shown(panel))
        if gone and came:
            names = ", ".join(f"{info.title} ({label_of_key(info.key)})" for info in gone)
            self.app.notify(f"{came} instead of {names}")

    def maximize(self, panel: str) -> None:
        """Show one panel alone; an empty id shows the others again."""
        if panel != self.alone or self._roomy:
            self.alone = panel
            self._roomy = None
            self.lay_out()

    def make_room(self, panel: str, columns: int, rows: int) -> None:
        """Enlarge a panel to a width in columns and a height in rows, at the cost of the panels beside it.

        If that is not enough, show the panel alone.
        """
        if panel != self.alone:
            self._roomy = panel, columns, rows
            self.lay_out()

    def _choose_panels(self) -> tuple[list[str], list[str]]:
        """Return the ids of the panels to show, the most important first, and of those that fill the remaining area."""
        width, height = self.size
        self.is_stacked = self.is_beside = False
        chosen, fill = choose_panels(self.preset, self._asked, width, height)
        if self._roomy:
            panel, columns, rows = self._roomy
            keeps_lesson = "lesson" in chosen and panel != "lesson" and height >= _STACKED_ROWS
            asked_for = chosen
            chosen = make_room(panel, chosen, (columns, rows), (width, height), self.preset)
            if chosen == [panel] and arrange_beside_world(panel, asked_for, width, height):
                self.alone = ""
                self.is_beside = True
                return [panel, *asked_for], []
            if chosen == [panel] and keeps_lesson:
                # The lines of the panel need the whole width, but not all rows.
                self.alone = ""
                self.is_stacked = True
                return [panel, "lesson"], []
            self.alone = panel if chosen == [panel] else ""
            return chosen, []
        if self.alone == "instrumentation" and height >= _READINGS_ROWS:
            # The readings have no use for all rows: the world is above them.
            self.is_stacked = True
            return ["world", self.alone], []
        if self.alone or self.is_single:
            return [self.alone or self.front], []
        return chosen, fill

    def _arrange(self) -> PanelLayout:
        chosen, fill = self._choose_panels()
        if self.is_beside and (layout := arrange_beside_world(chosen[0], chosen[1:], *self.size)):
            return layout
        if self.is_stacked:
            return stack_panels(chosen[0], chosen[1], self.size.width, self.size.height)
        return arrange(chosen, self.size.width, self.size.height, fill, self.preset)

    def lay_out(self, keeps: str = "") -> None:
        """Choose and arrange the panels for the present size.

        Args:
            keeps: Id of a panel that is shown before all others, such as the one in which the user of a phone types;
                empty for none.
        """
        if not self.size:
            return
        self.arrangement = self._arrange()
        if keeps and keeps not in self.arrangement.boxes and not self.alone:
            self._asked[keeps] = True
            self.arrangement = self._arrange()
        self._place_panels()
        if self.world:
            is_usual = self.preset == Preset.STANDARD
            key = fill_keys(self.app, f"{{layout-{self.preset}}}")
            self.world.name_layout("" if is_usual else f"{key} {self.preset}")

    def _place_panels(self) -> None:
        """Move the panels to their boxes, with the rows left free that a notice needs."""
        with self.app.batch_update():
            for panel, widget in self.panels.items():
                widget.display = panel in self.arrangement.boxes
            for panel, box in free_rows(self.arrangement.boxes, self._free_rows).items():
                styles = self._find_panel(panel).styles
                styles.width, styles.height = box.width, box.height
                styles.offset = (box.x, box.y)
        self.post_message(self.Rearranged())

    def leave_rows(self, rows: int) -> None:
        """Leave some rows below the panels free for a notice; leave none if the notice is shown on a dialog."""
        rows = rows if self.app.screen is self.screen else 0
        if rows != self._free_rows:
            self._free_rows = rows
            self._place_panels()

    def _find_panel(self, panel: str) -> Widget:
        if panel not in self.panels:
            widget = cast(Widget, PANELS[panel].load()())
            widget.border_title = build_title(self.app, panel)
            widget.add_class("panel")
            self.panels[panel] = widget
            self.mount(widget)
            self.post_message(self.Added(panel))
        return self.panels[panel]

    def show_next_run(self, plan: NextRun) -> None:
        """Show the plan of the next run in the panels that edit it, even in hidden ones."""
        for widget in self.panels.values():
            if isinstance(widget, NextRunPanel):
                widget.show_next_run(plan)

    def focus_world(self) -> None:
        """Focus the world if it is shown; a dialog above the panels keeps its focus."""
        self.screen.set_focus(self.world if self.is_shown("world") else None)

    def leave_code(self) -> None:
        """Move the focus from the code to the world, unless the user types in the code."""
        if self.code is not None and self.code.has_focus_within and not self.code.typing:
            self.focus_world()

    def bring(self, panel: str) -> None:
        """Show a hidden panel, as the panel's key does; do nothing if the panel is shown."""
        if not self.is_shown(panel):
            self.toggle(panel)

    def release_buttons(self) -> None:
        """Release all buttons in the panel of the brick."""
        if self.brick:
            self.brick.release_all()

    def focus_opened(self, panel: str) -> None:
        """Focus a panel after its key was pressed, if it is shown and can have the focus; else focus the world."""
        widget = self.panels.get(panel)
        if not self.is_shown(panel) or widget is None:
            self.focus_world()
        elif not widget.is_mounted:
            # The panel is still being mounted: try again when that is done.
            widget.call_later(self.focus_opened, panel)
        elif hasattr(widget, "begin"):
            widget.begin()
        else:
            inside = (
                child for child in widget.walk_children(Widget, with_self=True) if child.focusable
            )
            if first := next(inside, None):
                first.focus()

    def ensure(self, *panels: str) -> None:
        """Mount panels that need data from the start, without showing them."""
        for panel in panels:
            if panel not in self.panels:
                self._find_panel(panel).display = False

    def on_resize(self, event: events.Resize) -> None:
        if not self._is_loaded:
            self._load()
        panel = self.find_focused_panel()
        self.lay_out(keeps=panel if self.is_shown(panel) else "")

    def on_descendant_focus(self, event: events.DescendantFocus) -> None:
        """Mark the panel that has the focus by a class of its widget.

        The class changes only when the focus moves to another panel: `:focus-within` would make Textual restyle every
        field of a form at each move from one field to the next.
        """
        self._mark(event.widget)

    def on_descendant_blur(self) -> None:
        if self.screen.focused is None:
            self._mark(None)

    def _mark(self, focused: Widget | None) -> None:
        around = focused.ancestors_with_self if focused else []
        for panel in self.panels.values():
            panel.set_class(panel in around, "-focused")
        self.front = self.find_focused_panel() or self.front
        if self.front != "world":
            self.clicked = ""

    def show(self, snapshot: Snapshot) -> None:
        """Show an instant in every panel on the screen; panels with readings are updated less often, all together."""
        before = self._snapshot
        self._snapshot = snapshot
        for panel, widget in self.panels.items():
            if widget.display and widget.is_attached and panel not in _READINGS:
                cast(Panel, widget).show(snapshot)
        self._throttle.period_s = (
            _ARRAYS_PERIOD_S if self.is_shown("arrays") else _READINGS_PERIOD_S
        )
        self._throttle.ask(at_once=snapshot.has_stopped_since(before))

    def _show_readings(self) -> None:
        if (now := self._snapshot) is None:
            return
        for panel in _READINGS:
            if self.is_shown(panel) and self.panels[panel].is_attached:
                cast(Panel, self.panels[panel]).show(now)
        if self.world is not None:
            self.world.time_bar.show(now)
