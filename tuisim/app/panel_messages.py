"""Message handlers for the panels: code, poses, noise, obstacles, settings."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, assert_never

from textual import events, on

from tuisim.app.actions import ActionContext, time_travel
from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.app.host import LabHost
from tuisim.app.layout.arrangement import EDITOR_COLS
from tuisim.app.layout.forms import DISCS_COLS
from tuisim.app.panel_area import PanelArea
from tuisim.app.setup.next_run import change_obstacles
from tuisim.base.errors import TuisimError

if TYPE_CHECKING:
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

ROOMY_ROWS = 15
"""A code panel with fewer rows, or too narrow for lines of 79 characters, becomes larger while the user types."""
_HIGH_ROWS = 35
"""The same number of rows in an area that is wide enough for the world beside lines of 79 characters."""
_LESSON_COLUMNS = 74
"""Columns that a code panel needs while the user types and the text of a lesson is shown."""


_BUTTONS = re.compile(
    r"^[^#\n]*(\bev3dev2(\.|\s+import\s.*\b)button\b|\.buttons(\.pressed)?\()", re.MULTILINE
)
"""An import of ev3dev2's buttons, or a look at those of Pybricks' brick."""


def has_button_calls(program: str) -> bool:
    """Return whether the text of a program contains calls for the brick's buttons."""
    return bool(_BUTTONS.search(program))


def _find_typing_room(area: PanelArea) -> tuple[int, int]:
    """Return the columns and rows that the code panel should have while the user types in it."""
    if area.is_shown("lesson"):
        return _LESSON_COLUMNS, ROOMY_ROWS
    is_wide = area.is_shown("world") and area.size.width >= EDITOR_COLS + DISCS_COLS
    return EDITOR_COLS, _HIGH_ROWS if is_wide else ROOMY_ROWS


