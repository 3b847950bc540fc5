"""Mats that a seed draws, for the other worlds of a task: a program that knows one mat by heart fails on them."""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Mapping
from random import Random
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

_BAND_TOP_MM, _BAND_BOTTOM_MM = 993, 242
"""The y of the bands' ends, as on the mat Grey_bands."""
_FIRST_MM, _LAST_MM = 300.0, 1850.0
"""All bands are between these x: the robot starts before the first, and stops behind the second."""
_GREY_STEP = 28
"""The least difference of the greys of two bands, or of a band and the mat, from 0 to 255."""
_LINE_MM = 30.0
_WAVES = ((1700.0, 190.0), (900.0, 90.0), (520.0, 35.0))
"""Length and largest height of the waves that make up a line; it can be followed everywhere, and stays on the mat."""
_LINE_START_MM, _LINE_END_MM = 150.0, 2200.0


@dataclass(frozen=True, slots=True)
class DrawnMat:
    """A mat that was drawn at random, with its start and bands."""

    pixels: Array
    """A mm each, shape (h, w, 3)."""
    start: tuple[float, float, float]
    """Where the robot may start: x and y in mm, heading in degrees."""
    bands: tuple[tuple[float, float, float], ...] = ()
    """Left and right edge of each band in mm, and its level in percent, from left to right."""

    @property
    def png(self) -> bytes:
        """The image of the mat as a PNG file."""
        from PIL import Image

        content = io.BytesIO()
        Image.fromarray(self.pixels).save(content, "png")
        return content.getvalue()

    def format_world_lines(self, image: str) -> list[str]:
        """Return the lines of a goals file that make the mat a hidden world.

        Args:
            image: The name of the mat's file, in the folder of the goals file.
        """
        x_mm, y_mm, heading_deg = self.start
        lines = [
            "[[also]]",
            'where = "on another mat"',
            "hidden = true",
            f'background = "{image}"',
            f"start = {{ x_mm = {x_mm:g}, y_mm = {y_mm:g}, heading_deg = {heading_deg:g} }}",
        ]
        lines += [
            f"# a band from x {left_mm:g} to {right_mm:g} mm: {level:g} %"
            for left_mm, right_mm, level in self.bands
        ]
        if self.bands:
            levels = ", ".join(f"{level:g}" for *_, level in self.bands)
            lines += [
                "# [[also.goal]]",
                '# name = "levels"',
                f'# log = {{ name = "Colour", levels = [{levels}], reading = "color" }}',
            ]
        return lines


def _build_white_mat() -> Array:
    import numpy as np

    return np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)


def _draw_bands(chance: Random) -> DrawnMat:
    """Return a mat with three to five vertical bands, the last one black."""
    pixels = _build_white_mat()
    count = 3 + int(3 * chance.random())
    greys: list[int] = [0]
    while len(greys) < count:
        grey = int((255 - _GREY_STEP) * chance.random())
        if all(abs(grey - other) >= _GREY_STEP for other in greys):
            greys.insert(0, grey)
    room_mm = (_LAST_MM - _FIRST_MM) / count
    bands = []
    for number, grey in enumerate(greys):
        width_mm = int(room_mm * (0.35 + 0.25 * chance.random()))
        # The factor 0.85 leaves enough white between two bands for a sensor.
        left_mm = int(_FIRST_MM + room_mm * number + (room_mm * 0.85 - width_mm) * chance.random())
        pixels[
            FIELD_HEIGHT_MM - _BAND_TOP_MM : FIELD_HEIGHT_MM - _BAND_BOTTOM_MM,
            left_mm : left_mm + width_mm,
        ] = grey
        bands.append((left_mm, left_mm + width_mm, round(100 * grey / 255, 1)))
    return DrawnMat(pixels, (150.0, 500.0, 0.0), tuple(bands))


def _draw_line(chance: Random) -> DrawnMat:
    """Return a mat with a curved black line from left to right."""
    import numpy as np

    pixels = _build_white_mat()
    waves = [
        (length, height * (0.5 + chance.random() / 2), math.tau * chance.random())
        for length, height in _WAVES
    ]

    def at(x_mm: Any) -> tuple[Any, Any]:
        """Return y in mm and slope of the line at some x."""
        turns = [
            (height, math.tau / length, math.tau * x_mm / length + begin)
            for length, height, begin in waves
        ]
        height_mm = sum(height * np.sin(turn) for height, _, turn in turns)
        return FIELD_HEIGHT_MM / 2 + height_mm, sum(
            height * rate * np.cos(turn) for height, rate, turn in turns
        )

    x_mm = np.arange(FIELD_WIDTH_MM) + 0.5
    y_mm, slope = at(x_mm)
    rows_mm = FIELD_HEIGHT_MM - 0.5 - np.arange(FIELD_HEIGHT_MM)[:, None]
    on_line = np.abs(rows_mm - y_mm) <= _LINE_MM / 2 * np.hypot(1, slope)
    pixels[on_line & (x_mm >= _LINE_START_MM) & (x_mm <= _LINE_END_MM)] = 0
    y_start_mm, first_slope = at(_LINE_START_MM + 50)
    heading_deg = math.degrees(math.atan(first_slope))
    return DrawnMat(
        pixels, (_LINE_START_MM + 50, round(float(y_start_mm), 1), round(heading_deg, 1))
    )


DRAWN_MATS: Mapping[str, Callable[[Random], DrawnMat]] = {"bands": _draw_bands, "line": _draw_line}
"""The kinds of drawn mats. To add one: write its function and a line here."""


def generate_mat(kind: str, seed: int) -> DrawnMat:
    """Return a mat of a kind, one of `DRAWN_MATS`, drawn at random from a seed."""
    return DRAWN_MATS[kind](Random(seed))
