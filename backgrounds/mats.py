"""Every mat, drawn from numbers: one function a mat, in image coordinates, and the table `MATS`.

To add a mat: write its function, add a line to `MATS` and a table to catalog.toml, and
run `python backgrounds/draw.py NAME`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from itertools import pairwise

import numpy as np
from courses import junction_handling_test, line_following_test, obstacles_test, thruxton_circuit
from digits import mnist_digits, mnist_digits_black
from harbour import harbour
from harvest import harvest_trail
from lollipop import LOWER_BRANCH, OPENING, UPPER_BRANCH
from numpy.typing import NDArray
from patterns import sensor_diameter_test, simple_shapes
from shapes import (
    BLACK,
    HEIGHT,
    WHITE,
    WIDTH,
    Box,
    Canvas,
    Point,
    Rgb,
    blank,
    disc,
    ellipse,
    finished,
    paint,
    polygon,
    radial_gradient,
    rect,
    ring,
    rounded_rect,
    row_gradient,
)
from spaceport import space_port
from speckle import speckled
from terrain import topo_map
from testcard import Placement, card

VERY_LIGHT_GREY: Rgb = (220, 220, 220)
LIGHT_GREY: Rgb = (211, 211, 211)
MID_GREY: Rgb = (128, 128, 128)
RED: Rgb = (255, 0, 0)
GREEN: Rgb = (0, 255, 0)
BLUE: Rgb = (0, 0, 255)
CYAN: Rgb = (0, 255, 255)
MAGENTA: Rgb = (255, 0, 255)
YELLOW: Rgb = (255, 255, 0)

BAND_TOP = 150
"""First row of the upright bands on every mat that has them."""
BAND_COLUMNS = ((250, 451), (650, 851), (1050, 1251), (1450, 1651))
"""Left and right edge of four bands that stand apart."""

CORNER_OUTER, CORNER_INNER = 80.75, 50.5
"""Corner radii of the outside and the inside of a thick rounded track."""
TRACK_WIDTH = 100


def empty_map() -> Canvas:
    """Plain white."""
    return blank()


def grey_bands() -> Canvas:
    """Four upright bands from very light grey to black, then three coloured dots."""
    canvas = blank()
    for (x0, x1), rgb in zip(
        BAND_COLUMNS, (VERY_LIGHT_GREY, LIGHT_GREY, MID_GREY, BLACK), strict=True
    ):
        rect(canvas, rgb, (x0, BAND_TOP, x1, 901))
    for cy, rgb in ((300.5, RED), (500.5, GREEN), (700.5, BLUE)):
        paint(canvas, rgb, disc((1900.5, cy), 50.5))
    return canvas


def grey_and_black() -> Canvas:
    """A black bar, and below it a bar in four greys."""
    canvas = blank()
    rect(canvas, BLACK, (200, 100, 1801, 201))
    edges = (200, 600, 1000, 1400, 1801)
    for (x0, x1), rgb in zip(
        pairwise(edges), (LIGHT_GREY, BLACK, VERY_LIGHT_GREY, MID_GREY), strict=True
    ):
        rect(canvas, rgb, (x0, 600, x1, 701))
    return canvas


def coloured_bands() -> Canvas:
    """Four upright bands that stand apart: red, green, blue, black."""
    canvas = blank()
    for (x0, x1), rgb in zip(BAND_COLUMNS, (RED, GREEN, BLUE, BLACK), strict=True):
        rect(canvas, rgb, (x0, BAND_TOP, x1, 751))
    return canvas


def rainbow_bands() -> Canvas:
    """Seven upright bands side by side."""
    canvas = blank()
    edges = (200, 400, 600, 800, 1000, 1200, 1400, 1601)
    for (x0, x1), rgb in zip(
        pairwise(edges), (RED, GREEN, BLUE, CYAN, MAGENTA, YELLOW, BLACK), strict=True
    ):
        rect(canvas, rgb, (x0, BAND_TOP, x1, 751))
    return canvas


def linear_grey() -> Canvas:
    """White at the top fading to black, with a white strip at the bottom."""
    canvas = blank()
    row_gradient(canvas, 100, 1094, start=255, span=943)
    return canvas


def _glow(inner: Rgb, outer: Rgb) -> Canvas:
    """A glow that fades with the cube root of the distance from the middle of the mat."""
    canvas = blank()
    centre = (WIDTH / 2, HEIGHT / 2)
    radial_gradient(canvas, centre, math.sqrt(2) * WIDTH / 2, 1 / 3, inner, outer)
    return canvas


def radial_grey() -> Canvas:
    """A round glow from light grey to near black."""
    return _glow(WHITE, BLACK)


def radial_red() -> Canvas:
    """A round glow from bright to dark red."""
    return _glow((255, 80, 80), (80, 0, 0))


def _rounded_track(canvas: Canvas, outer: Box) -> None:
    """A thick black track along the inside of a box."""
    x0, y0, x1, y1 = outer
    inner = (x0 + TRACK_WIDTH, y0 + TRACK_WIDTH, x1 - TRACK_WIDTH, y1 - TRACK_WIDTH)
    paint(canvas, BLACK, rounded_rect(outer, CORNER_OUTER))
    paint(canvas, WHITE, rounded_rect(inner, CORNER_INNER))


def loop() -> Canvas:
    """A thick black track around a rounded rectangle."""
    canvas = blank()
    _rounded_track(canvas, (200, 200, 1901, 1001))
    return canvas


def square() -> Canvas:
    """A thin grey square with a filled one in its middle."""
    canvas = blank()
    rect(canvas, MID_GREY, (300, 100, 1301, 1101))
    rect(canvas, WHITE, (320, 120, 1281, 1081))
    rect(canvas, MID_GREY, (600, 400, 1001, 801))
    return canvas


def two_shapes() -> Canvas:
    """A thick rounded square track and a thick circular one."""
    canvas = blank()
    _rounded_track(canvas, (200, 400, 701, 901))
    paint(canvas, BLACK, ring((1450.5, 650.5), outer_radius=250.45, inner_radius=150.35))
    return canvas


def lollipop() -> Canvas:
    """A line that runs round a loop and out along a stick, across yellow, to red."""
    canvas = blank(LIGHT_GREY)
    middle: Point = (650.5, 571.5)
    paint(canvas, BLACK, ellipse(middle, 250.5, 200.5))
    paint(canvas, LIGHT_GREY, ellipse(middle, 230.5, 180.5))
    paint(canvas, LIGHT_GREY, polygon(OPENING))
    paint(canvas, BLACK, polygon(UPPER_BRANCH))
    paint(canvas, BLACK, polygon(LOWER_BRANCH))
    rect(canvas, YELLOW, (1680, 371, 1721, 772))
    rect(canvas, BLACK, (930, 549, 1880, 572))
    rect(canvas, RED, (1880, 371, 1921, 772))
    return canvas


def noisy_lollipop() -> Canvas:
    """The lollipop, mottled and blurred."""
    return speckled(lollipop())


def testcard() -> Canvas:
    """Three television test cards, one of them on its side, in a thin frame."""
    canvas = blank()
    frame: Rgb = (15, 15, 15)
    right, bottom = 2215, 1073
    for line in (
        (0, 0, right, 1),
        (0, bottom - 1, right, bottom),
        (0, 0, 1, bottom),
        (right - 1, 0, right, bottom),
    ):
        rect(canvas, frame, line)
    card(canvas, Placement(1485.44, 527.98, 67.4913, 67.536, ramp_white=0.045))
    card(canvas, Placement(404.62, 804.27, 29.995, 30.019, ramp_white=0.083))
    card(canvas, Placement(365.07, 326.8, 22.497, 22.513, ramp_white=0.11, turned=True))
    return canvas


MATS: Mapping[str, Callable[[], Canvas]] = {
    "Empty_Map": empty_map,
    "Grey_bands": grey_bands,
    "Grey_and_black": grey_and_black,
    "Coloured_bands": coloured_bands,
    "Rainbow_bands": rainbow_bands,
    "Linear_grey": linear_grey,
    "Radial_grey": radial_grey,
    "Radial_red": radial_red,
    "Loop": loop,
    "Square": square,
    "Two_shapes": two_shapes,
    "Lollipop": lollipop,
    "Testcard": testcard,
    "Noisy_Lollipop": noisy_lollipop,
    "Line_Following_Test": line_following_test,
    "Junction_Handling_Test": junction_handling_test,
    "Obstacles_Test": obstacles_test,
    "Thruxton_Circuit": thruxton_circuit,
    "Simple_Shapes": simple_shapes,
    "Sensor_Diameter_Test": sensor_diameter_test,
    "Topo_map": topo_map,
    "MNIST_Digits": mnist_digits,
    "MNIST_Digits_Black": mnist_digits_black,
    "Harvest_Trail": harvest_trail,
    "Space_Port": space_port,
    "Harbour": harbour,
}
"""Every mat by name."""


def picture(name: str) -> NDArray[np.uint8]:
    """Return one mat of `MATS`, shape (HEIGHT, WIDTH, 3)."""
    return finished(MATS[name]())
