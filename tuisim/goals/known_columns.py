"""Checks that the columns which the goals of a task name are columns of its robot."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.config.files import Location
from tuisim.config.robots import DEFAULT_ROBOT, RobotChoice, choose_robot
from tuisim.core.conditions import ValueCondition
from tuisim.core.spec import RobotSpec
from tuisim.errors import ConfigError
from tuisim.goals.brick import with_column
from tuisim.goals.comparisons import CountCondition, KeepCondition, WhenCondition
from tuisim.goals.condition import Condition
from tuisim.goals.spec import CONDITIONS, Goal
from tuisim.goals.trial_world import TrialWorld


def robots_of(worlds: Sequence[TrialWorld]) -> list[RobotSpec]:
    """Return the robots of some worlds, each with all that it has."""
    chosen = [world.settings.get("robot", DEFAULT_ROBOT) for world in worlds]
    return [(one if isinstance(one, RobotChoice) else choose_robot(one)).spec for one in chosen]


def check_columns(goals: Sequence[Goal], robots: Sequence[RobotSpec], at: Location) -> None:
    """Check the goals in a list of tables, in its order.

    Raises:
        ConfigError: one names a column that none of the robots has.
    """
    for number, goal in enumerate(goals, start=1):
        for part in goal.parts:
            for wanted in _conditions(part):
                key = next(key for key, kind in CONDITIONS.items() if type(part) is kind)
                _check(wanted, robots, at.at(f"[{number}]").at(key))


def _conditions(part: Condition) -> tuple[ValueCondition, ...]:
    match part:
        case WhenCondition() | KeepCondition():
            return part.conditions
        case CountCondition():
            return (part.condition,)
    return ()


def _check(wanted: ValueCondition, robots: Sequence[RobotSpec], at: Location) -> None:
    found: ConfigError | None = None
    for robot in robots:
        try:
            with_column(wanted, robot)
            return
        except ConfigError as error:
            found = error
    if found:
        raise at.wrong(f"the robot has no column {wanted.name!r}", found.hint)
