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
from collections.abc import Callable
from dataclasses import astuple
from functools import lru_cache
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from tuisim.data_class import dataclass
from tuisim.errors import LogError
from tuisim.runs.arrays import FloatArray

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

_FEW_SAMPLES = 100
"""Up to this number, a median is found by sorting a list."""

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


@dataclass(frozen=True, slots=True)
class Plateau:
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


def _steps(differences: FloatArray) -> NDArray[np.bool_]:
    """Return which differences between neighbours are steps, if the log has only short levels; otherwise none.

    If more than a fifth of the differences are far larger than the ones before and after them, most levels have two or
    three samples, without edges or strays between them. In noise, large differences follow each other.
    """
    calm = np.minimum(differences[1:], differences[:-1]).max(initial=0.0)
    steps: NDArray[np.bool_] = differences > _FAR * calm
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
        if not short_levels:
            pieces = _without_strays(clean, pieces, least_step, sigma)
        pieces = _joined(clean, pieces, least_step, sigma)
    found = [_plateau(clean, start, stop, sigma) for start, stop in pieces if stop - start >= MIN_SAMPLES]
    found = [p for p in found if not _is_slope(clean, p, scale)]
    if not short_levels:
        found = [p for p in found if not _is_ramp(clean, p, sigma)]
        found = [plateau for at, plateau in enumerate(found) if not _is_edge(found, at)]
        # With noise, two samples of about the same value are no level, except at the ends of a log.
        least = MIN_SAMPLES + (noise > 0.0)
        found = [p for p in found if p.samples >= least or p.start == 0 or p.stop == len(clean)]
    found = _grown(clean, found, sigma)
    # After growing, two may be separated by no more than a stray.
    whole = {(p.start, p.stop): p for p in found}
    spans = _joined(clean, list(whole), least_step, sigma)
    found = [whole.get(span) or _plateau(clean, *span, sigma) for span in spans]
    found = _with_ends(clean, found, max(least_step, _FAR * sigma))
    return [
        Plateau(int(finite[p.start]), int(finite[p.stop - 1]) + 1, p.level, p.spread, p.drift, p.strays) for p in found
    ]


def _levels(values: FloatArray) -> tuple[float, float]:
    """Return the lowest and the highest level, whatever the values of strays."""
    if len(values) > _STRAY_SAMPLES:
        parts = [values[at : len(values) - _STRAY_SAMPLES + at] for at in range(_STRAY_SAMPLES + 1)]
        low, high = float(np.maximum.reduce(parts).min()), float(np.minimum.reduce(parts).max())
        if low <= high:
            return low, high
    return float(values.min()), float(values.max())


Pieces = list[tuple[int, int]]


def _cut(values: FloatArray, sigma: float) -> Pieces:
    """Cut the log into pieces of about one level each."""
    pieces: Pieces = []
    for first in range(0, len(values), _BLOCK):
        block = values[first : first + _BLOCK]
        # Centred, since sums of squares of large values have no digits left for small steps.
        block = (block - block.mean()) / sigma
        places = _places(block)
        pieces += [(first + start, first + stop) for start, stop in _partition(block, places)]
    return pieces


def _places(scaled: FloatArray) -> NDArray[np.int64]:
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


def _partition(scaled: FloatArray, places: NDArray[np.int64]) -> Pieces:
    """Return the cheapest partition of values in units of the noise, with cuts at some of the places."""
    price = 3.0 * np.log(max(len(scaled), 8)) + 2.0
    sums = np.concatenate(([0.0], np.cumsum(scaled)))[places]
    squares = np.concatenate(([0.0], np.cumsum(scaled**2)))[places]
    count = len(places)
    best = np.full(count, np.inf)
    best[0] = -price
    before = np.zeros(count, np.int64)
    alive = np.zeros(1, np.int64)
    for at in range(1, count):
        length = places[at] - places[alive]
        total = sums[at] - sums[alive]
        cost = best[alive] + squares[at] - squares[alive] - total * total / length
        cheapest = int(np.argmin(cost))
        best[at] = cost[cheapest] + price
        before[at] = alive[cheapest]
        # A start with higher costs can never become the best one again.
        alive = np.append(alive[cost <= best[at]], at)
    pieces: Pieces = []
    at = count - 1
    while at > 0:
        pieces.append((int(places[before[at]]), int(places[at])))
        at = int(before[at])
    return pieces[::-1]


