"""Motors as drivers command them."""

from __future__ import annotations

from typing import Protocol, cast

from tests.engine.core.driver.lab import give
from tuisim.engine.core.driver.motor import Command
from tuisim.engine.core.driver.simulated import SimulatedMotor
from tuisim.engine.core.motors import Motor
from tuisim.engine.core.profile import PROFILES, Library
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation

COMMANDED = sorted(
    name for name, profile in PROFILES.items() if profile.motor_law.library is Library.EV3DEV2
)
"""The profiles whose motors a driver commands."""


class CommandedMotor(Motor, Protocol):
    """A motor that a driver commands, as those of a brick and of the browser simulator do."""

    def run(self, speed_dps: float) -> None: ...

    def run_until(self, speed_dps: float, end_tick: int) -> None:
        """Run until a tick."""

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None: ...

    def stop(self) -> None: ...


class DriverCommands:
    """Gives a motor of the driver the commands of the others, at the end of its last tick.

    Args:
        motor: The motor.
    """

    def __init__(self, motor: SimulatedMotor) -> None:
        self._motor = motor

    def _give(self, command: Command, **setpoints: int) -> None:
        motor = self._motor
        give(motor, motor._end_ns(motor._tick), command, **setpoints)

    def run(self, speed_dps: float) -> None:
        """Run until the next command."""
        self._give(Command.RUN_FOREVER, speed_dps=int(speed_dps))

    def run_until(self, speed_dps: float, end_tick: int) -> None:
        """Run for a time that ends with a tick, or as soon as the kernel's timer allows."""
        time_ms = (end_tick - self._motor._tick) * 1000 // self._motor._hz
        self._give(Command.RUN_TIMED, speed_dps=int(speed_dps), time_ms=time_ms)

    def run_to(self, goal_deg: float, speed_dps: float, backwards: bool) -> None:
        """Run to a position."""
        self._give(Command.RUN_TO_ABS_POS, position=int(goal_deg), speed_dps=int(speed_dps))

    def stop(self) -> None:
        """Let the motor coast."""
        self._give(Command.STOP)


def commanded(motor: Motor) -> CommandedMotor:
    """Return what gives commands to a motor of a brick or of the browser simulator."""
    if isinstance(motor, SimulatedMotor):
        return cast(CommandedMotor, DriverCommands(motor))
    return cast(CommandedMotor, motor)


def run(sim: Simulation, motor: Motor, dps: float) -> None:
    """Run a motor as the library of its profile does."""
    if isinstance(motor, ServoMotor):
        now_us = sim.tick * 1_000_000 // sim.spec.profile.tick_hz
        settings = motor.control.settings
        motor.control.run(
            now_us, motor.measure_start, settings.counts(int(dps)), settings.acceleration
        )
        motor.follow()
    else:
        commanded(motor).run(dps)
