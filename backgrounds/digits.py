"""Sheets of tiny handwritten digits, each followed by a grey square that says which it is.

The digits are drawn here, with a pen that trembles by chance of a fixed seed; they are no
pictures of anybody's writing. Each fills the same box with the same mean brightness as the
digit that the cell tables describe.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

import numpy as np
from digit_cells import BLACK_SHEET, WHITE_SHEET, Sheet
from shapes import BLACK, WHITE, Box, Canvas, Floats, Point, Rgb, blank, coverage, rect
from strokes import bent, pen_line

CELL = 14
"""Width and height of a digit's black cell."""
CELL_LEFT, CELL_TOP, PITCH = 73, 56, 100
SQUARE_LEFT, SQUARE_TOP, SQUARE_WIDTH, SQUARE_HEIGHT = 111, 53, 21, 24
GREY_STEP = 25
"""The square of digit n is 25 n grey."""

PEN_RANGE = (1.1, 3.6)
"""Thinnest and thickest pen in pixels; how bright a digit is says which one wrote it."""
TREMBLE = 0.07
"""How far a point of a stroke may go astray, as a share of the digit's size."""
# fmt: off
_STROKES: Mapping[str, tuple[tuple[Point, ...], ...]] = {
    "0": (((0.5, 0), (0.05, 0.1), (0, 0.55), (0.1, 1), (0.5, 1), (0.95, 0.95), (1, 0.45), (0.95, 0.05), (0.5, 0)),),
    "1": (((0.6, 0), (0.5, 0.5), (0.4, 1)),),
    "2": (((0.05, 0.2), (0.3, -0.05), (0.8, 0), (1, 0.35), (0.5, 0.7), (0, 1.02), (0.35, 0.85), (0.6, 1), (1, 0.95)),),
    "3": (((0.05, 0.08), (0.6, -0.08), (1, 0.2), (0.85, 0.45), (0.35, 0.48), (0.95, 0.5), (1, 0.8), (0.7, 1.05),
           (0, 0.95)),),
    "4": (((0.15, 0), (0, 0.35), (0.05, 0.55), (0.4, 0.6), (0.95, 0.45)), ((0.9, 0), (0.8, 0.5), (0.7, 1))),
    "5": (((1, 0), (0.6, 0), (0.25, 0.05), (0.2, 0.25), (0.15, 0.45), (0.6, 0.35), (0.95, 0.55), (0.95, 0.95),
           (0.4, 1.05), (0, 0.9)),),
    "6": (((0.75, 0), (0.3, 0.1), (0, 0.6), (0.05, 1), (0.5, 1.02), (1, 0.95), (0.9, 0.65), (0.55, 0.5), (0.1, 0.8)),),
    "7": (((0, 0.12), (0.4, 0.02), (0.95, 0), (0.9, 0.3), (0.6, 0.6), (0.45, 0.8), (0.4, 1)),),
    "8": (((0.9, 0.1), (0.5, -0.1), (0.1, 0.1), (0.15, 0.35), (0.5, 0.5), (1, 0.7), (0.8, 1), (0.4, 1.05), (0, 0.9),
           (0.2, 0.65), (0.6, 0.45), (0.95, 0.3), (0.9, 0.1)),),
    "9": (((0.9, 0.15), (0.5, -0.08), (0.05, 0.1), (0.05, 0.45), (0.4, 0.5), (0.85, 0.45), (0.95, 0.1), (0.9, 0.5),
           (0.75, 1)),),
}
# fmt: on
"""Where the pen is led: the strokes bend towards these points and meet their ends; x right, y down, 0 … 1."""


