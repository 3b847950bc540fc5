"""Plateaus of a log, separated from the samples on their edges and from strays.

The log is cut into pieces so that the squared distances from the means of the pieces, in
units of the noise, plus a price for every cut, are minimal (optimal partitioning, with the
pruning of Killick et al. 2012). A piece of one or two samples between two others is an
edge, or strays if the log continues as before; pieces that drift into each other are joined.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from tuisim.errors import LogError
from tuisim.runs.arrays import FloatArray, IntArray

MIN_SAMPLES = 2
"""Fewest samples of a plateau; one more with noise, one at the ends of the log."""

EVERY_PLACE = 4000
"""Most samples for which every position may be a cut; in longer logs, only those where neighbouring means differ."""

_STRAY_SAMPLES = 2
"""Most samples in a row that count as strays."""

_EDGE_SAMPLES = 3
"""Most samples of an edge between two plateaus."""

_FEW_STEPS = 0.2
"""Largest fraction of the differences between neighbours that are steps, in a common log."""

_FAR = 5.0
"""A sample farther off than this number of standard deviations is a stray."""

_NEAR_SAMPLES = 12
"""Samples on each side of a cut from which a drift is estimated."""

_FEW_STARTS = 12
"""Up to this number of starts of a piece, Python's own floats are faster than arrays."""

_GIANT = 1000.0
"""Samples are clipped at this multiple of the range beyond it."""

_STEP_OF_RANGE = 0.005
"""Smallest step, as a fraction of the range, whatever the noise."""

_DUST = 1e-9
"""Differences below this fraction of the values are rounding errors."""

_SLOPE_OF_RANGE, _SLOPE_OF_VALUE = 0.25, 0.1
"""A piece that drifts by more than these fractions of the log's range and of its own highest value is no plateau."""

_CERTAINTY = 4.0
"""Smallest step in standard deviations."""

_BLOCK = 400_000
"""Samples that are cut at a time in a long log."""

_AT_ONCE = 100_000
"""Most samples of pieces that are looked at together, but for a longer piece: they fit in the caches of a processor."""


class Plateau(NamedTuple):
    """A span of a log with one level. Positions count samples; `stop` is the one after the last."""

    start: int
    stop: int
    level: float
    """Mean without strays; the value itself where all are equal."""
    spread: float
    """Standard deviation of its samples without strays."""
    drift: float
    """How much it rises from its first sample to its last."""
    strays: int = 0
    """Samples that lie far off."""

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.stop - self.start


Search = Callable[[FloatArray], list[Plateau]]
"""What finds the plateaus of a log: `plateaus`, or `plateaus_in_subprocess`."""

Pieces = IntArray
"""Spans of a log in order, shape (n, 2): their starts, and their stops."""

_Found = NDArray[np.void]
"""Plateaus as an array of `FIELDS`, shape (n,)."""
FIELDS = np.dtype(
    [("start", "i8"), ("stop", "i8"), ("level", "f8"), ("spread", "f8"), ("drift", "f8"), ("strays", "i8")]
)

_BoolArray = NDArray[np.bool_]


def noise_of(values: FloatArray) -> float:
    """Return the standard deviation of the noise of finite values, shape (n,), from the differences of neighbours.

    It is 0 for clean steps.
    """
    if len(values) < 3:
        return 0.0
    differences = np.abs(np.diff(values))
    differences = differences[~_steps(differences)]
    by_median = 1.4826 * float(np.median(differences)) / np.sqrt(2.0)
    # Where values jump between two neighbours of a coarse scale, the median difference is 0.
    calm = np.sort(differences)[: max(1, int(0.8 * len(differences)))]
    by_calm = float(np.sqrt(np.mean(calm**2) / 2.0))
    return max(float(by_median), by_calm)


