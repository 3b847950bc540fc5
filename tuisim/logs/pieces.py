"""Pieces of a log: spans of samples, the strays among them, and which pieces continue others.

Two pieces are one if a line with the same slope on both sides fits them without a step between them: the step is
estimated by least squares, and counts if it is larger than `CERTAINTY` of its standard deviations. Only the samples
next to the seam are looked at, since a drift is straight only nearby.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from tuisim.engine.runs.arrays import FloatArray, IntArray

MIN_SAMPLES = 2
"""Fewest samples of a plateau in a log without noise. With noise, a plateau needs one more; at an end of the log, one
sample is enough.
"""

STRAY_SAMPLES = 2
"""Largest number of samples in a row that can be strays: more are a level of their own."""

FAR = 5.0
"""A sample is a stray if it is farther from the others of its piece than this number of standard deviations: of noise,
6 samples in 10 million are.
"""

NEAR_SAMPLES = 12
"""Largest number of samples on each side of a cut from which the slope of a drift is estimated.

With so many on both sides, the standard deviation of a step is 0.82 times the noise, so that one of 3.3 times the noise
is certain. Fewer would leave the slope unknown: the deviation is 1.3 times the noise with five.
"""

CERTAINTY = 4.0
"""Smallest step between two pieces, in standard deviations of a step: noise makes a larger one at 6 of 100,000 places.
"""

_MAX_SAMPLES_TOGETHER = 100_000
"""Largest number of samples in an array of pieces, except for a single longer piece: so many fit in the caches of a
processor.
"""

Pieces = IntArray
"""Spans of a log in order, shape (n, 2): the index of the first sample of each, and that of its last sample plus 1."""

BoolArray = NDArray[np.bool_]


class Signal(NamedTuple):
    """The finite samples of a log, with the sizes that the search for plateaus needs, such as the noise."""

    values: FloatArray
    """The samples, all finite, shape (n,)."""
    range: float
    """Difference between the highest level and the lowest."""
    noise: float
    """Standard deviation of the noise, measured so that a slope of the log does not add to it."""
    sigma: float
    """Standard deviation of the noise, to which a slope of the log adds; strays and steps are found by it."""
    min_step: float
    """Smallest difference between two neighbouring levels, whatever the noise."""
    drifts: bool = True
    """Whether two pieces are joined if both lie on one line with a slope."""


def count_samples(pieces: Pieces) -> IntArray:
    """Return the number of samples of each piece."""
    return pieces[:, 1] - pieces[:, 0]


def group_by_length(values: FloatArray, pieces: Pieces) -> Iterator[tuple[IntArray, FloatArray]]:
    """Yield pieces in groups of the same length: the indices of m pieces, and their samples, shape (m, length).

    A group is limited in size, so that many pieces of one length are yielded in several groups.
    """
    lengths = count_samples(pieces)
    order = np.argsort(lengths, kind="stable")
    for alike in np.split(order, np.flatnonzero(np.diff(lengths[order])) + 1) if len(order) else ():
        length = int(lengths[alike[0]])
        windows = sliding_window_view(values, length)
        count = max(1, _MAX_SAMPLES_TOGETHER // length)
        for first in range(0, len(alike), count):
            some = alike[first : first + count]
            yield some, windows[pieces[some, 0]]


def join_across_strays(signal: Signal, pieces: Pieces) -> Pieces:
    """Return pieces of a log; two are joined if only a few strays separate them and the second continues the first."""
    after = np.searchsorted(pieces[:, 1], pieces[:, 0] + STRAY_SAMPLES, side="right")
    indices = np.arange(1, len(pieces))
    indices = indices[(indices < after[indices]) & (after[indices] < len(pieces))]
    # At least two samples are needed on either side, as an edge is no stray.
    return _join_seams(signal, pieces, np.stack((indices, after[indices]), axis=1), MIN_SAMPLES)


def join_drifting(signal: Signal, pieces: Pieces) -> Pieces:
    """Return pieces of a log; neighbours are joined if they lie on one line, which may have a slope.

    At most `STRAY_SAMPLES` strays may lie between the two.
    """
    indices = 1 + np.flatnonzero(pieces[1:, 0] - pieces[:-1, 1] <= STRAY_SAMPLES)
    return _join_seams(signal, pieces, np.stack((indices, indices), axis=1), STRAY_SAMPLES + 1)


def _join_seams(signal: Signal, pieces: Pieces, seams: IntArray, min_samples: int) -> Pieces:
    """Return pieces of a log; the pieces on both sides of a seam are joined if the right one continues the left one.

    Args:
        signal: The log.
        pieces: Its pieces.
        seams: The places where pieces may be joined, shape (n, 2). Each row has two indices of pieces: the index of the
            left piece plus 1, and the index of the right piece. Pieces from the first index to before the second are
            strays.
        min_samples: Fewest samples that a piece on either side must have.
    """
    left, right = pieces[seams[:, 0] - 1], pieces[seams[:, 1]]
    firsts = np.arange(len(pieces))
    goes_on = np.zeros(len(seams), bool)
    unsure = np.ones(len(seams), bool)
    # A join makes the piece on the left of the next seam longer: judge that seam again, with more samples.
    while unsure.any():
        goes_on[unsure] = _find_continued(signal, left[unsure], right[unsure], min_samples)
        firsts = _find_firsts(len(pieces), seams[goes_on])
        nearest = left[:, 1] - NEAR_SAMPLES
        starts = pieces[firsts[seams[:, 0] - 1], 0]
        unsure = np.maximum(starts, nearest) != np.maximum(left[:, 0], nearest)
        left[:, 0] = starts
    heads = np.unique(firsts)
    tails = np.append(heads[1:], len(pieces)) - 1
    return np.stack((pieces[heads, 0], pieces[tails, 1]), axis=1)


def _find_firsts(count: int, seams: IntArray) -> IntArray:
    """Return for each piece the index of the first of the pieces with which it is joined, shape (n,).

    A piece that is not joined has its own index.

    Args:
        count: The number of pieces.
        seams: The seams to join, as for `_join_seams`. A seam is ignored if its left piece is one of the strays of an
            earlier seam.
    """
    firsts = np.arange(count)
    reached = -1
    for piece, after in seams.tolist():
        if piece > reached:
            firsts[piece : after + 1] = 0
            reached = after
    return np.maximum.accumulate(firsts)


def _find_continued(signal: Signal, left: Pieces, right: Pieces, min_samples: int) -> BoolArray:
    """Return for each pair of pieces whether the right one continues the left one, without a step between them.

    Both may lie on one line with a slope, as in a log that drifts.

    Args:
        signal: The log.
        left, right: The pieces of each pair.
        min_samples: Fewest samples of either piece.
    """
    goes_on = np.minimum(count_samples(left), count_samples(right)) >= min_samples
    before, after = left[goes_on], right[goes_on]
    before[:, 0] = np.maximum(before[:, 0], before[:, 1] - NEAR_SAMPLES)
    after[:, 1] = np.minimum(after[:, 1], after[:, 0] + NEAR_SAMPLES)
    lines = _fit_lines(signal, before), _fit_lines(signal, after)
    step, spread = _estimate_steps(*lines, drifts=signal.drifts)
    min_steps = np.maximum(signal.min_step, CERTAINTY * signal.sigma * spread)
    goes_on[goes_on] = np.abs(step) <= min_steps
    return goes_on


class _Lines(NamedTuple):
    """Means and sums for fitting a straight line to the samples of each piece, without strays; each of shape (n,)."""

    samples: FloatArray
    place: FloatArray
    """Mean position of the samples of each piece."""
    level: FloatArray
    """Mean value of the samples of each piece."""
    width: FloatArray
    """For each piece, the sum of the squared distances of its samples from their mean position."""
    rise: FloatArray
    """For each piece, the sum over its samples of the distance from the mean position times that from the mean value.
    """


def _fit_lines(signal: Signal, pieces: Pieces) -> _Lines:
    lines = np.empty((5, len(pieces)))
    for some, part in group_by_length(signal.values, pieces):
        weights = (~find_strays(part, signal.sigma)).astype(np.float64)
        positions = np.arange(part.shape[1], dtype=np.float64)
        samples = weights.sum(axis=1)
        place = weights @ positions / samples
        level = _sum_products(weights, part) / samples
        apart = weights * (positions - place[:, None])
        width = _sum_products(apart, apart)
        rise = _sum_products(apart, part - level[:, None])
        lines[:, some] = samples, pieces[some, 0] + place, level, width, rise
    return _Lines(*lines)


def _sum_products(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return for each row the sum of the products of two arrays, shape (n, length), without storing all products."""
    sums: FloatArray = np.einsum("ij,ij->i", left, right)
    return sums


