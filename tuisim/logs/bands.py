"""Bands: the plateaus of a log with times, distances, widths, and the names of their greys."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache, cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tuisim.core.css_colors import css_names
from tuisim.data_class import dataclass
from tuisim.errors import counted
from tuisim.logs.columns import numeric_columns
from tuisim.logs.plateaus import FIELDS, Search, plateaus
from tuisim.runs.arrays import FloatArray, IntArray

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


def nearest_greys(percents: FloatArray) -> list[Grey | None]:
    """Return the grey nearest to each level of 0 to 100 %, None if none is within NEAR_PERCENT."""
    named = list(greys().values())
    nearest = np.zeros(len(percents), np.int64)
    least = np.full(len(percents), np.inf)
    for at, grey in enumerate(named):
        apart = np.abs(grey.percent - percents)
        nearest[apart < least] = at
        least = np.minimum(least, apart)
    nearest[least > NEAR_PERCENT] = -1
    return [None if at < 0 else named[at] for at in nearest.tolist()]


def without_clamping(percents: FloatArray, noise: int) -> FloatArray:
    """Return the true levels from the means of noisy pixels.

    Noise is uniform within ±`noise`, and values outside 0 to 255 are clamped, so that
    near both ends the mean is too far inside. The mean of a pixel of value 255 - u, u
    below the noise, is 255 - (noise + u)² / (4 noise).

    Args:
        percents: Mean levels, 0 to 100.
        noise: Light noise of the run, 0 to 128.
    """
    if not noise:
        return percents
    values = percents * FULL / 100.0
    return 100.0 * _unclamped(FULL - _unclamped(FULL - values, noise), noise) / FULL


def _unclamped(below: FloatArray, noise: int) -> FloatArray:
    """Undo the clamping at one end; `below` are the distances from it."""
    undone = np.maximum(0.0, 2.0 * np.sqrt(noise * np.maximum(below, 0.0)) - noise)
    return np.where(below >= noise, below, undone)


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


Column = NDArray[Any] | Sequence[str]


@dataclass(frozen=True, eq=False)
class BandReport:
    """The bands of one variable."""

    variable: str
    columns: Mapping[str, Column]
    """The fields of the bands by name, in their order: numbers as arrays, texts as lists, each of shape (n,)."""
    transitions: int
    """Samples on edges, which belong to no band."""
    total: int

    @property
    def count(self) -> int:
        """Number of bands."""
        return len(self.columns["number"])

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """The bands one by one; a long log has a hundred thousand, which take long to make."""
        return tuple(map(Band, *map(items_of, self.columns.values())))


def items_of(column: Column) -> Sequence[Any]:
    """Return the items of a column as Python's own objects."""
    return column.tolist() if isinstance(column, np.ndarray) else column


def band_report(log: Log, name: str, search: Search = plateaus) -> BandReport:
    """Return the bands of a variable, whose plateaus `search` returns.

    Raises:
        LogError: there is no such variable.
    """
    series = log.series(name)
    found = np.array(search(series.values), FIELDS)
    scale, noise = light_scale(series.values), light_noise(log.metadata, series.run)
    finite = np.append(0, np.cumsum(np.isfinite(series.values)))
    first, last, level = found["start"], found["stop"] - 1, found["level"]
    samples = finite[last + 1] - finite[first]
    true_level = level
    greys_near: list[Grey | None] = [None] * len(found)
    if scale:
        percents = without_clamping(level * scale, noise)
        true_level = percents / scale if noise else level
        greys_near = nearest_greys(percents)
    columns = {
        "variable": [series.name] * len(found),
        "number": np.arange(1, len(found) + 1),
        "start_s": series.time_s[first],
        "stop_s": series.time_s[last],
        "samples": samples,
        "level": level,
        "spread": found["spread"],
        "strays": found["strays"],
        "grey": [grey.name if grey else "" for grey in greys_near],
        "grey_percent": np.array([grey.percent if grey else NAN for grey in greys_near]),
        "true_level": true_level,
        **_places(driven_mm(log, series), first, last),
        "first_row": series.rows[first],
        "last_row": series.rows[last],
    }
    total = int(finite[-1])
    return BandReport(name, columns, total - int(samples.sum()), total)


def _places(driven: FloatArray | None, first: IntArray, last: IntArray) -> dict[str, FloatArray]:
    """Return where bands begin and end, and their widths, from the first and the last sample of each."""
    if driven is None:
        return dict.fromkeys(("start_mm", "stop_mm", "width_mm"), np.full(len(first), NAN))
    before, after = np.maximum(first - 1, 0), np.minimum(last + 1, len(driven) - 1)
    start_mm, stop_mm = driven[first], driven[last]
    width_mm = (stop_mm + driven[after] - start_mm - driven[before]) / 2.0
    return {"start_mm": start_mm, "stop_mm": stop_mm, "width_mm": width_mm}


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
    x_mm, y_mm = (log.numbers_at(name, series.rows) for name in ("x_mm", "y_mm"))
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
    levels: dict[str, list[tuple[str, float, int]]] = {}
    for band in zip(*(items_of(report.columns[name]) for name in ("grey", "true_level", "samples")), strict=True):
        levels.setdefault(band[0] or f"{band[1]:.4g}", []).append(band)
    said = []
    for bands in levels.values():
        samples = sum(count for *_, count in bands)
        level = sum(true_level * count for _, true_level, count in bands) / samples
        times = f" ({len(bands)}x)" if len(bands) > 1 else f" ({ONE_SAMPLE})" if samples == 1 else ""
        grey = bands[0][0]
        said.append(f"{level:.2f}{' ' * bool(grey)}{grey}{times}")
    known = f"{counted(len(levels), 'level')}{': ' * bool(said)}{', '.join(said)}"
    edges = f"{report.transitions} of {report.total} samples {'lies' if report.transitions == 1 else 'lie'} on edges"
    return f"{report.variable}: {known}; {edges}"