def _without_strays(values: FloatArray, pieces: Pieces, least_step: float, sigma: float) -> Pieces:
    """Join pieces that only a few strays separate."""
    done: Pieces = []
    at = 0
    while at < len(pieces):
        after = at
        while after < len(pieces) and pieces[after][1] - pieces[at][0] <= _STRAY_SAMPLES:
            after += 1
        if done and at < after < len(pieces):
            left, right = done[-1], pieces[after]
            # At least two on either side: an edge is no stray.
            long_enough = min(left[1] - left[0], right[1] - right[0]) >= MIN_SAMPLES
            if long_enough and _goes_on(values, left, right, least_step, sigma):
                done[-1] = (left[0], right[1])
                at = after + 1
                continue
        done.append(pieces[at])
        at += 1
    return done


def _joined(values: FloatArray, pieces: Pieces, least_step: float, sigma: float) -> Pieces:
    """Join neighbours that drift into each other, with at most a stray between them."""
    done: Pieces = []
    for piece in pieces:
        if done:
            left = done[-1]
            near = piece[0] - left[1] <= _STRAY_SAMPLES < min(left[1] - left[0], piece[1] - piece[0])
            if near and _goes_on(values, left, piece, least_step, sigma):
                done[-1] = (left[0], piece[1])
                continue
        done.append(piece)
    return done


def _goes_on(
    values: FloatArray, left: tuple[int, int], right: tuple[int, int], least_step: float, sigma: float
) -> bool:
    """Return whether one piece continues the other: a common drift explains the step between them."""
    before = values[max(left[0], left[1] - _NEAR_SAMPLES) : left[1]]
    after = values[right[0] : min(right[1], right[0] + _NEAR_SAMPLES)]
    off_before, off_after = _strays(before, sigma), _strays(after, sigma)
    apart = right[0] - left[1]
    places = np.concatenate((np.arange(-len(before), 0)[~off_before], np.arange(apart, apart + len(after))[~off_after]))
    kept = np.concatenate((before[~off_before], after[~off_after]))
    fit = _step_fit(places.tobytes(), apart)
    step = float(fit.row @ (fit.model.T @ kept))
    return abs(step) <= max(least_step, _CERTAINTY * sigma * fit.spread)


@dataclass(frozen=True, slots=True)
class _StepFit:
    """Least-squares fit of the step between two pieces, for samples at certain positions."""

    model: FloatArray
    """Shape (n, 3): level, drift and step at each position."""
    row: FloatArray
    """Shape (3,): the row of the inverse of the normal equations that gives the step."""
    spread: float
    """Standard deviation of the step, in units of the noise."""


@lru_cache(maxsize=1000)
def _step_fit(places: bytes, apart: int) -> _StepFit:
    """Return the fit for positions from the end of the left piece; cached, since most cuts have the same ones."""
    at = np.frombuffer(places, np.int64)
    model = np.stack([np.ones(len(at)), at, at >= apart], axis=1).astype(np.float64)
    inverse = np.linalg.pinv(model.T @ model)
    return _StepFit(model, inverse[2], float(np.sqrt(inverse[2, 2])))


def _strays(part: FloatArray, sigma: float) -> NDArray[np.bool_]:
    """Return which samples of a level are strays."""
    half = len(part) // 2
    rest = part
    if half >= 4:
        slope = (_median(part[-half:]) - _median(part[:half])) / (len(part) - half)
        rest = part - slope * np.arange(len(part))
    off: NDArray[np.bool_] = np.abs(rest - _median(rest)) > _FAR * sigma
    return off if not off.all() else np.zeros(len(part), bool)


def _median(part: FloatArray) -> float:
    """Return the median; faster than numpy's for the few samples of most pieces."""
    if len(part) > _FEW_SAMPLES:
        return float(np.median(part))
    ordered = sorted(part.tolist())
    middle = len(ordered) // 2
    return float(ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2.0)


