"""The parts of a line of readings: labels, values and units, in the variant that fits."""

from __future__ import annotations

from collections.abc import Sequence

from rich.style import Style

from tuisim.base import palette
from tuisim.terminal.text_runs import Line, Run

LABEL = Style(color=palette.LABEL)
VALUE = Style(color=palette.WHITE, bold=True)
UNIT = Style(color=palette.LABEL)
WARNING = Style(color=palette.RED, bold=True)
COLUMN = 12
"""Width of the labels if there is room."""


def fit_line(width: int, *variants: Sequence[Run]) -> Line:
    """Return the first variant that fits, or the last one."""
    for variant in variants:
        if sum(len(text) for text, _ in variant) <= width:
            return list(variant)
    return list(variants[-1])


def format_label(text: str, column: int = COLUMN) -> Run:
    """Return a label."""
    return text.ljust(column), LABEL


def format_value(text: str) -> Run:
    """Return a value."""
    return text, VALUE


def format_unit(text: str) -> Run:
    """Return a unit, or other words between values."""
    return text, UNIT


def format_values(*texts: str) -> list[Run]:
    """Return values, each with the unit after it."""
    return [
        format_unit(text) if index % 2 else format_value(text) for index, text in enumerate(texts)
    ]