def _steps(differences: FloatArray) -> _BoolArray:
    """Return which differences between neighbours are steps, if the log has only short levels; otherwise none.

    If more than a fifth of the differences are far larger than the ones before and after them, most levels have two or
    three samples, without edges or strays between them. In noise, large differences follow each other.
    """
    calm = np.minimum(differences[1:], differences[:-1]).max(initial=0.0)
    steps: _BoolArray = differences > _FAR * calm
    return steps if steps.sum() > _FEW_STEPS * len(differences) else np.zeros(len(differences), bool)


@np.errstate(over="ignore", invalid="ignore")
def plateaus(values: FloatArray) -> list[Plateau]:
    """Return the plateaus of a log of samples at a fixed period, shape (n,), in order; the samples between are edges.

    Samples that are not finite belong to no plateau.
    """
    finite = np.flatnonzero(np.isfinite(values))
    clean = np.asarray(values, np.float64)[finite]
    if not len(clean):
        return []
    noise = noise_of(clean)
    low, high = _levels(clean)
    scale = high - low
    # Without noise, the smallest step sets the price of a cut.
    least_step = max(scale * _STEP_OF_RANGE, _DUST * max(abs(low), abs(high)), 1e-12)
    sigma = max(noise, least_step / _CERTAINTY)
    # Squares of huge values would leave no digits for the others.
    far = _GIANT * max(scale, sigma)
    pieces = _cut(np.clip(clean, low - far, high + far), sigma)
    short_levels = bool(_steps(np.abs(np.diff(clean))).any())
    # Twice: a stray may be hidden between short pieces of a drift.
    for _ in range(2):
        count = len(pieces)
        if not short_levels:
            pieces = _without_strays(clean, pieces, least_step, sigma)
        pieces = _joined(clean, pieces, least_step, sigma)
        if len(pieces) == count:
            break
    found = _measured(clean, pieces[_lengths(pieces) >= MIN_SAMPLES], sigma)
    found = found[~_are_slopes(clean, found, scale)]
    if not short_levels:
        found = found[~_are_ramps(clean, found, sigma)]
        found = found[~_are_edges(found)]
        # With noise, two samples of about the same value are no level, except at the ends of a log.
        at_an_end = (found["start"] == 0) | (found["stop"] == len(clean))
        found = found[at_an_end | (_lengths(_spans(found)) >= MIN_SAMPLES + (noise > 0.0))]
    if not len(found):
        return []
    # After growing, two may be separated by no more than a stray.
    spans = _joined(clean, _grown(clean, _spans(found), sigma), least_step, sigma)
    found = _with_ends(clean, _measured_again(clean, spans, found, sigma), max(least_step, _FAR * sigma))
    found["start"], found["stop"] = finite[found["start"]], finite[found["stop"] - 1] + 1
    return list(map(Plateau._make, found.tolist()))


def _levels(values: FloatArray) -> tuple[float, float]:
    """Return the lowest and the highest level, whatever the values of strays."""
    if len(values) > _STRAY_SAMPLES:
        parts = [values[at : len(values) - _STRAY_SAMPLES + at] for at in range(_STRAY_SAMPLES + 1)]
        low, high = float(np.maximum.reduce(parts).min()), float(np.minimum.reduce(parts).max())
        if low <= high:
            return low, high
    return float(values.min()), float(values.max())


def _cut(values: FloatArray, sigma: float) -> Pieces:
    """Cut the log into pieces of about one level each."""
    pieces = []
    for first in range(0, len(values), _BLOCK):
        block = values[first : first + _BLOCK]
        # Centred, since sums of squares of large values have no digits left for small steps.
        block = (block - block.mean()) / sigma
        pieces.append(first + _partition(block, _places(block)))
    return np.concatenate(pieces)


