"""Whether a program can have given a command: it is in the range of the motors' law, and time does not go back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.engine.core.commands.calls import Call, SimulationCommand
from tuisim.engine.core.commands.table import CALLS, Range, list_parts
from tuisim.engine.core.driver.regulator import MODELS
from tuisim.engine.core.profile import MotorLaw

if TYPE_CHECKING:
    from tuisim.engine.core.simulation import Simulation

MAX_AN_INSTANT = 10_000
"""No program gives more commands at one time: what costs nothing costs something from the hundredth call on, and a
loop in which no time passes does, too."""


class CommandCheck:
    """Finds commands that no program can have given.

    Args:
        sim: The simulation that is to obey them.
    """

    __slots__ = ("_count", "_newest_ns", "_ranges", "_robot", "_sim")

    def __init__(self, sim: Simulation) -> None:
        self._sim = sim
        self._robot = sim.spec.robot
        self._newest_ns = self._count = 0
        self._ranges: dict[tuple[Call, int], tuple[Range, ...]] = {}
        """The ranges of the values of calls to parts, as far as they are known of this robot."""

    def find_disorder(self, time_ns: int) -> str:
        """Take the time of the next command; return why the time is not possible, in words as those of `find_fault`."""
        if time_ns < self._newest_ns:
            return "goes back in time"
        self._count = self._count + 1 if time_ns == self._newest_ns else 1
        self._newest_ns = time_ns
        return "the time is too short for" if self._count > MAX_AN_INSTANT else ""

    def find_fault(self, command: SimulationCommand) -> str:
        """Return why no program can have given a command, in words that follow "a command that"; empty if one can.

        Args:
            command: The command, right before it is obeyed. Values that its call does not take do not matter.
        """
        _, part, call, values = command
        if self._sim.spec.robot is not self._robot:
            self._robot = self._sim.spec.robot
            self._ranges.clear()
        ranges = self._ranges.get((call, part))
        if ranges is None:
            if self._sim.spec.profile.motor_law not in CALLS[call].laws:
                return "no motor of this profile takes"
            if part >= len(list_parts(self._sim, CALLS[call].target)):
                return "is for a part that the robot does not have"
            ranges = self._ranges[call, part] = _narrow_ranges(call, part, self._sim)
        for value, (low, high) in zip(values, ranges, strict=False):
            if not low <= value <= high and (value == value or not CALLS[call].may_be_missing):
                return "has a value that is not allowed"
        return ""


def _narrow_ranges(call: Call, part: int, sim: Simulation) -> tuple[Range, ...]:
    """Return the ranges of a call's values; the range of a speed depends on the kind of motor."""
    ranges = [*CALLS[call].ranges]
    place = CALLS[call].speed_place
    if place is not None and sim.spec.profile.motor_law is not MotorLaw.NBEV3DEVSIM:
        max_dps = float(MODELS[sim.spec.robot.motors[part].kind].max_speed_dps)
        ranges[place] = -max_dps, max_dps
    return tuple(ranges)
