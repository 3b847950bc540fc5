"""Derived variables: expressions such as `speed = slope(distance)`, computed for each run, and dead reckoning."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.core.conditions import NUMBER
from tuisim.engine.runs.arrays import FloatArray
from tuisim.engine.runs.command_events import ScaleChange
from tuisim.engine.runs.frames import compute_dead_reckoning, compute_scales, find_lacking_columns
from tuisim.logs.columns import is_numeric
from tuisim.logs.expressions import CONSTANTS, FUNCTIONS, Functions, evaluate, find_names
from tuisim.logs.log import Log, Series
from tuisim.logs.metadata import SCALES
from tuisim.logs.signals import (
    compute_derivative,
    compute_integral,
    compute_moving_average,
    resample,
    sort_known,
)
from tuisim.logs.units import drop_run, parse_unit

TIME = "time"
"""Name by which an expression refers to the times of the samples."""
SIGNALS = {
    "slope": "derivative, per second",
    "integral": "integral over time",
    "average": "centred rolling mean of that many samples",
    "resample": "samples at a fixed period in seconds",
}
"""Functions of whole series that an expression has besides `FUNCTIONS`, by name, with their descriptions."""

_NAMED = re.compile(r"\s*(?P<name>[^\W\d]\w*)\s*=(?!=)(?P<expression>.*)", re.DOTALL)
_EVEN = re.compile(
    rf"\s*resample\s*\((?P<expression>.*),\s*(?P<period_s>{NUMBER})\s*s?\s*\)\s*", re.DOTALL
)


@dataclass(frozen=True, slots=True)
class Definition:
    """The definition of a derived variable: its name and its expression."""

    name: str
    expression: str
    """The expression that computes the variable; empty to remove the variable."""
    period_s: float | None = None
    """Sampling period of the variable in seconds; None if it has the times of the variable from which it is computed.
    """

    def compute(self, log: Log, otherwise: str) -> list[Series]:
        """Return the series of the variable, one for each run that has the first variable of its expression.

        The result has a value at each sample of this first variable. Other variables have the value of their last
        sample there, and columns the value in the same row.

        Args:
            log: The log.
            otherwise: The variable that takes the place of the first variable if the expression has no variables.

        Raises:
            LogError: the expression is invalid, or names an unknown variable; or the name exists already.
        """
        if self.name in log.table.column_names or self.name in log.names:
            raise LogError(
                f"there is a column {self.name!r} already",
                f"such as other = {self.expression}",
            )
        names = find_names(self.expression)
        known = {drop_run(name) for name in log.names} | set(log.names)
        first = next((name for name in names if name in known), drop_run(otherwise))
        # Each run has a series, unless the definition names a single run.
        bases = [log.series(name) for name in log.names if first in (name, drop_run(name))]
        alone = len(bases) == 1
        return [
            replace(
                _compute_series(log, self, names, base),
                name=self.name if alone else f"{self.name} #{base.run}",
            )
            for base in bases
        ]


def parse_definition(text: str) -> Definition:
    """Return the definition in a line such as `speed = slope(distance)`; without a name, the expression is the name.

    Raises:
        LogError: there is neither a name nor an expression.
    """
    match = _NAMED.fullmatch(text)
    expression = (match["expression"] if match else text).strip()
    # A name with ` #2` means run 2, so a name made from the expression has `#` without the blank.
    name = match["name"] if match else expression.replace("`", "").replace(" #", "#")
    if not name:
        raise LogError("nothing to compute", "such as speed = slope(distance)")
    even = _EVEN.fullmatch(expression)
    if even:
        return Definition(name, even["expression"].strip(), float(even["period_s"]))
    return Definition(name, expression)


def _compute_series(log: Log, definition: Definition, names: Sequence[str], base: Series) -> Series:
    columns = {
        TIME: base.time_s,
        **{name: _sample_column(log, name, base) for name in names if name != TIME},
    }
    functions: Functions = {
        **FUNCTIONS,
        "slope": (1, partial(_apply_to_signal, base, compute_derivative), ""),
        "integral": (1, partial(_apply_to_signal, base, compute_integral), ""),
        "average": (2, _average, ""),
        "resample": (2, _refuse_resample, ""),
    }
    values = evaluate(definition.expression, columns, functions)
    if definition.period_s is None:
        return replace(base, values=values)
    moments_s, values = resample(base.time_s, values, definition.period_s)
    order = sort_known(base.time_s, base.time_s)
    before = np.searchsorted(base.time_s[order], moments_s + 1e-9, side="right") - 1
    return Series(base.name, moments_s, values, base.rows[order][before], base.run)


def _sample_column(log: Log, name: str, base: Series) -> FloatArray:
    """Return the values of a variable or column at each sample of the series `base`, shape (n,)."""
    for candidate in (name, f"{name} #{base.run}"):
        if candidate in log.names:
            series = log.series(candidate)
            if not len(series.rows):
                return np.full(len(base.rows), np.nan)
            if series.rows is base.rows or series.time_s is base.time_s:
                return series.values
            return series.sample(base.time_s)
    schema = log.table.schema
    if name in schema.names and is_numeric(schema.field(name).type):
        return log.numbers(name)[base.rows]
    if (known := find_computed_columns(log).get(name)) is not None:
        return known()[base.rows]
    raise LogError(f"no variable {name!r}", among(name, _list_names(log)), file=log.title)


def _list_names(log: Log) -> list[str]:
    """Return the names of a log's variables, without numbers of runs, and of its columns with numbers."""
    variables = (drop_run(name) for name in log.names)
    return [*dict.fromkeys((*variables, *log.numeric_columns, TIME))]


