"""The container of the panels: mounts them when first shown, and lays them out."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

from textual import events
from textual.containers import Container
from textual.message import Message
from textual.widget import Widget

from tuisim.app.layout import arrange, size_class, with_room
from tuisim.app.panels import PANELS, Panel, PlanPanel
from tuisim.app.setup.next_run import NextRun
from tuisim.app.snapshot import Snapshot

if TYPE_CHECKING:
    from tuisim.app.panels.brick import Brick
    from tuisim.app.panels.chart import Chart
    from tuisim.app.panels.code import Code
    from tuisim.app.panels.controls import Controls
    from tuisim.app.panels.debug import Debug
    from tuisim.app.panels.obstacles import Obstacles
    from tuisim.app.panels.output import Output
    from tuisim.app.panels.world import World


class PanelArea(Container):
    """The area of all panels.

    Args:
        on: Ids of panels shown whatever the size.
        off: Ids of panels hidden whatever the size.
    """

    class Rearranged(Message):
        """Posted when panels were shown, hidden or moved."""

    class Added(Message):
        """Posted when a panel was mounted."""

        def __init__(self, panel: str) -> None:
            super().__init__()
            self.panel = panel

    def __init__(self, on: frozenset[str], off: frozenset[str]) -> None:
        super().__init__(id="desk")
        self.panels: dict[str, Widget] = {}
        """The panels that have been mounted, by id."""
        asked = {**dict.fromkeys(on, True), **dict.fromkeys(off, False)}
        self._asked = {panel: asked[panel] for panel in PANELS if panel in asked}
        """Panels that were asked for, the latest last."""
        self.alone = ""
        """Id of the maximized panel, empty for none."""
        self._roomy: tuple[str, int, int] | None = None
        """The panel that needs a number of columns and rows."""
        self._left_out: tuple[str, ...] = ()

    # A hidden panel is still fed; one that was never shown is None.

    @property
    def world(self) -> World | None:
        """The world panel, if mounted."""
        return cast("World | None", self.panels.get("world"))

    @property
    def output(self) -> Output | None:
        """The output panel, if mounted."""
        return cast("Output | None", self.panels.get("output"))

    @property
    def chart(self) -> Chart | None:
        """The chart panel, if mounted."""
        return cast("Chart | None", self.panels.get("chart"))

    @property
    def code(self) -> Code | None:
        """The code panel, if mounted."""
        return cast("Code | None", self.panels.get("code"))

    @property
    def controls(self) -> Controls | None:
        """The panel of the simulator controls, if mounted."""
        return cast("Controls | None", self.panels.get("controls"))

    @property
    def debug(self) -> Debug | None:
        """The debug panel, if mounted."""
        return cast("Debug | None", self.panels.get("debug"))

    @property
    def brick(self) -> Brick | None:
        """The brick panel, if mounted."""
        return cast("Brick | None", self.panels.get("brick"))

    @property
    def obstacles(self) -> Obstacles | None:
        """The obstacles panel, if mounted."""
        return cast("Obstacles | None", self.panels.get("obstacles"))

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
        self.ask({panel: show})

    def ask(self, wanted: Mapping[str, bool | None]) -> None:
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
            self.app.notify(f"{came} takes the room of {names}")

    def give_all(self, panel: str) -> None:
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
        self._left_out = arrangement.left_out
        self.post_message(self.Rearranged())

    def _panel(self, panel: str) -> Widget:
        if panel not in self.panels:
            widget = cast(Widget, PANELS[panel].load()())
            widget.add_class("panel")
            self.panels[panel] = widget
            self.mount(widget)
            self.post_message(self.Added(panel))
        return self.panels[panel]

    def show_plan(self, plan: NextRun) -> None:
        """Update the panels that edit the plan of the next run, on the screen or not."""
        for widget in self.panels.values():
            if isinstance(widget, PlanPanel):
                widget.show_plan(plan)

    def focus_world(self) -> None:
        """Focus the world if it is shown; the focus of a dialog above the panels stays."""
        self.screen.set_focus(self.world if self.shown("world") else None)

    def ensure(self, *panels: str) -> None:
        """Mount the panels that need data from the start, shown or not."""
        for panel in panels:
            if panel not in self.panels:
                self._panel(panel).display = False

    def on_resize(self, event: events.Resize) -> None:
        """Lay out for the new size."""
        self.lay_out()

    def on_descendant_focus(self, event: events.DescendantFocus) -> None:
        """Mark the panel that has the focus.

        By a class, which changes only when the focus moves to another panel: `:focus-within` would make Textual restyle
        every field of a form at each move from one field to the next.
        """
        self._mark(event.widget)

    def on_descendant_blur(self) -> None:
        """Remove the mark when no panel has the focus."""
        if self.screen.focused is None:
            self._mark(None)

    def _mark(self, focused: Widget | None) -> None:
        around = focused.ancestors_with_self if focused else []
        for panel in self.panels.values():
            panel.set_class(panel in around, "-hears-keys")

    def show(self, snapshot: Snapshot) -> None:
        """Show a moment in every panel on the screen."""
        for panel in self.on_screen():
            if cast(Widget, panel).is_attached:
                panel.show(snapshot)
