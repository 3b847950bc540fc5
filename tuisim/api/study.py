"""What `experiment` does: it runs programs with every combination of what varies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import version
from itertools import product
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

from tuisim.api.calls import build_run_options, prepare_program, read_source
from tuisim.api.descriptions import (
    Description,
    plain,
    read_options,
    read_seeds,
    read_world,
    warn_all,
)
from tuisim.api.measures import Measures, Metric, show_progress, take_columns
from tuisim.base.errors import ConfigError, counted
from tuisim.base.folders import user_path
from tuisim.batch.parameters import SEED, Choice, parse_values
from tuisim.batch.plan import Plan, Subject
from tuisim.batch.rounds import Rounds, parse_precision
from tuisim.batch.sweep import Sweep, Workers, is_interrupted
from tuisim.batch.table import RUN, RUN_ID
from tuisim.engine.protocol import End
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import check_target
from tuisim.programs.program_file import ProgramSource
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.task import MAX_JOBS, Keep, Value

if TYPE_CHECKING:
    import pandas as pd

_NOT_VARIED = ("press",)
"""Options that take a list as one value: a list for them is not a list of values to vary."""


def run_experiment(
    program: Any,
    *,
    seeds: Iterable[int] | None,
    constants: Mapping[str, Any] | None,
    metrics: Mapping[str, Metric] | None,
    columns: Sequence[str],
    expressions: Mapping[str, str] | None,
    keep: str,
    jobs: int,
    scheduler: str,
    out: str | Path | None,
    until: str,
    **how: Any,
) -> pd.DataFrame:
    """Run an experiment and return its table; the arguments are those of `tuisim.experiment`."""
    workers = build_workers(jobs, scheduler)
    study = Study(program, constants or {}, **how)
    metrics = metrics or {}
    expressions = expressions or {}
    measures = Measures(metrics, columns)
    plan = study.build_plan(seeds, keep, returns_files=measures.needs_files)
    plan.check_expressions(expressions)
    measures.check(plan, study.columns)
    warn_all(plan.remarks)
    own = *metrics, *expressions
    precision = parse_precision(until, "until", plan, own) if until else None
    sweep = open_sweep(plan, expressions, out, measures)
    rounds = Rounds(plan, sweep, precision) if precision else None
    with show_progress(len(plan) - len(sweep.rows)) as tell:
        sweep.run(workers, tell, measures.measure, rounds)
    frames = take_columns(sweep.rows)
    frame = study.add_variants(sweep.build_frame())
    if rounds:
        warn_unknown(until, rounds.unknown)
    warn_raised(frame)
    frame = number_stored(join_columns(frame, frames, own) if columns else frame)
    sweep.export(frame)
    sweep.finish()
    return frame


def open_sweep(
    plan: Plan, expressions: Mapping[str, str], out: str | Path | None, measures: Measures
) -> Sweep:
    """Return the sweep, which runs the plan and collects the rows of the table.

    If the experiment was interrupted before, the sweep has the rows of the runs that it finished. Warns if these rows
    cannot be used, or if another table is replaced.

    Args:
        plan: The runs.
        expressions: Further columns, by name.
        out: The file for the table; None for none.
        measures: The metrics and telemetry columns.

    Raises:
        ConfigError: the interrupted experiment has other runs.
        ExportError: the table cannot be written.
    """
    target = check_target(user_path(str(out))) if out is not None else None
    resumes = target is not None and is_interrupted(target)
    sweep = Sweep(
        plan, expressions, target, version("tuisim"), resumes=resumes, measured=measures.identity
    )
    if resumes and not sweep.rows:
        warn(f"{out}.part is of other metrics or columns: the experiment begins anew", stacklevel=5)
    elif sweep.replaces and not resumes:
        warn(f"{out} has another table, which is replaced", stacklevel=5)
    return sweep


def build_workers(jobs: int, scheduler: str) -> Workers:
    """Return the workers that run the programs.

    Args:
        jobs: Number of processes on this machine; 0 is one for each processor.
        scheduler: Address of a Dask scheduler; empty for this machine.

    Raises:
        ConfigError: `jobs` is no whole number, or is too large.
    """
    if jobs not in range(MAX_JOBS + 1):
        raise ConfigError(f"must be a whole number from 0 to {MAX_JOBS}, got {jobs!r}", key="jobs")
    return Workers(jobs, scheduler)


def warn_unknown(until: str, margins: Sequence[float]) -> None:
    """Warn that the means of some combinations are less precise than `until` requires.

    Args:
        until: The column and its margin.
        margins: For each of these combinations, the margin of its mean after all seeds.
    """
    if not margins:
        return
    known = f"only to ± {max(margins):.3g}, after all seeds"
    known = known if max(margins) < inf else "not at all"
    text = f"until {until!r}: {counted(len(margins), 'mean')} known {known}"
    warn(text, stacklevel=5)


def warn_raised(table: pd.DataFrame) -> None:
    """Warn about the runs whose program raised an error: their values are those of an incomplete run."""
    raised = table["summary"][table["end"] == End.RAISED]
    if len(raised):
        what = f"{len(raised)} of {counted(len(table), 'run')} raised"
        warn(f"{what}; the first: {raised.iloc[0]}", stacklevel=5)


class Study:
    """The programs of an experiment, with everything that varies except seeds.

    Args:
        program: As for `tuisim.experiment`.
        constants: Values of the programs' constants, or several of each.
        parameters, arguments, answers, timeout_s: As for `tuisim.experiment`.
        goals: The goals file; None for none.
        options: Worlds, and values by the names of options, or several of each.

    Raises:
        ConfigError: an argument is wrong.
    """

    def __init__(
        self,
        program: Any,
        constants: Mapping[str, Any],
        *,
        parameters: Mapping[str, Any] | None,
        goals: str | Path | None,
        arguments: Sequence[str],
        answers: Sequence[str],
        timeout_s: float,
        **options: Any,
    ) -> None:
        named = program if isinstance(program, list | tuple) else [program]
        if not named:
            raise ConfigError("no program is named", key="program")
        self._programs = [read_source(each) for each in named]
        self._names = number_repeated(
            [
                # A function is listed by its own name, without that of its file.
                source.program.name.rpartition(":")[2] if callable(each) else source.program.name
                for each, source in zip(named, self._programs, strict=True)
            ]
        )
        self._constants = constants
        self._arguments = arguments
        self._parameters = {
            name: _read_choice(name, values) for name, values in (parameters or {}).items()
        }
        if SEED in self._parameters:
            raise ConfigError("the seed varies by seeds=", key="parameters")
        self._task = GoalsFile.load(goals) if goals is not None else None
        self._options = build_run_options(
            timeout_s, answers or (self._task.answers if self._task else ())
        )
        self._variants = list_variants({**options, **constants})
        several = [name for name, value in options.items() if _is_varied(name, value)]
        self.columns = {*constants, *several}
        """Names of the constants, and of the options with several values, which have a column in the table."""

    def build_plan(self, seeds: Iterable[int] | None, keep: str, *, returns_files: bool) -> Plan:
        """Return the plan of all runs.

        Args:
            seeds: The seeds; None for the default.
            keep: Which runs to store.
            returns_files: Whether workers return the recorded files.

        Raises:
            ConfigError: a seed, a parameter or `keep` is wrong.
        """
        if keep not in [*Keep]:
            raise ConfigError(f"no such value {keep!r}", f"one of {', '.join(Keep)}", key="keep")
        self._plan = Plan(
            tuple(
                self._build_subject(program, name, variant)
                for program, name in zip(self._programs, self._names, strict=True)
                for variant in self._variants
            ),
            {**self._parameters, **({} if seeds is None else {SEED: read_seeds(seeds)})},
            Path("parameters"),
            self._task.goals if self._task else (),
            Keep(keep),
            returns_files,
            self._options,
        )
        return self._plan

    def _build_subject(
        self, source: ProgramSource, name: str, variant: Mapping[str, Any]
    ) -> Subject:
        """Return a program with its settings for one combination of constants and options.

        Args:
            source: The program.
            name: Its name in the table.
            variant: The values of the constants and options.
        """
        options = {name: value for name, value in variant.items() if name not in self._constants}
        values = {name: plain(value) for name, value in variant.items() if name not in options}
        world = options.pop("world", None)
        chosen = read_options(options)
        in_world = read_world(world, chosen.get("mats"))
        if task := self._task:
            in_world = task.settings if world is None else {**in_world, **task.presses}
        started, settings = prepare_program(
            source, self._arguments, in_world, chosen, constants=values
        )
        return Subject(started, settings.settings, frozenset(chosen), name)

    def add_variants(self, frame: pd.DataFrame) -> pd.DataFrame:
        """Return the table of the runs with a column for each constant, and for each option that has several values."""
        variants = self._variants
        names = [name for name in variants[0] if name in self.columns]
        runs_of_each = len(self._plan.grid)
        numbers = [(run - 1) // runs_of_each % len(variants) for run in frame["run"]]
        for place, name in enumerate(names, start=1):
            values = [variants[number][name] for number in numbers]
            frame.insert(place, name, [_name_value(value) for value in values])
        is_named = len(self._programs) > 1 or "program" not in frame
        return frame if is_named else frame.drop(columns="program")


def join_columns(
    table: pd.DataFrame, frames: Mapping[int, pd.DataFrame], names: Sequence[str]
) -> pd.DataFrame:
    """Return one frame with the telemetry columns of all runs, one run below another.

    Beside the telemetry, each row has the values of its run.

    Args:
        table: One row for each run; its columns up to `seed` come before those of telemetry.
        frames: The telemetry columns by the index of their run, in the order of the result.
        names: Other columns of the table, to come directly after `seed`.
    """
    import pandas as pd

    if not frames:
        return table.iloc[:0]
    runs = [index + 1 for index, frame in frames.items() for _ in range(len(frame))]
    ids = [RUN_ID] if RUN_ID in table else []
    values = table[[*table.loc[:, :"seed"], *names, *ids]].set_index(RUN, drop=False).loc[runs]
    joined = pd.concat(frames.values(), ignore_index=True)
    return pd.concat([values.reset_index(drop=True), joined], axis=1)


def number_stored(frame: pd.DataFrame) -> pd.DataFrame:
    """Return a table whose column `run` has the numbers of the run store, if all its runs are stored.

    Otherwise the table is unchanged.
    """
    if RUN_ID not in frame:
        return frame
    numbers = {info.id: info.number for info in RunStore().runs()}
    stored = [numbers.get(run_id, 0) for run_id in frame[RUN_ID]]
    return frame.assign(run=stored) if all(stored) else frame


def number_repeated(names: Sequence[str]) -> list[str]:
    """Return names in which each repeated name, such as that of a function made in a loop, gets a number at its end."""
    counts = [names[: place + 1].count(name) for place, name in enumerate(names)]
    return [
        name if count == 1 else f"{name} {count}" for name, count in zip(names, counts, strict=True)
    ]


def list_variants(options: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return every combination of the options that have several values, the last option varying fastest.

    Raises:
        ConfigError: an option has no values.
    """
    given = {name: value for name, value in options.items() if value is not None}
    values = {
        name: [*value] if _is_varied(name, value) else [value] for name, value in given.items()
    }
    for name, listed in values.items():
        if not listed:
            raise ConfigError("has no values", key=name)
    return [dict(zip(values, point, strict=True)) for point in product(*values.values())]


def _is_varied(name: str, value: object) -> bool:
    return isinstance(value, Iterable) and not (
        isinstance(value, str | Mapping) or name in _NOT_VARIED
    )


def _read_choice(name: str, values: Any) -> Choice:
    """Return the values of a parameter; a text is parsed like the value of the option `--set`.

    Raises:
        ConfigError: there are no values, or the text cannot be parsed.
    """
    if isinstance(values, str):
        return parse_values(values, name)
    listed = list(values) if isinstance(values, Iterable) else [values]
    if not listed:
        raise ConfigError("has no values", key=name)
    choice: list[Any] = [plain(value) for value in listed]
    for value in choice:
        if not isinstance(value, Value):
            hint = "a table by its keys, such as noise.light; obstacles by world= in a loop"
            raise ConfigError(
                f"varies numbers, texts and truth values, got {value!r}", hint, key=name
            )
    return tuple(choice)


def _name_value(value: object) -> object:
    """Return a value as a number or a text, for a cell of a table."""
    cell = value.label if isinstance(value, Description) else plain(value)
    return cell if isinstance(cell, bool | int | float | str) else str(cell)