def _plateau(values: FloatArray, start: int, stop: int, sigma: float) -> Plateau:
    part = values[start:stop]
    off = _strays(part, sigma)
    kept = part[~off]
    if bool((kept == kept[0]).all()):
        return Plateau(start, stop, float(kept[0]), 0.0, 0.0, int(off.sum()))
    drift = 0.0
    if len(kept) >= 8:
        at = np.flatnonzero(~off).astype(np.float64)
        at -= at.mean()
        drift = float(at @ kept / (at @ at)) * (len(part) - 1)
    return Plateau(start, stop, float(kept.mean()), float(kept.std()), drift, int(off.sum()))


def _is_edge(found: list[Plateau], at: int) -> bool:
    """Return whether a short piece is only the edge between two plateaus."""
    piece = found[at]
    if piece.samples > _EDGE_SAMPLES or not 0 < at < len(found) - 1:
        return False
    before, after = found[at - 1], found[at + 1]
    if min(before.samples, after.samples) <= piece.samples:
        return False
    return min(before.level, after.level) < piece.level < max(before.level, after.level)


def _is_ramp(values: FloatArray, plateau: Plateau, sigma: float) -> bool:
    """Return whether a short piece rises or falls from each sample to the next."""
    if plateau.samples > _EDGE_SAMPLES + 1:
        return False
    steps = np.diff(values[plateau.start : plateau.stop])
    return bool((np.abs(steps) > _CERTAINTY * sigma).all() and (np.sign(steps) == np.sign(steps[0])).all())


def _is_slope(values: FloatArray, plateau: Plateau, scale: float) -> bool:
    """Return whether a piece rises or falls so much that it has no level, as an angle does in a turn."""
    highest = float(np.max(np.abs(values[plateau.start : plateau.stop])))
    return abs(plateau.drift) > max(_SLOPE_OF_RANGE * scale, _SLOPE_OF_VALUE * highest)


def _with_ends(values: FloatArray, found: list[Plateau], least_step: float) -> list[Plateau]:
    """Add the first and the last sample as levels of their own if they are a step away from the nearest plateau.

    A program that logs until it meets a value ends its log at the first sample of that level.
    """
    if not found:
        return found
    first, last = 0, len(values) - 1
    ends = ((first, found[0].start - first, found[0].level), (last, last + 1 - found[-1].stop, found[-1].level))
    single = [
        Plateau(at, at + 1, float(values[at]), 0.0, 0.0)
        for at, apart, level in ends
        if 1 <= apart <= _EDGE_SAMPLES and abs(values[at] - level) > least_step
    ]
    return sorted((*found, *single), key=lambda plateau: plateau.start)


def _grown(values: FloatArray, found: list[Plateau], sigma: float) -> list[Plateau]:
    """Extend plateaus by samples of the same level beyond a stray at their ends."""
    grown: list[Plateau] = []
    for at, plateau in enumerate(found):
        first = grown[-1].stop if grown else 0
        last = found[at + 1].start if at + 1 < len(found) else len(values)
        start, stop = plateau.start, plateau.stop
        near = _FAR * sigma / 2.0
        for ahead in range(start - 1, max(first, start - 1 - _STRAY_SAMPLES) - 1, -1):
            if abs(values[ahead] - _median(values[start : start + _NEAR_SAMPLES])) <= near:
                start = ahead
        for ahead in range(stop, min(last, stop + 1 + _STRAY_SAMPLES)):
            if abs(values[ahead] - _median(values[max(start, stop - _NEAR_SAMPLES) : stop])) <= near:
                stop = ahead + 1
        same = (start, stop) == (plateau.start, plateau.stop)
        grown.append(plateau if same else _plateau(values, start, stop, sigma))
    return grown


_PACKAGE_FOLDER = Path(__file__).resolve().parents[2]
_LOOK_S = 0.1
_FIELDS = 6
"""Numbers of a plateau; a float holds each of them exactly."""


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
            found = np.fromfile(answer).reshape(-1, _FIELDS).tolist()
    except OSError as error:
        raise LogError(
            f"cannot search for bands: {error.strerror or error}", "it needs space for temporary files"
        ) from error
    return [Plateau(int(row[0]), int(row[1]), row[2], row[3], row[4], int(row[5])) for row in found]


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
    np.array([astuple(plateau) for plateau in found], np.float64).tofile(sys.stdout.buffer)


if __name__ == "__main__":
    _answer()
