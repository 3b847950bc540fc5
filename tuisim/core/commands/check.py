"""Whether a program can have given a command: it is in the range of the motors' law, and time does not go back."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from tuisim.core.commands.calls import Call, SimulationCommand
from tuisim.core.commands.table import CALLS, CallSpec, Range
from tuisim.core.driver.regulator import MODELS
from tuisim.core.profile import MotorLaw

if TYPE_CHECKING:
    from tuisim.core.simulation import Simulation

MAX_AN_INSTANT = 10_000
"""No program gives more commands at one time: what costs nothing costs something from the hundredth call on, and a
loop in which no time passes does, too."""
_OF_BASES = frozenset(range(Call.MOVE_BASE, Call.SET_BASE_CONTROL + 1))
_OF_ROBOTS = frozenset((Call.RESET_GYRO, Call.MOVE_PEN, Call.PLUG, Call.BUILD_BASE))
_SPEED_PLACES = {
    Call.RUN: 0,
    Call.RUN_UNTIL: 0,
    Call.RUN_TO: 1,
    **dict.fromkeys(range(Call.RUN_FOREVER, Call.RESET_DRIVER + 1), 0),
}
"""Which value of a call is a speed that the kind of the motor limits."""


class CommandTimes:
    """Follows the times of the commands of a run."""

    __slots__ = ("_count", "_newest_ns")

    def __init__(self) -> None:
        self._newest_ns = self._count = 0

    def find_fault(self, time_ns: int) -> str:
        """Take the time of the next command, and return why it cannot be; words as of `find_fault`."""
        if time_ns < self._newest_ns:
            return "goes back in time"
        self._count = self._count + 1 if time_ns == self._newest_ns else 1
        self._newest_ns = time_ns
        return "the time is too short for" if self._count > MAX_AN_INSTANT else ""


def find_fault(command: SimulationCommand, sim: Simulation) -> str:
    """Return why no program can have given a command, as words after "that"; empty if one can.

    Args:
        command: The command, with all values that its record has.
        sim: The simulation right before it.
    """
    spec = CALLS[command.call]
    if sim.spec.profile.motor_law not in spec.laws:
        return "no motor of this profile takes"
    if command.part >= _count_parts(command.call, sim):
        return "is for a part that the robot does not have"
    values = command.values
    ranges = [*_narrow_ranges(command, spec, sim)]
    are_allowed = all(
        low <= value <= high or (value != value and spec.may_be_missing)
        for value, (low, high) in zip(values, ranges, strict=False)
    )
    if not are_allowed or any(value == value for value in values[len(ranges) :]):
        return "has a value that is not allowed"
    return ""


def _count_parts(call: Call, sim: Simulation) -> int:
    """Return how many parts there are of the kind that a call is for."""
    if call in _OF_ROBOTS:
        return 1
    return len(sim.bases) if call in _OF_BASES else len(sim.motors)


def _narrow_ranges(command: SimulationCommand, spec: CallSpec, sim: Simulation) -> Iterator[Range]:
    """Yield the ranges of the values of a command, those of speeds as the kind of its motor has them."""
    place = _SPEED_PLACES.get(command.call, -1)
    if place < 0 or sim.spec.profile.motor_law is MotorLaw.NBEV3DEVSIM:
        yield from spec.ranges
        return
    max_dps = float(MODELS[sim.spec.robot.motors[command.part].kind].max_speed_dps)
    for number, limits in enumerate(spec.ranges):
        yield (-max_dps, max_dps) if number == place else limits
