"""Message handlers for the panels: code, poses, noise, obstacles, settings."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from textual import events, on

from tuisim.app.action import ActionHost
from tuisim.app.actions import time_travel
from tuisim.app.actions.keys import RUN_KEYS
from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.app.setup.next_run import with_obstacles
from tuisim.app.terminal.input_order import takes_letters
from tuisim.app.terminal.terminal_app import TerminalApp
from tuisim.app.workspace import Workspace
from tuisim.errors import TuisimError

if TYPE_CHECKING:
    from tuisim.app.panels.brick import Brick
    from tuisim.app.panels.chart import Chart
    from tuisim.app.panels.code import Code
    from tuisim.app.panels.debug import Debug
    from tuisim.app.panels.noise import Noise
    from tuisim.app.panels.obstacles import Obstacles
    from tuisim.app.panels.position import Positioning
    from tuisim.app.panels.settings import Settings
    from tuisim.app.panels.world import TimeBar, World

ROOMY_COLUMNS, ROOMY_ROWS = 86, 15
"""A code panel smaller than this grows while the user types, so that lines of 79 characters are visible."""
_LESSON_COLUMNS = 74
"""Columns that are enough while the text of a lesson is beside the code."""


class PanelMessages(ActionHost, TerminalApp):
    """Message handlers of the app for the panels; Textual finds the methods by name."""

    workspace: Workspace

    def situation_changed(self) -> None:
        """Update the footer."""

    def _waits(self, event: events.Event) -> bool:
        """Let the keys of a run wait also for the mat, without which none can start."""
        is_of_run = isinstance(event, events.Key) and event.key in RUN_KEYS and len(self.screen_stack) == 1
        waits = is_of_run and self.workspace.loader.is_preparing
        return super()._waits(event) or (waits and not (self.focused and takes_letters(self.focused)))

    def on_code_typing_changed(self, message: Code.TypingChanged) -> None:
        self.situation_changed()
        area = self.workspace.panel_area
        if not message.typing:
            area.maximize("")
        else:
            columns = _LESSON_COLUMNS if area.shown("lesson") else ROOMY_COLUMNS
            area.make_room("code", columns, ROOMY_ROWS)
        if area.lesson:
            area.lesson.set_typing(message.typing, is_low=area.is_stacked)

    def _end_former_text(self) -> None:
        """End a run of the text before the edit: the user wants the new one to run."""
        controller, code = self.workspace.run_controller, self.workspace.panel_area.code
        if code and code.differs and controller.in_run and not controller.in_past and self.workspace.document.apply():
            controller.close()
            self.workspace.app.run_changed()

    def on_code_edited(self, message: Code.Edited) -> None:
        self.workspace.document.edited(message.text)
        self.workspace.debugger.edited(message.text)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        from tuisim.app.panels.code import ProgramCommand

        match message.command:
            case ProgramCommand.SAVE:
                self.workspace.document.save()
            case ProgramCommand.RUN:
                self._end_former_text()
                self.action_act("run")
                # Make the robot visible, or the place of the error in the text.
                area = self.workspace.panel_area
                if area.alone and not (area.code and area.code.error_line):
                    area.maximize("")
                # In a lesson, the next keys are for the lesson.
                if self.workspace.lesson.step and area.code and not area.code.error_line:
                    area.code.stop_typing()
            case ProgramCommand.NEW | ProgramCommand.OPEN:
                self.action_act(message.command.value)
            case ProgramCommand.NONE:
                self.say("No program to edit: {open} opens one, {new} creates one")
            case _:
                assert_never(message.command)

    def on_descendant_focus(self) -> None:
        """Update the footer: other keys may be available."""
        self.call_later(self.situation_changed)

    def on_descendant_blur(self) -> None:
        self.call_later(self.situation_changed)

    @on(ClosesOnce.Changed)
    def show_keys_of_the_screen(self) -> None:
        """Update the footer: below a dialog that closed another widget has the focus."""
        self.situation_changed()

    def on_world_pose_dragged(self, message: World.PoseDragged) -> None:
        """Move the robot with the mouse; in the past, ask about a branch at the end of the drag."""
        if message.done or not self.workspace.run_controller.in_past:
            self.workspace.run_controller.place(message.pose)

    def on_chart_cursor_moved(self, message: Chart.CursorMoved) -> None:
        time_travel.to_time(self.workspace, message.time_s)

    def on_time_bar_scrubbed(self, message: TimeBar.Scrubbed) -> None:
        time_travel.to_tick(self.workspace, message.tick)

    def on_positioning_applied(self, message: Positioning.Applied) -> None:
        self.workspace.run_controller.place(message.pose)

    def on_settings_edited(self, message: Settings.Edited) -> None:
        """Apply a field of the settings; the field shows an error."""
        try:
            self.workspace.loader.set_next_run(self.workspace.loader.change(message.apply))
        except TuisimError as error:
            message.row.refuse(error)

    def on_obstacles_edited(self, message: Obstacles.Edited) -> None:
        self.workspace.loader.attempt(lambda plan: with_obstacles(plan, message.change(plan.spec.world.obstacles)))

    def on_obstacles_marked(self) -> None:
        self.mark_box()

    def mark_box(self) -> None:
        """Show in the world which obstacle is selected, and whether the mouse draws obstacles."""
        area = self.workspace.panel_area
        on = area.shown("obstacles")
        if area.world:
            area.world.edit_boxes(on, area.obstacles.at if on and area.obstacles else None)

    def on_world_boxes_dragged(self, message: World.BoxesDragged) -> None:
        panel = self.workspace.panel_area.obstacles
        if self.workspace.loader.attempt(lambda plan: with_obstacles(plan, message.obstacles)) and panel:
            panel.mark(message.index)

    def on_code_breakpoint_toggled(self, message: Code.BreakpointToggled) -> None:
        self.workspace.debugger.toggle_line(message.line)

    def on_debug_frame_wanted(self, message: Debug.FrameWanted) -> None:
        self.workspace.debugger.choose_frame(message.by)

    def on_debug_thread_wanted(self) -> None:
        self.workspace.debugger.choose_thread()

    def on_brick_pressed(self, message: Brick.Pressed) -> None:
        runs = self.workspace.run_controller
        if message.buttons <= runs.pressed or (runs.in_run and not runs.in_past):
            runs.press(message.buttons)
        elif runs.in_run:
            self.say("The brick's buttons work only in the present: {now} returns to it")
        else:
            self.say("The brick's buttons work only while a program runs: {run} runs it")

    def on_noise_changed(self, message: Noise.Changed) -> None:
        self.workspace.run_controller.set_noise(message.noise)

    def on_noise_seeded(self, message: Noise.Seeded) -> None:
        self.workspace.run_controller.set_seed(message.seed)
