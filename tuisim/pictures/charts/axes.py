"""Axes: round limits, ticks and labels, also in character cells."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

import numpy as np

if TYPE_CHECKING:
    from tuisim.engine.runs.arrays import FloatArray

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Steps that read well, as factors of a power of ten: those of Heckbert, "Nice numbers for graph labels" (Graphics
Gems, 1990), and 2.5, without which a step of 2 is followed by one more than twice as long."""

Limits = tuple[float, float]

MAX_DRAWN = 1e300
"""Charts draw larger numbers at this one: the distances between places on an axis must not overflow."""


def limit_drawn(numbers: FloatArray) -> FloatArray:
    """Return numbers with all finite numbers limited to ±`MAX_DRAWN`, for charts."""
    if not len(numbers) or (numbers.min() >= -MAX_DRAWN and numbers.max() <= MAX_DRAWN):
        return numbers
    return np.where(np.isfinite(numbers), numbers.clip(-MAX_DRAWN, MAX_DRAWN), numbers)


def choose_step(span: float, count: int) -> float:
    """Return a round number that divides a span, which is above 0, into at most about `count` parts."""
    # The minimum is 1e-300, since a part of the smallest span would be 0.
    rough = max(span / max(count, 1), 1e-300)
    magnitude = 10.0 ** math.floor(math.log10(rough))
    return next(step * magnitude for step in _STEPS if step * magnitude >= rough * 0.999)


def choose_limits(low: float, high: float) -> Limits:
    """Return round limits around two values, so that they seldom change while values come in."""
    size = max(abs(low), abs(high), 1.0)
    if high - low < 1e-9 * size:
        # The room grows with the number: adding 1 does not change one of more than sixteen digits. It is at least 2, so
        # that the step is 1 and the label of a count has no decimals.
        room = max(2.0, (1e-6 if size < 1e15 else 1e-3) * size)
        low, high = low - room, high + room
    step = choose_step(high - low, 4)
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step


_MORE_PARTS = 4
"""Number by which more parts are tried: such a step is at most half of the span, so that two positions are inside."""


def find_ticks(limits: Limits, count: int) -> list[float]:
    """Return round positions inside limits: at most about `count` of them, but at least two."""
    low, high = limits
    positions: list[float] = []
    for parts in range(count, count + _MORE_PARTS):
        step = choose_step(high - low, parts)
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
        positions = [multiple * step for multiple in range(first, last + 1)]
        if len(positions) > 1:
            break
    return positions


_MAX_DIGITS = 300
_MAX_CHARACTERS = 20
"""Longer labels are written with a power of ten."""


def label(value: float, step: float) -> str:
    """Return the label of a tick, with no more digits than are needed to tell it from the next tick.

    Args:
        value: Position of the tick.
        step: Distance between two ticks.
    """
    # The comparison has a tolerance: the distance may be the difference of two positions far from 0.
    exact = (
        count
        for count in range(_MAX_DIGITS)
        if math.isclose(round(step, count), step, rel_tol=1e-3)
    )
    digits = next(exact, _MAX_DIGITS)
    text = f"{value:.{digits}f}"
    if len(text) > _MAX_CHARACTERS:
        return _label_shortly(value, step)
    return "0" if float(text) == 0 else text


def _label_shortly(value: float, step: float) -> str:
    """Return the label of a tick as a few digits and a power of ten, enough to differ from the next tick's label."""
    digits = math.floor(math.log10(max(abs(value) / step, 1.0))) + 2
    return f"{value:.{max(digits, 4)}g}"


_MAX_LABEL = 9
"""Labels with more characters than that are written with a power of ten."""


def label_ticks(limits: Limits, count: int) -> list[tuple[float, str]]:
    """Return at most about `count` round positions between limits, with their labels."""
    positions = find_ticks(limits, max(count, 1))
    step = positions[1] - positions[0] if len(positions) > 1 else limits[1] - limits[0]
    texts = [label(position, step) for position in positions]
    if max(map(len, texts), default=0) > _MAX_LABEL:
        texts = [_label_shortly(position, step) for position in positions]
    return list(zip(positions, texts, strict=True))


def grow_limits(end_s: float) -> Limits:
    """Return limits from 0 to a time in s shortly after `end_s`.

    The limits grow in steps, so that a new point rarely rescales the curves.
    """
    step = choose_step(max(end_s, 1.0), 8)
    return 0.0, max(math.ceil(end_s / step - 1e-9) * step, 1.0)


_MIN_TIME_SHARE = 1e-14
_MIN_SPAN_S = 1e-100
"""Relative and absolute tolerance below which two times are equal."""


def widen_times(low_s: float, high_s: float) -> Limits:
    """Return two times in s as limits; if they are equal, limits around them."""
    size_s = max(abs(low_s), abs(high_s))
    if high_s - low_s > max(_MIN_TIME_SHARE * size_s, _MIN_SPAN_S):
        return low_s, high_s
    room_s = max(0.5, _MIN_TIME_SHARE * size_s)
    return low_s - room_s, high_s + room_s


