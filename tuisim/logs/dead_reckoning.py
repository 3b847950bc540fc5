"""Dead reckoning: the robot's pose from the wheel encoders."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tuisim.core.drive import mm_per_degree
from tuisim.core.geometry import Pose
from tuisim.core.spec import RobotSpec, from_plain
from tuisim.errors import LogError
from tuisim.logs.log import Log, Series
from tuisim.runs.arrays import FloatArray


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
    """Return the distances between the dead-reckoning positions and the true ones in mm, shape (n,)."""
    return np.hypot(reckoned.x_mm - x_mm, reckoned.y_mm - y_mm)


def distance_mm(x_mm: FloatArray, y_mm: FloatArray) -> FloatArray:
    """Return how far the robot has gone since the first place, shape (n,)."""
    if not len(x_mm):
        return np.empty(0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm)))))


NEEDED = ("left_position_deg", "right_position_deg", "x_mm", "y_mm", "heading_deg")
RECKONED = ("reckoned_x_mm", "reckoned_y_mm", "reckoned_heading_deg", "error_mm")


def reckoned_series(log: Log) -> list[Series]:
    """Return a series for each name of `RECKONED`.

    Raises:
        LogError: the log is none of every tick, or does not know the robot.
    """
    missing = [name for name in NEEDED if name not in log.table.column_names]
    if missing:
        raise LogError(f"no column {missing[0]!r}", "a stored run, or its telemetry exported", file=log.title)
    try:
        spec = from_plain({k: v for k, v in log.metadata["runs"][0].items() if k not in ("run", "program")})
    except (KeyError, IndexError, TypeError) as error:
        hint = "a stored run, or its telemetry exported to a file"
        raise LogError("has no metadata of the robot", hint, file=log.title) from error
    left, right, x_mm, y_mm, _ = (log.numbers(name) for name in NEEDED)
    found = dead_reckoning(left, right, spec.world.start, spec.robot)
    columns = (found.x_mm, found.y_mm, found.heading_deg, error_mm(found, x_mm, y_mm))
    base = next((log.series(name) for name in log.names if len(log.series(name).rows) == log.rows), None)
    time_s = base.time_s if base else np.arange(log.rows, dtype=np.float64)
    rows = base.rows if base else np.arange(log.rows)
    return [Series(name, time_s, values, rows) for name, values in zip(RECKONED, columns, strict=True)]