def _places(scaled: FloatArray) -> IntArray:
    """Return the positions of possible cuts, from 0 to the length, both included."""
    count = len(scaled)
    if count <= EVERY_PLACE:
        return np.arange(count + 1)
    sums = np.concatenate(([0.0], np.cumsum(scaled)))
    chosen = np.zeros(count + 1, bool)
    chosen[[0, count]] = True
    for width in (1, 3, 8, 24):
        at = np.arange(width, count - width + 1)
        step = np.abs(sums[at + width] - 2.0 * sums[at] + sums[at - width]) / width
        step *= np.sqrt(width / 2.0)
        # Only the highest within its own width, so that one edge does not give many positions.
        peak = np.ones(len(step), bool)
        for shift in range(1, width + 1):
            peak[shift:] &= step[shift:] >= step[:-shift]
            peak[:-shift] &= step[:-shift] >= step[shift:]
        strong = np.flatnonzero(peak & (step > _CERTAINTY))
        for shift in (-1, 0, 1):
            chosen[np.clip(at[strong] + shift, 0, count)] = True
    return np.flatnonzero(chosen)


def _partition(scaled: FloatArray, places: IntArray) -> Pieces:
    """Return the cheapest partition of values in units of the noise, with cuts at some of the places."""
    price = float(3.0 * np.log(max(len(scaled), 8)) + 2.0)
    all_sums = np.concatenate(([0.0], np.cumsum(scaled)))[places]
    all_squares = np.concatenate(([0.0], np.cumsum(scaled**2)))[places]
    all_best = np.full(len(places), -price)
    ends, sums, squares, best = places.tolist(), all_sums.tolist(), all_squares.tolist(), [-price]
    before = [0]
    alive: Sequence[int] | IntArray = [0]
    for at in range(1, len(ends)):
        end, total, square = ends[at], sums[at], squares[at]
        # A start with higher costs can never become the best one again.
        if len(alive) <= _FEW_STARTS:
            costs = [
                best[start] + square - squares[start] - (rise := total - sums[start]) * rise / (end - ends[start])
                for start in alive
            ]
            least = min(costs)
            before.append(alive[costs.index(least)])
            highest = least + price
            alive = [start for start, cost in zip(alive, costs, strict=True) if cost <= highest]
            alive.append(at)
        else:
            starts = np.asarray(alive)
            rises = total - all_sums[starts]
            all_costs = all_best[starts] + square - all_squares[starts] - rises * rises / (end - places[starts])
            cheapest = int(np.argmin(all_costs))
            before.append(int(starts[cheapest]))
            highest = float(all_costs[cheapest]) + price
            alive = np.append(starts[all_costs <= highest], at)
        best.append(highest)
        all_best[at] = highest
    cuts = [len(ends) - 1]
    while cuts[-1] > 0:
        cuts.append(before[cuts[-1]])
    chosen = places[cuts[::-1]]
    return np.stack((chosen[:-1], chosen[1:]), axis=1)


def _lengths(pieces: Pieces) -> IntArray:
    return pieces[:, 1] - pieces[:, 0]


def _spans(found: _Found) -> Pieces:
    return np.stack((found["start"], found["stop"]), axis=1)


