"""Drawing on a mat: shapes, gradients, and how they are painted.

Image coordinates in pixels of one millimetre: x to the right, y down, origin at the top
left. Pixel (col, row) is the unit square from (col, row) to (col + 1, row + 1).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WIDTH, HEIGHT = 2362, 1143
"""Size of every mat."""

SUBPIXELS = 8
"""A smooth edge looks at so many by so many points of a pixel."""
_BAND_ROWS = 32
"""Rows of a smooth shape that are looked at together, so that memory stays small."""

Canvas = NDArray[np.float32]
"""Shape (HEIGHT, WIDTH, 3), 0 … 255; not rounded until the picture is done."""
Floats = NDArray[np.float64]
Mask = NDArray[np.bool_]
Rgb = tuple[float, float, float]
Point = tuple[float, float]
Box = tuple[float, float, float, float]
"""x0, y0, x1, y1; x1 and y1 are outside."""

BLACK: Rgb = (0, 0, 0)
WHITE: Rgb = (255, 255, 255)


@dataclass(frozen=True, slots=True)
class Shape:
    """An area: a box around it and the test whether points are inside."""

    box: Box
    inside: Callable[[Floats, Floats], Mask]
    """From x, shape (1, w), and y, shape (h, 1), to shape (h, w)."""


def blank(rgb: Rgb = WHITE) -> Canvas:
    """Return a canvas of one colour."""
    canvas = np.empty((HEIGHT, WIDTH, 3), np.float32)
    canvas[:] = rgb
    return canvas


def finished(canvas: Canvas) -> NDArray[np.uint8]:
    """Return the picture: shape (HEIGHT, WIDTH, 3), rounded to bytes."""
    return np.rint(canvas).astype(np.uint8)


def _pixels_of(box: Box) -> tuple[slice, slice]:
    """Rows and columns of the canvas that a box touches."""
    x0, y0, x1, y1 = box
    columns = slice(max(math.floor(x0), 0), min(max(math.ceil(x1), 0), WIDTH))
    return slice(max(math.floor(y0), 0), min(max(math.ceil(y1), 0), HEIGHT)), columns


def _centres(span: slice) -> Floats:
    return np.arange(span.start, max(span.stop, span.start)) + 0.5


def pixel_centres(box: Box) -> tuple[Floats, Floats]:
    """Return x, shape (1, w), and y, shape (h, 1), of the pixels that a box touches."""
    rows, columns = _pixels_of(box)
    return _centres(columns)[None, :], _centres(rows)[:, None]


def _share(low: float, high: float, centres: Floats) -> Floats:
    """How much of each pixel lies between two edges, 0 … 1."""
    share: Floats = np.clip(
        np.minimum(high, centres + 0.5) - np.maximum(low, centres - 0.5), 0.0, 1.0
    )
    return share


def shade(canvas: Canvas, box: Box, colors: Rgb | Floats) -> None:
    """Paint a rectangle, a pixel on its edge by the share that is covered.

    Args:
        canvas: Is painted on.
        box: The rectangle; its edges may lie between pixels.
        colors: One colour, or one for each pixel that the box touches, shape (h, w, 3).
    """
    x, y = pixel_centres(box)
    share = _share(box[1], box[3], y) * _share(box[0], box[2], x)
    region = canvas[_pixels_of(box)]
    region += (share[:, :, None] * (np.asarray(colors) - region)).astype(np.float32)


def rect(canvas: Canvas, rgb: Rgb, box: Box) -> None:
    """Paint a rectangle of one colour."""
    shade(canvas, box, rgb)


def paint(canvas: Canvas, rgb: Rgb, shape: Shape, *, smooth: bool = False) -> None:
    """Paint a shape.

    Args:
        canvas: Is painted on.
        rgb: The colour.
        shape: The area.
        smooth: False paints the pixels whose centres are inside; True blends a pixel by
            the share of it that is covered.
    """
    region = canvas[_pixels_of(shape.box)]
    x, y = pixel_centres(shape.box)
    if not smooth:
        region[shape.inside(x, y)] = rgb
        return
    _blend(canvas, np.asarray(rgb, np.float32), shape)


def _blend(canvas: Canvas, rgb: Canvas, shape: Shape) -> None:
    """Paint a shape, each pixel by the share of it that is covered."""
    rows, columns = _pixels_of(shape.box)
    for top in range(rows.start, rows.stop, _BAND_ROWS):
        band = slice(top, min(top + _BAND_ROWS, rows.stop))
        region = canvas[band, columns]
        region += _covered(shape, band, columns)[:, :, None] * (rgb - region)


def _covered(shape: Shape, rows: slice, columns: slice) -> Canvas:
    """How much of each pixel a shape covers, 0 … 1, shape (h, w)."""
    inside = shape.inside(_points(columns)[None, :], _points(rows)[:, None])
    height, width = rows.stop - rows.start, max(columns.stop - columns.start, 0)
    counted = inside.reshape(height, SUBPIXELS, width, SUBPIXELS).sum((1, 3), dtype=np.float32)
    share: Canvas = counted / np.float32(SUBPIXELS**2)
    return share


def coverage(shape: Shape, height: int, width: int) -> Canvas:
    """Return how much of each pixel of a small picture a shape covers, 0 … 1, shape (height, width)."""
    return _covered(shape, slice(0, height), slice(0, width))


def _points(span: slice) -> Floats:
    """Where a smooth edge looks at some rows or columns: SUBPIXELS places in each."""
    return (
        np.arange(span.start * SUBPIXELS, max(span.stop, span.start) * SUBPIXELS) / SUBPIXELS
        + 0.5 / SUBPIXELS
    )


def ellipse(centre: Point, rx: float, ry: float) -> Shape:
    """Return an upright ellipse with semi-axes `rx` and `ry`."""
    cx, cy = centre
    return Shape(
        (cx - rx, cy - ry, cx + rx, cy + ry),
        lambda x, y: ((x - cx) / rx) ** 2 + ((y - cy) / ry) ** 2 <= 1.0,
    )


def disc(centre: Point, radius: float) -> Shape:
    """Return a circle with what is in it."""
    return ellipse(centre, radius, radius)


def without(outer: Shape, inner: Shape) -> Shape:
    """Return the part of `outer` that is not in `inner`, such as a ring of two discs."""
    return Shape(outer.box, lambda x, y: outer.inside(x, y) & ~inner.inside(x, y))


def ring(centre: Point, outer_radius: float, inner_radius: float) -> Shape:
    """Return the area between two circles."""
    return without(disc(centre, outer_radius), disc(centre, inner_radius))


def rounded_rect(box: Box, radius: float) -> Shape:
    """Return a rectangle whose corners are quarter circles."""
    x0, y0, x1, y1 = box

    def inside(x: Floats, y: Floats) -> Mask:
        beyond_x = np.maximum(np.maximum(x0 + radius - x, x - x1 + radius), 0.0)
        beyond_y = np.maximum(np.maximum(y0 + radius - y, y - y1 + radius), 0.0)
        found: Mask = beyond_x**2 + beyond_y**2 <= radius**2
        return found

    return Shape(box, inside)


def union(parts: Sequence[Shape]) -> Shape:
    """Return the area that is in any of the parts."""
    boxes = np.array([part.box for part in parts])

    def inside(x: Floats, y: Floats) -> Mask:
        found = np.zeros((y.size, x.size), np.bool_)
        # A part far smaller than the whole is asked only about points near it.
        left, right = (
            np.searchsorted(x[0], boxes[:, 0]),
            np.searchsorted(x[0], boxes[:, 2], "right"),
        )
        top, bottom = (
            np.searchsorted(y[:, 0], boxes[:, 1]),
            np.searchsorted(y[:, 0], boxes[:, 3], "right"),
        )
        for at in np.flatnonzero((left < right) & (top < bottom)).tolist():
            rows, columns = slice(top[at], bottom[at]), slice(left[at], right[at])
            found[rows, columns] |= parts[at].inside(x[:, columns], y[rows])
        return found

    return Shape((*boxes[:, :2].min(axis=0).tolist(), *boxes[:, 2:].max(axis=0).tolist()), inside)


def polygon(points: Sequence[Point]) -> Shape:
    """Return the inside of a closed polygon, by the even-odd rule."""
    across, down = zip(*points, strict=True)

    def inside(x: Floats, y: Floats) -> Mask:
        found = np.zeros(np.broadcast_shapes(x.shape, y.shape), np.bool_)
        for (x1, y1), (x2, y2) in zip(points, [*points[1:], points[0]], strict=True):
            if y1 == y2:
                continue
            beside = (np.minimum(y1, y2) <= y) & (y < np.maximum(y1, y2))
            found ^= beside & (x >= x1 + (y - y1) * (x2 - x1) / (y2 - y1))
        return found

    return Shape((min(across), min(down), max(across), max(down)), inside)


def row_gradient(canvas: Canvas, y0: int, y1: int, start: int, span: int) -> None:
    """Paint rows y0 … y1 - 1 in greys that fall from `start` to 0 in `span` rows, then stay 0."""
    steps = np.arange(y1 - y0) * start // span
    canvas[y0:y1] = np.maximum(0, start - steps)[:, None, None]


def radial_gradient(
    canvas: Canvas, centre: Point, scale: float, exponent: float, inner: Rgb, outer: Rgb
) -> None:
    """Paint a round glow over the whole canvas.

    Args:
        canvas: Is painted on.
        centre: Column and row of the brightest place; distances are taken from pixel corners.
        scale: Distance at which the colour would be `outer`.
        exponent: The mix is (distance / scale) ** exponent.
        inner: Colour in the centre.
        outer: Colour far away.
    """
    columns, rows = np.arange(WIDTH)[None, :], np.arange(HEIGHT)[:, None]
    mix = (np.sqrt((columns - centre[0]) ** 2 + (rows - centre[1]) ** 2) / scale) ** exponent
    for channel in range(3):
        canvas[:, :, channel] = np.floor(inner[channel] * (1 - mix) + outer[channel] * mix)
