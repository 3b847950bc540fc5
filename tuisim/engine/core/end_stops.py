"""End stops of motors that drive no wheel: such a motor turns between its two stops.

Where a motor is between its stops is measured from its position at the start, whatever position the program sets: a
program that homes an arm sets the motor's position to 0 at a stop.
"""

from __future__ import annotations

import math

from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.core.motors import Motor
from tuisim.engine.core.spec import MOTOR_ENDS, MotorSpec, RobotSpec
from tuisim.engine.core.state import end_flag

NEAR_DEG = 2.0
"""Distance from a stop at which a motor is at it: a touch sensor that the motor presses there yields before it
stops."""


def build_start_flags(robot: RobotSpec) -> int:
    """Return the end stops at which motors are at the start of a run, as flags of a tick record."""
    return sum(EndStops(robot, motor).flags for motor in robot.extra_motors)


class EndStops:
    """The end stops of one motor, and where the motor is between them."""

    def __init__(self, robot: RobotSpec, motor: MotorSpec) -> None:
        self._low_deg = -math.inf if motor.low_deg is None else motor.low_deg
        self._high_deg = math.inf if motor.high_deg is None else motor.high_deg
        self._low_flag, self._high_flag = (end_flag(robot, motor.port, end) for end in MOTOR_ENDS)
        self._at_deg = 0.0

    @property
    def flags(self) -> int:
        """The flag in a tick record for the end stop at which the motor is; 0 while it is between its end stops."""
        if self._at_deg - self._low_deg <= NEAR_DEG:
            return self._low_flag
        return self._high_flag if self._high_deg - self._at_deg <= NEAR_DEG else 0

    def step(self, motor: Motor, tick: int) -> None:
        """Run the motor by one tick, but not beyond its end stops."""
        before = motor.state()
        turned_deg = motor.step(tick, 0.0)
        there_deg = self._at_deg + turned_deg
        stop_deg = min(max(there_deg, self._low_deg), self._high_deg)
        if stop_deg == there_deg:
            motor.blocked_ticks = 0
        else:
            motor.hold_back(before, turned_deg, (stop_deg - self._at_deg) / turned_deg)
        self._at_deg = stop_deg


class Fence(EndStops):
    """The end stops of a motor that itself keeps its axle between them.

    Args:
        robot: The robot.
        spec: The description of the motor in the robot.
        motor: The motor.
    """

    def __init__(self, robot: RobotSpec, spec: MotorSpec, motor: SimulatedMotor) -> None:
        super().__init__(robot, spec)
        motor.limit_axle(self._low_deg, self._high_deg)

    def step(self, motor: Motor, tick: int) -> None:
        """Run one tick of a motor that keeps itself between its end stops."""
        self._at_deg += motor.step(tick, 0.0)


def build_stops(robot: RobotSpec, spec: MotorSpec, motor: Motor) -> EndStops:
    """Return the end stops of a motor: a `Fence` for a motor with the kernel's driver, else an `EndStops`."""
    if isinstance(motor, SimulatedMotor):
        return Fence(robot, spec, motor)
    return EndStops(robot, spec)
