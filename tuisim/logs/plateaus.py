"""Plateaus of a log, separated from the samples on their edges and from strays.

The search takes seven steps.

1. Samples that repeat a measurement are left out: a program may read faster than the sensor measures.
2. The noise is estimated from the differences of neighbours (Rice 1984), which levels leave alone.
3. Optimal partitioning cuts the log: the squared distances from the means of the pieces, in units of the noise,
   plus a price for each cut, are minimal. Starts that can no longer be the best are pruned (PELT: Killick, Fearnhead
   and Eckley 2012). In a long log, only the peaks of local differences may be cuts (screening and ranking: Niu and
   Zhang 2012).
4. Pieces are joined where the log goes on: across strays, and where a common drift explains the step (`pieces`). If
   this joined a level with an edge, only pieces of equal levels are joined.
5. Pieces without a level are dropped: those that move (`stillness`), and the steps of edges (`edges`).
6. What is left grows to its ends.
7. Parts of curves are dropped (`curves`).

Binary segmentation would be simpler, but it misses a short level between two long ones that are alike.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from tuisim.base.errors import LogError
from tuisim.engine.runs.arrays import FloatArray, IntArray, number_members
from tuisim.logs.curves import find_curves
from tuisim.logs.edges import EDGE_SAMPLES, find_edges, find_hidden_edges
from tuisim.logs.pieces import (
    CERTAINTY,
    FAR,
    MIN_SAMPLES,
    NEAR_SAMPLES,
    STRAY_SAMPLES,
    BoolArray,
    Pieces,
    Signal,
    compute_medians,
    count_samples,
    group_by_length,
    join_across_strays,
    join_drifting,
)
from tuisim.logs.stillness import (
    FIELDS,
    PlateauArray,
    add_apart,
    estimate_noise,
    find_moving,
    find_still_parts,
    measure,
    read_spans,
)

MAX_SAMPLES_CUT_ANYWHERE = 4000
"""Largest number of samples of a log that may be cut at every position.

A longer log is cut only at positions before and after which the means of the samples differ. The time of the search
grows with the square of the positions where nothing can be pruned: in a log without steps.
"""

_FEW_STEPS = 0.2
"""Most levels of a log are short if more than this fraction of the differences between neighbouring samples are steps.
"""

_FEW_STARTS = 12
"""Up to this number of possible starts of a piece, the search computes with Python's floats, which are then faster than
arrays.
"""

_GIANT = 1000.0
"""Samples farther from their median than this multiple of their range are moved to that distance.

