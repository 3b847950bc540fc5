"""The mat as sensors see it: pixels, and precomputed sums of every disc on it.

A disc of diameter d is the set of pixels of a d × d box with
(row - d/2)² + (col - d/2)² < (d/2)². Its sums over the whole mat are precomputed, so
that a reading is one look-up. Pixels off the mat are black, unless it lies on a floor of its own colour.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass

if TYPE_CHECKING:
    from tuisim.engine.core.css_colors import Rgb

OUTSIDE_DISC_RGB = (245, 226, 225)
"""Colour of a pixel array in the corners of the box, outside the disc."""


def build_disc_mask(diameter: int) -> list[list[bool]]:
    """Return for each pixel of a square whether it belongs to the square's disc, as rows of `diameter` booleans."""
    radius = diameter / 2
    return [
        [(row - radius) ** 2 + (col - radius) ** 2 < radius**2 for col in range(diameter)]
        for row in range(diameter)
    ]


@lru_cache(maxsize=16)
def count_disc_pixels(diameter: int) -> int:
    """Return the number of pixels in a disc of a diameter in pixels: 305 for 20, 69 for 10, 697 for 30."""
    return sum(map(sum, build_disc_mask(diameter)))


@lru_cache(maxsize=16)
def list_disc_spans(diameter: int) -> tuple[tuple[int, int, int], ...]:
    """Return the pixels of a disc in a square, as three numbers for each row that has any.

    The numbers are the row's number in the square, the first column of the disc, and the column after its last one.
    """
    rows = enumerate(build_disc_mask(diameter))
    return tuple(
        (row, inside.index(True), diameter - inside[::-1].index(True))
        for row, inside in rows
        if any(inside)
    )


@dataclass(frozen=True, slots=True)
class Field:
    """A mat, ready to be read by sensors.

    Buffers are memory views, usually of memory-mapped files, so that reading needs neither
    numpy nor an image library.
    """

    width_px: int
    height_px: int
    pixels: memoryview
    """The mat's image: rows from the top, three bytes (red, green, blue) per pixel."""
    sums: Mapping[int, memoryview]
    """By diameter d: sums of red, green and blue (unsigned, 32 bits) of the disc whose box has its
    corner at (col - d, row - d); shape (height + d, width + d, 3), flat."""
    floor_rgb: Rgb | None = None
    """Colour of the floor around the mat; None for no floor, where nothing reflects."""

    def sum_disc(self, diameter: int, col: int, row: int) -> tuple[int, int, int]:
        """Return the sums of red, green and blue over a disc of the mat.

        Args:
            diameter: The disc's diameter in pixels, a key of `sums`.
            col, row: The upper left corner of the disc's box, which may be off the mat.
        """
        width = self.width_px + diameter
        left = col + diameter
        top = row + diameter
        if 0 <= left < width and 0 <= top < self.height_px + diameter:
            sums = self.sums[diameter]
            offset = (top * width + left) * 3
            left_sums = sums[offset], sums[offset + 1], sums[offset + 2]
        else:
            left_sums = (0, 0, 0)
        if self.floor_rgb is None or self.has_box(diameter, col, row):
            return left_sums
        count = self._count_on_floor(diameter, col, row)
        red, green, blue = self.floor_rgb
        return left_sums[0] + count * red, left_sums[1] + count * green, left_sums[2] + count * blue

    def has_box(self, diameter: int, col: int, row: int) -> bool:
        """Return whether the whole square box around a disc is on the mat.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the box.
        """
        return 0 <= col <= self.width_px - diameter and 0 <= row <= self.height_px - diameter

    def _count_on_floor(self, diameter: int, col: int, row: int) -> int:
        """Return how many pixels of a disc are beside the mat.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the disc's box.
        """
        count = 0
        for down, first, end in list_disc_spans(diameter):
            count += end - first
            if 0 <= row + down < self.height_px:
                count -= max(0, min(col + end, self.width_px) - max(col + first, 0))
        return count

    def pixel(self, col: int, row: int) -> Rgb:
        """Return the colour of a pixel; off the mat, the colour of the floor."""
        if 0 <= col < self.width_px and 0 <= row < self.height_px:
            offset = 3 * (row * self.width_px + col)
            return self.pixels[offset], self.pixels[offset + 1], self.pixels[offset + 2]
        return self.floor_rgb or (0, 0, 0)

    def read_box(self, diameter: int, col: int, row: int) -> bytes:
        """Return the pixels of the square box around a disc, row by row, three bytes per pixel.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the box, which may be off the mat.
        """
        off = bytes(self.floor_rgb or (0, 0, 0))
        left, right = max(col, 0), min(col + diameter, self.width_px)
        before, after = off * max(left - col, 0), off * max(col + diameter - right, 0)
        rows = []
        for image_row in range(row, row + diameter):
            if 0 <= image_row < self.height_px and left < right:
                offset = 3 * image_row * self.width_px
                inside = self.pixels[offset + 3 * left : offset + 3 * right]
                rows.append(before + bytes(inside) + after)
            else:
                rows.append(off * diameter)
        return b"".join(rows)

    def read_disc(self, diameter: int, col: int, row: int) -> bytes:
        """Return the pixels of a disc, row by row, three bytes per pixel.

        Args:
            diameter: The disc's diameter in pixels.
            col, row: The upper left corner of the disc's box, which may be off the mat.
        """
        if not self.has_box(diameter, col, row):
            return in_disc(Field.read_box(self, diameter, col, row), diameter)
        pixels = self.pixels
        line = 3 * self.width_px
        corner = 3 * (row * self.width_px + col)
        return b"".join(
            [
                pixels[corner + down * line + 3 * first : corner + down * line + 3 * end]
                for down, first, end in list_disc_spans(diameter)
            ]
        )


