"""Which pieces of a log stand still, so that they have a level, and the levels of pieces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.pieces import (
    NEAR_SAMPLES,
    BoolArray,
    Pieces,
    Signal,
    count_samples,
    find_strays,
    group_by_length,
)

_SLOPE_OF_RANGE, _SLOPE_OF_VALUE = 0.25, 0.1
"""A piece that drifts by more than these fractions of the log's range and of its own highest value is no plateau."""

_STILL_OF_RANGE, _STILL_OF_VALUE = 0.02, 0.02
"""A piece with a spread below one of these fractions, of the log's range and its own highest value, stands still."""

_STILL_NOISES = 3.0
"""A piece whose spread is below this multiple of the noise stands still."""

_SHORT_SAMPLES = 8
"""A piece of fewer samples moves if each is larger, or each smaller, than the one before."""

_WANDERS = 0.5
"""A piece wanders if neighbours differ by less than this fraction of its variance tells.

This is half the ratio of von Neumann (1941), which is about 1 for samples that do not depend on each other. Its
standard deviation is 0.1 for 100 samples.
"""

_SWINGS = 0.65
_SWING_OF_VALUE = 0.01
_SWING_SAMPLES = 30
"""A piece of so many samples swings if so large a fraction of its steps goes on in the direction of the one before.

Of samples that do not depend on each other, a third does. A spread below this fraction of its highest value is small.
"""

_UNSURE_OF_RANGE, _UNSURE_OF_VALUE = 0.1, 0.05
"""A mean that is less certain than these fractions of the log's range and of its own highest value is no level."""

PART_OF_SLOPE = 0.5
"""A part of a slope stands still if its spread is below this fraction of what the slope would give it."""

_MAX_STRAYS = 0.3
"""Largest fraction of strays in a plateau."""

PlateauArray = NDArray[np.void]
"""Plateaus as an array of `FIELDS`, shape (n,)."""
FIELDS = np.dtype(
    [
        ("start", "i8"),
        ("stop", "i8"),
        ("level", "f8"),
        ("spread", "f8"),
        ("drift", "f8"),
        ("strays", "i8"),
    ]
)
"""A plateau is a span of a log with one level, from the sample `start` to before the sample `stop`.

`level` is the mean without strays, or the value itself where all are equal; `spread` is the standard deviation without
strays; `drift` is how much it rises from its first sample to its last; `strays` counts the samples that lie far off.
"""


def estimate_noise(differences: FloatArray, variance: float) -> float:
    """Return the standard deviation of the noise that explains differences between samples; 0 without differences.

    The median of absolute differences, times 1.4826, is the standard deviation of normal noise, even if up to half of
    them are steps (Rousseeuw and Croux 1993).

    Args:
        differences: Absolute differences of samples from what their neighbours predict, shape (n,).
        variance: The variance that such differences have for noise of variance 1: 2 for differences of two neighbours;
            6 for second differences, which are 0 on slopes.
    """
    if not len(differences):
        return 0.0
    by_median = 1.4826 * float(np.median(differences)) / np.sqrt(variance)
    # If values jump between two steps of a coarse scale, the median difference may be 0: then the mean square of the
    # smaller differences is the better estimate.
    calm = np.sort(differences)[: max(1, int(0.8 * len(differences)))]
    return max(float(by_median), float(np.sqrt(np.mean(calm**2) / variance)))


def read_spans(plateaus: PlateauArray) -> Pieces:
    """Return the starts and ends of plateaus, shape (n, 2)."""
    return np.stack((plateaus["start"], plateaus["stop"]), axis=1)


def measure(signal: Signal, pieces: Pieces) -> PlateauArray:
    """Return pieces of a log as plateaus, with level, spread, drift and strays."""
    plateaus = np.zeros(len(pieces), FIELDS)
    plateaus["start"], plateaus["stop"] = pieces.T
    for some, part in group_by_length(signal.values, pieces):
        off = find_strays(part, signal.sigma)
        counts = off.sum(axis=1)
        plateaus["strays"][some] = counts
        for count in np.unique(counts):
            alike = counts == count
            plateaus[some[alike]] = _measure_levels(plateaus[some[alike]], part[alike], ~off[alike])
    return plateaus


def _measure_levels(plateaus: PlateauArray, part: FloatArray, keep: BoolArray) -> PlateauArray:
    """Return plateaus of equal length with their level, spread and drift.

    Args:
        plateaus: The plateaus.
        part: Their samples, shape (m, length).
        keep: False for samples that are strays and do not count, shape (m, length). Each row must have the same number
            of strays.
    """
    count, length = part.shape
    samples = part[keep].reshape(count, -1)
    uneven = (samples != samples[:, :1]).any(axis=1)
    plateaus["level"] = np.where(uneven, samples.mean(axis=1), samples[:, 0])
    plateaus["spread"] = np.where(uneven, samples.std(axis=1), 0.0)
    if samples.shape[1] >= 8:
        positions = np.nonzero(keep)[1].reshape(samples.shape).astype(np.float64)
        positions -= positions.mean(axis=1, keepdims=True)
        drift = (
            (positions * samples).sum(axis=1) / (positions * positions).sum(axis=1) * (length - 1)
        )
        plateaus["drift"] = np.where(uneven, drift, 0.0)
    return plateaus


