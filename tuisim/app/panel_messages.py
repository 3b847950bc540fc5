"""What the panels ask of the app: the robot somewhere else, other noise, obstacles, settings."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from textual.widget import Widget

from tuisim.app.actions import time_travel
from tuisim.app.code_messages import CodeMessages
from tuisim.app.setup.next_run import with_obstacles
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.app import LabApp
    from tuisim.app.debugger import AppDebugger
    from tuisim.app.loader import Loader
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.panels.brick import Brick
    from tuisim.app.panels.chart import Chart
    from tuisim.app.panels.code import Code
    from tuisim.app.panels.debug import Debug
    from tuisim.app.panels.noise import Noise
    from tuisim.app.panels.obstacles import Obstacles
    from tuisim.app.panels.position import Positioning
    from tuisim.app.panels.settings import Settings
    from tuisim.app.panels.time_bar import TimeBar
    from tuisim.app.panels.world import World
    from tuisim.app.run_controller import RunController


class PanelMessages(CodeMessages):
    """The part of the app that answers messages of panels; Textual finds the methods by their names."""

    bridge: RunController
    debugging: AppDebugger
    desk: PanelArea
    loading: Loader

    def on_descendant_focus(self) -> None:
        """Other keys may work now."""
        self.call_later(cast("LabApp", self).situation_changed)

    def on_descendant_blur(self) -> None:
        """Other keys may work now."""
        self.call_later(cast("LabApp", self).situation_changed)

    def on_world_pose_dragged(self, message: World.PoseDragged) -> None:
        """The robot was dragged with the mouse; in the past it is asked only at the end what is to come of that."""
        if message.done or not self.bridge.in_past:
            self.bridge.place(message.pose)

    def on_chart_cursor_moved(self, message: Chart.CursorMoved) -> None:
        """Look at the time that the chart's cursor is at."""
        time_travel.to_time(cast("LabApp", self), message.time_s)

    def on_time_bar_scrubbed(self, message: TimeBar.Scrubbed) -> None:
        """Look at the instant that the mouse has chosen."""
        time_travel.to_tick(cast("LabApp", self), message.tick)

    def on_positioning_applied(self, message: Positioning.Applied) -> None:
        """A pose was typed in."""
        self.bridge.place(message.pose)

    def attend(self, panel: str) -> None:
        """Give the focus to a panel that has been opened, as far as it hears keys; to the world if it was closed."""
        widget = self.desk.panels.get(panel)
        if not self.desk.shown(panel) or widget is None:
            self.desk.focus_world()
        elif not widget.is_mounted:
            # It is still being built.
            widget.call_later(self.attend, panel)
        elif hasattr(widget, "begin"):
            widget.begin()
        else:
            inside = (child for child in widget.walk_children(Widget, with_self=True) if child.focusable)
            if first := next(inside, None):
                first.focus()

    def on_settings_edited(self, message: Settings.Edited) -> None:
        """A field of the settings was entered: what is wrong with it is said there."""
        try:
            self.loading.take(self.loading.change(lambda plan: message.edit.write(plan, message.text)))
        except TuisimError as error:
            message.row.refuse(error)

    def on_obstacles_edited(self, message: Obstacles.Edited) -> None:
        """Obstacles were typed, added or removed."""
        self.loading.attempt(lambda plan: with_obstacles(plan, message.obstacles))

    def on_obstacles_marked(self) -> None:
        """Another obstacle is at hand."""
        self.mark_box()

    def mark_box(self) -> None:
        """Show in the world which obstacle is at hand, and whether the mouse draws any."""
        on = self.desk.shown("obstacles")
        if world := self.desk.world:
            world.edit_boxes(on, self.desk.obstacles.at if on and self.desk.obstacles else None)

    def on_world_boxes_dragged(self, message: World.BoxesDragged) -> None:
        """An obstacle was drawn or moved with the mouse."""
        if self.loading.attempt(lambda plan: with_obstacles(plan, message.obstacles)) and self.desk.obstacles:
            self.desk.obstacles.mark(message.index)

    def on_code_breakpoint_toggled(self, message: Code.BreakpointToggled) -> None:
        """The gutter of the code was clicked on."""
        self.debugging.toggle_line(message.line)

    def on_debug_frame_wanted(self, message: Debug.FrameWanted) -> None:
        """Another call is to be looked at."""
        self.debugging.choose_frame(message.by)

    def on_debug_thread_wanted(self) -> None:
        """Another thread is to be looked at."""
        self.debugging.choose_thread()

    def on_brick_pressed(self, message: Brick.Pressed) -> None:
        """The user presses the brick's buttons, or lets them go."""
        if message.buttons <= self.bridge.pressed or (self.bridge.in_run and not self.bridge.in_past):
            self.bridge.press(message.buttons)
        elif self.bridge.in_run:
            self.notify("The brick's buttons work now, not in the past: end comes back", timeout=3)
        else:
            self.notify("The brick's buttons work while a program runs: R runs it", timeout=3)

    def on_noise_changed(self, message: Noise.Changed) -> None:
        """Noise was set."""
        self.bridge.set_noise(message.noise)

    def on_noise_seeded(self, message: Noise.Seeded) -> None:
        """The seed of the next run was set."""
        self.bridge.set_seed(message.seed)