def find_floor_rgb(width_px: int, height_px: int, pixels: memoryview) -> Rgb:
    """Return the colour of the floor around a mat: the most frequent colour of the pixels at the mat's edges."""
    line = 3 * width_px
    ends = range(0, line, 3), range(line * (height_px - 1), line * height_px, 3)
    sides = range(0, line * height_px, line), range(line - 3, line * height_px, line)
    edge = Counter(
        bytes(pixels[offset : offset + 3]) for places in (*ends, *sides) for offset in places
    )
    red, green, blue = edge.most_common(1)[0][0]
    return red, green, blue


def in_disc(box: bytes, diameter: int) -> bytes:
    """Return those pixels of a square box that are in its disc, row by row, three bytes per pixel.

    Args:
        box: The pixels of the box, in the same form.
        diameter: The diameter of the disc, and the width of the box, in pixels.
    """
    return b"".join(
        box[3 * (down * diameter + first) : 3 * (down * diameter + end)]
        for down, first, end in list_disc_spans(diameter)
    )


GAUSSIAN_SCALE = 1000
CENTRE_WEIGHT = 3


@lru_cache(maxsize=32)
def disc_weights(diameter: int, strategy: str) -> tuple[int, ...]:
    """Return the relative weight of each pixel of a box, row by row, 0 outside the disc.

    Args:
        diameter: Diameter of the disc in pixels.
        strategy: One of `spec.STRATEGIES`: `mean`, equal weights; `gaussian`, a bell curve whose standard deviation is
            half the radius; `centre`, threefold weight within half the radius.
    """
    radius = diameter / 2
    weights = []
    for row, inside_row in enumerate(build_disc_mask(diameter)):
        for col, inside in enumerate(inside_row):
            squared = (row - radius) ** 2 + (col - radius) ** 2
            weights.append(_weight(squared, radius, strategy) if inside else 0)
    return tuple(weights)


def _weight(squared: float, radius: float, strategy: str) -> int:
    match strategy:
        case "gaussian":
            return round(GAUSSIAN_SCALE * math.exp(-squared / (2 * (radius / 2) ** 2)))
        case "centre":
            return CENTRE_WEIGHT if squared < (radius / 2) ** 2 else 1
        case _:
            return 1


def weighted_mean(box: bytes, diameter: int, strategy: str) -> tuple[float, float, float]:
    """Return the weighted mean red, green and blue of the pixels in a box around a disc.

    Args:
        box: The pixels, row by row, three bytes per pixel.
        diameter: Diameter of the disc in pixels.
        strategy: How the pixels are weighted, one of `spec.STRATEGIES`; see `disc_weights`.
    """
    weights = disc_weights(diameter, strategy)
    total = sum(weights)
    red, green, blue = (
        sum(map(int.__mul__, box[channel::3], weights)) / total for channel in range(3)
    )
    return red, green, blue
