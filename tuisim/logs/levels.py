"""The levels of samples: plateaus, the true value of each without the clamping of noise, and the name of its grey."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.css_colors import load_css_colors
from tuisim.engine.core.sensors.color import find_response
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.magnitude import find_scale
from tuisim.logs.plateaus import Search, find_plateaus
from tuisim.logs.units import can_be_light, names_level

NEAR_PERCENT = 2.0
"""A level gets the name of the nearest grey if the two differ by at most this, where white is 100."""

FULL = 255.0

_PLAIN_NAMES = MappingProxyType({0: "black", 128: "grey", 255: "white", 211: "light grey", 220: "pale grey",
                                 169: "dark grey", 105: "dim grey", 192: "silver"})  # fmt: skip
"""Common names of greys by their channel value, 0 to 255; all other greys have their names in CSS."""


@dataclass(frozen=True, slots=True)
class Grey:
    """A grey that the printed mats have, with its name."""

    name: str
    percent: float
    """Lightness of the grey in percent: 0 is black, and 100 is white."""


@cache
def list_greys() -> Mapping[int, Grey]:
    """Return the named greys by their channel value, 0 to 255."""
    names = {
        red: name for name, (red, green, blue) in load_css_colors().items() if red == green == blue
    }
    names |= _PLAIN_NAMES
    return {value: Grey(name, 100.0 * value / FULL) for value, name in sorted(names.items())}


def find_nearest_greys(percents: FloatArray) -> list[Grey | None]:
    """Return for each level of 0 to 100 % the nearest named grey; None where none is within `NEAR_PERCENT`."""
    named = list(list_greys().values())
    apart = np.abs(np.array([grey.percent for grey in named]) - percents[:, None])
    nearest = np.where((apart <= NEAR_PERCENT).any(axis=1), apart.argmin(axis=1), -1)
    return [None if index < 0 else named[index] for index in nearest.tolist()]


def undo_clamping(percents: FloatArray, noise: int) -> FloatArray:
    """Return the true levels in percent from the means of noisy pixels.

    Noise changes a pixel by at most ±`noise`, and a value outside 0 to 255 is set to the nearest end. Near an end, the
    mean of the noisy pixels is therefore too far from it. A pixel that is u below 255, with u less than the noise, has
    the mean 255 - (noise + u)² / (4 noise); this function computes u from that mean.

    Args:
        percents: Mean levels, 0 to 100.
        noise: Light noise of the run, 0 to 128.
    """
    if not noise:
        return percents
    values = percents * FULL / 100.0
    return 100.0 * _undo_end_clamping(FULL - _undo_end_clamping(FULL - values, noise), noise) / FULL


def _undo_end_clamping(below: FloatArray, noise: int) -> FloatArray:
    """Return how far levels really are from one end of the scale, given how far they seem to be after clamping.

    Args:
        below: The distances from the end after clamping.
        noise: Light noise of the run, in the same unit.
    """
    undone = np.maximum(0.0, 2.0 * np.sqrt(noise * np.maximum(below, 0.0)) - noise)
    return np.where(below >= noise, below, undone)


def _has_light_levels(name: str, values: FloatArray) -> bool:
    """Return whether a variable can have levels of light, which greys of the mat cause.

    False if its name says otherwise, or if all values are whole numbers from 0 to 7: these are taken for codes of
    colours, such as 6 for white, unless the name says that they are levels.
    """
    if not can_be_light(name):
        return False
    are_codes = np.isin(values[np.isfinite(values)], np.arange(len(COLOR_NAMES))).all()
    return names_level(name) or not are_codes


def find_light_scale(values: FloatArray) -> float:
    """Return the factor from light readings to percent: 1 for 0 to 100, 100/255 for 0 to 255; 0 for other values."""
    finite = values[np.isfinite(values)]
    if not len(finite) or finite.min() < 0.0 or finite.max() > 255.0:
        return 0.0
    return 1.0 if finite.max() <= 100.0 else 100.0 / 255.0


class Light(NamedTuple):
    """How a colour sensor reads the mat: its noise, and its readings of black and white."""

    noise: int = 0
    """The light noise that was set for the run, 0 to 128; 0 is none."""
    black: float = 0.0
    """What the colour sensor reads on black, in percent."""
    white: float = 100.0
    """What the colour sensor reads on white, in percent."""

    def undo_response(self, percents: FloatArray) -> FloatArray:
        """Return the greys of the mat, 0 to 100 %, for which the sensor gives these readings, 0 to 100."""
        return (percents - self.black) / ((self.white - self.black) / 100.0)

    def seen(self, percents: FloatArray) -> FloatArray:
        """Return the sensor's readings, 0 to 100, for greys of the mat, 0 to 100 %."""
        return self.black + percents * ((self.white - self.black) / 100.0)


def find_light(spec: RunSpec | None) -> Light:
    """Return how the first colour sensor of a run reads the mat; without a sensor, only the noise is known."""
    if spec is None:
        return Light()
    noise = spec.world.noise.light
    for sensor in spec.robot.color_sensors:
        dark, span = find_response(sensor, spec.profile)
        return Light(noise, 100.0 * dark / FULL, 100.0 * (dark + span) / FULL)
    return Light(noise)


@dataclass(frozen=True, eq=False)
class Levels:
    """The plateaus of the samples of one variable, with their levels and greys."""

    start: IntArray
    """Index of the first sample of each plateau, shape (n,)."""
    stop: IntArray
    """Index of the last sample of each plateau plus 1, shape (n,)."""
    level: FloatArray
    """Mean of the samples of each plateau without strays, shape (n,)."""
    true_level: FloatArray
    """The level of each plateau, corrected for clamped noise near the ends of the scale, shape (n,)."""
    spread: FloatArray
    strays: IntArray
    greys: tuple[str, ...]
    """The name of the grey nearest to the level of each plateau; empty if none is near, or if the samples are not light
    levels.
    """
    grey_percent: FloatArray
    """The sensor's reading of the grey in `greys` for each plateau, in percent, shape (n,); NaN without a grey."""


def measure_levels(
    name: str, values: FloatArray, light: Light, search: Search = find_plateaus
) -> Levels:
    """Return the plateaus of samples, with their levels and greys.

    Args:
        name: The variable, which tells whether these are levels of light.
        values: The samples, shape (n,).
        light: How a sensor reads levels of light from the mat.
        search: Finds the plateaus.
    """
    finite = values[np.isfinite(values)]
    magnitude = find_scale(float(finite.min()), float(finite.max())) if len(finite) else 1.0
    plateaus = search(values if magnitude == 1.0 else values / magnitude)
    level = plateaus["level"] * magnitude
    scale = find_light_scale(values) if _has_light_levels(name, values) else 0.0
    true_level = level
    greys: list[Grey | None] = [None] * len(level)
    if scale:
        percents = undo_clamping(light.undo_response(level * scale), light.noise)
        true_level = light.seen(percents) / scale if light.noise else level
        greys = find_nearest_greys(percents)
    return Levels(
        plateaus["start"],
        plateaus["stop"],
        level,
        true_level,
        plateaus["spread"] * magnitude,
        plateaus["strays"],
        tuple(grey.name if grey else "" for grey in greys),
        light.seen(np.array([grey.percent if grey else np.nan for grey in greys])),
    )
