"""Bands: the plateaus of a log with times, distances, widths, and the names of their greys.

A width goes from the edge before a level to the edge after it. The light sensor sees a spot, so that its reading passes
an edge gradually, and is halfway between two levels where the edge lies in the middle of the spot.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.runs.arrays import FloatArray, IntArray, number_members
from tuisim.logs.columns import list_numeric_columns
from tuisim.logs.levels import Levels, Light, find_light, has_light_levels, measure_levels
from tuisim.logs.plateaus import Search, find_plateaus

if TYPE_CHECKING:
    from tuisim.logs.log import Log, Series

NAN = float("nan")
ONE_SAMPLE = "one sample"
"""Marks a level that only the first or the last sample of the log has."""
CUT_OFF = "cut off"
"""Stands for the width of a band on which the log begins or ends."""
NO_EDGE = "no edge"
"""Stands for the width of a band with other samples between it and a neighbour, so that its edge is not known."""


@dataclass(frozen=True, slots=True)
class Band:
    """A plateau of one variable, such as a grey band in the readings of a sensor, with its level, times and width."""

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
    """Standard deviation of its samples without strays (divided by n - 1), 0 for a single sample."""
    strays: int
    """Samples that lie far off."""
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
    """From the edge before it to the edge after it, where readings are halfway between two levels; NaN if unknown."""
    cut_off: bool
    """Whether the log begins or ends on it, so that its width is not known."""
    first_row: int
    """Row of its first sample in the table, from 0."""
    last_row: int


Column = NDArray[Any] | Sequence[str]


@dataclass(frozen=True, eq=False)
class BandReport:
    """The bands that were found in one variable of a log, as columns."""

    variable: str
    columns: Mapping[str, Column]
    """The fields of the bands by name, in their order: numbers as arrays, texts as lists, each of shape (n,)."""
    transitions: int
    """Samples on edges and slopes, which belong to no band."""
    total: int

    @property
    def count(self) -> int:
        """The number of bands of the variable."""
        return len(self.columns["number"])

    @cached_property
    def has_true_levels(self) -> bool:
        """Whether the true level of any band differs from its measured level.

        They differ near the ends of the scale: noise is cut off there, so the mean of the samples is not the level.
        """
        return bool(np.any(self.columns["true_level"] != self.columns["level"]))

    @cached_property
    def bands(self) -> tuple[Band, ...]:
        """The bands as objects; for a long log with a hundred thousand bands, creating them is slow."""
        return tuple(map(Band, *map(unpack_column, self.columns.values())))


def count_samples(band: Band) -> str:
    """Return the number of samples of a band as text, such as `12, 1 stray`.

    A stray is a sample that is far from the level of the band. Strays do not affect the band's level and spread.
    """
    strays = f", {counted(band.strays, 'stray')}" if band.strays else ""
    return f"{band.samples}{strays}"


def unpack_column(column: Column) -> Sequence[Any]:
    """Return the items of a column as Python objects."""
    return column.tolist() if isinstance(column, np.ndarray) else column


def build_band_report(log: Log, name: str, search: Search = find_plateaus) -> BandReport:
    """Return the bands of a variable.

    Args:
        log: The log.
        name: The variable.
        search: Returns the plateaus of an array of samples; each plateau is a band.

    Raises:
        LogError: the log has no variable of that name.
    """
    series = log.series(name)
    spec = log.find_spec(max(series.run - 1, 0))
    light = find_light(spec) if spec else Light()
    levels = measure_levels(
        series.values, light if has_light_levels(name, series.values) else None, search
    )
    finite = np.append(0, np.cumsum(np.isfinite(series.values)))
    first, last = levels.start, levels.stop - 1
    samples = finite[last + 1] - finite[first]
    columns = {
        "variable": [series.name] * len(first),
        "number": np.arange(1, len(first) + 1),
        "start_s": series.time_s[first],
        "stop_s": series.time_s[last],
        "samples": samples,
        "level": levels.level,
        "spread": levels.spread,
        "strays": levels.strays,
        "grey": [grey.name if grey else "" for grey in levels.greys],
        "grey_percent": light.seen(
            np.array([grey.percent if grey else NAN for grey in levels.greys])
        ),
        "true_level": levels.true_level,
        **_measure_places(compute_driven_mm(log, series), series.values, levels),
        "cut_off": (finite[first] == 0) | (finite[last + 1] == finite[-1]),
        "first_row": series.rows[first],
        "last_row": series.rows[last],
    }
    total = int(finite[-1])
    return BandReport(name, columns, total - int(samples.sum()), total)


def _measure_places(
    driven: FloatArray | None, values: FloatArray, levels: Levels
) -> dict[str, FloatArray]:
    """Return where bands begin and end, and how wide they are: the columns `start_mm`, `stop_mm` and `width_mm`.

    Args:
        driven: The distance driven at each sample in mm; with None, as for a log without positions, all values are NaN.
        values: The samples.
        levels: The bands.
    """
    if driven is None:
        unknown = np.full(len(levels.start), NAN)
        return dict.fromkeys(("start_mm", "stop_mm", "width_mm"), unknown)
    return {
        "start_mm": driven[levels.start],
        "stop_mm": driven[levels.stop - 1],
        "width_mm": measure_widths(values, driven, levels),
    }


def describe_width(band: Band) -> str:
    """Return the width of a band in mm as text.

    If the width is unknown, the text is `CUT_OFF` for a band at an end of the log, and `NO_EDGE` for any other band. It
    is empty for a log without positions.
    """
    if not isfinite(band.start_mm):
        return ""
    if isfinite(band.width_mm):
        return f"{band.width_mm:.0f}"
    return CUT_OFF if band.cut_off else NO_EDGE


def compute_driven_mm(log: Log, series: Series) -> FloatArray | None:
    """Return the distance driven at each sample in mm, shape (n,); None if the log has no positions."""
    if not {"x_mm", "y_mm"} <= set(list_numeric_columns(log.table.schema)) or not len(series.rows):
        return None
    x_mm, y_mm = (log.pick_numbers(name, series.rows) for name in ("x_mm", "y_mm"))
    if not (np.isfinite(x_mm).all() and np.isfinite(y_mm).all()):
        return None
    return np.append(0.0, np.cumsum(np.hypot(np.diff(x_mm), np.diff(y_mm))))


def describe_levels(report: BandReport) -> str:
    """Return the levels of a variable's bands as a text of one line.

    Each level has its grey after it and, if several bands have this level, their number, such as `50.20 grey (3x)`. If
    the width of a band is `NO_EDGE`, the text says why.
    """
    if not report.count:
        return f"{report.variable}: no level: its values stand still nowhere"
    levels = _group_levels(report)
    parts = []
    for bands in levels:
        samples = sum(count for _, _, count, _ in bands)
        level = sum(level * count for _, level, count, _ in bands) / samples
        if len(bands) > 1:
            times = f" ({len(bands)}x)"
        elif samples == 1:
            times = f" ({ONE_SAMPLE})"
        else:
            times = ""
        grey = bands[0][0]
        parts.append(f"{level:.2f}{' ' * bool(grey)}{grey}{times}")
    known = f"{counted(len(levels), 'level')}: {', '.join(parts)}"
    lie = "lies" if report.transitions == 1 else "lie"
    edges = f"{report.transitions} of {report.total} samples {lie} on edges or slopes"
    places, widths, cut_off = (report.columns[name] for name in ("start_mm", "width_mm", "cut_off"))
    has_reason = bool(np.any(np.isfinite(places) & np.isnan(widths) & ~np.asarray(cut_off)))
    reason = f"; {NO_EDGE}: other samples lie between this band and the next" if has_reason else ""
    return f"{report.variable}: {known}; {edges}{reason}"


_Level = tuple[str, float, int, float]
"""Grey, level, number of samples and spread of a band."""


def _group_levels(report: BandReport) -> list[list[_Level]]:
    """Return grey, level, number of samples and spread of the bands, grouped by level, in order of their first bands.

    Bands have the same level if they have the same grey or, without one, if their levels differ by no more than the
    spread of their samples.
    """
    names = ("grey", "level", "samples", "spread")
    bands = list(zip(*(unpack_column(report.columns[name]) for name in names), strict=True))
    keys: list[object] = [grey for grey, *_ in bands]
    first: _Level | None = None
    for index in sorted(range(len(bands)), key=lambda place: bands[place][1]):
        grey, level, _, spread = bands[index]
        if grey:
            continue
        if first is None or (
            level - first[1] > max(spread, first[3]) and f"{level:.4g}" != f"{first[1]:.4g}"
        ):
            first = bands[index]
        keys[index] = first
    groups: dict[object, list[_Level]] = {}
    for key, band in zip(keys, bands, strict=True):
        groups.setdefault(key, []).append(band)
    return list(groups.values())


_MAX_EDGE_MM = 100.0
_MAX_EDGE_STEPS = 8
"""A passage between two levels of more mm and more steps of the log is a slope: the spot of a sensor is far smaller."""

_FAR_OF_STEP, _FAR_OF_SPREAD = 0.75, 4.0
"""A sample between two levels is of a third one, farther from their middle than these parts of step and spread."""


@np.errstate(over="ignore", invalid="ignore")
def measure_widths(values: FloatArray, driven_mm: FloatArray, levels: Levels) -> FloatArray:
    """Return the widths of levels in mm, shape (n,): each from the edge before the level to the edge after it.

    A width is NaN where an edge is not known: before the first level, after the last level, and between two levels with
    samples of another level, or a slope, between them.

    Args:
        values: Samples, shape (m,).
        driven_mm: The distance driven at each of them, shape (m,).
        levels: The n levels of the samples.
    """
    rows = np.flatnonzero(np.isfinite(values))
    # From the last sample of each level to the first of the next, each pair of neighbours has its level and its row.
    last, first = np.searchsorted(rows, np.stack((levels.stop[:-1] - 1, levels.start[1:])))
    level, number = number_members(first - last)
    row = last[level] + number
    places_mm = driven_mm[rows]
    edges_mm = _find_edges(values[rows], places_mm, levels, level, row)
    is_slope = (places_mm[first] - places_mm[last] > _MAX_EDGE_MM) & (
        first - last > _MAX_EDGE_STEPS
    )
    edges_mm[is_slope] = np.nan
    return np.diff(edges_mm, prepend=np.nan, append=np.nan)[: len(levels.start)]


def _find_edges(
    values: FloatArray, driven_mm: FloatArray, levels: Levels, level: IntArray, row: IntArray
) -> FloatArray:
    """Return the position in mm at which samples pass the value midway between each level and the next, shape (n - 1,).

    With noise, samples may pass the middle several times: the edge is then midway between the first and the last time.
    The position is NaN if samples of a third level lie between two levels.

    Each edge is searched in all pairs of neighbouring samples from the last sample of a level to the first of the next
    one; the k pairs are those of all edges.

    Args:
        values: Samples, shape (m,).
        driven_mm: The distance driven at each of them, shape (m,).
        levels: The n levels of the samples.
        level: For each of the k pairs, the index of the level before it.
        row: For each of the k pairs, the index of its first sample.
    """
    middles = (levels.true_level[:-1] + levels.true_level[1:]) / 2.0
    apart = values[row] - middles[level]
    have_third = np.zeros(len(middles), bool)
    have_third[level[np.abs(apart) > _measure_reach(levels)[level]]] = True
    apart_next = values[row + 1] - middles[level]
    passing = np.flatnonzero((apart < 0.0) != (apart_next < 0.0))
    level = level[passing]
    row = row[passing]
    part = apart[passing] / (apart[passing] - apart_next[passing])
    places_mm = driven_mm[row] + part * (driven_mm[row + 1] - driven_mm[row])
    edges_mm = np.stack((np.full(len(middles), np.inf), np.full(len(middles), -np.inf)))
    np.minimum.at(edges_mm[0], level, places_mm)
    np.maximum.at(edges_mm[1], level, places_mm)
    edges_mm[:, ~np.isfinite(edges_mm[0]) | have_third] = np.nan
    middle_mm: FloatArray = edges_mm.mean(axis=0)
    return middle_mm


def _measure_reach(levels: Levels) -> FloatArray:
    """Return how far a sample on the edge between two levels can be from the middle of the two, shape (n - 1,).

    There is one value for each level and the next one. A sample between the two that is farther from the middle belongs
    to a third level.
    """
    spread = np.maximum(levels.spread[:-1], levels.spread[1:])
    return _FAR_OF_STEP * np.abs(np.diff(levels.true_level)) + _FAR_OF_SPREAD * spread
