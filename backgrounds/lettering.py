"""Writing on mats: bold letters of straight pen strokes, made here, so that no font is needed.

A letter stands on a grid of 2 × 4 steps: x to the right, y up, the base line at 0, capitals
and figures reaching 4. Its strokes are lists of grid points; the pen is broader than high.
"""

from __future__ import annotations

from collections.abc import Mapping

from shapes import Canvas, Point, Rgb, paint
from strokes import pen_line

CAP_HEIGHT_EM = 0.729
PEN_WIDTH_EM, PEN_HEIGHT_EM = 0.175, 0.125
SIDE_EM = 0.045
"""Empty space on each side of a letter."""

FIGURE_EM = 0.696
_WIDTHS_EM: Mapping[str, float] = {
    **dict.fromkeys("0123456789", FIGURE_EM),
    " ": 0.348,
    ":": 0.4,
    ",": 0.38,
    ".": 0.38,
    "-": 0.415,
    "I": 0.372,
    "M": 0.995,
    "W": 1.05,
    "x": 0.645,
    "y": 0.652,
}
"""How far the pen moves on after a letter."""
CAPITAL_EM = 0.76
"""The same for the letters that are not listed."""

Strokes = tuple[tuple[Point, ...], ...]

# fmt: off
_GLYPHS: Mapping[str, Strokes] = {
    " ": (),
    ".": (((1, 0), (1, 0.05)),),
    "-": (((0.2, 1.6), (1.8, 1.6)),),
    ",": (((1.2, 0.4), (0.2, -0.8)),),
    ":": (((1, -0.1), (1, 0.5)), ((0.9, 2.8), (1.1, 2.3)),),
    "0": (((0.1, 2.2), (0, 1.3), (0.3, 0.3), (1, -0.2), (1.7, 0.3), (2, 1.4), (2, 2.6), (1.7, 3.7), (1, 4.2),
            (0.3, 3.7), (0, 2.7), (0.1, 2.2)),),
    "1": (((0.25, 3.85), (1.1, 4.05), (1.1, 0)), ((0.25, 0.05), (2, 0)),),
    "2": (((0.05, 3.9), (1, 4.15), (1.55, 3.9), (1.85, 3), (1.6, 2.4), (0.05, 0.05), (1.9, 0)),),
    "3": (((0.2, 4), (1.1, 4.2), (1.8, 3.6), (1.6, 2.7), (1.3, 2.15), (0.6, 2.05)), ((1.3, 2.15), (1.7, 1.5),
            (1.9, 0.6), (1.8, 0.5), (1.1, -0.2), (0, 0.1)),),
    "4": (((1.55, -0.1), (1.45, 4.2), (-0.2, 0.95), (2.1, 0.9)),),
    "5": (((1.8, 3.9), (0.3, 4.1), (0.2, 2.3), (0.6, 2.5), (1.7, 2.1), (1.9, 0.8), (1.7, 0.3), (1, -0.2),
            (0.1, 0.1)),),
    "6": (((1.8, 4), (1.1, 4.2), (0.4, 3.6), (0, 2.2), (0.2, 0.8), (0.3, 0.3), (1.2, -0.2), (1.9, 0.5), (2, 1.4),
            (1.7, 2.1), (1.7, 2.2), (0.6, 2.3), (0.2, 1.9)),),
    "7": (((0, 3.95), (1.9, 4), (0.6, -0.1)),),
    "8": (((1.3, 2.2), (0.5, 2.2), (0.1, 3.6), (0.1, 3.7), (1, 4.2), (1.9, 3.7), (1.8, 3), (1.5, 2.3), (1.3, 2.2),
            (0.5, 2.2), (0, 0.9), (0.3, 0.1), (1, -0.2), (1.8, 0.2), (2, 1.1), (1.5, 2.1), (1.3, 2.2)),),
    "9": (((0.2, -0.1), (1.2, 0), (1.6, 0.4), (1.8, 1), (2, 2.6), (1.5, 3.9), (0.8, 4.2), (0.1, 3.6), (0, 2.9),
            (0.1, 2.2), (0.6, 1.6), (1.6, 1.9), (2, 2.6)),),
    "A": (((0, 0), (1, 4), (2, 0)), ((0.4, 1.3), (1.6, 1.3))),
    "B": (((1.2, 2.1), (0, 2.1), (0, 4), (1.2, 4), (1.8, 3.6), (1.8, 2.6), (1.2, 2.1), (1.8, 1.8), (2, 1.1), (1.7, 0.2),
           (1.2, 0), (0, 0), (0, 2.1)),),
    "C": (((2, 3.5), (1.2, 4), (0.4, 3.6), (0, 2.6), (0, 1.4), (0.4, 0.4), (1.2, 0), (2, 0.5)),),
    "D": (((0, 0), (0, 4), (1, 4), (1.7, 3.6), (2, 2.6), (2, 1.4), (1.7, 0.4), (1, 0), (0, 0)),),
    "E": (((1.9, 4), (0, 4), (0, 0), (1.9, 0)), ((0, 2.1), (1.6, 2.1))),
    "F": (((1.9, 4), (0, 4), (0, 0)), ((0, 2.1), (1.6, 2.1))),
    "G": (((1.9, 3.6), (1.1, 4), (0.4, 3.6), (0, 2.6), (0, 1.4), (0.4, 0.4), (1.1, 0), (2, 0.4), (2, 1.8),
           (1.2, 1.8)),),
    "H": (((0, 0), (0, 4)), ((2, 0), (2, 4)), ((0, 2.1), (2, 2.1))),
    "I": (((1, 0), (1, 4)),),
    "J": (((1.7, 4), (1.7, 1), (1.4, 0.2), (0.8, 0), (0.1, 0.3)),),
    "K": (((0, 0), (0, 4)), ((1.9, 4), (0, 1.8)), ((0.6, 2.3), (2, 0))),
    "L": (((0, 4), (0, 0), (1.9, 0)),),
    "M": (((0, 0), (0, 4), (1, 1.5), (2, 4), (2, 0)),),
    "N": (((0, 0), (0, 4), (2, 0), (2, 4)),),
    "O": (((1, 0), (0.3, 0.4), (0, 1.3), (0, 2.7), (0.3, 3.6), (1, 4), (1.7, 3.6), (2, 2.7), (2, 1.3), (1.7, 0.4),
           (1, 0)),),
    "P": (((0, 0), (0, 4), (1.2, 4), (1.8, 3.7), (2, 2.9), (1.8, 2.1), (1.2, 1.8), (0, 1.8)),),
    "Q": (((1, 0), (0.3, 0.4), (0, 1.3), (0, 2.7), (0.3, 3.6), (1, 4), (1.7, 3.6), (2, 2.7), (2, 1.3), (1.7, 0.4),
           (1, 0)), ((1.2, 0.9), (2, -0.4))),
    "R": (((0, 0), (0, 4), (1.2, 4), (1.8, 3.7), (1.9, 2.9), (1.8, 2.3), (1.2, 2), (0, 2)), ((1.2, 2), (2, 0))),
    "S": (((1.8, 3.7), (1.1, 4), (0.3, 3.7), (0.1, 3), (0.4, 2.4), (1.6, 1.7), (2, 1.1), (1.7, 0.3), (0.9, 0),
           (0, 0.4)),),
    "T": (((0, 4), (2, 4)), ((1, 4), (1, 0))),
    "U": (((0, 4), (0, 1.2), (0.3, 0.3), (1, 0), (1.7, 0.3), (2, 1.2), (2, 4)),),
    "V": (((0, 4), (1, 0), (2, 4)),),
    "W": (((0, 4), (0.5, 0), (1, 3), (1.5, 0), (2, 4)),),
    "X": (((0, 0), (2, 4)), ((0, 4), (2, 0))),
    "Y": (((0, 4), (1, 2), (2, 4)), ((1, 2), (1, 0))),
    "Z": (((0, 4), (2, 4), (0, 0), (2, 0)),),
    "x": (((0.05, -0.05), (1.9, 2.85)), ((0.1, 2.85), (1.95, -0.05)),),
    "y": (((-0.1, 2.85), (0.8, 0.45)), ((2.05, 2.8), (1.1, -0.1), (0.8, -1.2), (0.25, -1.5)),),
}
# fmt: on


