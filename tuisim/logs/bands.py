"""Bands: the plateaus of a log with times, distances, widths, and the names of their greys."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from math import sqrt
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.core.css_colors import css_names
from tuisim.data_class import dataclass
from tuisim.errors import counted
from tuisim.logs.columns import numeric_columns
from tuisim.logs.plateaus import Plateau, Search, plateaus
from tuisim.runs.arrays import FloatArray

if TYPE_CHECKING:
    from tuisim.logs.log import Log, Series

NEAR_PERCENT = 2.0
"""Largest distance from a named grey."""

FULL = 255.0

_PLAIN_NAMES = MappingProxyType({0: "black", 128: "grey", 255: "white", 211: "light grey", 220: "pale grey",
                                 169: "dark grey", 105: "dim grey", 192: "silver"})  # fmt: skip
"""Common names by channel value; the others are those of CSS."""


@dataclass(frozen=True, slots=True)
class Grey:
    """A grey with a name."""

    name: str
    percent: float
    """100 is white."""


@cache
def greys() -> Mapping[int, Grey]:
    """Return the named greys by channel value, 0 to 255."""
    found = {red: name for name, (red, green, blue) in css_names().items() if red == green == blue}
    found |= _PLAIN_NAMES
    return {value: Grey(name, 100.0 * value / FULL) for value, name in sorted(found.items())}


def nearest_grey(percent: float) -> Grey | None:
    """Return the grey nearest to a level of 0 to 100 %, None if none is within NEAR_PERCENT."""
    best = min(greys().values(), key=lambda grey: abs(grey.percent - percent))
    return best if abs(best.percent - percent) <= NEAR_PERCENT else None


def without_clamping(percent: float, noise: int) -> float:
    """Return the true level from the mean of noisy pixels.

    Noise is uniform within ±`noise`, and values outside 0 to 255 are clamped, so that
    near both ends the mean is too far inside. The mean of a pixel of value 255 - u, u
    below the noise, is 255 - (noise + u)² / (4 noise).

    Args:
        percent: Mean level, 0 to 100.
        noise: Light noise of the run, 0 to 128.
    """
    if not noise:
        return percent
    value = percent * FULL / 100.0
    return 100.0 * _unclamped(FULL - _unclamped(FULL - value, noise), noise) / FULL


def _unclamped(below: float, noise: int) -> float:
    """Undo the clamping at one end; `below` is the distance from it."""
    if below >= noise:
        return below
    return max(0.0, 2.0 * sqrt(noise * max(below, 0.0)) - noise)


NAN = float("nan")
ONE_SAMPLE = "one sample"
"""Marks a level that only the first or the last sample of the log has."""


@dataclass(frozen=True, slots=True)
class Band:
    """One plateau of one variable."""

    variable: str
    number: int
    """From 1, in order of time."""
    start_s: float
    """Time of its first sample."""
    stop_s: float
    """Time of its last sample."""
    samples: int
    level: float
    """Mean without strays."""
    spread: float
    """Standard deviation."""
    strays: int
    grey: str
    """Name of the nearest grey; empty if there is none, or if the variable is not a light level."""
    grey_percent: float
    """The level of that grey."""
    true_level: float
    """The level, corrected for clamped noise near the ends of the scale."""
    start_mm: float
    """Distance driven at the first sample; NaN if the log has no positions."""
    stop_mm: float
    """Distance driven at the last sample."""
    width_mm: float
    """From halfway to the sample before it to halfway to the one after it."""
    first_row: int
    """Row of its first sample in the table, from 0."""
    last_row: int


@dataclass(frozen=True, slots=True)
class BandReport:
    """The bands of one variable."""

    variable: str
    bands: tuple[Band, ...]
    transitions: int
    """Samples on edges, which belong to no band."""
    total: int


def band_report(log: Log, name: str, search: Search = plateaus) -> BandReport:
    """Return the bands of a variable, whose plateaus `search` returns.

    Raises:
        LogError: there is no such variable.
    """
    series = log.series(name)
    found = search(series.values)
    driven = driven_mm(log, series)
    scale, noise = light_scale(series.values), light_noise(log.metadata, series.run)
    bands = tuple(_band(series, number, plateau, driven, scale, noise) for number, plateau in enumerate(found, 1))
    total = int(np.isfinite(series.values).sum())
    return BandReport(name, bands, total - sum(band.samples for band in bands), total)


def _band(series: Series, number: int, plateau: Plateau, driven: FloatArray | None, scale: float, noise: int) -> Band:
    first, last = plateau.start, plateau.stop - 1
    start_mm = stop_mm = width_mm = NAN
    if driven is not None:
        before, after = max(first - 1, 0), min(last + 1, len(driven) - 1)
        start_mm, stop_mm = float(driven[first]), float(driven[last])
        width_mm = float(driven[last] + driven[after] - driven[first] - driven[before]) / 2.0
    true_level, grey = plateau.level, None
    if scale:
        percent = without_clamping(plateau.level * scale, noise)
        true_level = percent / scale if noise else plateau.level
        grey = nearest_grey(percent)
    return Band(
        variable=series.name,
        number=number,
        start_s=float(series.time_s[first]),
        stop_s=float(series.time_s[last]),
        samples=int(np.isfinite(series.values[first : plateau.stop]).sum()),
        level=plateau.level,
        spread=plateau.spread,
        strays=plateau.strays,
        grey=grey.name if grey else "",
        grey_percent=grey.percent if grey else NAN,
        true_level=true_level,
        start_mm=start_mm,
        stop_mm=stop_mm,
        width_mm=width_mm,
        first_row=int(series.rows[first]),
        last_row=int(series.rows[last]),
    )


def light_scale(values: FloatArray) -> float:
    """Return the factor from light readings to percent: 1 for 0 to 100, 100/255 for 0 to 255; 0 for other values."""
    finite = values[np.isfinite(values)]
    if not len(finite) or finite.min() < 0.0 or finite.max() > 255.0:
        return 0.0
    return 1.0 if finite.max() <= 100.0 else 100.0 / 255.0


def light_noise(metadata: Mapping[str, Any], run: int) -> int:
    """Return the light noise of a run (0: the first) from the metadata of its log; 0 if they do not say."""
    try:
        found = [entry for entry in metadata["runs"] if isinstance(entry, Mapping) and run in (0, entry.get("run"))]
        return int(found[0]["world"]["noise"]["light"])
    except (IndexError, KeyError, TypeError, ValueError, OverflowError):
        return 0


def driven_mm(log: Log, series: Series) -> FloatArray | None:
    """Return the distance driven at each sample, shape (n,); None if the log has no positions."""
    if not {"x_mm", "y_mm"} <= set(numeric_columns(log.table.schema)) or not len(series.rows):
        return None
    x_mm, y_mm = (log.numbers(name)[series.rows] for name in ("x_mm", "y_mm"))
    if not (np.isfinite(x_mm).all() and np.isfinite(y_mm).all()):
        return None
    return distance_mm(x_mm, y_mm)


def distance_mm(x_mm: FloatArray, y_mm: FloatArray) -> FloatArray:
    """Return the distance along a path since its first point, shape (n,)."""
    if not len(x_mm):
        return np.empty(0)
    return np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm)))))


def in_words(report: BandReport) -> str:
    """Return the levels of a report in words, for people."""
    levels: dict[str, list[Band]] = {}
    for band in report.bands:
        levels.setdefault(band.grey or f"{band.true_level:.4g}", []).append(band)
    said = []
    for grey, bands in levels.items():
        samples = sum(band.samples for band in bands)
        level = sum(band.true_level * band.samples for band in bands) / samples
        times = f" ({len(bands)}x)" if len(bands) > 1 else f" ({ONE_SAMPLE})" if samples == 1 else ""
        said.append(f"{level:.2f}{f' {grey}' if bands[0].grey else ''}{times}")
    known = f"{counted(len(levels), 'level')}{': ' * bool(said)}{', '.join(said)}"
    edges = f"{report.transitions} of {report.total} samples {'lies' if report.transitions == 1 else 'lie'} on edges"
    return f"{report.variable}: {known}; {edges}"