def _trembled(digit: str, seed: int) -> list[list[Point]]:
    """The strokes of one digit, as a hand might lead them."""
    strokes = _STROKES[digit]
    count = 2 * sum(map(len, strokes)) + 1
    # Raw draws: unlike numpy's distributions they never change between versions.
    chance = iter((np.random.PCG64(seed).random_raw(count) / 2.0**63 - 1.0).tolist())
    slant = 0.25 * next(chance)
    hand = []
    for stroke in strokes:
        led = [(x + TREMBLE * next(chance), y + TREMBLE * next(chance)) for x, y in stroke]
        hand.append(bent([(x + slant * (0.5 - y), y) for x, y in led]))
    return hand


def _length(hand: list[list[Point]]) -> float:
    return sum(
        math.hypot(x2 - x1, y2 - y1) for stroke in hand for (x1, y1), (x2, y2) in pairwise(stroke)
    )


def _fitted(hand: list[list[Point]], box: Box, pen: float) -> list[list[Point]]:
    """The strokes moved and stretched so that the pen fills a box."""
    xs, ys = zip(*(point for stroke in hand for point in stroke), strict=True)
    left, right, top, bottom = min(xs), max(xs), min(ys), max(ys)
    # The outermost pixels of a stroke are pale.
    margin = pen / 2 - 0.2
    x0, y0, x1, y1 = box[0] + margin, box[1] + margin, box[2] - margin, box[3] - margin
    scale_x, scale_y = max(x1 - x0, 0.2) / (right - left), max(y1 - y0, 0.2) / (bottom - top)
    return [
        [(x0 + (x - left) * scale_x, y0 + (y - top) * scale_y) for x, y in stroke]
        for stroke in hand
    ]


def digit_ink(digit: str, box: Box, mean: float, seed: int) -> Floats:
    """Return one digit, light on black.

    Args:
        digit: `0` … `9`.
        box: What it fills of its cell, in pixels.
        mean: Mean of all its pixels, 0 … 255; met as nearly as whole shades allow.
        seed: Which hand writes.

    Returns:
        Whole numbers 0 … 255, shape (CELL, CELL).
    """
    hand, pen = _trembled(digit, seed), sum(PEN_RANGE) / 2
    for _ in range(3):
        written = _fitted(hand, box, pen)
        pen = min(max(mean / 255 * CELL**2 / _length(written), PEN_RANGE[0]), PEN_RANGE[1])
    ink = np.zeros((CELL, CELL))
    for stroke in _fitted(hand, box, pen):
        ink = np.maximum(ink, coverage(pen_line(stroke, pen, pen), CELL, CELL))
    low, high = 0.0, 64.0
    for _ in range(40):
        strength = (low + high) / 2
        if np.minimum(ink * strength, 1.0).mean() * 255 < mean:
            low = strength
        else:
            high = strength
    shades: Floats = np.rint(np.minimum(ink * high, 1.0) * 255)
    return shades


def _digit_sheet(ground: Rgb, sheet: Sheet, first_seed: int) -> Canvas:
    canvas = blank(ground)
    for row, (labels, boxes, means) in enumerate(zip(*sheet, strict=True)):
        for column, (label, box, mean) in enumerate(
            zip(labels, boxes.split(), means.split(), strict=True)
        ):
            x0, y0, x1, y1 = (int(figure, 16) for figure in box)
            ink = digit_ink(label, (x0, y0, x1, y1), float(mean), first_seed + 100 * row + column)
            left, top = CELL_LEFT + PITCH * column, CELL_TOP + PITCH * row
            canvas[top : top + CELL, left : left + CELL] = ink[:, :, None]
            left, top = SQUARE_LEFT + PITCH * column, SQUARE_TOP + PITCH * row
            grey = GREY_STEP * int(label)
            rect(canvas, (grey, grey, grey), (left, top, left + SQUARE_WIDTH, top + SQUARE_HEIGHT))
    return canvas


def mnist_digits() -> Canvas:
    """Digits and their squares on white."""
    return _digit_sheet(WHITE, WHITE_SHEET, 10_000)


def mnist_digits_black() -> Canvas:
    """Other digits and their squares on black."""
    return _digit_sheet(BLACK, BLACK_SHEET, 20_000)
