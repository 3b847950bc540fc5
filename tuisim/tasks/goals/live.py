"""Goals of a simulation that a script moves on, without a program: what they are worth if it ends now."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.engine.core.conditions import ValueSource
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD
from tuisim.engine.protocol import End, Ended
from tuisim.tasks.goals.brick import BRICK_COLUMNS, BRICK_TEXTS
from tuisim.tasks.goals.comparisons import (
    CountCondition,
    KeepCondition,
    StructureCondition,
    WhenCondition,
)
from tuisim.tasks.goals.condition import Condition
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.goals.judgement import GoalState, Judgement, compute_points
from tuisim.tasks.goals.spec import (
    CallsCondition,
    DialogueCondition,
    Goal,
    LogCondition,
    PrintCondition,
    ReadCondition,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np

    from tuisim.engine.core.field import Field
    from tuisim.engine.core.simulation import Simulation
    from tuisim.engine.core.tick_record import MemoryRecording
    from tuisim.engine.runs.handle import RunHandle
    from tuisim.engine.runs.records import OutputRow

_OF_PROGRAM = (
    PrintCondition,
    LogCondition,
    ReadCondition,
    DialogueCondition,
    CallsCondition,
    StructureCondition,
)


class LiveRun:
    """A run as judges see it, for a simulation that ends now; it is also its own recording.

    Args:
        sim: The simulation.
        recording: The ticks so far.
    """

    program = Program("script", "")
    answers = ()
    folder = Path("/nonexistent")
    """Nothing else is recorded."""

    def __init__(self, sim: Simulation, recording: MemoryRecording) -> None:
        self._sim = sim
        self._recording = recording
        self.spec = sim.spec
        self.telemetry = self.output = self

    @property
    def ended(self) -> Ended:
        """The end of the run: now."""
        return Ended(End.FINISHED, self._sim.tick, self._sim.compute_due_ns(self._sim.tick))

    def array(self) -> np.ndarray[Any, Any]:
        """Return the records of the ticks."""
        import numpy as np

        end = TICK_RECORD.size * (1 + self._recording.count)
        records = bytes(memoryview(self._recording.buffer)[TICK_RECORD.size : end])
        return np.frombuffer(records, np.dtype(list(TICK_FIELDS)))

    def rows(self) -> Iterator[OutputRow]:
        """Yield no rows of output: there is no program."""
        yield from ()


class LiveGoals:
    """Judges goals on a simulation as if it ended now.

    Args:
        goals: The goals.
        sim: A simulation that has just begun.
        recording: Its ticks.
        field: Its mat.
    """

    def __init__(
        self, goals: Sequence[Goal], sim: Simulation, recording: MemoryRecording, field: Field
    ) -> None:
        # `judge` asks a run only for what LiveRun has, too.
        run = cast("RunHandle", LiveRun(sim, recording))
        self._judge = partial(judge, goals, run, field)
        self._sim = sim
        self._open = {each.goal.name for each in self._judge() if not each.is_good}

    def judge(self) -> tuple[float, bool]:
        """Return the points, and whether each goal that was not met at the beginning is met, or missed for good."""
        judgements = self._judge()
        ends = [
            each.is_good or self._is_lost(each)
            for each in judgements
            if each.goal.name in self._open
        ]
        return compute_points(judgements), bool(ends) and all(ends)

    def _is_lost(self, judgement: Judgement) -> bool:
        """Return whether a goal was missed before the end, and not only because the simulation ends."""
        return judgement.state is GoalState.MISSED and judgement.changes[-1].tick < self._sim.tick


def check_goals(goals: Sequence[Goal]) -> None:
    """Check that goals can be judged without a program.

    Raises:
        ConfigError: one is about a program.
    """
    for goal in goals:
        if any(map(needs_program, goal.parts)):
            hint = "a Lab has none; take goals that are about the robot"
            raise ConfigError(f"{goal.name!r} is about a program", hint, key="goals")


def needs_program(condition: Condition) -> bool:
    """Return whether a condition is about a program: its text, or what it reads, prints or shows."""
    match condition:
        case WhenCondition() | KeepCondition():
            comparisons = condition.conditions
        case CountCondition():
            comparisons = (condition.condition,)
        case _:
            return isinstance(condition, _OF_PROGRAM)
    return any(
        each.source is not ValueSource.COLUMN or each.name in (*BRICK_COLUMNS, *BRICK_TEXTS)
        for each in comparisons
    )