def find_computed_columns(log: Log) -> dict[str, Callable[[], FloatArray]]:
    """Return the columns that a log of telemetry lacks but that can be computed, by name.

    Each is a function that returns the values of the column. The result is empty for other logs.
    """
    if (spec := log.find_spec()) is None:
        return {}
    return find_lacking_columns(spec, log.numeric_columns, log.numbers)


def list_expression_words(log: Log) -> Iterator[str]:
    """Yield the words that an expression on a log may contain: its variables and columns, and the functions."""
    yield from (name if name.isidentifier() else f"`{name}`" for name in _list_names(log))
    yield from find_computed_columns(log)
    yield from (f"{name}(" for name in (*SIGNALS, *FUNCTIONS))
    yield from CONSTANTS


def find_named_columns(log: Log, text: str) -> list[str]:
    """Return those names of computed columns that a text contains; for the columns, see `find_computed_columns`."""
    if not text.strip():
        return []
    return [name for name in find_computed_columns(log) if re.search(rf"\b{name}\b", text)]


def add_named_columns(log: Log, text: str) -> Log:
    """Return a log with all computed columns whose names a text contains, see `find_computed_columns`."""
    for name in find_named_columns(log, text):
        log = log.add_derived(name, Definition(name, name).compute(log, log.names[0]))
        # In a damaged file, the units may be of another type.
        if isinstance(units := log.metadata.get("units"), dict):
            log = replace(
                log, metadata={**log.metadata, "units": {**units, name: parse_unit(name).words}}
            )
    return log


def _read_scale_changes(metadata: Mapping[str, Any]) -> Iterator[ScaleChange]:
    """Yield the changes of motor scales in the first run of a log, without damaged entries."""
    for change in metadata["runs"][0].get(SCALES, ()):
        match change:
            case int(tick), str(port), int(scale) | float(scale) if scale:
                yield tick, port, scale


def _apply_to_signal(base: Series, change: Any, values: Any) -> FloatArray:
    changed: FloatArray = change(base.time_s, np.broadcast_to(values, base.time_s.shape))
    return changed


def _average(values: Any, width: Any) -> FloatArray:
    if np.ndim(width) or not float(width).is_integer():
        raise LogError("average needs a whole number of samples", "such as average(Colour, 5)")
    return compute_moving_average(np.atleast_1d(values), int(width))


def _refuse_resample(values: Any, period_s: Any) -> FloatArray:
    raise LogError(
        "resample must be the outermost function", "such as resample(slope(Colour), 0.1)"
    )


NEEDED = ("left_position_deg", "right_position_deg", "x_mm", "y_mm", "heading_deg")
RECKONED_COLUMNS = ("reckoned_x_mm", "reckoned_y_mm", "reckoned_heading_deg", "error_mm")


def build_reckoned_series(log: Log) -> list[Series]:
    """Return the pose by dead reckoning in a log of telemetry: a series for each name of `RECKONED_COLUMNS`.

    Raises:
        LogError: the log is not telemetry, or has no metadata of the robot.
    """
    numbers = log.numeric_columns
    missing = [name for name in NEEDED if name not in numbers]
    if missing:
        raise LogError(
            f"no column {missing[0]!r} with numbers",
            "a stored run, or its telemetry exported",
            file=log.title,
        )
    spec = log.find_spec()
    if spec is None:
        hint = "a stored run, or its telemetry exported to a file"
        raise LogError("has no metadata of the robot", hint, file=log.title)
    left, right, x_mm, y_mm, _ = (log.numbers(name) for name in NEEDED)
    ticks = np.round(log.times_s * spec.profile.tick_hz)
    scales = compute_scales(ticks, spec.robot, _read_scale_changes(log.metadata))
    left, right = left / scales.get("left", 1.0), right / scales.get("right", 1.0)
    reckoned = compute_dead_reckoning(left, right, spec.world.start, spec.robot)
    columns = (
        reckoned.x_mm,
        reckoned.y_mm,
        reckoned.heading_deg,
        reckoned.compute_error_mm(x_mm, y_mm),
    )
    time_s = log.times_s
    rows = np.arange(log.rows)
    return [
        Series(name, time_s, values, rows)
        for name, values in zip(RECKONED_COLUMNS, columns, strict=True)
    ]
