"""Bands: the plateaus of a log with times, distances, widths, and the names of their greys.

A width goes from the edge before a level to the edge after it. The light sensor sees a spot, so that its reading passes
an edge gradually, and is halfway between two levels where the edge lies in the middle of the spot.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.runs.arrays import FloatArray, IntArray, number_members
from tuisim.logs.levels import Levels, find_light, measure_levels
from tuisim.logs.plateaus import Search, find_plateaus

if TYPE_CHECKING:
    from tuisim.logs.log import Log

NAN = float("nan")
ONE_SAMPLE = "one sample"
"""Marks, in the list of levels, a level that only the first or the last sample of the log has."""
CUT_OFF = "cut off"
"""Stands for the width of a band on which the log begins or ends."""
NO_EDGE = "no edge"
"""Stands for the width of a band with other samples between it and a neighbour, so that its edge is not known."""


@dataclass(frozen=True, slots=True)
class Band:
    """A plateau of one variable, such as a grey band in the readings of a sensor, with its level, times and width."""

    variable: str
    number: int
    """Number of the band among those of its variable, from 1, in order of time."""
    start_s: float
    """Time of the band's first sample."""
    stop_s: float
    """Time of the band's last sample."""
    samples: int
    level: float
    """Mean of the band's samples without strays."""
    spread: float
    """Standard deviation of the band's samples without strays (divided by n - 1); 0 for a single sample."""
    strays: int
    """Number of the band's samples that are far from its level."""
    grey: str
    """Name of the grey that is nearest to the level; empty if none is near, or if the variable is not a light level."""
    grey_percent: float
    """The sensor's reading of the grey in `grey`, in percent; NaN if `grey` is empty."""
    true_level: float
    """The level of the band, corrected for noise that the ends of the scale have clamped."""
    start_mm: float
    """Distance that the robot had driven at the band's first sample; NaN if the log has no positions."""
    stop_mm: float
    """Distance that the robot had driven at the band's last sample; NaN if the log has no positions."""
    width_mm: float
    """Distance driven from the edge before the band to the edge after it, where readings are halfway between two
    levels; NaN if unknown.
    """
    cut_off: bool
    """Whether the log begins or ends on the band, so that the band's width is not known."""
    first_row: int
    """Row of the band's first sample in the log's table, from 0."""
    last_row: int

    def describe_samples(self) -> str:
        """Return the number of samples as text, such as `12, 1 stray`.

        A stray is a sample that is far from the level of the band. Strays do not affect the band's level and spread.
        """
        strays = f", {counted(self.strays, 'stray')}" if self.strays else ""
        return f"{self.samples}{strays}"

    def describe_width(self) -> str:
        """Return the width in mm as text.

        If the width is unknown, the text is `CUT_OFF` for a band at an end of the log, and `NO_EDGE` for any other
        band. It is empty for a log without positions.
        """
        if not isfinite(self.start_mm):
            return ""
        if isfinite(self.width_mm):
            return f"{self.width_mm:.0f}"
        return CUT_OFF if self.cut_off else NO_EDGE


@dataclass(frozen=True, eq=False)
class BandReport:
    """The bands that were found in one variable of a log."""

    variable: str
    bands: tuple[Band, ...]
    total: int
    """The number of all samples of the variable, those between the bands included."""

    @cached_property
    def has_true_levels(self) -> bool:
        """Whether the true level of any band differs from its measured level.

        They differ near the ends of the scale: noise is cut off there, so the mean of the samples is not the level.
        """
        return any(band.true_level != band.level for band in self.bands)

    @property
    def transitions(self) -> int:
        """The number of samples on edges and slopes, which belong to no band."""
        return self.total - sum(band.samples for band in self.bands)

    def describe(self) -> str:
        """Return the levels of the bands as a text of one line.

        Each level has its grey after it and, if several bands have this level, their number, such as `50.20 grey (3x)`.
        If the width of a band is `NO_EDGE`, the text says why.
        """
        if not self.bands:
            return f"{self.variable}: no level: its values stand still nowhere"
        levels = _group_levels(self.bands)
        known = f"{counted(len(levels), 'level')}: {', '.join(map(_describe_level, levels))}"
        lie = "lies" if self.transitions == 1 else "lie"
        edges = f"{self.transitions} of {self.total} samples {lie} on edges or slopes"
        has_reason = any(band.describe_width() == NO_EDGE for band in self.bands)
        reason = (
            f"; {NO_EDGE}: other samples lie between this band and the next" if has_reason else ""
        )
        return f"{self.variable}: {known}; {edges}{reason}"


def _describe_level(bands: Sequence[Band]) -> str:
    """Return the level of bands that have the same, such as `50.20 grey (3x)`."""
    samples = sum(band.samples for band in bands)
    level = sum(band.level * band.samples for band in bands) / samples
    text = f"{level:.2f} {bands[0].grey}".rstrip()
    if len(bands) > 1:
        return f"{text} ({len(bands)}x)"
    return f"{text} ({ONE_SAMPLE})" if samples == 1 else text


