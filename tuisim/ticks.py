"""Round limits of an axis, its ticks, and their labels."""

from __future__ import annotations

import math

_STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)

Limits = tuple[float, float]


def nice_step(span: float, count: int) -> float:
    """Return a round distance that divides `span` (above 0) into about `count` parts, at most."""
    # Parts of the smallest numbers come out as nothing.
    rough = max(span / max(count, 1), 1e-300)
    magnitude = 10.0 ** math.floor(math.log10(rough))
    return next(step * magnitude for step in _STEPS if step * magnitude >= rough * 0.999)


def value_limits(low: float, high: float, from_zero: bool = False) -> Limits:
    """Return round limits around values, so that they seldom change while values come in.

    Args:
        low: The least value.
        high: The greatest one.
        from_zero: Whether 0 is to be seen.
    """
    if from_zero:
        low = min(low, 0.0)
    size = max(abs(low), abs(high), 1.0)
    if high - low < 1e-9 * size:
        # One more or less would make no difference to a number with more than sixteen digits.
        room = max(1.0, 1e-6 * size)
        low, high = low - room, high + room
    step = nice_step(high - low, 4)
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step


def ticks(limits: Limits, count: int) -> list[float]:
    """Return at most about `count` round positions inside limits."""
    low, high = limits
    step = nice_step(high - low, count)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [at * step for at in range(first, last + 1)]


def label(value: float, step: float) -> str:
    """Return a tick's label with no more digits than the distance between ticks needs."""
    digits = max(0, math.ceil(-math.log10(step) - 1e-9)) if step < 1 else int(step % 1 != 0)
    text = f"{value:.{digits}f}"
    return "0" if float(text) == 0 else text