class PanelMessages(LabHost):
    """Base class of the app with the methods that handle messages of the panels; Textual finds the methods by name."""

    context: ActionContext
    has_hinted = False
    """Whether a notice has told the user about the panel of the brick."""

    def suggest_brick(self, does: str) -> None:
        """If the panel of the brick is hidden, name its key in a notice, once in a session.

        Args:
            does: What the program does with the brick, such as `reads the brick's buttons`.
        """
        if not self.has_hinted and not self.context.panels.is_shown("brick"):
            self.say(f"The program {does}: {{panel-brick}} opens its panel")
        self.has_hinted = True

    def on_panel_area_rearranged(self) -> None:
        """Send the shown panels to the web page, whose buttons show them."""
        self.context.app.tell_server("panels", shown=[*self.context.panels.arrangement.boxes])

    def on_code_typing_changed(self, message: Code.TypingChanged) -> None:
        self.handle_situation_change()
        area = self.context.panels
        if not message.typing:
            area.maximize("")
            if code := area.code:
                # The panel must have its new size before it can scroll to the cursor.
                code.call_after_refresh(code.show_cursor)
        else:
            area.make_room("code", *_find_typing_room(area))
        if area.lesson:
            area.lesson.set_typing(message.typing, is_low=area.is_stacked)

    def on_click(self, event: events.Click) -> None:
        area = self.context.panels
        owner = area.find_owner(event.widget)
        if owner != area.find_focused_panel() and self.screen is area.screen:
            # A click does not return from the past, because a drag along the time bar ends with one, too.
            area.focus_world()
            area.clicked = owner

    def on_code_area_letters_changed(self) -> None:
        self.handle_situation_change()

    def _end_former_text(self) -> None:
        """If the live run executes the text from before an edit, end the run, so that the edited text can run."""
        controller = self.context.runs
        code = self.context.panels.code
        if (
            code
            and code.differs
            and controller.in_run
            and not controller.in_past
            and self.context.document.apply()
        ):
            controller.close()
            self.context.app.run_changed()

    def on_code_edited(self, message: Code.Edited) -> None:
        self.context.document.handle_edit(message.text)
        self.context.debugger.follow_edit(message.text)

    def on_code_wanted(self, message: Code.Wanted) -> None:
        from tuisim.app.panels.code import ProgramCommand

        match message.command:
            case ProgramCommand.SAVE:
                self.context.document.save()
            case ProgramCommand.RUN:
                self._end_former_text()
                self.action_act("run")
                # Show the other panels again, so that the robot is visible, unless the code shows an error.
                area = self.context.panels
                if area.alone and not (area.code and area.code.error_line):
                    area.maximize("")
                # The next keys are for the run, or for the mistake that prevents it.
                if area.code and (self.context.runs.in_run or self.context.loader.is_preparing):
                    area.code.stop_typing()
            case ProgramCommand.NEW | ProgramCommand.OPEN:
                self.action_act(message.command.value)
            case ProgramCommand.NONE:
                self.say("No program to edit: {open} opens one, {new} creates one")
            case _:
                assert_never(message.command)

    def on_descendant_focus(self) -> None:
        """Update the footer after the focus has moved, because other keys may be available."""
        self.call_later(self.handle_situation_change)

    def on_descendant_blur(self) -> None:
        self.call_later(self.handle_situation_change)

    @on(ClosesOnce.Changed)
    def show_keys_of_the_screen(self) -> None:
        """Update the footer after a dialog was opened or closed, because another widget has the focus."""
        self.handle_situation_change()

    def on_world_pose_dragged(self, message: World.PoseDragged) -> None:
        """Move the robot to where it is dragged.

        If a past instant is in view, ask at the end of the drag whether to start a branch there.
        """
        if message.done or not self.context.debugger.is_away:
            self.context.runs.place(message.pose)

    def on_chart_cursor_moved(self, message: Chart.CursorMoved) -> None:
        time_travel.go_to_time(self.context, message.time_s, message.sample)

    def on_time_bar_scrubbed(self, message: TimeBar.Scrubbed) -> None:
        time_travel.go_to_tick(self.context, message.tick)

    def on_positioning_applied(self, message: Positioning.Applied) -> None:
        self.context.runs.place(message.pose)

    def on_settings_edited(self, message: Settings.Edited) -> None:
        """Apply the value of a field in the settings panel; if it is invalid, show the error below the field."""
        try:
            self.context.loader.set_next_run(self.context.loader.change(message.apply))
        except TuisimError as error:
            message.row.refuse(error)

    def on_obstacles_edited(self, message: Obstacles.Edited) -> None:
        self.context.loader.try_change(
            lambda plan: change_obstacles(plan, message.change(plan.spec.world.obstacles))
        )

    def on_obstacles_marked(self) -> None:
        self.mark_box()

    def mark_box(self) -> None:
        """Mark the selected obstacle in the world panel, and set whether the mouse edits obstacles in that panel."""
        area = self.context.panels
        on = area.is_shown("obstacles")
        if area.world:
            area.world.edit_boxes(on, area.obstacles.at if on and area.obstacles else None)

    def on_world_boxes_dragged(self, message: World.BoxesDragged) -> None:
        panel = self.context.panels.obstacles
        if (
            self.context.loader.try_change(lambda plan: change_obstacles(plan, message.obstacles))
            and panel
        ):
            panel.mark(message.index)

    def on_code_breakpoint_toggled(self, message: Code.BreakpointToggled) -> None:
        self.context.debugger.toggle_line(message.line)

    def on_debug_frame_wanted(self, message: Debug.FrameWanted) -> None:
        self.context.debugger.choose_frame(message.by)

    def on_debug_thread_wanted(self) -> None:
        self.context.debugger.choose_thread()

    def on_brick_pressed(self, message: Brick.Pressed) -> None:
        runs = self.context.runs
        if message.buttons <= runs.pressed or (runs.in_run and not self.context.debugger.is_away):
            runs.press(message.buttons)
        elif runs.in_run:
            self.say("The brick's buttons work only in the present: {now} returns to it")
        else:
            self.say("The brick's buttons work only while a program runs: {run} runs it")

    def on_noise_changed(self, message: Noise.Changed) -> None:
        self.context.runs.set_noise(message.noise)

    def on_noise_seeded(self, message: Noise.Seeded) -> None:
        self.context.runs.set_seed(message.seed)
