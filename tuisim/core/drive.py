"""Differential drive: how two turning wheels move the robot."""

from __future__ import annotations

import math

from tuisim.core.spec import RobotSpec


def mm_per_degree(robot: RobotSpec) -> float:
    """Return how far a wheel rolls for one degree of turn."""
    return math.pi * robot.wheel_diameter_mm / 360.0


def turn_rate_dps(left_dps: float, right_dps: float, robot: RobotSpec) -> float:
    """Return the counter-clockwise rate of turn in degrees per second.

    Args:
        left_dps: Turning speed of the left wheel, degrees per second.
        right_dps: Turning speed of the right wheel.
        robot: Wheel diameter and spacing.
    """
    return (right_dps - left_dps) * robot.wheel_diameter_mm / (2.0 * robot.wheel_spacing_mm)