The noise counts as at least 1/800 of the range, so the square of a clipped sample is at most 6.4e11 times that of the
noise: a float of 16 digits still has four for the others.
"""

_STEP_OF_RANGE = 0.005
"""Smallest step between two levels as a fraction of the range, whatever the noise: half of a step of 1 in readings from
0 to 100.
"""

_COARSE = 0.05
"""Jumps of noisy readings by one step of their scale are noise if the step is below this fraction of the range: 1 in
readings from 0 to 20.
"""

_MIN_RUNS = 24
"""Fewest runs of equal samples from which it is estimated for how many samples a sensor repeats a measurement."""

_DUST = 1e-9
"""Differences between samples below this fraction of the largest one are rounding errors."""

_BLOCK = 400_000
"""Number of samples in each block of a long log that is cut into pieces by itself; a level that goes on in the next
block is joined again.
"""


Search = Callable[[FloatArray], PlateauArray]
"""A function that finds plateaus: `find_plateaus`, or `find_plateaus_in_subprocess`."""


def _find_steps(differences: FloatArray) -> BoolArray:
    """Return for each difference between neighbours whether it is a step; all False unless most levels are short.

    A log with two or three samples for most levels is known by its differences: more than a fifth of them are far
    larger than those before and after. In noise, large differences follow each other.
    """
    calm = np.minimum(differences[1:], differences[:-1]).max(initial=0.0)
    steps = differences > FAR * calm
    real_steps: BoolArray = steps & (steps.sum() > _FEW_STEPS * len(differences))
    return real_steps


@np.errstate(over="ignore", invalid="ignore")
def find_plateaus(values: FloatArray) -> PlateauArray:
    """Return the plateaus of a log in order; the samples between plateaus are edges.

    Samples that are not finite belong to no plateau. A spread is the standard deviation of a sample (divided by n - 1).

    Args:
        values: Samples at a fixed period, shape (n,).
    """
    places = np.flatnonzero(np.isfinite(values))
    clean = np.asarray(values, np.float64)[places]
    if not len(clean):
        return np.empty(0, FIELDS)
    starts = _find_measurements(clean)
    signal, plateaus = _search(clean[starts])
    if len(starts) < len(clean):
        spans = np.append(starts, len(clean))[read_spans(plateaus)]
        plateaus = measure(signal._replace(values=clean), spans)
    # The search divides by n, so that short pieces do not count as uneven; people compare with pandas.
    counts = count_samples(read_spans(plateaus)) - plateaus["strays"]
    plateaus["spread"] *= np.sqrt(counts / np.maximum(counts - 1, 1))
    plateaus["start"] = places[plateaus["start"]]
    plateaus["stop"] = places[plateaus["stop"] - 1] + 1
    return plateaus


def _find_measurements(values: FloatArray) -> IntArray:
    """Return the index of the first sample of each measurement of a sensor.

    A sensor that measures more seldom than the program reads it repeats its last value, so that a measurement is a run
    of equal samples. A run of twice the usual length is two measurements with the same value. If most samples are in
    runs of the usual length, each of these is a short level instead, and each sample is a measurement.
    """
    starts = np.append(0, np.flatnonzero(np.diff(values)) + 1)
    lengths = np.diff(starts, append=len(values))
    shortest = np.percentile(lengths, 10.0, method="lower")
    if shortest == 1:
        return np.arange(len(values))
    period = lengths[lengths <= 1.5 * shortest].mean()
    counts = np.maximum(1, np.rint(lengths / period).astype(np.int64))
    if len(lengths) < _MIN_RUNS or 2 * lengths[counts == 1].sum() > len(values):
        return np.arange(len(values))
    run, number = number_members(counts)
    firsts: IntArray = starts[run] + number * lengths[run] // counts[run]
    return firsts


def _search(values: FloatArray) -> tuple[Signal, PlateauArray]:
    """Return the noise and other sizes of a log, and its plateaus.

    Args:
        values: The samples, all finite, shape (n,); at least one.
    """
    differences = np.abs(np.diff(values))
    is_step = _find_steps(differences)
    signal, has_noise = _measure_signal(values, differences[~is_step])
    # Huge values are limited, as their squares would leave no digits for other values.
    far = _GIANT * max(signal.range, signal.sigma)
    middle = np.median(values)
    cut = _cut(np.clip(values, middle - far, middle + far), signal.sigma)
    has_strays = not is_step.any()
    plateaus = _join_levels(signal, cut, has_strays=has_strays)
    moving = find_moving(signal, plateaus)
    parts = find_still_parts(signal, plateaus[moving], cut)
    plateaus = plateaus[~moving]
    if has_strays:
        # With noise, a level needs one sample more than `MIN_SAMPLES`, except at the ends of a log.
        plateaus = _drop_short(signal, plateaus, MIN_SAMPLES + has_noise)
    plateaus = add_apart(_settle(signal, plateaus), parts)
    plateaus = _add_ends(signal, plateaus[~find_curves(signal, plateaus)])
    return signal, plateaus[~find_edges(plateaus)] if has_strays else plateaus


def _measure_signal(values: FloatArray, differences: FloatArray) -> tuple[Signal, bool]:
    """Return a log with its range and noise, and whether it has noise.

    Args:
        values: The log.
        differences: The absolute differences between neighbours, without steps.
    """
    low, high = _find_extremes(values)
    # Without noise, the price of a cut follows from the smallest step.
    min_step = max((high - low) * _STEP_OF_RANGE, _DUST * max(abs(low), abs(high)), 1e-12)
    noise = estimate_noise(differences, 2.0)
    jumps = differences[differences > _DUST * max(abs(low), abs(high))]
    step = jumps.min(initial=np.inf)
    if noise and step < _COARSE * (high - low) and np.median(jumps) < 2.0 * step:
        # Readings on a coarse scale jump between two of its values: a standard deviation of half a step.
        noise = max(noise, step / 2.0)
    sigma = max(noise, min_step / CERTAINTY)
    noise_of_slopes = max(estimate_noise(np.abs(np.diff(values, 2)), 6.0), min_step / CERTAINTY)
    signal = Signal(values, high - low, min(sigma, noise_of_slopes), sigma, min_step)
    return signal, noise > 0.0


def _join_levels(signal: Signal, cut: Pieces, *, has_strays: bool) -> PlateauArray:
    """Return pieces of a log as plateaus; pieces are joined if one continues the other, but not over an edge.

    Args:
        signal: The log.
        cut: Its pieces, without gaps between them.
        has_strays: Whether to join also across strays.
    """
    pieces = _join_pieces(signal, cut, has_strays=has_strays)
    plateaus = measure(signal, pieces)
    owners = np.searchsorted(pieces[:, 0], cut[:, 0], side="right") - 1
    hidden = find_hidden_edges(signal, plateaus, cut, owners)
    if hidden.any():
        # Beside a level, the beginning of a slow edge looks like a drift: there, only equal levels are joined.
        parts = np.concatenate((pieces[~hidden], cut[hidden[owners]]))
        parts = parts[np.argsort(parts[:, 0])]
        pieces = _join_pieces(signal._replace(drifts=False), parts, has_strays=has_strays)
        plateaus = _measure_changed(signal, pieces, plateaus)
    long_plateaus: PlateauArray = plateaus[count_samples(pieces) >= MIN_SAMPLES]
    return long_plateaus


def _join_pieces(signal: Signal, pieces: Pieces, *, has_strays: bool) -> Pieces:
    """Return pieces of a log, joined where one continues another.

    Args:
        signal: The log.
        pieces: Its pieces.
        has_strays: Whether to join also across strays.
    """
    # Strays are joined twice, as one may be hidden between short pieces of a drift.
    for _ in range(2):
        count = len(pieces)
        if has_strays:
            pieces = join_across_strays(signal, pieces)
        pieces = join_drifting(signal, pieces)
        if len(pieces) == count:
            break
    return pieces


def _drop_short(signal: Signal, plateaus: PlateauArray, min_samples: int) -> PlateauArray:
    """Return plateaus without steps on edges, and without plateaus of fewer than `min_samples` samples.

    A short plateau at an end of the log is kept, as the log may have cut it off.
    """
    plateaus = plateaus[~find_edges(plateaus)]
    at_an_end = (plateaus["start"] == 0) | (plateaus["stop"] == len(signal.values))
    is_long = count_samples(read_spans(plateaus)) >= min_samples
    long_plateaus: PlateauArray = plateaus[at_an_end | is_long]
    return long_plateaus


def _settle(signal: Signal, plateaus: PlateauArray) -> PlateauArray:
    """Return plateaus extended at their ends, joined where one continues another, and measured again.

    Plateaus that turn out to rise or fall are left out.
    """
    if not len(plateaus):
        return plateaus
    # After they were extended, two plateaus may be separated only by a stray, so they are joined again.
    grown = _extend_pieces(signal, read_spans(plateaus))
    spans = join_drifting(signal._replace(drifts=False), grown)
    settled = _measure_changed(signal, spans, plateaus)
    still: PlateauArray = settled[~find_moving(signal, settled)]
    return still


def _measure_changed(signal: Signal, pieces: Pieces, plateaus: PlateauArray) -> PlateauArray:
    """Return pieces of a log as plateaus, with level, spread, drift and strays.

    Pieces that are equal to one of the given plateaus are not measured again. Most pieces are, so this saves up to a
    sixth of the time of the search.

    Args:
        signal: The log.
        pieces: The pieces.
        plateaus: Plateaus that were measured before, at least one.
    """
    known = np.minimum(np.searchsorted(plateaus["start"], pieces[:, 0]), len(plateaus) - 1)
    measured = plateaus[known]
    changed = (read_spans(measured) != pieces).any(axis=1)
    measured[changed] = measure(signal, pieces[changed])
    return measured


def _find_extremes(values: FloatArray) -> tuple[float, float]:
    """Return the lowest and the highest value of a log, where a few strays in a row do not count."""
    if len(values) > STRAY_SAMPLES:
        windows = sliding_window_view(values, STRAY_SAMPLES + 1).T
        low, high = float(windows.max(axis=0).min()), float(windows.min(axis=0).max())
        if low <= high:
            return low, high
    return float(values.min()), float(values.max())


def _cut(values: FloatArray, sigma: float) -> Pieces:
    """Return a log cut into pieces at the steps between levels, so that each piece has about one level.

    Args:
        values: The log.
        sigma: Standard deviation of the noise.
    """
    pieces = []
    for first in range(0, len(values), _BLOCK):
        block = values[first : first + _BLOCK]
        # The values are centred, as sums of squares of large values have too few digits for small steps.
        block = (block - block.mean()) / sigma
        pieces.append(first + _partition(block, _choose_places(block)))
    return np.concatenate(pieces)


def _choose_places(scaled: FloatArray) -> IntArray:
    """Return the positions at which a log may be cut, from 0 to its length, both included.

    In a short log, these are all positions. In a long log, they are those where the mean of the samples before and the
    mean of the samples after differ most, by more than `CERTAINTY` standard deviations. The means are taken over 1, 3,
    8 and 24 samples, so that one of these widths fits a level of any length; 24 samples show a step of 1.2 times the
    noise. The positions beside such a position may be cuts, too, since noise shifts it.

    Args:
        scaled: The log in units of the noise.
    """
    count = len(scaled)
    if count <= MAX_SAMPLES_CUT_ANYWHERE:
        return np.arange(count + 1)
    sums = np.concatenate(([0.0], np.cumsum(scaled)))
    chosen = np.zeros(count + 1, bool)
    chosen[[0, count]] = True
    for width in (1, 3, 8, 24):
        step = np.abs(sums[2 * width :] - 2.0 * sums[width:-width] + sums[: -2 * width]) / width
        step *= np.sqrt(width / 2.0)
        # Keep only the highest step within its own width, so that one edge does not give many positions.
        peak = np.ones(len(step), bool)
        for shift in range(1, width + 1):
            peak[shift:] &= step[shift:] >= step[:-shift]
            peak[:-shift] &= step[:-shift] >= step[shift:]
        strong = np.flatnonzero(peak & (step > CERTAINTY)) + width
        for shift in (-1, 0, 1):
            chosen[np.clip(strong + shift, 0, count)] = True
    return np.flatnonzero(chosen)


def _partition(scaled: FloatArray, places: IntArray) -> Pieces:
    """Return the cheapest partition of a log, with cuts at some of the given positions.

    Args:
        scaled: The log in units of the noise.
        places: The positions of possible cuts.
    """
    # The price of one more cut: Schwarz's criterion charges 2 ln n, the modified one of Zhang and Siegmund (2007)
    # 3 ln n. Of 300 logs of 300 samples of noise alone, a price of ln n cuts 80 %, one of 2 ln n 4 %, this one none.
    price = float(3.0 * np.log(max(len(scaled), 8)) + 2.0)
    all_sums = np.concatenate(([0.0], np.cumsum(scaled)))[places]
    all_squares = np.concatenate(([0.0], np.cumsum(scaled**2)))[places]
    all_best = np.full(len(places), -price)
    ends = places.tolist()
    sums = all_sums.tolist()
    squares = all_squares.tolist()
    best = [-price]
    before = [0]
    alive: Sequence[int] | IntArray = [0]
    for index in range(1, len(ends)):
        end = ends[index]
        total = sums[index]
        square = squares[index]
        # A start with higher costs can never become the best one again.
        if len(alive) <= _FEW_STARTS:
            costs = [
                best[start]
                + square
                - squares[start]
                - (rise := total - sums[start]) * rise / (end - ends[start])
                for start in alive
            ]
            lowest = min(costs)
            before.append(alive[costs.index(lowest)])
            highest = lowest + price
            alive = [start for start, cost in zip(alive, costs, strict=True) if cost <= highest]
            alive.append(index)
        else:
            starts = np.asarray(alive)
            rises = total - all_sums[starts]
            all_costs = (
                all_best[starts]
                + square
                - all_squares[starts]
                - rises * rises / (end - places[starts])
            )
            cheapest = int(np.argmin(all_costs))
            before.append(int(starts[cheapest]))
            highest = float(all_costs[cheapest]) + price
            alive = np.append(starts[all_costs <= highest], index)
        best.append(highest)
        all_best[index] = highest
    cuts = [len(ends) - 1]
    while cuts[-1] > 0:
        cuts.append(before[cuts[-1]])
    chosen = places[cuts[::-1]]
    return np.stack((chosen[:-1], chosen[1:]), axis=1)


def _add_ends(signal: Signal, plateaus: PlateauArray) -> PlateauArray:
    """Return plateaus together with the first and the last sample of the log as plateaus of one sample, in order.

    Such a sample is added only if it is near a plateau and clearly differs from its level: a program that logs until it
    meets a value ends its log at the first sample of the new level.
    """
    if not len(plateaus):
        return plateaus
    values = signal.values
    min_step = max(signal.min_step, FAR * signal.sigma)
    last = len(values) - 1
    before, after = plateaus[0], plateaus[-1]
    ends = (
        (0, before["start"], before["level"]),
        (last, last + 1 - after["stop"], after["level"]),
    )
    single = [
        (position, position + 1, values[position], 0.0, 0.0, 0)
        for position, apart, level in ends
        if 1 <= apart <= EDGE_SAMPLES + 1 and abs(values[position] - level) > min_step
    ]
    return add_apart(plateaus, np.array(single, FIELDS))


def _extend_pieces(signal: Signal, pieces: Pieces) -> Pieces:
    """Return pieces extended at both ends: a sample next to a piece is added if it has the level of the piece.

    A few strays may lie in between. A short piece is not extended at its start.
    """
    values = signal.values
    near = FAR * signal.sigma / 2.0
    # In the reversed log, the ends of pieces are starts.
    mirrored = len(values) - pieces[::-1, ::-1]
    stops = (
        len(values)
        - _extend_starts(values[::-1], mirrored, np.append(0, mirrored[:-1, 1]), near)[::-1]
    )
    # A short piece is not extended backwards, as a sample there may as well belong to the piece before.
    limits = np.where(
        2 * count_samples(pieces) <= NEAR_SAMPLES, pieces[:, 0], np.append(0, stops[:-1])
    )
    return np.stack((_extend_starts(values, pieces, limits, near), stops), axis=1)


def _extend_starts(values: FloatArray, pieces: Pieces, limits: IntArray, near: float) -> IntArray:
    """Return the starts of pieces after each piece was extended to earlier samples of its level.

    Args:
        values: The log.
        pieces: Its pieces.
        limits: The earliest start of each piece, such as the end of the piece before it.
        near: By how much a sample may differ from the level of a piece.
    """
    starts: IntArray
    starts, stops = pieces.T.copy()
    for ahead in starts - 1 - np.arange(STRAY_SAMPLES + 1)[:, None]:
        free = np.flatnonzero(ahead >= limits)
        nearest = np.minimum(starts[free] + NEAR_SAMPLES, stops[free])
        for some, part in group_by_length(values, np.stack((starts[free], nearest), axis=1)):
            apart = np.abs(values[ahead[free[some]]] - compute_medians(part))
            grown = free[some][apart <= near]
            starts[grown] = ahead[grown]
    return starts


_PACKAGE_FOLDER = Path(__file__).resolve().parents[2]
_LOOK_S = 0.1


def find_plateaus_in_subprocess(values: FloatArray, stopped: Callable[[], bool]) -> PlateauArray:
    """Return the plateaus of a log, as `find_plateaus` does, computed in another process.

    A search in a thread of the app would stop it from reacting to keys for a second.

    Args:
        values: As for `find_plateaus`.
        stopped: Returns whether to give up; called repeatedly.

    Raises:
        LogError: the search was stopped, or its process has ended without an answer.
    """
    unsent: bytes | None = np.asarray(values, np.float64).tobytes()
    with subprocess.Popen(
        [sys.executable, "-s", "-P", "-m", __name__],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(_PACKAGE_FOLDER)},
    ) as process:
        answer = None
        while answer is None:
            try:
                answer, _ = process.communicate(unsent, _LOOK_S)
            except subprocess.TimeoutExpired:
                unsent = None
                if stopped():
                    process.kill()
                    raise LogError("the search for bands was stopped") from None
    if process.returncode:
        raise LogError(f"the search for bands failed (exit code {process.returncode})")
    return np.frombuffer(answer, FIELDS)


def _answer() -> None:
    """Read values from the standard input and write their plateaus to the standard output."""
    sys.stdout.buffer.write(find_plateaus(np.frombuffer(sys.stdin.buffer.read())).tobytes())


if __name__ == "__main__":
    _answer()
