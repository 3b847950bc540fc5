"""Pictures as arrays of pixels, and how many of them a character cell holds."""

from __future__ import annotations

from typing import NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

Pixels: TypeAlias = npt.NDArray[np.uint8]
"""A picture, shape (rows, columns, 3): red, green and blue."""
Rgb: TypeAlias = tuple[int, int, int]
"""Red, green and blue, 0 to 255."""


def unpack_rgb(packed: int) -> Rgb:
    """Return the red, green and blue values, 0 to 255, of a colour 0xRRGGBB."""
    return packed >> 16 & 255, packed >> 8 & 255, packed & 255


def pack_rgb(colors: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Return colours of shape (3, …) as numbers 0xRRGGBB."""
    packed: npt.NDArray[np.int64] = colors[0] << 16 | colors[1] << 8 | colors[2]
    return packed


class CellPoints(NamedTuple):
    """How many pixels of a picture a character cell has, across and down."""

    cols: int = 1
    rows: int = 2
    aspect: float = 2.0
    """Height of the cell, as a multiple of its width."""

    @property
    def tall(self) -> float:
        """Height of a pixel, as a multiple of its width."""
        return self.aspect * self.cols / self.rows
