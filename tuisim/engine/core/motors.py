"""The interface of a motor to the rest of the simulation, for any motor law.

Motors are mutable objects that change in every tick: most of a simulation's time is spent in them. Angles are in
degrees of the wheel (one encoder count is one degree), speeds in degrees per second.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from tuisim.engine.core.drive import EvenGlide, Glide
    from tuisim.engine.core.profile import ProfileSpec

STOPPED, FOREVER, TIMED, POSITION = range(4)
"""Values of `Motor.mode`."""

ENDLESS = 1 << 60
"""A number of ticks that no run reaches; it stands for `never`."""

MEDIUM_MAX_SPEED_DPS = 1560.0
"""Highest speed of a medium motor of the EV3 without load, in degrees per second (EV3 motor driver table)."""

STANDSTILL_DEG = 1e-3
"""A wheel that turns by less than this in a tick counts as standing."""


def find_top_speed_dps(kind: str, profile: ProfileSpec) -> float:
    """Return the highest speed of a kind of motor without load, in degrees per second."""
    return MEDIUM_MAX_SPEED_DPS if kind == "medium" else profile.max_speed_dps


MotorState = tuple[int, float, float, float]
"""State of a motor before a tick: mode, sign, target speed and position."""


class Motor(Protocol):
    """The interface of a motor with its encoder, under any motor law.

    Members without a docstring are as in `BrickMotor`.
    """

    position_deg: float
    """Position of the motor's encoder in degrees."""
    blocked_ticks: int
    """Number of consecutive ticks in which an obstacle or wall has blocked the wheel; 0 if it is free."""

    @property
    def mode(self) -> int:
        """The motor's mode: one of the constants of `engine.core.motors`. The motor runs in all modes but `STOPPED`."""

    @property
    def speed_dps(self) -> float:
        """Current speed in degrees per second; some motor laws keep it while the motor is stopped."""

    @property
    def goal_deg(self) -> float:
        """Encoder position in degrees at which a move to a position ends."""

    @property
    def end_tick(self) -> float:
        """The tick at which the motor's timed move ends; it means nothing in other modes."""

    @property
    def moving_dps(self) -> float: ...

    @property
    def counting_dps(self) -> float: ...

    @property
    def aim_dps(self) -> float: ...

    def read_turn(self, now_ns: int) -> tuple[float, float]: ...

    @property
    def resting(self) -> bool: ...

    @property
    def ramping_ticks(self) -> int:
        """Approximate number of ticks until the speed is steady; 0 only if it is steady."""

    def step(self, tick: int, noise_dps: float) -> float:
        """Advance the motor by one tick; return the rotation of the wheel in degrees.

        Args:
            tick: The number of the tick.
            noise_dps: The noise that is added to the motor's speed.
        """

    def count_quiet_ticks(self, tick: int) -> int:
        """Return the number of ticks after `tick` in which only the ramp of its speed changes this motor."""

    def glide(self, ticks: int) -> Glide:
        """Advance the motor by several ticks in which only the ramp of its speed changes it; return how it moves."""

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Return the motor's motion over several ticks at constant speed.

        `position_deg` is not changed: the caller sets it after that.
        """

    def state(self) -> MotorState: ...

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the motion of the last tick beyond the point at which an obstacle stopped the wheel.

        Args:
            before: The motor's `state` before the tick.
            turned_deg: How far the wheel would have turned in the tick without the obstacle.
            part: The fraction of the tick's motion that the obstacle allowed, below 1.
        """
