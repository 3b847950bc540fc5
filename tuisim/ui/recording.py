"""A run as it can be looked at: at work, over, or from the store. One way for all of them."""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import TYPE_CHECKING

from tuisim.core.field import Field
from tuisim.core.marks import MarkedField, PenMarks
from tuisim.core.spec import NoiseSpec, RunSpec
from tuisim.core.state import FLAG_LEFT_RUNNING, FLAG_RIGHT_RUNNING
from tuisim.datalog.runfile import Action, noise_at, read_actions
from tuisim.host import program_again
from tuisim.ui.rows import RowIndex

if TYPE_CHECKING:
    from tuisim.datalog.runfile import StoredRun
    from tuisim.datalog.views import TelemetryView, TickRecord
    from tuisim.host import RunHandle

STALL_S = 0.1
"""A running motor that has not turned for longer is stalled (EV3 motor driver)."""
_STILL_DEG = 0.05
"""Less in that time is no turning, but pushing."""


class Recording:
    """What a run has written so far.

    Args:
        source: The run at work, or one from the store.
        answers: What a run at work was given to answer `input()` with; one from the store knows it.
    """

    def __init__(self, source: RunHandle | StoredRun, answers: tuple[str, ...] = ()) -> None:
        self.run_id: str
        self.number: int = source.number
        """Number in the catalogue, 0 if it is in none."""
        self.spec: RunSpec = source.spec
        self.folder: Path = source.folder
        self.telemetry: TelemetryView = source.telemetry
        self.rows = RowIndex(source.output)
        self.program = program_again(source)
        self._actions: tuple[Action, ...] = ()
        self._marks: _TimedMarks | None = None
        self.answers = answers
        """Scripted answers to `input()`."""
        self._take_source(source)

    def _take_source(self, source: RunHandle | StoredRun) -> None:
        from tuisim.datalog.runfile import StoredRun

        if isinstance(source, StoredRun):
            self.run_id, self._actions = source.id, source.actions
            self.answers = tuple(source.options.get("answers", ()))
        else:
            self.run_id = source.run_id

    @property
    def name(self) -> str:
        """What the run is called: its number, or its id if it has none."""
        return f"run {self.number}" if self.number else self.run_id

    @property
    def newest(self) -> int:
        """Tick of the newest record, -1 before the first."""
        return self.telemetry.count - 1

    def actions(self) -> tuple[Action, ...]:
        """Return the user's actions so far.

        Raises:
            LogError: their file is damaged.
        """
        last = self.telemetry.last()
        # The record counts the actions modulo 65536, and may be a little ahead of their file.
        if last is not None and 0 < (last.actions - len(self._actions)) & 0xFFFF < 0x8000:
            self._actions = read_actions(self.folder)[0]
        return self._actions

    def noise_at(self, record: TickRecord) -> NoiseSpec:
        """Return the noise at the tick of a record."""
        return noise_at(self.spec, self.actions(), record)

    def pressed_at(self, tick: int) -> frozenset[str]:
        """Return the brick's buttons that were held down when a tick was done."""
        for action in reversed(self.actions()):
            if action.kind == "set_buttons" and action.tick < tick:
                return frozenset(action.fields["pressed"])
        return frozenset()

    def field_at(self, tick: int, mat: Field) -> Field:
        """Return the mat as the sensors saw it at a tick: with what the pen had drawn, if they see that."""
        if not self.spec.world.pen_marks:
            return mat
        if self._marks is None:
            self._marks = _TimedMarks(mat, self)
        return self._marks.at(tick)

    def stalled(self, record: TickRecord) -> tuple[bool, bool]:
        """Return whether the left and the right motor were told to run but did not turn."""
        ticks = int(STALL_S * self.spec.profile.tick_hz) + 1
        if record.tick < ticks:
            return False, False
        before = self.telemetry.record(record.tick - ticks)
        running = record.flags & before.flags
        turned = (
            abs(record.left_position_deg - before.left_position_deg),
            abs(record.right_position_deg - before.right_position_deg),
        )
        return (
            bool(running & FLAG_LEFT_RUNNING) and turned[0] < _STILL_DEG,
            bool(running & FLAG_RIGHT_RUNNING) and turned[1] < _STILL_DEG,
        )


class _TimedMarks:
    """The marks of the pen at any tick: they only grow, and are kept in the order in which they were drawn."""

    def __init__(self, mat: Field, run: Recording) -> None:
        self._run = run
        self._drawn = PenMarks(mat, run.spec)
        self._counts = array("Q")
        """How many marks there were after each record."""
        self._cut: tuple[int, MarkedField] | None = None
        """The last field that was asked for, with its number of marks."""

    def at(self, tick: int) -> Field:
        marks = self._drawn.field.marks
        if tick >= len(self._counts):
            for record in self._run.telemetry.array()[len(self._counts) :].tolist():
                self._drawn.take_in([record])
                self._counts.append(len(marks))
        count = self._counts[min(tick, len(self._counts) - 1)] if self._counts else 0
        if count == len(marks):
            return self._drawn.field
        if self._cut is None or self._cut[0] != count:
            self._cut = count, self._drawn.field_of_first(count)
        return self._cut[1]
