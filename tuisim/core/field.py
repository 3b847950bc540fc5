"""The mat as sensors see it: pixels, and precomputed sums of every disc on it.

A disc of diameter d is the set of pixels of a d × d box with
(row - d/2)² + (col - d/2)² < (d/2)². Its sums over the whole mat are precomputed, so
that a reading is one look-up. Pixels off the mat are black.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

OUTSIDE_DISC_RGB = (245, 226, 225)
"""Colour of a pixel array in the corners of the box, outside the disc."""


def disc_mask(diameter: int) -> list[list[bool]]:
    """Return which pixels of a box belong to its disc, as rows of `diameter` booleans."""
    radius = diameter / 2
    return [
        [(row - radius) ** 2 + (col - radius) ** 2 < radius**2 for col in range(diameter)] for row in range(diameter)
    ]


def disc_pixels(diameter: int) -> int:
    """Return the number of pixels in a disc: 305 for 20, 69 for 10, 697 for 30."""
    return sum(map(sum, disc_mask(diameter)))


@dataclass(frozen=True, slots=True)
class Field:
    """A mat, ready to be read by sensors.

    Buffers are memory views, usually of memory-mapped files, so that reading needs neither
    numpy nor an image library.
    """

    width_px: int
    height_px: int
    pixels: memoryview
    """Rows from the top, three bytes per pixel."""
    sums: Mapping[int, memoryview]
    """By diameter d: unsigned 32-bit red, green and blue sums of the disc whose box has its
    corner at (col - d, row - d); shape (height + d, width + d, 3), flat."""

    def disc_sums(self, diameter: int, col: int, row: int) -> tuple[int, int, int]:
        """Return the sums of red, green and blue over one disc.

        Args:
            diameter: A key of `sums`.
            col: Left column of its box; may be off the mat.
            row: Top row of its box; may be off the mat.
        """
        width = self.width_px + diameter
        col += diameter
        row += diameter
        if not (0 <= col < width and 0 <= row < self.height_px + diameter):
            return (0, 0, 0)
        sums = self.sums[diameter]
        at = (row * width + col) * 3
        return sums[at], sums[at + 1], sums[at + 2]

    def box(self, diameter: int, col: int, row: int) -> bytes:
        """Return the pixels of one box, row-major, three bytes per pixel; black off the mat."""
        left, right = max(col, 0), min(col + diameter, self.width_px)
        before = bytes(3 * min(max(left - col, 0), diameter))
        rows = []
        for image_row in range(row, row + diameter):
            if 0 <= image_row < self.height_px and left < right:
                at = 3 * image_row * self.width_px
                inside = self.pixels[at + 3 * left : at + 3 * right]
                rows.append((before + bytes(inside)).ljust(3 * diameter, b"\0"))
            else:
                rows.append(bytes(3 * diameter))
        return b"".join(rows)
