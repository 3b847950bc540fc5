"""The array types for logs, and arrays from the poses of a recording."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
"""Real numbers, shape (n,)."""

IntArray = NDArray[np.int64]
"""Row numbers, shape (n,)."""


def world_points_mm(records: NDArray[Any], x_mm: float, y_mm: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return x and y in the world of a point of the robot at every tick, each of shape (n,).

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        x_mm: To the right of the midpoint between the wheels.
        y_mm: Forward of it.
    """
    # As `core.geometry.world_point`, for all ticks at once.
    turn = np.radians(records["heading_deg"] - 90.0)
    with np.errstate(invalid="ignore"):  # a damaged record may have no valid heading
        cos, sin = np.cos(turn), np.sin(turn)
    return records["x_mm"] + cos * x_mm - sin * y_mm, records["y_mm"] + sin * x_mm + cos * y_mm