def _of_one_length(values: FloatArray, pieces: Pieces) -> Iterator[tuple[IntArray, FloatArray]]:
    """Yield the pieces of each length, not too many at once: their indices, and their samples, shape (m, length)."""
    lengths = _lengths(pieces)
    order = np.argsort(lengths, kind="stable")
    for alike in np.split(order, np.flatnonzero(np.diff(lengths[order])) + 1) if len(order) else ():
        length = int(lengths[alike[0]])
        windows = sliding_window_view(values, length)
        count = max(1, _AT_ONCE // length)
        for first in range(0, len(alike), count):
            some = alike[first : first + count]
            yield some, windows[pieces[some, 0]]


def _without_strays(values: FloatArray, pieces: Pieces, least_step: float, sigma: float) -> Pieces:
    """Join pieces that only a few strays separate."""
    after = np.searchsorted(pieces[:, 1], pieces[:, 0] + _STRAY_SAMPLES, side="right")
    at = np.arange(1, len(pieces))
    at = at[(at < after[at]) & (after[at] < len(pieces))]
    # At least two on either side: an edge is no stray.
    return _joined_at(values, pieces, np.stack((at, after[at]), axis=1), MIN_SAMPLES, least_step, sigma)


def _joined(values: FloatArray, pieces: Pieces, least_step: float, sigma: float) -> Pieces:
    """Join neighbours that drift into each other, with at most a stray between them."""
    at = 1 + np.flatnonzero(pieces[1:, 0] - pieces[:-1, 1] <= _STRAY_SAMPLES)
    return _joined_at(values, pieces, np.stack((at, at), axis=1), _STRAY_SAMPLES + 1, least_step, sigma)


def _joined_at(
    values: FloatArray, pieces: Pieces, seams: IntArray, least_samples: int, least_step: float, sigma: float
) -> Pieces:
    """Join pieces at the seams across which the log goes on, the first ones first.

    Args:
        values: The log.
        pieces: Its pieces.
        seams: Shape (n, 2): a piece, and the one at or after it that may continue the one before it.
        least_samples: Fewest samples on either side.
        least_step: The smallest step between levels.
        sigma: Standard deviation of the noise.
    """
    left, right = pieces[seams[:, 0] - 1], pieces[seams[:, 1]]
    firsts = np.arange(len(pieces))
    goes_on, unsure = np.zeros(len(seams), bool), np.ones(len(seams), bool)
    # If what is before a seam was itself joined to what is before it, more samples tell how it goes on.
    while unsure.any():
        goes_on[unsure] = _go_on(values, left[unsure], right[unsure], least_samples, least_step, sigma)
        firsts = _firsts(len(pieces), seams[goes_on])
        nearest = left[:, 1] - _NEAR_SAMPLES
        starts = pieces[firsts[seams[:, 0] - 1], 0]
        unsure = np.maximum(starts, nearest) != np.maximum(left[:, 0], nearest)
        left[:, 0] = starts
    heads = np.flatnonzero(firsts == np.arange(len(pieces)))
    tails = np.append(heads[1:], len(pieces)) - 1
    return np.stack((pieces[heads, 0], pieces[tails, 1]), axis=1)


def _firsts(count: int, seams: IntArray) -> IntArray:
    """Return for each piece the first one of those that it is joined to; a seam inside an earlier one is none."""
    taken = []
    reached = -1
    for at, after in seams.tolist():
        if at > reached:
            taken.append((at, after + 1))
            reached = after
    starts, stops = np.array(taken, np.int64).reshape(-1, 2).T
    joined = np.cumsum(np.bincount(starts, minlength=count + 1) - np.bincount(stops, minlength=count + 1))[:count]
    firsts: IntArray = np.maximum.accumulate(np.where(joined, 0, np.arange(count)))
    return firsts


def _go_on(
    values: FloatArray, left: Pieces, right: Pieces, least_samples: int, least_step: float, sigma: float
) -> _BoolArray:
    """Return which pieces continue those on their left: a common drift explains the step between them."""
    goes_on = np.minimum(_lengths(left), _lengths(right)) >= least_samples
    before, after = left[goes_on], right[goes_on]
    before[:, 0] = np.maximum(before[:, 0], before[:, 1] - _NEAR_SAMPLES)
    after[:, 1] = np.minimum(after[:, 1], after[:, 0] + _NEAR_SAMPLES)
    step, spread = _steps_between(_lines(values, before, sigma), _lines(values, after, sigma), before[:, 1])
    goes_on[goes_on] = np.abs(step) <= np.maximum(least_step, _CERTAINTY * sigma * spread)
    return goes_on


class _Lines(NamedTuple):
    """What a straight line through the samples of each piece needs, without strays; each of shape (n,)."""

    samples: FloatArray
    place: FloatArray
    """Mean position."""
    level: FloatArray
    """Mean value."""
    width: FloatArray
    """Sum of the squared distances from the mean position."""
    rise: FloatArray
    """Sum of the products of the distances from both means."""


def _lines(values: FloatArray, pieces: Pieces, sigma: float) -> _Lines:
    lines = _Lines(*np.empty((5, len(pieces))))
    for some, part in _of_one_length(values, pieces):
        kept = (~_strays(part, sigma)).astype(np.float64)
        at = np.arange(part.shape[1], dtype=np.float64)
        samples = kept.sum(axis=1)
        place = kept @ at / samples
        level = _row_sums(kept, part) / samples
        apart = kept * (at - place[:, None])
        lines.samples[some], lines.place[some], lines.level[some] = samples, pieces[some, 0] + place, level
        lines.width[some] = _row_sums(apart, apart)
        lines.rise[some] = _row_sums(apart, part - level[:, None])
    return lines


def _row_sums(left: FloatArray, right: FloatArray) -> FloatArray:
    """Return the sum of the products in each row; faster than a product that is summed up."""
    sums: FloatArray = np.einsum("ij,ij->i", left, right)
    return sums


def _steps_between(before: _Lines, after: _Lines, edges: IntArray) -> tuple[FloatArray, FloatArray]:
    """Return the steps of least squares between pieces of the same drift, and their deviations in units of the noise.

    Args:
        before: The pieces before the steps.
        after: The pieces after them.
        edges: Where the pieces before the steps stop.
    """
    apart = after.place - before.place
    width = before.width + after.width
    lone = width == 0.0
    safe_width = np.where(lone, 1.0, width)
    step = after.level - before.level - apart * (before.rise + after.rise) / safe_width
    spread = np.sqrt(1.0 / before.samples + 1.0 / after.samples + apart * apart / safe_width)
    if lone.any():
        # Of the many solutions for one sample on each side, the one with the smallest numbers.
        step[lone], spread[lone] = _lone_steps(
            np.stack((before.place[lone], after.place[lone]), axis=1) - edges[lone, None],
            np.stack((before.level[lone], after.level[lone]), axis=1),
        )
    return step, spread


def _lone_steps(places: FloatArray, levels: FloatArray) -> tuple[FloatArray, FloatArray]:
    ones, after = np.ones_like(places), np.broadcast_to([0.0, 1.0], places.shape)
    rows = np.linalg.pinv(np.stack((ones, places, after), axis=2))[:, 2]
    return (rows * levels).sum(axis=1), np.sqrt((rows * rows).sum(axis=1))


def _strays(part: FloatArray, sigma: float) -> _BoolArray:
    """Return which samples of levels are strays, shape (m, length) as the samples."""
    length = part.shape[1]
    half = length // 2
    rest = part
    if half >= 4:
        slope = (_medians(part[:, -half:]) - _medians(part[:, :half])) / (length - half)
        rest = part - slope[:, None] * np.arange(length)
    off: _BoolArray = np.abs(rest - _medians(rest)[:, None]) > _FAR * sigma
    return off & ~off.all(axis=1, keepdims=True)


def _medians(part: FloatArray) -> FloatArray:
    """Return the median of each row; numpy's own takes ten times longer for short rows."""
    ordered = np.sort(part, axis=1)
    middle = part.shape[1] // 2
    return ordered[:, middle] if part.shape[1] % 2 else (ordered[:, middle - 1] + ordered[:, middle]) / 2.0


def _measured(values: FloatArray, pieces: Pieces, sigma: float) -> _Found:
    """Return the pieces as plateaus."""
    found = np.zeros(len(pieces), FIELDS)
    found["start"], found["stop"] = pieces.T
    for some, part in _of_one_length(values, pieces):
        off = _strays(part, sigma)
        counts = off.sum(axis=1)
        found["strays"][some] = counts
        for count in np.unique(counts):
            alike = counts == count
            found[some[alike]] = _levelled(found[some[alike]], part[alike], ~off[alike])
    return found


def _levelled(found: _Found, part: FloatArray, keep: _BoolArray) -> _Found:
    """Return plateaus of one length with their level, spread and drift.

    Args:
        found: The plateaus.
        part: Their samples, shape (m, length).
        keep: Which of them are no strays: the same number of each plateau.
    """
    count, length = part.shape
    kept = part[keep].reshape(count, -1)
    uneven = (kept != kept[:, :1]).any(axis=1)
    found["level"] = np.where(uneven, kept.mean(axis=1), kept[:, 0])
    found["spread"] = np.where(uneven, kept.std(axis=1), 0.0)
    if kept.shape[1] >= 8:
        at = np.nonzero(keep)[1].reshape(kept.shape).astype(np.float64)
        at -= at.mean(axis=1, keepdims=True)
        drift = (at * kept).sum(axis=1) / (at * at).sum(axis=1) * (length - 1)
        found["drift"] = np.where(uneven, drift, 0.0)
    return found


def _measured_again(values: FloatArray, pieces: Pieces, found: _Found, sigma: float) -> _Found:
    """Return the pieces as plateaus; those that are found already are taken over."""
    known = np.minimum(np.searchsorted(found["start"], pieces[:, 0]), len(found) - 1)
    measured = found[known]
    changed = (_spans(measured) != pieces).any(axis=1)
    measured[changed] = _measured(values, pieces[changed], sigma)
    return measured


def _are_edges(found: _Found) -> _BoolArray:
    """Return which are short pieces that are only the edge between two plateaus."""
    edges = np.zeros(len(found), bool)
    lengths, level = _lengths(_spans(found)), found["level"]
    low, high = np.minimum(level[:-2], level[2:]), np.maximum(level[:-2], level[2:])
    is_between = (low < level[1:-1]) & (level[1:-1] < high)
    is_shorter = np.minimum(lengths[:-2], lengths[2:]) > lengths[1:-1]
    edges[1:-1] = (lengths[1:-1] <= _EDGE_SAMPLES) & is_shorter & is_between
    return edges


def _are_ramps(values: FloatArray, found: _Found, sigma: float) -> _BoolArray:
    """Return which are short pieces that rise or fall from each sample to the next."""
    ramps = _lengths(_spans(found)) <= _EDGE_SAMPLES + 1
    short = np.flatnonzero(ramps)
    for some, part in _of_one_length(values, _spans(found[short])):
        steps = np.diff(part, axis=1)
        one_way = (steps > 0.0).all(axis=1) | (steps < 0.0).all(axis=1)
        ramps[short[some]] = one_way & (np.abs(steps) > _CERTAINTY * sigma).all(axis=1)
    return ramps


def _are_slopes(values: FloatArray, found: _Found, scale: float) -> _BoolArray:
    """Return which rise or fall so much that they have no level, as an angle does in a turn."""
    slopes: _BoolArray = np.abs(found["drift"]) > _SLOPE_OF_RANGE * scale
    for at in np.flatnonzero(slopes):
        highest = np.max(np.abs(values[found["start"][at] : found["stop"][at]]))
        slopes[at] = np.abs(found["drift"][at]) > _SLOPE_OF_VALUE * highest
    return slopes


def _with_ends(values: FloatArray, found: _Found, least_step: float) -> _Found:
    """Add the first and the last sample as levels of their own if they are a step away from the nearest plateau.

    A program that logs until it meets a value ends its log at the first sample of that level.
    """
    first, last = 0, len(values) - 1
    before, after = found[0], found[-1]
    ends = ((first, before["start"] - first, before["level"]), (last, last + 1 - after["stop"], after["level"]))
    single = [
        (at, at + 1, values[at], 0.0, 0.0, 0)
        for at, apart, level in ends
        if 1 <= apart <= _EDGE_SAMPLES and abs(values[at] - level) > least_step
    ]
    added = np.array(single, FIELDS)
    is_first = added["start"] < before["start"]
    return np.concatenate((added[is_first], found, added[~is_first]))


def _grown(values: FloatArray, pieces: Pieces, sigma: float) -> Pieces:
    """Extend pieces by samples of the same level beyond a stray at their ends."""
    grown = pieces.copy()
    near = _FAR * sigma / 2.0
    for at in _growing(values, pieces, near).tolist():
        start, stop = pieces[at].tolist()
        first = grown[at - 1, 1] if at else 0
        last = pieces[at + 1, 0] if at + 1 < len(pieces) else len(values)
        for ahead in range(start - 1, max(first, start - 1 - _STRAY_SAMPLES) - 1, -1):
            if abs(values[ahead] - _medians(values[None, start : start + _NEAR_SAMPLES])[0]) <= near:
                start = ahead
        for ahead in range(stop, min(last, stop + 1 + _STRAY_SAMPLES)):
            if abs(values[ahead] - _medians(values[None, max(start, stop - _NEAR_SAMPLES) : stop])[0]) <= near:
                stop = ahead + 1
        grown[at] = start, stop
    return grown


def _growing(values: FloatArray, pieces: Pieces, near: float) -> IntArray:
    """Return which pieces have a sample of their level ahead of one of their ends, so that they may grow."""
    starts, stops = pieces.T
    firsts, lasts = np.append(0, stops[:-1]), np.append(starts[1:], len(values))
    apart = np.flatnonzero((firsts < starts) | (stops < lasts))
    starts, stops, firsts, lasts = starts[apart], stops[apart], firsts[apart], lasts[apart]
    heads = _levels_of(values, starts, np.minimum(starts + _NEAR_SAMPLES, len(values)))
    tails = _levels_of(values, np.maximum(starts, stops - _NEAR_SAMPLES), stops)
    growing = np.zeros(len(apart), bool)
    for ahead in range(1 + _STRAY_SAMPLES):
        for at, level in ((starts - 1 - ahead, heads), (stops + ahead, tails)):
            free = (firsts <= at) & (at < lasts)
            growing |= free & (np.abs(values[np.where(free, at, 0)] - level) <= near)
    return apart[growing]


def _levels_of(values: FloatArray, starts: IntArray, stops: IntArray) -> FloatArray:
    """Return the medians of spans."""
    levels = np.empty(len(starts))
    for some, part in _of_one_length(values, np.stack((starts, stops), axis=1)):
        levels[some] = _medians(part)
    return levels


_PACKAGE_FOLDER = Path(__file__).resolve().parents[2]
_LOOK_S = 0.1


def plateaus_in_subprocess(values: FloatArray, stopped: Callable[[], bool]) -> list[Plateau]:
    """Return the plateaus of a log, as `plateaus` does, from a process of its own.

    A search in a thread would hold up every key for a second.

    Args:
        values: As for `plateaus`.
        stopped: Returns whether to give up; called repeatedly.

    Raises:
        LogError: the search was stopped, its process has ended without an answer, or there
            is no room for temporary files.
    """
    try:
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as answer:
            np.asarray(values, np.float64).tofile(given)
            given.seek(0)
            code = _ended(given, answer, stopped)
            if code:
                raise LogError(f"the search for bands failed (exit code {code})")
            answer.seek(0)
            found = np.fromfile(answer, FIELDS).tolist()
    except OSError as error:
        raise LogError(
            f"cannot search for bands: {error.strerror or error}", "it needs space for temporary files"
        ) from error
    return list(map(Plateau._make, found))


def _ended(given: IO[bytes], answer: IO[bytes], stopped: Callable[[], bool]) -> int:
    """Run the process and return its exit code."""
    with subprocess.Popen(
        [sys.executable, "-s", "-P", "-m", __name__],
        stdin=given,
        stdout=answer,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(_PACKAGE_FOLDER)},
    ) as process:
        while True:
            try:
                return process.wait(_LOOK_S)
            except subprocess.TimeoutExpired:
                if stopped():
                    process.kill()
                    raise LogError("the search for bands was stopped") from None


def _answer() -> None:
    """Read values from the standard input and write their plateaus to the standard output, both files."""
    found = plateaus(np.fromfile(sys.stdin.buffer))
    np.array(found, FIELDS).tofile(sys.stdout.buffer)


if __name__ == "__main__":
    _answer()