def find_moving(signal: Signal, plateaus: PlateauArray) -> BoolArray:
    """Return for each plateau whether it has no level.

    It then rises, falls or bends, or consists of a few samples that are very different.
    """
    lengths = count_samples(read_spans(plateaus))
    moving: BoolArray = plateaus["strays"] > _MAX_STRAYS * lengths
    spread = plateaus["spread"]
    drift = np.abs(plateaus["drift"])
    wide = spread > max(_STILL_NOISES * signal.noise, _STILL_OF_RANGE * signal.range)
    steep = drift > _SLOPE_OF_RANGE * signal.range
    root = np.sqrt(lengths - plateaus["strays"])
    unsure = spread > _UNSURE_OF_RANGE * signal.range * root
    long = (lengths >= _SWING_SAMPLES) & (spread > _STILL_OF_RANGE * signal.range)
    judged = np.flatnonzero(wide | steep | unsure | long)
    for some, part in group_by_length(signal.values, read_spans(plateaus[judged])):
        some = judged[some]
        highest = np.abs(part).max(axis=1)
        moving[some] |= (
            wide[some]
            & (spread[some] > _STILL_OF_VALUE * highest)
            & _find_wandering(part, spread[some], signal.sigma)
        )
        moving[some] |= (
            long[some] & (spread[some] > _SWING_OF_VALUE * highest) & _find_swinging(part)
        )
        moving[some] |= steep[some] & (drift[some] > _SLOPE_OF_VALUE * highest)
        moving[some] |= unsure[some] & (spread[some] > _UNSURE_OF_VALUE * highest * root[some])
    return moving


def _find_wandering(part: FloatArray, spread: FloatArray, sigma: float) -> BoolArray:
    """Return for each row of samples, shape (m, length), whether it wanders instead of staying at a level.

    A row of noise has large differences between neighbours. In a row that wanders, they are small for the row's spread.
    """
    wanders: BoolArray = _compare_neighbours(part, sigma) < _WANDERS * spread**2
    if part.shape[1] < _SHORT_SAMPLES:
        steps = np.diff(part, axis=1)
        wanders |= (steps > 0.0).all(axis=1) | (steps < 0.0).all(axis=1)
    return wanders


def _find_swinging(part: FloatArray) -> BoolArray:
    """Return for each row, shape (m, length), whether it mostly keeps its direction, as a saw-tooth or a wave does."""
    if part.shape[1] < _SWING_SAMPLES:
        return np.zeros(len(part), bool)
    steps = np.diff(part, axis=1)
    swinging: BoolArray = (steps[:, 1:] * steps[:, :-1] > 0.0).mean(axis=1) > _SWINGS
    return swinging


def _compare_neighbours(part: FloatArray, sigma: float) -> FloatArray:
    """Return the variance of the noise in each row of samples, shape (m,), from differences of neighbours.

    Args:
        part: The rows, shape (m, length); strays in them are ignored.
        sigma: Standard deviation of the noise, by which strays are found.
    """
    keep = ~find_strays(part, sigma)
    pairs = keep[:, 1:] & keep[:, :-1]
    squares = (np.diff(part, axis=1) ** 2 * pairs).sum(axis=1)
    variance: FloatArray = squares / np.maximum(2 * pairs.sum(axis=1), 1)
    return variance


def find_still_parts(signal: Signal, moving: PlateauArray, cut: Pieces) -> PlateauArray:
    """Return the parts of moving pieces that stay at a level, such as the top between two slopes.

    Args:
        signal: The log.
        moving: The pieces that rise, fall or bend.
        cut: The shorter pieces that were joined to these, without gaps between them.
    """
    started = np.searchsorted(moving["start"], cut[:, 0], side="right")
    ended = np.searchsorted(moving["stop"], cut[:, 1])
    chosen = (started > ended) & (count_samples(cut) >= NEAR_SAMPLES)
    levels = np.add.reduceat(signal.values, cut[:, 0]) / count_samples(cut)
    rates = np.abs(np.diff(levels) / np.diff(cut.mean(axis=1)))
    slopes = np.maximum(np.append(0.0, rates), np.append(rates, 0.0))[chosen]
    parts = _trim(signal.values, cut[chosen], _STILL_NOISES * signal.noise)
    measured = measure(signal, parts)
    spread = slopes * count_samples(parts) / np.sqrt(12.0)
    still = measured["spread"] <= PART_OF_SLOPE * spread
    for some, part in group_by_length(signal.values, parts):
        min_variance = _WANDERS * measured["spread"][some] ** 2
        still[some] &= _compare_neighbours(part, signal.sigma) >= min_variance
    still &= count_samples(parts) >= _SHORT_SAMPLES
    level_parts: PlateauArray = measured[still & ~find_moving(signal, measured)]
    return level_parts


def _trim(values: FloatArray, parts: Pieces, far: float) -> Pieces:
    """Return parts of a log, shortened at both ends by the samples that are far from the median of the part.

    Args:
        values: The log.
        parts: The parts.
        far: By how much a sample must differ from the median to be far from it.
    """
    trimmed = parts.copy()
    for index, (start, stop) in enumerate(parts.tolist()):
        part = values[start:stop]
        near = np.flatnonzero(np.abs(part - np.median(part)) <= far)
        if len(near):
            trimmed[index] = start + near[0], start + near[-1] + 1
    return trimmed


def add_apart(plateaus: PlateauArray, parts: PlateauArray) -> PlateauArray:
    """Return plateaus together with those of `parts` that overlap none of them, in the order of the log."""
    # All plateaus that start before such a part ends have ended before it starts.
    started = np.searchsorted(plateaus["start"], parts["stop"])
    ended = np.searchsorted(plateaus["stop"], parts["start"], side="right")
    both = np.concatenate((plateaus, parts[started == ended]))
    return both[np.argsort(both["start"], kind="stable")]