def _estimate_steps(
    before: _Lines, after: _Lines, *, drifts: bool = True
) -> tuple[FloatArray, FloatArray]:
    """Return the steps between two pieces that drift alike, and the standard deviations of these steps.

    The steps are estimated by least squares, in units of the noise: one slope is fitted to both pieces, and the step is
    the difference that remains between their means (analysis of covariance).

    Args:
        before: The pieces before the steps.
        after: The pieces after them.
        drifts: Whether the slope may differ from 0.
    """
    apart = (after.place - before.place) * drifts
    width = before.width + after.width
    # Pieces of one sample have no slope; the width 1 avoids a division by 0.
    width[width == 0.0] = 1.0
    step = after.level - before.level - apart * (before.rise + after.rise) / width
    spread = np.sqrt(1.0 / before.samples + 1.0 / after.samples + apart * apart / width)
    return step, spread


def find_strays(part: FloatArray, sigma: float) -> BoolArray:
    """Return for each sample whether it is a stray, far from the level that it belongs to, shape (m, length).

    Args:
        part: The samples of m levels, shape (m, length).
        sigma: Standard deviation of the noise.
    """
    length = part.shape[1]
    half = length // 2
    rest = part
    if half >= 4:
        slope = (compute_medians(part[:, -half:]) - compute_medians(part[:, :half])) / (
            length - half
        )
        rest = part - slope[:, None] * np.arange(length)
    off: BoolArray = np.abs(rest - compute_medians(rest)[:, None]) > FAR * sigma
    return off & ~off.all(axis=1, keepdims=True)


def compute_medians(part: FloatArray) -> FloatArray:
    """Return the median of each row of an array, shape (m,); numpy's own takes ten times longer for short rows."""
    ordered = np.sort(part, axis=1)
    middle = part.shape[1] // 2
    return (
        ordered[:, middle]
        if part.shape[1] % 2
        else (ordered[:, middle - 1] + ordered[:, middle]) / 2.0
    )
