"""Variables at past instants: a re-run of the recording is paused there, in a process of its own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.base.folders import remove_tree
from tuisim.engine import protocol
from tuisim.engine.protocol import BEFORE_NEXT_TICK, Ended, Inspected, LineHistory, Paused
from tuisim.engine.runs.temporary import create_owned_folder

if TYPE_CHECKING:
    from tuisim.engine.runs.handle import RunHandle
    from tuisim.engine.runs.recorded_run import Recording

FIRST_WINDOW_TICKS = 200
"""Number of ticks before an instant in which previous lines are searched first; the search window grows."""

HISTORY = 400
"""Number of lines to request."""


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """An instant of a run: a tick, and the position among the lines of that tick."""

    tick: int
    ordinal: int = BEFORE_NEXT_TICK
    """The position among the lines of the tick, as in `engine.protocol.Paused`."""

    @property
    def _sort_key(self) -> tuple[int, float]:
        """A key to sort positions by; `BEFORE_NEXT_TICK` comes after every line of the tick."""
        return self.tick, float("inf") if self.ordinal == BEFORE_NEXT_TICK else self.ordinal

    def precedes(self, other: Position) -> bool:
        """Return whether this instant comes before another one."""
        return self._sort_key < other._sort_key


Arrived = Callable[[Paused, Inspected], None]
Failed = Callable[[str], None]
Passed = Callable[[], None]


class ReplayDebugger:
    """A debugger of a recorded run. It runs the program again (the re-run), and pauses at a requested instant.

    To go back, it starts another re-run.

    Args:
        arrived: Called with the position of the pause and the program's state there.
        failed: Called with the reason why the re-run cannot pause at the requested instant.
        passed: Called when the re-run was resumed and reached the end of the program.
    """

    def __init__(self, arrived: Arrived, failed: Failed, passed: Passed) -> None:
        self._arrived = arrived
        self._failed = failed
        self._passed = passed
        self.run: RunHandle | None = None
        """The re-run; None while there is none."""
        self._folder: Path | None = None
        self._of: Recording | None = None
        self._actions = 0
        """Number of user actions that the re-run includes."""
        self._traced_from = -1
        self._paused: Paused | None = None
        self._request = protocol.Inspect()
        self._back = 0
        """How many lines before the paused position the requested line is."""
        self._line = 0
        """Number of the line at whose last start in the tick the re-run pauses; 0 for none."""
        self._next_command: protocol.Message | None = None
        """Command for resuming once it is paused."""
        self._aim: Position | None = None
        self._resumes = False
        self.busy = False
        """Whether an answer is pending."""

    # Requests

    def go(self, recording: Recording, at: Position, look: protocol.Inspect) -> None:
        """Pause the re-run at an instant of a recording, and request the program's state there.

        Args:
            recording: The recording of the run to repeat.
            at: The instant.
            look: The request for the program's state.
        """
        self._line = 0
        self._request = look
        self._back = 0
        self._next_command = None
        self._resumes = False
        self._go(recording, at, -1)

    def go_to_line(
        self, recording: Recording, tick: int, line: int, look: protocol.Inspect
    ) -> None:
        """Pause at the last time in a tick at which a line began.

        If the line did not begin in this tick, pause at the end of the tick.

        Args:
            recording: The recording of the run to repeat.
            tick: The tick.
            line: The line of the program.
            look: The request for the program's state at the pause.
        """
        self._request = look
        self._back = 0
        self._next_command = None
        self._resumes = False
        self._line = line
        self._go(recording, Position(tick), tick)

    def look(self, look: protocol.Inspect) -> None:
        """Send another request for its state to the paused program."""
        self._request = look
        if self.run is not None and self._paused is not None:
            self.busy = True
            self.run.send(look)

    def go_on(
        self, recording: Recording, at: Position, command: protocol.Message, look: protocol.Inspect
    ) -> None:
        """Pause at an instant, then resume with a command, and request the program's state at the next pause.

        Args:
            recording: The recording of the run to repeat.
            at: The instant.
            command: The command that resumes the run, such as a step.
            look: The request for the program's state.
        """
        self._line = 0
        self._request = look
        self._back = 0
        self._resumes = True
        here = self._paused and Position(self._paused.tick, self._paused.ordinal)
        if self.run is not None and self._of is recording and here == at:
            self.busy = True
            self._paused = None
            self.run.send(command)
        else:
            self._next_command = command
            self._go(recording, at, -1)

    def lines_back(
        self, recording: Recording, at: Position, count: int, look: protocol.Inspect
    ) -> None:
        """Pause at the line that the program executed `count` lines before an instant.

        Args:
            recording: The recording of the run to repeat.
            at: The instant.
            count: The number of lines.
            look: The request for the program's state at the pause.
        """
        self._line = 0
        self._request = look
        self._back = count
        self._next_command = None
        self._resumes = False
        self._go(recording, at, max(0, at.tick - FIRST_WINDOW_TICKS))

    # Replay

    def _go(self, recording: Recording, at: Position, traced_from: int) -> None:
        from tuisim.engine.runs.handle import RunOptions, start_run
        from tuisim.engine.runs.store import RunStore

        self.busy = True
        self._aim = at
        actions = recording.actions()
        known = self._of is recording and self._actions == len(actions) and self.run is not None
        if known and self._paused is not None and traced_from < 0:
            here = Position(self._paused.tick, self._paused.ordinal)
            assert self.run is not None
            if here == at:
                # The re-run is already paused at this instant, and `RunToInstant` would run on.
                self.run.send(self._request)
                return
            if here.precedes(at):
                self._paused = None
                self.run.send(protocol.RunToInstant(at.tick, at.ordinal))
                return
        self.close()
        self.busy = True
        self._of, self._actions, self._traced_from, self._aim = (
            recording,
            len(actions),
            traced_from,
            at,
        )
        options = RunOptions(
            time_limit_s=0.0,
            stall_limit_s=0.0,
            answers=recording.answers,
            asks_user=True,
            actions=actions,
            hold_at=(at.tick, at.ordinal),
            trace_from_tick=traced_from if traced_from >= 0 else None,
        )
        try:
            self._folder = create_owned_folder()
            self.run = start_run(
                recording.program, recording.first_spec, options, RunStore(self._folder)
            )
        except (TuisimError, OSError) as error:
            self.busy = False
            self._failed(str(error))

    def poll(self) -> None:
        """Process the events of the re-run that have arrived, without blocking."""
        run = self.run
        if run is None:
            return
        for event in run.pump():
            match event:
                case Paused():
                    self._on_paused(event)
                case LineHistory():
                    self._choose_line(event)
                case Inspected() if self._paused is not None:
                    self.busy = False
                    self._arrived(self._paused, event)
                case Ended():
                    self.close()
                    if self._resumes:
                        self._passed()
                    else:
                        self._failed("The program has ended before that")
                    return

    def _on_paused(self, paused: Paused) -> None:
        assert self.run is not None
        if self._next_command is not None:
            command = self._next_command
            self._next_command = None
            self.run.send(command)
            return
        self._paused = paused
        is_searched = self._back or self._line
        self.run.send(protocol.RequestHistory(HISTORY) if is_searched else self._request)

    def _choose_line(self, history: LineHistory) -> None:
        """Go to the requested line in a history of executed lines.

        If the history is too short, request a longer one.
        """
        assert self._of is not None and self._aim is not None
        aim = self._aim
        if self._line:
            met = [
                line for line in history.lines if (line.tick, line.line) == (aim.tick, self._line)
            ]
            self._line = 0
            if met:
                self._go(self._of, Position(aim.tick, met[-1].ordinal), aim.tick)
            else:
                assert self.run is not None
                self.run.send(self._request)
            return
        lines = [Position(met.tick, met.ordinal) for met in history.lines]
        before = [place for place in lines if place.precedes(aim)]
        if len(before) >= self._back:
            position = before[-self._back]
        elif self._traced_from > 0 and len(lines) < HISTORY:
            farther = max(0, aim.tick - 8 * (aim.tick - self._traced_from))
            self._go(self._of, aim, farther)
            return
        elif before:
            position = before[0]
        else:
            self._back = 0
            assert self.run is not None
            self.run.send(self._request)
            self._failed("This is the first line of the run")
            return
        self._back = 0
        # Lines are counted from the tick at which tracing begins: from the same tick on, the line has the same number.
        self._go(self._of, position, position.tick)

    def close(self) -> None:
        """End the process of the re-run, and delete its files."""
        if self.run is not None:
            self.run.kill()
            self.run.close()
        if self._folder is not None:
            remove_tree(self._folder)
        self.run = self._folder = self._paused = self._of = None
        self.busy = False
