"""Goals of a simulation that a script moves on, without a program: what they are worth if it ends now."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, cast

from tuisim.base.errors import ConfigError
from tuisim.engine.core.conditions import ValueSource
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

    from tuisim.engine.core.field import Field
    from tuisim.engine.runs.handle import RunHandle
    from tuisim.engine.runs.stepped_run import SteppedRun

_OF_PROGRAM = (
    PrintCondition,
    LogCondition,
    ReadCondition,
    DialogueCondition,
    CallsCondition,
    StructureCondition,
)


class LiveGoals:
    """Judges goals on a simulation as if it ended now.

    Args:
        goals: The goals.
        run: A recorded run that has just begun.
        mat: Its mat.
    """

    def __init__(self, goals: Sequence[Goal], run: SteppedRun, mat: Field) -> None:
        # `judge` uses only those attributes of a run that a SteppedRun has, too.
        self._judge = partial(judge, goals, cast("RunHandle", run), mat)
        self._run = run
        self._open = {each.goal.name for each in self._judge() if not each.is_good}

    @staticmethod
    def check(goals: Sequence[Goal]) -> None:
        """Check that all goals can be judged in a simulation without a program.

        Raises:
            ConfigError: a goal is about a program.
        """
        for goal in goals:
            if any(map(needs_program, goal.parts)):
                hint = "a Lab has none; take goals that are about the robot"
                raise ConfigError(f"{goal.name!r} is about a program", hint, key="goals")

    def judge(self) -> tuple[float, bool]:
        """Return the points of the run so far, and whether all goals open at the beginning are now met or lost.

        The second result is False if no goal was open at the beginning.
        """
        judgements = self._judge()
        ends = [
            each.is_good or self._is_lost(each)
            for each in judgements
            if each.goal.name in self._open
        ]
        return compute_points(judgements), bool(ends) and all(ends)

    def _is_lost(self, judgement: Judgement) -> bool:
        """Return whether a goal was missed before the end of the simulation, so that it cannot be met later."""
        return judgement.state is GoalState.MISSED and judgement.changes[-1].tick < self._run.tick


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
