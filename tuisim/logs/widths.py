"""Widths of bands: from the edge before a level to the edge after it.

The light sensor sees a spot, so that its reading passes an edge gradually, and is halfway between two levels where the
edge lies in the middle of the spot.
"""

from __future__ import annotations

import numpy as np

from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.levels import Levels

_FAR_OF_STEP, _FAR_OF_SPREAD = 0.75, 4.0
"""A sample between two levels is of a third one, farther from their middle than these parts of step and spread."""


@np.errstate(over="ignore", invalid="ignore")
def measure_widths(values: FloatArray, driven_mm: FloatArray, levels: Levels) -> FloatArray:
    """Return the widths of levels in mm, shape (n,), each from the edge before it to the edge after it.

    NaN where an edge is not known: before the first level, after the last one, and between two levels with samples of
    another level between them.

    Args:
        values: Samples, shape (m,).
        driven_mm: The distance driven at each of them, shape (m,).
        levels: Those of the samples, n of them.
    """
    rows = np.flatnonzero(np.isfinite(values))
    last, first = np.searchsorted(rows, np.stack((levels.stop[:-1] - 1, levels.start[1:])))
    pairs = _find_pairs(last, first)
    edges_mm = _find_edges(values[rows], driven_mm[rows], levels, pairs)
    return np.diff(edges_mm, prepend=np.nan, append=np.nan)[: len(levels.start)]


def _find_edges(
    values: FloatArray, driven_mm: FloatArray, levels: Levels, pairs: tuple[IntArray, IntArray]
) -> FloatArray:
    """Return where samples pass the middle between each level and the next one, in mm, shape (n - 1,).

    With noise, they may pass it several times: the middle between the first and the last time counts.
    """
    level, row = pairs
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


def _find_pairs(last: IntArray, first: IntArray) -> tuple[IntArray, IntArray]:
    """Return the pairs of neighbouring samples from the last one of each level to the first one of the next.

    Returns: For each pair, the position of the level, and the row of its first sample.
    """
    sizes = first - last
    level = np.repeat(np.arange(len(sizes)), sizes)
    return level, np.arange(sizes.sum()) - (np.cumsum(sizes) - sizes - last)[level]


def _measure_reach(levels: Levels) -> FloatArray:
    """Return how far samples between each level and the next one may be from their middle, shape (n - 1,)."""
    spread = np.maximum(levels.spread[:-1], levels.spread[1:])
    return _FAR_OF_STEP * np.abs(np.diff(levels.true_level)) + _FAR_OF_SPREAD * spread
