"""Figures and their goals, as a table and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from math import isfinite, isnan, nan

from tests.bench.references import Ratio
from tests.bench.sampling import MeasuringError

NOT_MEASURED = nan
"""In place of the figure of something that is not there."""
LOOSE = 1.5
"""A goal that is farther than this factor from what is reached would not see a slow-down."""


@dataclass(frozen=True, slots=True)
class Figure:
    """One line of the table.

    Raises:
        MeasuringError: the value or its ratio is negative or infinite, or zero where it may not be.
    """

    name: str
    value: float
    unit: str
    least: float | None = None
    """The goal, where more is better: of the ratio if there is one, else of the value."""
    most: float | None = None
    """The goal, where less is better."""
    ratio: Ratio | None = None
    """The value compared with a reference of the same run, for what depends on the machine."""
    may_be_zero: bool = False

    def __post_init__(self) -> None:
        for number in (self.value, *([self.ratio.value] if self.ratio else [])):
            possible = isnan(number) or (
                isfinite(number) and (number > 0 or (not number and self.may_be_zero))
            )
            if not possible:
                raise MeasuringError(f"{self.name}: {number:g} {self.unit} is not possible")

    @property
    def goal(self) -> str:
        """The goal in words, empty if there is none."""
        unit = " x" if self.ratio else ""
        if self.least is not None:
            return f">= {self.least:,g}{unit}"
        return "" if self.most is None else f"<= {self.most:,g}{unit}"

    @property
    def verdict(self) -> str:
        """`met`, `missed`, `loose` if it is met by more than a factor, or empty where there is no goal."""
        value = self.ratio.value if self.ratio else self.value
        if self.least is not None:
            return (
                "missed" if value < self.least else "loose" if value > LOOSE * self.least else "met"
            )
        if self.most is not None:
            return (
                "missed" if value > self.most else "loose" if LOOSE * value < self.most else "met"
            )
        return ""


def as_line(figure: Figure) -> str:
    """Return a figure as a line that is read while others are measured."""
    ratio = f" = {figure.ratio.value:.3g} {figure.ratio.reference}" if figure.ratio else ""
    return f"{figure.name} {figure.value:.3f} {figure.unit}{ratio}"


def as_table(figures: Sequence[Figure]) -> str:
    """Return the figures as lines of aligned columns."""
    rows = [("name", "figure", "", "ratio", "", "goal", "")]
    for one in figures:
        ratio = (_rounded(one.ratio.value), one.ratio.reference) if one.ratio else ("", "")
        rows.append((one.name, _rounded(one.value), one.unit, *ratio, one.goal, one.verdict))
    wide = [max(len(row[column]) for row in rows) for column in range(6)]
    return "\n".join(
        f"{name:<{wide[0]}}  {value:>{wide[1]}} {unit:<{wide[2]}}  {ratio:>{wide[3]}} {reference:<{wide[4]}}  "
        f"{goal:<{wide[5]}}  {verdict}".rstrip()
        for name, value, unit, ratio, reference, goal, verdict in rows
    )


def as_json(figures: Iterable[Figure]) -> str:
    """Return the figures as a JSON list of objects; what was not measured is null."""
    objects = [{**asdict(figure), "verdict": figure.verdict} for figure in figures]
    return json.dumps(
        [{**one, "value": None if isnan(one["value"]) else one["value"]} for one in objects],
        indent=1,
    )


def _rounded(value: float) -> str:
    """Return a number with three figures that count."""
    if isnan(value):
        return "–"
    if abs(value) >= 100:
        return f"{value:,.0f}"
    return (
        f"{value:.1f}"
        if abs(value) >= 10
        else f"{value:.2f}"
        if abs(value) >= 1 or not value
        else f"{value:.2g}"
    )
