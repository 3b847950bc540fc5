"""The television test card after the FuBK pattern: one drawing in grid cells, placed anywhere.

Card coordinates: u to the right, v down, one unit is one cell of the grid, origin in the
middle of the card.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from shapes import (
    BLACK,
    Box,
    Canvas,
    Floats,
    Point,
    Rgb,
    ellipse,
    paint,
    pixel_centres,
    polygon,
    rect,
    shade,
    without,
)

HALF_WIDTH_U, HALF_HEIGHT_V = 9.6, 7.2
LINE_WIDTH_U, LINE_HEIGHT_V = 0.075, 0.0504
"""Thickness of upright and of flat grid lines."""
CIRCLE_CENTRE: Point = (0.0, 0.0127)
CIRCLE_RADIUS = 6.7065
NEEDLE: tuple[Point, ...] = ((-0.184, 2.0), (0.173, 2.0), (-0.18, 3.005))
MIDDLE_LINE: Box = (-0.0375, -2.0, 0.0375, 2.0)

CARD_WHITE: Rgb = (254, 254, 254)
DARK_GREY: Rgb = (62, 62, 62)
MID_GREY: Rgb = (127, 127, 127)
LIGHT_GREY: Rgb = (190, 190, 190)

TOP_V, BARS_END_V, STEPS_END_V, BOTTOM_V = -4.975, -2.006, -0.025, 4.975
LEFT_U, RIGHT_U = -5.9625, 5.9625
PLATE: Box = (-6.0375, -5.0252, 6.0375, 5.0252)

BARS: tuple[tuple[float, Rgb], ...] = (
    (-4.488, LIGHT_GREY),
    (-2.988, (191, 191, 0)),
    (-1.488, (0, 191, 191)),
    (0.012, (0, 191, 0)),
    (1.512, (191, 0, 191)),
    (3.012, (191, 0, 0)),
    (4.512, (0, 0, 191)),
    (RIGHT_U, BLACK),
)
"""Colour bars from the left: where each ends, and its colour."""

STEPS: tuple[tuple[float, Rgb], ...] = (
    (-3.585, BLACK),
    (-1.184, DARK_GREY),
    (1.216, MID_GREY),
    (3.617, LIGHT_GREY),
)
"""Grey steps from the left; white follows them."""

BLOCKS: tuple[tuple[Box, Rgb], ...] = (
    ((3.617, BARS_END_V, 6.0375, 1), CARD_WHITE),
    ((-3.585, 0.025, 3.617, 1), BLACK),
    ((-4.592, 1, -4.31, 2), MID_GREY),
    ((-2.459, 1, -2.207, 2), MID_GREY),
    ((-0.369, 1, 0.386, 2), MID_GREY),
    ((2.239, 1, 2.49, 2), MID_GREY),
    ((2.49, 1, 5.438, 2), (176, 127, 0)),
    ((5.438, 1, 5.957, 2), MID_GREY),
    ((2, 3, RIGHT_U, BOTTOM_V), (94, 94, 94)),
)
"""What lies below the grey steps, in drawing order."""

RAMP_END_U, RAMP_FULL_U = 2.0, -4.0
"""A ramp has its full colour up to RAMP_FULL_U and is black at RAMP_END_U."""
RAMPS: tuple[tuple[float, float, Rgb], ...] = (
    (3.0, 4.0, (253, 13, 94)),
    (4.0, BOTTOM_V, (95, 64, 254)),
)
"""Top, bottom and colour."""

BURST_V = (1.0, 2.0)
BURST_WINDOW = (0.5, 0.68, 0.85, 0.94, 0.98, 1.0, 0.93, 0.82, 0.7, 0.5, 0.25)
"""Strength of the stripes from the top to the bottom of BURST_V."""


# fmt: off
BURSTS: tuple[tuple[float, float, tuple[int, ...]], ...] = (
    (-4.3035, -2.4662, (
        24, 3, 7, 2, 1, 0, 0, 3, 9, 5, 27, 5, 37, 31, 24, 66, 4, 69, 33, 37, 57, 5, 51, 14, 21, 17, 3, 8, 0, 1, 0, 0,
        6, 3, 12, 20, 10, 45, 7, 51, 39, 29, 70, 4, 66, 29, 31, 44, 3, 33, 7, 11, 6, 2, 2, 2, 1, 5, 2, 18, 7, 25, 31,
        16, 61, 9, 60, 74, 13, 67, 3, 56, 22, 23, 28, 2, 16, 2, 3, 0, 0, 2, 2, 6, 15, 5, 35, 11, 39, 42, 21, 70, 43,
        44, 39, 28, 56, 3, 40, 13, 14, 13, 1, 4, 0, 0, 2, 0, 11, 7, 16, 29, 9, 53, 15, 59, 100, 100, 100, 26, 56, 31,
        22, 39,
    )),
    (-2.199, -0.362, (
        18, 2, 1, 4, 4, 22, 33, 27, 81, 4, 59, 18, 18, 9, 0, 0, 6, 8, 38, 6, 68, 23, 46, 37, 11, 19, 0, 1, 4, 2, 32,
        9, 51, 75, 12, 58, 2, 28, 3, 3, 2, 0, 20, 20, 28, 60, 9, 67, 14, 28, 11, 3, 0, 2, 8, 26, 11, 64, 44, 43, 32,
        21, 25, 4, 5, 5, 3, 24, 1, 54, 63, 24, 56, 8, 37, 3, 7, 0, 0, 15, 11, 32, 46, 20, 70, 8, 41, 12, 8, 2, 0, 5,
        16, 15, 56, 34, 55, 26, 34, 28, 4, 7, 0, 0, 15, 4, 49, 18, 51, 47, 20, 44, 2, 12, 0, 0, 9, 3, 33, 33, 32, 84,
        0, 56,
    )),
    (0.408, 2.231, (
        0, 5, 20, 25, 86, 0, 48, 2, 4, 6, 1, 49, 52, 35, 31, 12, 5, 2, 7, 32, 26, 78, 4, 38, 2, 1, 11, 1, 52, 65, 22,
        35, 4, 2, 5, 8, 45, 10, 70, 10, 26, 1, 0, 16, 11, 46, 44, 25, 33, 0, 1, 9, 8, 58, 3, 67, 14, 16, 0, 0, 20, 23,
        39, 54, 12, 28, 0, 0, 16, 6, 64, 13, 52, 16, 9, 0, 2, 22, 36, 29, 62, 2, 22, 0, 0, 25, 2, 68, 23, 39, 17, 3,
        0, 9, 22, 50, 18, 60, 3, 14, 0, 0, 34, 8, 61, 32, 25, 14, 0, 2, 17, 19, 63, 6, 56, 5, 8, 2, 0, 39, 54, 33, 39,
    )),
)
"""Left and right edge, and how dark each stripe between them is, in percent."""
# fmt: on


@dataclass(frozen=True, slots=True)
class Placement:
    """Where a card lies on the mat: its centre and the size of a cell, in pixels."""

    cx: float
    cy: float
    unit_x: float
    unit_y: float
    ramp_white: float
    """Share of white in the falling part of the ramps: their strips have pale seams."""
    turned: bool = False
    """A quarter turn counter-clockwise."""

    def point(self, u: float, v: float) -> Point:
        """Return a place on the card in image coordinates."""
        if self.turned:
            return self.cx + v * self.unit_x, self.cy - u * self.unit_y
        return self.cx + u * self.unit_x, self.cy + v * self.unit_y

    def box(self, on_card: Box) -> Box:
        """Return a rectangle of the card in image coordinates."""
        (xa, ya), (xb, yb) = self.point(*on_card[:2]), self.point(*on_card[2:])
        return min(xa, xb), min(ya, yb), max(xa, xb), max(ya, yb)

    def centres(self, on_card: Box) -> tuple[Floats, Floats]:
        """Return u and v of the pixels that a rectangle touches, for broadcasting to (h, w)."""
        x, y = pixel_centres(self.box(on_card))
        if self.turned:
            return (self.cy - y) / self.unit_y, (x - self.cx) / self.unit_x
        return (x - self.cx) / self.unit_x, (y - self.cy) / self.unit_y

    @property
    def pixel_u(self) -> float:
        """Size of a pixel along u."""
        return 1.0 / (self.unit_y if self.turned else self.unit_x)


def _grid(canvas: Canvas, place: Placement) -> None:
    rect(canvas, DARK_GREY, place.box((-HALF_WIDTH_U, -HALF_HEIGHT_V, HALF_WIDTH_U, HALF_HEIGHT_V)))
    for u in range(-int(HALF_WIDTH_U), int(HALF_WIDTH_U) + 1):
        line = (u - LINE_WIDTH_U / 2, -HALF_HEIGHT_V, u + LINE_WIDTH_U / 2, HALF_HEIGHT_V)
        rect(canvas, CARD_WHITE, place.box(line))
    for v in range(-int(HALF_HEIGHT_V), int(HALF_HEIGHT_V) + 1):
        line = (-HALF_WIDTH_U, v - LINE_HEIGHT_V / 2, HALF_WIDTH_U, v + LINE_HEIGHT_V / 2)
        rect(canvas, CARD_WHITE, place.box(line))


def _row_of_blocks(
    canvas: Canvas, place: Placement, v0: float, v1: float, blocks: Sequence[tuple[float, Rgb]]
) -> None:
    """Blocks side by side from LEFT_U on, each given by its right edge and colour."""
    left = LEFT_U
    for right, rgb in blocks:
        rect(canvas, rgb, place.box((left, v0, right, v1)))
        left = right


def _ramp(canvas: Canvas, place: Placement, v0: float, v1: float, rgb: Rgb) -> None:
    area = (LEFT_U, v0, RAMP_END_U, v1)
    u, v = place.centres(area)
    u = (u + 0 * v)[:, :, None]
    color = np.asarray(rgb) * np.clip((RAMP_END_U - u) / (RAMP_END_U - RAMP_FULL_U), 0, 1)
    white = np.where(u > RAMP_FULL_U, place.ramp_white, 0.0)
    shade(canvas, place.box(area), color + white * (np.asarray(CARD_WHITE) - color))


def _burst(
    canvas: Canvas, place: Placement, u0: float, u1: float, darkness_percent: Sequence[int]
) -> None:
    """Fine upright stripes; each pixel gets the mean of the stripes that it covers."""
    area = (u0, BURST_V[0], u1, BURST_V[1])
    u, v = place.centres(area)
    edges = np.linspace(u0, u1, len(darkness_percent) + 1)
    total = np.concatenate([[0.0], np.cumsum(darkness_percent)]) / 100 * (edges[1] - edges[0])
    low, high = np.clip(u - place.pixel_u / 2, u0, u1), np.clip(u + place.pixel_u / 2, u0, u1)
    # The tiny term keeps a pixel that only touches the burst from dividing nothing by nothing.
    darkness = (np.interp(high, edges, total) - np.interp(low, edges, total)) / (high - low + 1e-12)
    window = np.interp(v, np.linspace(*BURST_V, len(BURST_WINDOW)), BURST_WINDOW)
    value = CARD_WHITE[0] * (1 - darkness * window)
    shade(canvas, place.box(area), np.repeat(value[:, :, None], 3, axis=2))


def _circle(canvas: Canvas, place: Placement) -> None:
    centre = place.point(*CIRCLE_CENTRE)
    wide, high = LINE_WIDTH_U / 2, LINE_HEIGHT_V / 2
    if place.turned:
        wide, high = high, wide
    outer, inner = (
        ellipse(
            centre,
            (CIRCLE_RADIUS + side * wide) * place.unit_x,
            (CIRCLE_RADIUS + side * high) * place.unit_y,
        )
        for side in (1, -1)
    )
    paint(canvas, CARD_WHITE, without(outer, inner), smooth=True)


def card(canvas: Canvas, place: Placement) -> None:
    """Draw one test card."""
    _grid(canvas, place)
    rect(canvas, CARD_WHITE, place.box(PLATE))
    _row_of_blocks(canvas, place, TOP_V, BARS_END_V, BARS)
    _row_of_blocks(canvas, place, BARS_END_V, STEPS_END_V, STEPS)
    for box, rgb in BLOCKS:
        rect(canvas, rgb, place.box(box))
    for v0, v1, rgb in RAMPS:
        _ramp(canvas, place, v0, v1, rgb)
    for u0, u1, darkness_percent in BURSTS:
        _burst(canvas, place, u0, u1, darkness_percent)
    rect(canvas, CARD_WHITE, place.box(MIDDLE_LINE))
    paint(canvas, BLACK, polygon([place.point(*corner) for corner in NEEDLE]), smooth=True)
    _circle(canvas, place)
