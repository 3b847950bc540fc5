"""The array types for logs, stretches of arrays, and arrays from the poses of a recording."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
"""Array of real numbers, shape (n,)."""

IntArray = NDArray[np.int64]
"""Array of row numbers, shape (n,)."""


def find_spans(is_so: NDArray[np.bool_]) -> IntArray:
    """Return the stretches in which an array is true, as an array of shape (n, 2).

    Each row has the first index of a stretch, and the index after its last one.
    """
    edges: IntArray = np.flatnonzero(np.diff(is_so, prepend=False, append=False))
    return edges.reshape(-1, 2)


def number_members(sizes: IntArray) -> tuple[IntArray, IntArray]:
    """Return two arrays with a number for each member of several groups: the index of its group, and its place in it.

    The sizes 2, 0 and 1 give 0, 0, 2 for the groups, and 0, 1, 0 for the places.

    Args:
        sizes: The number of members of each group.
    """
    groups = np.repeat(np.arange(len(sizes)), sizes)
    return groups, np.arange(len(groups)) - (np.cumsum(sizes) - sizes)[groups]


def compute_world_points_mm(
    records: NDArray[Any], x_mm: float, y_mm: float
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return x and y in the world of a point of the robot at every tick, each of shape (n,).

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        x_mm: How far the point is to the right of the midpoint between the wheels.
        y_mm: How far it is forward of that.
    """
    cos, sin = compute_cos_and_sin(records["heading_deg"] - 90.0)
    return records["x_mm"] + cos * x_mm - sin * y_mm, records["y_mm"] + sin * x_mm + cos * y_mm


def compute_cos_and_sin(angles_deg: NDArray[Any]) -> tuple[FloatArray, FloatArray]:
    """Return cosine and sine of angles, each of shape (n,), exactly as `math` computes them.

    They are NaN for an angle that is infinite or NaN.
    """
    # The results of NumPy may differ from those of `math` in the last bit, which can change a pixel. NaN stands for the
    # heading of a damaged record.
    turns = list(map(math.radians, np.where(np.isfinite(angles_deg), angles_deg, np.nan).tolist()))
    return np.array(list(map(math.cos, turns))), np.array(list(map(math.sin, turns)))