def _group_levels(bands: Sequence[Band]) -> list[list[Band]]:
    """Return bands grouped by level, in order of their first bands.

    Bands have the same level if they have the same grey or, without one, if their levels differ by no more than the
    spread of their samples.
    """
    firsts: dict[int, Band] = {}
    first: Band | None = None
    for band in sorted(bands, key=lambda band: band.level):
        if band.grey:
            continue
        if first is None or (
            band.level - first.level > max(band.spread, first.spread)
            and f"{band.level:.4g}" != f"{first.level:.4g}"
        ):
            first = band
        firsts[band.number] = first
    groups: dict[str | int, list[Band]] = {}
    for band in bands:
        key = band.grey or firsts[band.number].number
        groups.setdefault(key, []).append(band)
    return list(groups.values())


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
    light = find_light(log.find_spec(max(series.run - 1, 0)))
    values = series.values
    levels = measure_levels(name, values, light, search)
    finite = np.append(0, np.cumsum(np.isfinite(values)))
    first, last = levels.start, levels.stop - 1
    driven_mm = log.compute_driven_mm(series)
    start_mm = stop_mm = width_mm = np.full(len(first), NAN)
    if driven_mm is not None:
        start_mm, stop_mm = driven_mm[first], driven_mm[last]
        width_mm = measure_widths(values, driven_mm, levels)
    columns = (
        np.arange(1, len(first) + 1),
        series.time_s[first],
        series.time_s[last],
        finite[last + 1] - finite[first],
        levels.level,
        levels.spread,
        levels.strays,
        np.array(levels.greys, object),
        levels.grey_percent,
        levels.true_level,
        start_mm,
        stop_mm,
        width_mm,
        (finite[first] == 0) | (finite[last + 1] == finite[-1]),
        series.rows[first],
        series.rows[last],
    )
    cells = zip(*(column.tolist() for column in columns), strict=True)
    bands = tuple(Band(series.name, *row) for row in cells)
    return BandReport(name, bands, int(finite[-1]))


_MAX_EDGE_MM = 100.0
_MAX_EDGE_STEPS = 8
"""Samples between two levels are a slope and no edge if they cover more than `_MAX_EDGE_MM` and are more than this
many: the spot of a sensor is far smaller.
"""

_FAR_OF_STEP, _FAR_OF_SPREAD = 0.75, 4.0
"""A sample between two levels belongs to a third level if it is farther from their middle than the sum of 0.75 times
their difference and 4 times the larger of their spreads.
"""


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
    # From the last sample of each level to the first of the next, each pair of neighbours has its edge and its row.
    last, first = np.searchsorted(rows, np.stack((levels.stop[:-1] - 1, levels.start[1:])))
    edge, number = number_members(first - last)
    row = last[edge] + number
    places_mm = driven_mm[rows]
    middles = (levels.true_level[:-1] + levels.true_level[1:]) / 2.0
    # How far a sample on the edge can be from the middle of both levels.
    reach = _FAR_OF_STEP * np.abs(np.diff(levels.true_level)) + _FAR_OF_SPREAD * np.maximum(
        levels.spread[:-1], levels.spread[1:]
    )
    is_unknown = (places_mm[first] - places_mm[last] > _MAX_EDGE_MM) & (
        first - last > _MAX_EDGE_STEPS
    )
    apart = values[rows[row]] - middles[edge]
    is_unknown[edge[np.abs(apart) > reach[edge]]] = True
    apart_next = values[rows[row + 1]] - middles[edge]
    passing = np.flatnonzero((apart < 0.0) != (apart_next < 0.0))
    edge, row = edge[passing], row[passing]
    part = apart[passing] / (apart[passing] - apart_next[passing])
    passed_mm = places_mm[row] + part * (places_mm[row + 1] - places_mm[row])
    edges_mm = np.where(is_unknown, NAN, _find_middles(edge, passed_mm, len(middles)))
    return np.diff(edges_mm, prepend=NAN, append=NAN)[: len(levels.start)]


def _find_middles(edge: IntArray, places_mm: FloatArray, count: int) -> FloatArray:
    """Return for each of `count` edges the position midway between its first and its last place, shape (count,).

    With noise, samples pass the middle between two levels several times. An edge without any place has NaN.

    Args:
        edge: For each place, the index of its edge.
        places_mm: The places.
        count: The number of edges.
    """
    first_mm = np.full(count, np.inf)
    last_mm = np.full(count, -np.inf)
    np.minimum.at(first_mm, edge, places_mm)
    np.maximum.at(last_mm, edge, places_mm)
    middles_mm: FloatArray = (first_mm + last_mm) / 2.0
    return middles_mm
