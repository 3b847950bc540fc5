"""The app's side of debugging: breakpoints, watches, and where the program is paused, now or in the past."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.app.kept_breaks import (
    StoredBreaks,
    break_lines,
    choose_sign,
    follow_edit,
    keep,
    load_kept,
)
from tuisim.app.snapshot import PauseView
from tuisim.base.errors import TuisimError, counted
from tuisim.base.source import find_code_line, source_lines
from tuisim.engine import protocol
from tuisim.engine.breakpoints import Breakpoint
from tuisim.engine.core.profile import compute_due_ns
from tuisim.engine.protocol import Inspected, Message, Paused, PauseReason
from tuisim.engine.runs.replay_debugger import Position, ReplayDebugger

if TYPE_CHECKING:
    from tuisim.app.editor.text_lines import LineMap
    from tuisim.app.host import LabHost
    from tuisim.app.panel_area import PanelArea
    from tuisim.app.run_controller import RunController
    from tuisim.base.source import Program

SHOWS_PANELS = frozenset({PauseReason.STEP, PauseReason.LINE, PauseReason.BREAK})
"""Pause reasons that open the debug panels automatically."""

_GOES_ON = frozenset({PauseReason.STEP, PauseReason.LINE, PauseReason.INSTANT})
"""Pause reasons after which the next of the waiting steps begins; any other reason discards the waiting steps."""


class DebugController:
    """The debugger of the app: breakpoints, watches, steps by lines, and the variables at the instant in view.

    Args:
        app: Shows notices, and starts the program.
        run_controller: Gets debug commands.
        panel_area: Has the code and debug panels.
        lines: Returns the map between the lines of the current run and the lines of the edited text.
    """

    def __init__(
        self,
        app: LabHost,
        run_controller: RunController,
        panel_area: PanelArea,
        lines: Callable[[], LineMap],
    ) -> None:
        self._app = app
        self._run_controller = run_controller
        self._panel_area = panel_area
        self._lines = lines
        self.breaks: tuple[Breakpoint, ...] = ()
        self.watches: tuple[str, ...] = ()
        self.view: PauseView | None = None
        """The pause that is shown; None while the program runs, or before it is first paused."""
        self._program = ""
        self._text = ""
        self._paused: Paused | None = None
        """The pause of the live run; None while it runs."""
        self.position: Position | None = None
        """The past position in view, exact to the line; None if the newest is in view, or if only the tick is known."""
        self._frame = 0
        self._thread = ""
        self.replay = ReplayDebugger(self._handle_arrival, self._report_missing, self._handle_now)
        self._wanted: Position | None = None
        """The position that was last requested from the debugger of re-runs; None for none."""
        self._seeks_raise = False
        """Whether the debugger of re-runs is on its way to the line that raised, at the end of the run."""
        self._is_stepping = False
        """Whether a step of the live run has been sent and has not ended yet."""
        self._steps: deque[Message | int] = deque()
        """Steps that wait for the end of an earlier step; a number stands for that many lines back into the past."""
        self._panels_opened = False
        self._breakpoints_unsent = False
        """Whether the live run lacks the breakpoints; it gets them at its first message, a branch at its instant."""

    # The following methods set breakpoints and watches.

    @property
    def texts(self) -> tuple[str, ...]:
        """The breakpoints as texts, in the form in which they are sent to the run."""
        return tuple(entry.written() for entry in self.breaks)

    @property
    def lines(self) -> list[str]:
        """The lines of the edited program text."""
        return source_lines(self._text)

    def load_breaks(self, program: Program | None) -> None:
        """Load the stored breakpoints and watches of another program, and mark the breakpoints in the shown text."""
        key = program.file if program else ""
        if key != self._program:
            self._program = key
            stored = load_kept(key) if key else StoredBreaks()
            self.breaks = stored.breaks
            self.watches = stored.watches
        self._text = program.text if program else ""
        self.mark()

    def follow_edit(self, text: str) -> None:
        """Move the breakpoints along with their lines after an edit of the text."""
        breaks = follow_edit(self.breaks, self._text, text)
        self._text = text
        if breaks != self.breaks:
            self.set_breaks(breaks)

    def set_breaks(self, breaks: tuple[Breakpoint, ...]) -> None:
        """Set new breakpoints in place of the present ones, also in the live run, and store them."""
        self.breaks = breaks
        self._send_breakpoints()
        self._keep()
        self.mark()

    def _send_breakpoints(self) -> None:
        """Send the breakpoints to the live run.

        The run may execute an older text than the edited one. A breakpoint on a line is then sent with the number that
        the line has in the older text. It is not sent if that text lacks the line.
        """
        lines = self._lines()
        texts = []
        for entry in self.breaks:
            shown_line = entry.find_line()
            runs = lines.find_run_line(shown_line)
            if runs or not shown_line:
                texts.append(entry.move(runs).written())
        self._run_controller.send(protocol.SetBreaks(tuple(texts)))

    def set_watches(self, watches: tuple[str, ...]) -> None:
        """Set new watched expressions in place of the present ones, and store them."""
        self.watches = watches
        self._keep()
        self._inspect_again()

    def _keep(self) -> None:
        if self._program:
            try:
                keep(self._program, StoredBreaks(self.breaks, self.watches))
            except TuisimError as error:
                self._app.complain(error)

    def mark(self) -> None:
        """Mark the breakpoints in the code panel."""
        if code := self._panel_area.code:
            marks = {line: choose_sign(entry) for line, entry in break_lines(self.breaks).items()}
            code.set_marks(marks, self._count_words)

    @property
    def _count_words(self) -> str:
        """Return the number of active breakpoints in words, with the key that lists them.

        The text is empty if all active breakpoints are on lines, because the code panel marks those.
        """
        active = [entry for entry in self.breaks if not entry.disabled]
        if all(entry.find_line() for entry in active):
            return ""
        return self._app.fill_keys(f"{counted(len(active), 'breakpoint')}: {{breaks}}")

    def toggle_line(self, line: int, which: str = "") -> None:
        """Set a breakpoint on a line, remove it, or enable it if it is disabled; say so in a notice.

        If the line has no code, use the next line of code.

        Args:
            line: The line of the edited text, from 1.
            which: In words, which line this is, for the notice.
        """
        code_line = line if line in break_lines(self.breaks) else find_code_line(self.lines, line)
        if not code_line:
            self._app.say(f"No breakpoint: there is no code from line {line} on")
            return
        which = which if code_line == line else f"the next line of code after line {line}"
        name = f"line {code_line}, {which}" if which else f"line {code_line}"
        there = break_lines(self.breaks).get(code_line)
        if there is None:
            self.set_breaks((*self.breaks, Breakpoint.parse(str(code_line))))
            self._app.say(f"Breakpoint on {name}")
        elif there.disabled:
            self.set_breaks(
                tuple(
                    replace(entry, disabled=False) if entry is there else entry
                    for entry in self.breaks
                )
            )
            self._app.say(f"Breakpoint enabled on {name}")
        else:
            self.set_breaks(tuple(entry for entry in self.breaks if entry is not there))
            self._app.say(f"Breakpoint removed from {name}")

    @property
    def current_line(self) -> int:
        """The line of the edited text that is shown as current; 0 if there is none."""
        snapshot = self._run_controller.build_snapshot()
        return (
            self._lines().find_shown_line(snapshot.line)
            if self._run_controller.in_run or snapshot.past
            else 0
        )

    # The following methods handle messages of the run.

    def run_changed(self) -> None:
        """Reset the debugger after the app has switched to another run, or to none."""
        self._app.notices.release()
        runs = self._run_controller
        self._paused = self.position = self._wanted = self.view = None
        runs.shown_pause = runs.chosen_line = None
        self._frame = 0
        self._thread = ""
        self._seeks_raise = self._panels_opened = False
        self._breakpoints_unsent = bool(self.breaks)
        self._forget_steps()
        if runs.in_run and self._count_words and not self._panel_area.is_shown("code"):
            self._app.say(self._count_words)
        self.replay.close()
        self.show()

    def handle_end(self) -> None:
        """Handle the end of the run: show no pause any more, unless a past instant is in view."""
        self._paused = None
        if not self.is_away:
            self._forget_steps()
            self.view = self._run_controller.shown_pause = None
            self.show()

    def handle(self, event: Message) -> None:
        """Handle a message of the run: it has paused or resumed, or sends its frames and variables."""
        if self._breakpoints_unsent:
            self._breakpoints_unsent = False
            self._send_breakpoints()
        match event:
            case Paused():
                self._handle_pause(event)
            case protocol.Resumed():
                self._paused = None
                if not self._run_controller.in_past:
                    self.position = self.view = None
                    self.show()
            case Inspected() if self._paused is not None and not self.looks_back:
                self._set_paused(PauseView(self._paused, event, False))

    def _handle_pause(self, paused: Paused) -> None:
        paused = self._set_tick_time(paused)
        self._paused = paused
        self.position = None
        self._frame = 0
        self._thread = ""
        self._is_stepping = False
        # While the past is viewed, steps wait for an instant of it, not for this pause of the live run.
        if not self.is_away:
            if self._steps and paused.reason in _GOES_ON:
                self._take_step()
                return
            self._steps.clear()
        if paused.reason in SHOWS_PANELS:
            self._open_panels()
        if paused.reason is PauseReason.BREAK:
            met = f": {paused.value}" if paused.value else ""
            self._app.say(f"Break {paused.detail}{met} at {paused.time_ns / 1e9:.2f} s")
        self._inspect_again()

    def _set_tick_time(self, paused: Paused) -> Paused:
        """Return a pause with the time of its tick, which every panel shows.

        The program's own time at the pause is somewhat later.
        """
        hz = self._run_controller.timeline.tick_hz
        return replace(paused, time_ns=compute_due_ns(paused.tick, hz))

    def _open_panels(self) -> None:
        if self._panels_opened:
            return
        self._panels_opened = True
        for panel in ("code", "debug"):
            self._panel_area.open(panel)
        # The user now reads the code, so it gets the arrow keys; a field in which the user types keeps them.
        if self._panel_area.find_focused_panel() in ("", "world"):
            self._app.call_after_refresh(self._panel_area.focus_opened, "code")

    # The following methods choose the instant in view, and show its variables.

    @property
    def looks_back(self) -> bool:
        """Whether an instant before the newest one is in view.

        This can also be a line of the program in the newest tick, before the last line that has run.
        """
        return self.position is not None or self._run_controller.timeline.at is not None

    @property
    def busy(self) -> bool:
        """Whether the variables at a past instant are still being computed."""
        return self.replay.busy

    @property
    def is_away(self) -> bool:
        """Whether a past instant is in view, or is being computed to be shown next."""
        return self.looks_back or self.busy

    @property
    def inspect_request(self) -> protocol.Inspect:
        """Return the message that requests the frames and variables of a paused program."""
        return protocol.Inspect(self.watches, self._thread, self._frame)

    def choose_frame(self, by: int) -> None:
        """Show the variables of another frame of the call stack.

        Args:
            by: How many frames to go: positive towards the callers, negative towards the called functions. The choice
                stops at the first and the last frame.
        """
        if self.view:
            self._frame = min(max(0, self._frame + by), max(0, len(self.view.inspected.stack) - 1))
            self._inspect_again()

    def choose_thread(self) -> None:
        """Show the variables of the next thread of the program; after the last thread comes the first."""
        if self.view and (threads := self.view.inspected.threads):
            names = [thread.name for thread in threads]
            index = (
                names.index(self.view.inspected.thread)
                if self.view.inspected.thread in names
                else -1
            )
            self._thread = names[(index + 1) % len(names)]
            self._frame = 0
            self._inspect_again()

    def _inspect_again(self) -> None:
        if self.looks_back:
            self.replay.look(self.inspect_request)
        elif self._paused is not None:
            self._run_controller.send(self.inspect_request)

    def poll(self) -> None:
        """Keep the variables of the past instant in view up to date; to be called regularly.

        To find past variables, the program runs again in another process. This method handles what that process has
        sent, and requests the variables of another instant if the view has moved.
        """
        self.replay.poll()
        timeline = self._run_controller.timeline
        if self.position and timeline.at not in (None, self.position.tick):
            self.position = None
        chosen = self._run_controller.chosen_line
        if chosen and chosen[0] != timeline.tick:
            self._run_controller.chosen_line = None
        if not self.looks_back:
            if self.view and self.view.past and not self.busy:
                self._return_to_now()
            return
        if timeline.at is not None and not self.position and self._has_past_variables():
            self._follow(Position(timeline.at))

    def _has_past_variables(self) -> bool:
        """Return whether to run the program again, to find the variables at the past instant in view.

        The debug panel needs these values. If only the code panel is shown, the program runs again only for a run of
        this session: the program of a stored run may be somebody else's.
        """
        run = self._run_controller.run
        recording = self._run_controller.timeline.recording
        is_own = run is not None and recording is not None and run.run_id == recording.run_id
        return self._panel_area.is_shown("debug") or (is_own and self._panel_area.is_shown("code"))

    def choose_line(self, tick: int, line: int) -> None:
        """Choose the line to show at a tick, such as the line that printed a sample.

        The line stays highlighted until another tick, or another line of the same tick, comes into view.

        Args:
            tick: The tick.
            line: The line in the text of the run, from 1; 0 for no line.
        """
        self._run_controller.chosen_line = (tick, line) if line else None
        self.position = self._wanted = None

    def show_raised(self, line: int) -> None:
        """Show the variables at the error with which the run ended: the program runs again up to the line of the error.

        Args:
            line: The line of the error in the text of the run, from 1; for 0, do nothing.
        """
        recording = self._run_controller.timeline.recording
        if recording is not None and line and self._has_past_variables():
            self._seeks_raise = True
            self.replay.go_to_line(recording, recording.newest, line, self.inspect_request)
            self.show()

    def go_to_now(self) -> None:
        """Return from the past to the newest instant; drop steps and variables that are still being computed."""
        self.position = None
        self._steps.clear()
        if self.replay.busy:
            # The result that is still being computed is not needed any more.
            self.replay.close()
            self._wanted = None
            self.show()

    def _return_to_now(self) -> None:
        self.view = self._run_controller.shown_pause = None
        self._wanted = None
        self.show()
        self._inspect_again()

    def _follow(self, position: Position) -> None:
        timeline = self._run_controller.timeline
        if (
            timeline.recording is None
            or timeline.playing
            or self.replay.busy
            or position == self._wanted
        ):
            return
        self._wanted = position
        chosen = self._run_controller.chosen_line
        if chosen and chosen[0] == position.tick and position == Position(position.tick):
            self.replay.go_to_line(timeline.recording, *chosen, self.inspect_request)
        else:
            self.replay.go(timeline.recording, position, self.inspect_request)
        self.show()

    def _handle_arrival(self, paused: Paused, inspected: Inspected) -> None:
        timeline = self._run_controller.timeline
        here = Position(paused.tick, paused.ordinal)
        if self._seeks_raise:
            self._seeks_raise = False
            if timeline.at is None:
                self._set_paused(PauseView(self._set_tick_time(paused), inspected, False))
                self._take_step()
            return
        if self._wanted is None:
            if not self._is_past(here):
                self._handle_now()
                return
            self.position = here
            timeline.go(paused.tick)
        elif timeline.at != self._wanted.tick:
            # The user has gone to another instant meanwhile, so this result is outdated.
            self._wanted = None
            return
        elif here.ordinal != protocol.BEFORE_NEXT_TICK:
            # The replay has arrived at the chosen line.
            self.position = here
        chosen = self._run_controller.chosen_line
        if chosen != (paused.tick, paused.line):
            record = timeline.record()
            if record and chosen == (paused.tick, record.line):
                # The program has gone on to another line within this tick, and may wait there.
                paused = replace(paused, line=record.line, file="")
                inspected = replace(inspected, waiting="")
            else:
                self._run_controller.chosen_line = None
        self._set_paused(PauseView(self._set_tick_time(paused), inspected, True))
        self._take_step()

    def _is_past(self, at: Position) -> bool:
        """Return whether a position is before the newest position of the run.

        This may be false: to find past variables, the program runs again, and may go further than the paused run has
        gone.
        """
        now = self._paused
        if now is None or not now.is_counted:
            return at.tick <= (self._run_controller.timeline.newest if now is None else now.tick)
        return at.precedes(Position(now.tick, now.ordinal))

    def _handle_now(self) -> None:
        steps = tuple(self._steps)
        self._app.go_to_now()
        self._return_to_now()
        if self._paused is not None:
            self._steps.extend(steps)
            self._take_step()

    def _report_missing(self, why: str) -> None:
        self._wanted = None
        self._steps.clear()
        self._app.say(why)
        self.show()

    def _set_paused(self, view: PauseView) -> None:
        self.view = self._run_controller.shown_pause = view
        if not view.past:
            self._run_controller.chosen_line = None
        self.show()
        self._app.draw(force=True)

    def show(self) -> None:
        """Update the debug panel, and the values of variables in the code panel."""
        if code := self._panel_area.code:
            code.show_pause(self.view)
        if panel := self._panel_area.debug:
            panel.show_pause(self.view, self.busy)

    # The following methods take steps, forwards and back.

    def _find_position(self) -> Position | None:
        """Return the position in the run that is in view; None before the first tick.

        A position is a tick and an executed line in it; if the line is not known, the position has only the tick.
        """
        timeline = self._run_controller.timeline
        if self.position:
            return self.position
        if timeline.at is not None:
            return Position(timeline.at)
        if self._paused is not None and self._paused.is_counted:
            return Position(self._paused.tick, self._paused.ordinal)
        return Position(timeline.newest) if timeline.recording and timeline.newest >= 0 else None

    def step(self, how: protocol.LineStep) -> None:
        """Take a step: to another recorded line if the past is in view, else in the live program.

        Args:
            how: Whether to step into calls, over them, or out of the function.
        """
        self.go_on(protocol.StepLine(how))

    def run_to(self, line: int) -> None:
        """Continue until the program is about to execute a line of the edited text."""
        run_controller = self._run_controller
        runs = self._lines().find_run_line(line) if run_controller.in_run or self.is_away else line
        if runs:
            self.go_on(protocol.RunToLine(runs))
        else:
            self._app.say("This line is not in the running text")

    def go_on(self, command: Message) -> None:
        """Send a command that continues the program until it pauses again.

        The command waits until an earlier step has ended. Without a run, the program is started first. If a past
        instant is in view, go to a recorded line instead.
        """
        if self.is_away:
            self._step_past(command)
        elif self._run_controller.in_run and self._is_stepping:
            self._steps.append(command)
        elif self._run_controller.in_run:
            self._send_step(command)
        elif self._app.start_run(paused=True):
            self._is_stepping = True
            # A program that is started for a step pauses at its first line anyway.
            if not isinstance(command, protocol.StepLine):
                self._steps.append(command)
            self._open_panels()

    def _send_step(self, command: Message) -> None:
        self._is_stepping = isinstance(command, protocol.StepLine)
        self._run_controller.send(command)

    def _forget_steps(self) -> None:
        self._is_stepping = False
        self._steps.clear()

    def _step_past(self, command: Message) -> None:
        timeline = self._run_controller.timeline
        if timeline.recording is None:
            return
        if self.replay.busy:
            self._steps.append(command)
            return
        self._open_panels()
        here = self._find_position()
        assert here is not None
        self.position = self._wanted = self._run_controller.chosen_line = None
        self.replay.go_on(timeline.recording, here, command, self.inspect_request)
        self.show()

    def step_back(self) -> None:
        """Go back by one executed line; if an earlier step is still being computed, do so after that step."""
        if not self.replay.busy:
            self._forget_steps()
            self._go_back(1)
        elif self._steps and isinstance(self._steps[-1], int):
            self._steps[-1] += 1
        else:
            self._steps.append(1)

    def _take_step(self) -> None:
        """Take the next of the steps that wait for an earlier step, if there is one."""
        match self._steps.popleft() if self._steps else None:
            case int(count):
                self._go_back(count)
            case Message() as command:
                self.go_on(command)

    def _go_back(self, count: int) -> None:
        here = self._find_position()
        recording = self._run_controller.timeline.recording
        if here is None or recording is None:
            self._app.say("No run yet: {run} runs the program")
            return
        self._run_controller.pause()
        self._open_panels()
        self.position = self._wanted = self._run_controller.chosen_line = None
        self.replay.lines_back(recording, here, count, self.inspect_request)
        self.show()

    def close(self) -> None:
        """Stop the process in which programs run again, so that their past variables can be shown."""
        self.replay.close()
