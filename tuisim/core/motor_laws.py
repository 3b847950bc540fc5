"""Implementation of a profile's motor law: the classes of motors and drive."""

from __future__ import annotations

from typing import assert_never

from tuisim.core.brick_motor import BrickMotor
from tuisim.core.browser_motor import BrowserMotor
from tuisim.core.drive import BrickDrive, BrowserDrive, Drive
from tuisim.core.motors import Motor, top_speed_dps
from tuisim.core.profile import MotorLaw
from tuisim.core.spec import RunSpec

WEIGHT_DPS2 = 5000.0
"""Change of speed per second, times the robot's weight."""


def weight_step(spec: RunSpec) -> float:
    """Return the largest change of a motor's speed in one tick, in degrees per second; 0 is unlimited."""
    return WEIGHT_DPS2 / spec.robot.weight / spec.profile.tick_hz if spec.robot.weight else 0.0


def motor_of(spec: RunSpec, kind: str) -> Motor:
    """Return a motor in its initial state.

    Args:
        spec: Robot, world and profile.
        kind: One of `MOTOR_KINDS`.
    """
    profile, step, fastest_dps = spec.profile, weight_step(spec), top_speed_dps(kind, spec.profile)
    match profile.motor_law:
        case MotorLaw.BRICK:
            return BrickMotor(profile.tick_hz, step, fastest_dps)
        case MotorLaw.NBEV3DEVSIM:
            return BrowserMotor(profile.tick_hz, step, fastest_dps)
        case _:
            assert_never(profile.motor_law)


def drive_of(spec: RunSpec) -> Drive:
    """Return the drive of a run's robot, at its initial pose."""
    robot, start, early = spec.robot, spec.world.start, 0.5 if spec.profile.halfway_heading else 0.0
    match spec.profile.motor_law:
        case MotorLaw.BRICK:
            return BrickDrive(robot, start, early)
        case MotorLaw.NBEV3DEVSIM:
            return BrowserDrive(robot, start, early)
        case _:
            assert_never(spec.profile.motor_law)
