"""The array types of logs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
"""Real numbers, shape (n,)."""

IntArray = NDArray[np.int64]
"""Numbers of rows, shape (n,)."""
