"""Dead reckoning: where the wheels' turns say that the robot is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tuisim.core.drive import mm_per_degree
from tuisim.core.geometry import Pose
from tuisim.core.spec import RobotSpec
from tuisim.datalog.arrays import FloatArray


@dataclass(frozen=True, slots=True)
class Reckoned:
    """Poses from wheel counts, each array of shape (n,)."""

    x_mm: FloatArray
    y_mm: FloatArray
    heading_deg: FloatArray


def dead_reckoning(
    left_position_deg: FloatArray, right_position_deg: FloatArray, start: Pose, robot: RobotSpec
) -> Reckoned:
    """Return where the robot is if every turn of a wheel carried it along.

    Between two counts the robot drives an arc, whose chord points halfway between the
    headings at its ends.

    Args:
        left_position_deg: Turned by the left wheel since the start, shape (n,).
        right_position_deg: Turned by the right wheel.
        start: Pose at the first count.
        robot: Wheel diameter and spacing.
    """
    per_degree = mm_per_degree(robot)
    left = np.diff(left_position_deg, prepend=left_position_deg[:1]) * per_degree
    right = np.diff(right_position_deg, prepend=right_position_deg[:1]) * per_degree
    turn_rad = (right - left) / robot.wheel_spacing_mm
    heading_rad = np.radians(start.heading_deg) + np.cumsum(turn_rad)
    halfway = heading_rad - turn_rad / 2.0
    # A chord is shorter than its arc; sinc is sin(pi x) / (pi x).
    chord = (left + right) / 2.0 * np.sinc(turn_rad / (2.0 * np.pi))
    return Reckoned(
        start.x_mm + np.cumsum(chord * np.cos(halfway)),
        start.y_mm + np.cumsum(chord * np.sin(halfway)),
        np.degrees(heading_rad),
    )


def error_mm(reckoned: Reckoned, x_mm: FloatArray, y_mm: FloatArray) -> FloatArray:
    """Return how far the reckoned places are from the true ones, shape (n,)."""
    return np.hypot(reckoned.x_mm - x_mm, reckoned.y_mm - y_mm)


def distance_mm(x_mm: FloatArray, y_mm: FloatArray) -> FloatArray:
    """Return how far the robot has gone since the first place, shape (n,)."""
    if not len(x_mm):
        return np.empty(0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm)))))
