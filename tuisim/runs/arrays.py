"""The array types for logs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
"""Real numbers, shape (n,)."""

IntArray = NDArray[np.int64]
"""Row numbers, shape (n,)."""