def find_column(x: float, limits: Limits, columns: int) -> int:
    """Return the character column of a value on a horizontal axis.

    For values inside the limits, it is from 0 to `columns` - 1.
    """
    low, high = limits
    return math.floor((x - low) / (high - low) * (columns - 0.5))


def find_column_value(column: int, limits: Limits, columns: int) -> float:
    """Return the value in the middle of a character column of a horizontal axis."""
    low, high = limits
    return low + (high - low) * min(max((column + 0.25) / (columns - 0.5), 0.0), 1.0)


_MIN_CELLS = 2
"""Rows from a tick to the next one at least."""
_NEAR = 1e-6
"""Tolerance for whole numbers."""
_MIN_ROUND_ROWS = 7
"""Limits are round numbers: on fewer rows, labels at both ends are more useful than one tick between them."""


_MAX_PARTS = 6
"""More ticks are crowded."""
_SPARSE = {2: 0.15, 3: 0.05}
"""Penalty by number of parts, as a share of the span of the values: an axis of two or three parts must be so much
shorter than one with more ticks to be taken instead of it. The numbers are set by eye."""


def extend_limits(ends: Limits, rows: int) -> Limits:
    """Return limits for a vertical axis on which round ticks are in the middle of rows, at equal distances.

    The axis begins at a multiple of a round step, at or below the values. It has 2 to 6 parts, and may end beyond its
    last tick. Of all such axes, one is chosen that is short and easy to read. For this comparison, an axis counts as
    longer if it has few parts, or ticks in neighbouring rows. The limits seldom change while values come in.

    Args:
        ends: The lowest and the highest value.
        rows: Height of the canvas in characters, at least 1; if it is small, the limits are those of `choose_limits`.
    """
    low, high = limits = choose_limits(*ends)
    if rows < _MIN_ROUND_ROWS:
        return limits
    if ends[1] - ends[0] > _NEAR * (high - low):
        low, high = ends
    candidates = []
    for count in range(2, _MAX_PARTS + 2):
        step = choose_step(high - low, count)
        first = math.floor(low / step + 1e-9) * step
        cells = math.floor((rows - 1) * step / (high - first) + 1e-9)
        parts = (rows - 1) // cells if cells else 0
        if 2 <= parts <= _MAX_PARTS:
            end = first + step * (rows - 1) / cells
            length = (end - first) / (high - low)
            sparse = _SPARSE.get(parts, 0.0) + (cells < _MIN_CELLS)
            candidates.append((length + sparse, first, end))
    return min(candidates)[1:] if candidates else limits


def find_row_ticks(limits: Limits, rows: int) -> list[float]:
    """Return the values at which a vertical axis of this number of rows has a label."""
    if rows < _MIN_ROUND_ROWS:
        return list(limits)
    low, high = limits
    for cells in range(_MIN_CELLS, (rows - 1) // 2 + 1):
        distance = (high - low) / (rows - 1) * cells
        parts = (rows - 1) // cells
        step = choose_step(distance, 1)
        if (
            parts <= _MAX_PARTS
            and math.isclose(step, distance)
            and abs(low / step - round(low / step)) < _NEAR
        ):
            return [(round(low / step) + part) * step for part in range(parts + 1)]
    return find_ticks(limits, min(_MAX_PARTS, (rows - 1) // 2))


Places = TypeVar("Places", float, "FloatArray")


def measure_row(values: Places, limits: Limits, rows: int) -> Places:
    """Return how far each value is below the top of a canvas, in rows of characters, with fractions.

    Args:
        values: The values.
        limits: The values in the middle of the lowest and of the highest row.
        rows: Height of the canvas in characters.
    """
    low, high = limits
    return 0.5 + (high - values) / (high - low) * (rows - 1)


def time_ticks(limits: Limits, columns: int) -> list[float]:
    """Return the values at which a horizontal axis of this number of columns has a tick."""
    return find_ticks(limits, max(1, columns // 10))


def label_rows(limits: Limits, rows: int) -> dict[int, str]:
    """Return the labels of a vertical axis by row; row 0 is at the top."""
    low, high = limits
    if rows < _MIN_ROUND_ROWS:
        step = choose_step(high - low, 4)
        return {rows - 1: label(low, step), 0: label(high, step)}
    positions = find_row_ticks(limits, rows)
    step = positions[1] - positions[0] if len(positions) > 1 else high - low
    return {math.floor(measure_row(y, limits, rows) + _NEAR): label(y, step) for y in positions}


def draw_time_axis(limits: Limits, columns: int, unit: str = "s") -> tuple[str, str]:
    """Return a horizontal axis as two texts of `columns` characters: the line with its ticks, and the labels below."""
    positions = time_ticks(limits, columns)
    step = positions[1] - positions[0] if len(positions) > 1 else limits[1] - limits[0]
    line = ["─"] * columns
    below = [" "] * columns
    free_from = 0
    for position in positions:
        column = find_column(position, limits, columns)
        text = label(position, step) + (f" {unit}" if position == positions[-1] else "")
        start = min(max(column - len(text) // 2, 0), columns - len(text))
        line[column] = "┬"
        if start >= free_from:
            below[start : start + len(text)] = text
            free_from = start + len(text) + 1
    return "".join(line), "".join(below)
