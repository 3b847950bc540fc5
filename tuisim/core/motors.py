"""What a motor is to the rest of the simulation, whatever law it follows.

A motor is changed in place, tick by tick: this is the hottest data of the simulation.
Angles in degrees of the wheel (one encoder count is one degree), speeds in degrees per
second.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from tuisim.core.drive import EvenGlide, Glide
from tuisim.core.profile import ProfileSpec

STOPPED, FOREVER, TIMED, POSITION = range(4)
"""What a motor is doing."""

ENDLESS = 1 << 60
"""More ticks than any run has."""

MEDIUM_MAX_SPEED_DPS = 1560.0
"""Medium motor, no load (EV3 motor driver table)."""

STANDS_STILL_DEG = 1e-3
"""A wheel that turns less in a tick stands still."""


def top_speed_dps(kind: str, profile: ProfileSpec) -> float:
    """Return how fast a motor of a kind turns without a load."""
    return MEDIUM_MAX_SPEED_DPS if kind == "medium" else profile.max_speed_dps


@dataclass(frozen=True, slots=True)
class MotorState:
    """A motor before a tick."""

    mode: int
    sign: float
    target_dps: float
    position_deg: float


class Motor(Protocol):
    """One motor with its encoder. How it obeys and moves is the law of its class."""

    mode: int
    """What it is doing: anything but `STOPPED` counts as running."""
    position_deg: float
    """What the encoder shows."""
    speed_dps: float
    """Speed the motor has reached; some laws keep it while the motor stands."""
    goal_deg: float
    """Where a move to a position ends."""
    end_tick: float
    """When a timed move ends."""
    blocked_ticks: int
    """For how many ticks something solid has kept the wheel from turning."""

    @property
    def moving_dps(self) -> float:
        """The speed at which the wheel turns, with its sign."""

    @property
    def counting_dps(self) -> float:
        """How fast the encoder counts."""

    @property
    def aim_dps(self) -> float:
        """The speed at which the wheel is to turn, with its sign."""

    @property
    def resting(self) -> bool:
        """Whether no tick changes anything of it until it is told something."""

    @property
    def ramping_ticks(self) -> int:
        """About how many ticks until its speed is steady; 0 only if it is."""

    def run(self, speed_dps: float) -> None:
        """Run until told otherwise."""

    def run_until(self, speed_dps: float, end_tick: int) -> None:
        """Run until a tick."""

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None:
        """Run to an encoder position at a speed given without sign."""

    def stop(self) -> None:
        """Stand still."""

    def step(self, tick: int, noise_dps: float) -> float:
        """Do one tick, whatever it brings.

        Args:
            tick: The tick that is being done.
            noise_dps: Added to the speed; 0 for none.

        Returns:
            Degrees by which the wheel rolls.
        """

    def quiet_ticks(self, tick: int) -> int:
        """Return for how many ticks nothing but the ramp can change this motor; `tick` of them are done."""

    def glide(self, ticks: int) -> Glide:
        """Do quiet ticks."""

    def glide_evenly(self, ticks: int) -> EvenGlide:
        """Do quiet ticks of a motor that is not ramping; the caller sets what its encoder shows in the end."""

    def state(self) -> MotorState:
        """Return what `hold_back` needs to undo a tick."""

    def hold_back(self, before: MotorState, turned_deg: float, part: float) -> None:
        """Undo the rest of a tick in which something solid stopped the wheel.

        Args:
            before: The state before the tick.
            turned_deg: What the tick turned the wheel.
            part: The part of it that was possible, below 1.
        """
