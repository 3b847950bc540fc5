"""The values that an experiment takes from each run: metrics, and columns over time."""

from __future__ import annotations

import sys
from base64 import b64decode, b64encode
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from hashlib import sha256
from inspect import getclosurevars
from io import BytesIO
from types import CodeType, FunctionType
from typing import TYPE_CHECKING, Any

from tuisim.api.descriptions import TIME, plain, read_columns
from tuisim.api.run import Run
from tuisim.base.errors import ConfigError
from tuisim.batch.plan import Plan
from tuisim.batch.table import Row, list_usual_columns
from tuisim.engine.protocol import End
from tuisim.engine.runs.frames import build_telemetry_columns
from tuisim.engine.runs.store import load_run
from tuisim.engine.runs.temporary import create_temporary_home
from tuisim.tasks.task import Result

if TYPE_CHECKING:
    import pandas as pd

Metric = Callable[[Run], Any]
_TICKS = "(columns)"
"""Key at which a row carries the telemetry columns of its run, packed as text, until `take_columns` removes them."""


class Measures:
    """Computes the metrics and telemetry columns of an experiment's runs from their recordings.

    Args:
        metrics: Functions of a run by the names of their columns.
        columns: Columns of telemetry.
    """

    def __init__(self, metrics: Mapping[str, Metric], columns: Sequence[str]) -> None:
        if not isinstance(metrics, Mapping) or not all(map(callable, metrics.values())):
            raise ConfigError(f"must be functions of a run by name, got {metrics!r}", key="metrics")
        self._metrics = metrics
        self._columns = (columns,) if isinstance(columns, str) else tuple(columns)

    @property
    def identity(self) -> list[str]:
        """A hash of the code of each metric, and the names of the columns.

        Experiments with the same identity measure the same values in equal runs.
        """
        metrics = (f"{name} {describe(metric)}" for name, metric in self._metrics.items())
        return [*(sha256(text.encode()).hexdigest() for text in metrics), *self._columns]

    @property
    def needs_files(self) -> bool:
        """Whether workers must return the recorded files of each run."""
        return bool(self._metrics or self._columns)

    def check(self, plan: Plan, chosen: Collection[str]) -> None:
        """Check the names of metrics and columns before any run starts.

        Args:
            plan: The runs.
            chosen: The constants and options that have a column.

        Raises:
            ConfigError: a run has no such column, or two columns would have the same name.
        """
        usual = list_usual_columns(plan.names, [goal.name for goal in plan.goals])
        for key, names in (("constants", chosen), ("metrics", self._metrics)):
            if twice := [name for name in names if name in usual]:
                raise ConfigError(f"{twice[0]!r} is a column already", key=key)
            usual += names
        for subject in plan.subjects:
            spec = plan.build_spec(subject, {})
            names = read_columns([name for name in self._columns if name != "line"], spec)
            lines = ("line",) if "line" in self._columns else ()
            # The time is left out here, since telemetry always has it.
            self._columns = (*(name for name in names if name != TIME), *lines)

    def measure(self, result: Result) -> Row:
        """Return the metrics of a run by name, and its telemetry columns packed in one cell."""
        if not result.files:
            return dict.fromkeys(self._metrics)
        import pandas as pd

        with create_temporary_home("tuisim-study-") as folder:
            for name, data in result.files.items():
                (folder / name).write_bytes(data)
            run = Run(load_run(folder))
            row = {
                name: compute_cell(name, metric, run, result.index)
                for name, metric in self._metrics.items()
            }
            if self._columns:
                frame = pd.DataFrame(build_telemetry_columns(run.stored, names=self._columns))
                frame.to_feather(packed := BytesIO(), compression="zstd")
                row[_TICKS] = b64encode(packed.getvalue()).decode()
            return row


def compute_cell(name: str, metric: Metric, run: Run, index: int) -> Any:
    """Return the value of a metric of a run, as a cell of the table.

    The result is None if the metric raises an exception and the program of the run has raised one, too. Any other
    exception of the metric gets a note with the names of the metric and the run.

    Args:
        name: The name of the metric.
        metric: The function that computes it.
        run: The run.
        index: The run's index in the experiment.

    Raises:
        ConfigError: the value is no number and no text.
    """
    try:
        value = metric(run)
    except Exception as error:  # Any error is raised again with a note.
        if run.state == End.RAISED:
            return None
        error.add_note(f"in the metric {name!r} of run {index + 1}")
        raise
    cell = value if getattr(value, "size", 1) != 1 else plain(value)
    if cell is not None and not isinstance(cell, bool | int | float | str):
        message = f"{name} of run {index + 1} is a {type(value).__name__}"
        raise ConfigError(message, "a metric returns a number or a text", key="metrics")
    return cell


def take_columns(rows: Mapping[int, Row]) -> dict[int, pd.DataFrame]:
    """Remove the packed telemetry columns from the rows, and return them as frames by the index of the run."""
    import pandas as pd

    return {
        index: pd.read_feather(BytesIO(b64decode(rows[index].pop(_TICKS))))
        for index in sorted(rows)
        if _TICKS in rows[index]
    }


def describe(value: Any, known: frozenset[int] = frozenset()) -> str:
    """Return a text that identifies a value: for a function, its code, its defaults, and what it uses from its file.

    Args:
        value: The value.
        known: Ids of the functions that are already being described, at which a recursion ends.
    """
    if isinstance(value, partial):
        return describe([value.func, *value.args, *value.keywords.items()], known)
    if isinstance(value, CodeType):
        return f"{value.co_code.hex()} {value.co_names} {[*map(describe, value.co_consts)]}"
    if isinstance(value, frozenset):
        return f"{sorted(map(repr, value))}"
    if isinstance(value, FunctionType) and id(value) not in known:
        names = getclosurevars(value)
        used = {**names.globals, **names.nonlocals}
        own = {
            name: describe(each, known | {id(value)})
            for name, each in sorted(used.items())
            if getattr(each, "__globals__", value.__globals__) is value.__globals__
        }
        return f"{describe(value.__code__)} {value.__defaults__!r} {own}"
    if isinstance(value, list | tuple):
        return f"{[describe(each, known) for each in value]}"
    if type(value) in (str, bytes, bool, int, float, dict):
        return repr(value)
    return getattr(value, "__qualname__", type(value).__qualname__)


@contextmanager
def show_progress(total: int | None = None) -> Iterator[Callable[..., None]]:
    """Show a progress bar on a terminal or in a notebook, if tqdm is installed.

    Yield a function to call after each run.
    """
    bar = None
    with suppress(ImportError):
        from tqdm.auto import tqdm

        # Without `disable=False`, tqdm shows nothing where there is no terminal, also not in a notebook.
        bar = tqdm(total=total, unit="run", disable=False if "ipykernel" in sys.modules else None)
    try:
        yield lambda *_: bar.update() if bar is not None else None
    finally:
        if bar is not None:
            bar.close()
