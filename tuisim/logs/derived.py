"""Derived variables, such as `speed = slope(distance)`, computed for each run separately."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from tuisim.errors import LogError, listed
from tuisim.logs.columns import is_numeric
from tuisim.logs.expressions import FUNCTIONS, Functions, evaluate, names_in
from tuisim.logs.log import Log, Series
from tuisim.logs.signals import derivative, integral, known_at, known_in_order, moving_average, resample
from tuisim.runs.arrays import FloatArray

TIME = "time"
"""Name of the sample times in an expression."""
SIGNALS = {
    "slope": "derivative, per second",
    "integral": "integral over time",
    "average": "centred rolling mean of that many samples",
    "resample": "samples at a fixed period in seconds",
}
"""Functions besides `FUNCTIONS`, with their descriptions."""

_NAMED = re.compile(r"\s*(?P<name>[^\W\d]\w*)\s*=(?!=)(?P<expression>.*)", re.DOTALL)
_EVEN = re.compile(
    r"\s*resample\s*\((?P<expression>.*),\s*(?P<period_s>-?\d*\.?\d+(?:e-?\d+)?)\s*s?\s*\)\s*", re.DOTALL
)


@dataclass(frozen=True, slots=True)
class Definition:
    """The definition of a derived variable."""

    name: str
    expression: str
    """Empty to remove the variable."""
    period_s: float | None = None
    """Sampling period; None keeps the times of its source."""


def definition_of(text: str) -> Definition:
    """Parse a line such as `speed = slope(distance)`; without a name the expression is the name.

    Raises:
        LogError: there is neither a name nor an expression.
    """
    match = _NAMED.fullmatch(text)
    expression = (match["expression"] if match else text).strip()
    # In names of variables ` #` is followed by the number of the run.
    name = match["name"] if match else expression.replace("`", "").replace(" #", "#")
    if not name:
        raise LogError("nothing to compute", "such as speed = slope(distance)")
    even = _EVEN.fullmatch(expression)
    if even:
        return Definition(name, even["expression"].strip(), float(even["period_s"]))
    return Definition(name, expression)


def derived(log: Log, definition: Definition, otherwise: str) -> list[Series]:
    """Return the series of a definition, one for each run that has the first variable in it.

    Variables sampled at other times are forward-filled; columns are read in the row of each sample.

    Args:
        log: The log that has the other variables.
        definition: The definition to compute.
        otherwise: The variable whose sample times are used if the definition names no variable.

    Raises:
        LogError: the expression is invalid, or names an unknown variable.
    """
    if definition.name in log.table.column_names or definition.name in log.names:
        raise LogError(f"there is a column {definition.name!r} already", f"such as other = {definition.expression}")
    names = names_in(definition.expression)
    known = {name.partition(" #")[0] for name in log.names} | set(log.names)
    first = next((name for name in names if name in known), otherwise.partition(" #")[0])
    # One series for each run, unless the definition names a single run.
    bases = [log.series(name) for name in log.names if first in (name, name.partition(" #")[0])]
    alone = len(bases) == 1
    return [
        replace(made, name=definition.name if alone else f"{definition.name} #{base.run}")
        for base in bases
        for made in [_computed(log, definition, names, base)]
    ]


def _computed(log: Log, definition: Definition, names: Sequence[str], base: Series) -> Series:
    columns = {TIME: base.time_s, **{name: _column(log, name, base) for name in names if name != TIME}}
    functions: Functions = {
        **FUNCTIONS,
        "slope": (1, partial(_of_signal, base, derivative), SIGNALS["slope"]),
        "integral": (1, partial(_of_signal, base, integral), SIGNALS["integral"]),
        "average": (2, _average, SIGNALS["average"]),
        "resample": (2, _resampled_within, SIGNALS["resample"]),
    }
    values = evaluate(definition.expression, columns, functions)
    if definition.period_s is None:
        return replace(base, values=values)
    moments_s, values = resample(base.time_s, values, definition.period_s)
    order = known_in_order(base.time_s, base.time_s)
    before = np.searchsorted(base.time_s[order], moments_s + 1e-9, side="right") - 1
    return Series(base.name, moments_s, values, base.rows[order][before], base.run)


def _column(log: Log, name: str, base: Series) -> FloatArray:
    """Return the values of a variable or column at each sample of the base."""
    for wanted in (name, f"{name} #{base.run}"):
        if wanted in log.names:
            series = log.series(wanted)
            if not len(series.rows):
                return np.full(len(base.rows), np.nan)
            if series.rows is base.rows or series.time_s is base.time_s:
                return series.values
            return known_at(series.time_s, series.values, base.time_s)
    schema = log.table.schema
    if name in schema.names and is_numeric(schema.field(name).type):
        return log.numbers(name)[base.rows]
    numbers = [at.name for at in schema if is_numeric(at.type)]
    there = dict.fromkeys((*(known.partition(" #")[0] for known in log.names), *numbers, TIME))
    raise LogError(f"no variable {name!r}", f"there are {listed(there)}", file=log.title)


def _of_signal(base: Series, change: Any, values: Any) -> FloatArray:
    made: FloatArray = change(base.time_s, np.broadcast_to(values, base.time_s.shape))
    return made


def _average(values: Any, width: Any) -> FloatArray:
    if np.ndim(width) or not float(width).is_integer():
        raise LogError("average needs a whole number of samples", "such as average(Colour, 5)")
    return moving_average(np.atleast_1d(values), int(width))


def _resampled_within(values: Any, period_s: Any) -> FloatArray:
    raise LogError("resample must be the outermost function", "such as resample(slope(Colour), 0.1)")
