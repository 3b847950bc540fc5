"""The sensor arrays: the discs of pixels under the colour sensors, as one picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from tuisim.app.render.mat import Pixels
from tuisim.core.field import disc_mask

FULL_PX = 20
"""Largest size of a disc, besides its own diameter."""

CORNER_RGB = (58, 70, 88)
"""Outside the disc: neither black, white nor a colour of a mat, so that its outline is visible on any of them."""

CORNER_16_RGB = (0, 0, 135)
"""The same for 16 colours, which have no grey to spare."""


@dataclass(frozen=True, slots=True)
class DiscLayout:
    """Where the discs are in a picture, in pixels."""

    width_px: int
    height_px: int
    side_px: int
    """Side of the box of one disc."""
    corners: tuple[tuple[int, int], ...]
    """Side of the box around a disc."""
    beside: bool
    """Column and row of the upper left corner of each box."""


def lay_out(count: int, width_px: int, height_px: int) -> DiscLayout:
    """Side by side rather than one above the other.

    Args:
        count: How many discs.
        width_px: Width of the picture.
        height_px: Height of the picture, an even number.
    """
    count = max(count, 1)
    beside_px = min(FULL_PX, width_px // count, height_px)
    # Boxes start on even rows: a cell holds two pixels, one above the other.
    stacked_px = min(FULL_PX, width_px, height_px // count // 2 * 2)
    beside = beside_px >= stacked_px
    side = max(beside_px if beside else stacked_px, 1)
    if beside:
        spare = width_px - count * side
        gap = min(spare // (count + 1), 4)
        left = (width_px - count * side - (count - 1) * gap) // 2
        corners = [(left + at * (side + gap), 0) for at in range(count)]
    else:
        corners = [((width_px - side) // 2, at * side) for at in range(count)]
    return DiscLayout(width_px, height_px, side, tuple(corners), beside)


def draw_discs(
    layout: DiscLayout, boxes: Sequence[bytes], ground_rgb: tuple[int, int, int], corner_rgb: tuple[int, int, int]
) -> Pixels:
    """Return the picture of some discs.

    Args:
        layout: Their places.
        boxes: The pixels of each box: d × d, three bytes a pixel, row-major.
        ground_rgb: Background colour.
        corner_rgb: Colour of the corners of the boxes.

    Returns:
        Shape (layout.height_px, layout.width_px, 3).
    """
    picture = np.empty((layout.height_px, layout.width_px, 3), np.uint8)
    picture[:] = ground_rgb
    for (col, row), box in zip(layout.corners, boxes, strict=False):
        disc = _scaled(box, layout.side_px, corner_rgb)
        at = (layout.side_px - len(disc)) // 2
        picture[row + at : row + at + len(disc), col + at : col + at + len(disc)] = disc
    return picture


def _scaled(box: bytes, side_px: int, corner_rgb: tuple[int, int, int]) -> Pixels:
    """Return a disc of at most `side_px`, area-averaged if it has to be shrunk."""
    diameter = round((len(box) / 3) ** 0.5)
    pixels = np.frombuffer(box, np.uint8).reshape(diameter, diameter, 3).copy()
    pixels[~np.array(disc_mask(diameter))] = corner_rgb
    if diameter <= side_px:
        return pixels
    edges = np.arange(side_px + 1) * diameter // side_px
    sums = np.add.reduceat(np.add.reduceat(pixels, edges[:-1], axis=0, dtype=np.uint32), edges[:-1], axis=1)
    sizes = np.diff(edges)
    smaller: Pixels = (sums / (sizes[:, None, None] * sizes[None, :, None])).astype(np.uint8)
    return smaller
