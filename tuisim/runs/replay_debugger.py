"""Former instants with their variables: a re-run of the recording that is held there, in a process of its own."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.errors import TuisimError
from tuisim.protocol import BEFORE_NEXT_TICK, Ended, Inspected, LineHistory, Paused, ScriptedAction

if TYPE_CHECKING:
    from tuisim.runs.handle import RunHandle
    from tuisim.runs.recording import Recording
    from tuisim.runs.store import RunStore

FIRST_WINDOW_TICKS = 200
"""The lines before an instant are looked for in so many ticks before it, then in ever more."""

HISTORY = 400
"""Lines that are asked for."""


@dataclass(frozen=True, slots=True, order=True)
class Position:
    """An instant of a run, to the line."""

    tick: int
    ordinal: int = BEFORE_NEXT_TICK
    """As in `protocol.Paused`."""

    @property
    def _place(self) -> tuple[int, float]:
        """Comparable: before the next tick is after every line of this one."""
        return self.tick, float("inf") if self.ordinal == BEFORE_NEXT_TICK else self.ordinal

    def is_before(self, other: Position) -> bool:
        """Whether this instant comes before another one."""
        return self._place < other._place


Arrived = Callable[[Paused, Inspected], None]
Failed = Callable[[str], None]
Passed = Callable[[], None]


class ReplayDebugger:
    """A re-run that stands where somebody looks; it goes forward by itself, and is started anew to go back.

    Args:
        arrived: Told where it stands and what the program looks like there.
        failed: Told why it cannot stand there.
        passed: Told that it went on and met the end of the program.
    """

    def __init__(self, arrived: Arrived, failed: Failed, passed: Passed) -> None:
        self._arrived, self._failed, self._passed = arrived, failed, passed
        self._run: RunHandle | None = None
        self._folder: Path | None = None
        self._of: Recording | None = None
        self._actions = 0
        """How many user actions the re-run knows."""
        self._traced_from = -1
        self._paused: Paused | None = None
        self._look = protocol.Inspect()
        self._back = 0
        """So many lines back from where it stands is where somebody wants to look."""
        self._then: protocol.Message | None = None
        """How to go on once it stands."""
        self._aim: Position | None = None
        self._goes_on = False
        self.busy = False
        """Whether an answer is still to come."""

    # What is asked

    def go(self, recording: Recording, at: Position, look: protocol.Inspect) -> None:
        """Stand at an instant of a recording and look."""
        self._look, self._back, self._then, self._goes_on = look, 0, None, False
        self._go(recording, at, -1)

    def look(self, look: protocol.Inspect) -> None:
        """Look again, at something else."""
        self._look = look
        if self._run is not None and self._paused is not None:
            self.busy = True
            self._run.send(look)

    def go_on(self, recording: Recording, at: Position, command: protocol.Message, look: protocol.Inspect) -> None:
        """Stand at an instant, go on from there as a command says, and look where that ends."""
        self._look, self._back, self._goes_on = look, 0, True
        stands = self._paused and Position(self._paused.tick, self._paused.ordinal)
        if self._run is not None and self._of is recording and stands == at:
            self.busy, self._paused = True, None
            self._run.send(command)
        else:
            self._then = command
            self._go(recording, at, -1)

    def lines_back(self, recording: Recording, at: Position, count: int, look: protocol.Inspect) -> None:
        """Stand so many lines before an instant."""
        self._look, self._back, self._then, self._goes_on = look, count, None, False
        self._go(recording, at, max(0, at.tick - FIRST_WINDOW_TICKS))

    # How it gets there

    def _go(self, recording: Recording, at: Position, traced_from: int) -> None:
        from tuisim.runs.handle import RunOptions, start_run

        self.busy, self._aim = True, at
        actions = recording.actions()
        known = self._of is recording and self._actions == len(actions) and self._run is not None
        if known and self._paused is not None and traced_from < 0:
            stands = Position(self._paused.tick, self._paused.ordinal)
            if stands == at or stands.is_before(at):
                self._paused = None
                assert self._run is not None
                self._run.send(protocol.RunToInstant(at.tick, at.ordinal))
                return
        self.close()
        self.busy = True
        self._of, self._actions, self._traced_from, self._aim = recording, len(actions), traced_from, at
        script = tuple(ScriptedAction.from_plain({"tick": one.tick, "kind": one.kind, **one.fields}) for one in actions)
        options = RunOptions(
            time_limit_s=0.0, stall_limit_s=0.0, answers=recording.answers, asks_user=True, actions=script,
            hold_at=(at.tick, at.ordinal), trace_from_tick=traced_from if traced_from >= 0 else None,
        )  # fmt: skip
        try:
            self._folder = Path(tempfile.mkdtemp(prefix="tuisim-"))
            self._run = start_run(recording.program, recording.spec, options, _scratch(self._folder))
        except (TuisimError, OSError) as error:
            self.busy = False
            self._failed(str(error))

    def beat(self) -> None:
        """Take what has come; never waits."""
        run = self._run
        if run is None:
            return
        for event in run.pump():
            match event:
                case Paused():
                    self._stands(event)
                case LineHistory():
                    self._choose_line(event)
                case Inspected() if self._paused is not None:
                    self.busy = False
                    self._arrived(self._paused, event)
                case Ended():
                    self.close()
                    if self._goes_on:
                        self._passed()
                    else:
                        self._failed("The program has ended before that")
                    return

    def _stands(self, paused: Paused) -> None:
        assert self._run is not None
        if self._then is not None:
            command, self._then = self._then, None
            self._run.send(command)
            return
        self._paused = paused
        self._run.send(protocol.RequestHistory(HISTORY) if self._back else self._look)

    def _choose_line(self, history: LineHistory) -> None:
        """Of the lines before, the one that is wanted is where to stand; if it is farther back, look farther."""
        assert self._of is not None and self._aim is not None
        aim = self._aim
        lines = [Position(met.tick, met.ordinal) for met in history.lines]
        before = [place for place in lines if place.is_before(aim)]
        if len(before) >= self._back:
            found = before[-self._back]
        elif self._traced_from > 0 and len(lines) < HISTORY:
            farther = max(0, aim.tick - 8 * (aim.tick - self._traced_from))
            self._go(self._of, aim, farther)
            return
        elif before:
            found = before[0]
        else:
            self._back = 0
            assert self._run is not None
            self._run.send(self._look)
            return
        self._back = 0
        # Traced from the same tick on, the same lines have the same numbers.
        self._go(self._of, found, found.tick)

    def close(self) -> None:
        """Let go of the process and of what it has written."""
        if self._run is not None:
            self._run.kill()
            self._run.close()
        if self._folder is not None:
            shutil.rmtree(self._folder, ignore_errors=True)
        self._run = self._folder = self._paused = self._of = None
        self.busy = False


def _scratch(folder: Path) -> RunStore:
    from tuisim.runs.store import RunStore

    return RunStore(folder)