def text_width(text: str, size: float) -> float:
    """Return how far the pen moves along a line of text whose em is `size` pixels."""
    return size * sum(_WIDTHS_EM.get(letter, CAPITAL_EM) for letter in text)


def write(canvas: Canvas, text: str, start: Point, size: float, rgb: Rgb) -> None:
    """Write a line of text.

    Args:
        canvas: Is painted on.
        text: Capitals, figures, `x`, `y` and `: , . -`.
        start: Where the pen starts, on the base line.
        size: The em in pixels; capitals are about three quarters as high.
        rgb: The colour.

    Raises:
        KeyError: there is no such letter.
    """
    x, base = start
    pen_width, pen_height = size * PEN_WIDTH_EM, size * PEN_HEIGHT_EM
    step_y = (size * CAP_HEIGHT_EM - pen_height) / 4
    for letter in text:
        width = size * _WIDTHS_EM.get(letter, CAPITAL_EM)
        left = x + size * SIDE_EM + pen_width / 2
        step_x = max(0.0, x + width - size * SIDE_EM - pen_width / 2 - left) / 2
        for points in _GLYPHS[letter]:
            placed = [(left + u * step_x, base - pen_height / 2 - v * step_y) for u, v in points]
            paint(canvas, rgb, pen_line(placed, pen_width, pen_height), smooth=True)
        x += width


def write_middle(canvas: Canvas, text: str, middle: Point, size: float, rgb: Rgb) -> None:
    """Write a line of text around a point."""
    x, y = middle
    write(canvas, text, (x - text_width(text, size) / 2, y + size * CAP_HEIGHT_EM / 2), size, rgb)
