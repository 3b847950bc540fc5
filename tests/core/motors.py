"""Motors as drivers command them."""

from __future__ import annotations

from typing import cast

from tuisim.core.motors import CommandedMotor, Motor
from tuisim.core.profile import PROFILES, Library
from tuisim.core.servo.motor import ServoMotor
from tuisim.core.simulation import Simulation

COMMANDED = sorted(
    name for name, profile in PROFILES.items() if profile.motor_law.library is Library.EV3DEV2
)
"""The profiles whose motors a driver commands."""
SERVO = sorted(set(PROFILES) - set(COMMANDED))
"""The profiles whose motors follow trajectories."""


def commanded(motor: Motor) -> CommandedMotor:
    """Return a motor of a brick or of the browser simulator."""
    return cast(CommandedMotor, motor)


def run(sim: Simulation, motor: Motor, dps: float) -> None:
    """Run a motor as the library of its profile does."""
    if isinstance(motor, ServoMotor):
        now_us, settings = sim.tick * 1_000_000 // sim.spec.profile.tick_hz, motor.control.settings
        motor.control.run(now_us, motor.measured, settings.counts(int(dps)), settings.acceleration)
        motor.follow()
    else:
        commanded(motor).run(dps)
