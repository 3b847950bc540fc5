"""What `experiment` does: it runs programs with every combination of what varies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.api.calls import check_timeout, prepare_program, read_source
from tuisim.api.descriptions import plain, read_options, read_world
from tuisim.base.errors import ConfigError
from tuisim.batch.parameters import SEED, Choice, checked_seeds, parse_values
from tuisim.batch.plan import Plan, Subject
from tuisim.batch.sweep import Sweep, Workers
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.handle import RunOptions
from tuisim.engine.runs.presses import press_actions
from tuisim.programs.program_file import ProgramSource
from tuisim.settings.options import Settings
from tuisim.tasks.goals.files import GoalsFile, load_goals
from tuisim.tasks.task import MAX_JOBS, Keep

if TYPE_CHECKING:
    import pandas as pd

_NOT_VARIED = ("press",)
"""Options whose value is a list."""


def run_experiment(
    program: Any,
    *,
    seeds: Iterable[int],
    parameters: Mapping[str, Any] | None,
    expressions: Mapping[str, str] | None,
    goals: str | Path | None,
    keep: str,
    jobs: int,
    scheduler: str,
    arguments: Sequence[str],
    answers: Sequence[str],
    timeout_s: float,
    world: Any,
    **options: Any,
) -> pd.DataFrame:
    """Run an experiment; arguments as of `tuisim.experiment`."""
    check_timeout(timeout_s)
    _check_choices(keep, jobs)
    named = program if isinstance(program, list | tuple) else [program]
    programs = [read_source(each) for each in named]
    if not programs:
        raise ConfigError("no program is named", key="program")
    task = load_goals(goals) if goals is not None else None
    variants = list_variants(options)
    subjects = [
        _build_subject(each, variant, world, task, arguments)
        for each in programs
        for variant in variants
    ]
    run_options = RunOptions(
        time_limit_s=timeout_s, answers=tuple(answers) or (task.answers if task else ())
    )

    def build_options(spec: RunSpec, settings: Settings) -> RunOptions:
        return replace(run_options, actions=press_actions(settings["press"], spec.profile.tick_hz))

    plan = Plan(
        tuple(subjects),
        _read_parameters(parameters or {}, seeds),
        Path("parameters"),
        task.goals if task else (),
        Keep(keep),
        build_options,
    )
    plan.check_expressions(expressions or {})
    sweep = Sweep(plan, expressions or {})
    sweep.run(Workers(jobs, scheduler))
    return _add_variants(sweep.build_frame(), variants, len(plan.grid), several=len(programs) > 1)


def _build_subject(
    source: ProgramSource,
    variant: Mapping[str, Any],
    world: Any,
    task: GoalsFile | None,
    arguments: Sequence[str],
) -> Subject:
    """Return a program with its settings, and a combination of options."""
    chosen = read_options(variant)
    in_world = read_world(world, chosen.get("mats"))
    if task:
        in_world = task.settings if world is None else {**in_world, **task.presses}
    started, settings = prepare_program(source, arguments, in_world, chosen)
    return Subject(started, settings.settings, frozenset(chosen))


def _check_choices(keep: str, jobs: int) -> None:
    if keep not in [*Keep]:
        raise ConfigError(f"no such value {keep!r}", f"one of {', '.join(Keep)}", key="keep")
    if jobs not in range(MAX_JOBS + 1):
        raise ConfigError(f"must be a whole number from 0 to {MAX_JOBS}, got {jobs!r}", key="jobs")


def list_variants(options: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return every combination of the options that are given several values, the last one varying fastest.

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


def _read_parameters(parameters: Mapping[str, Any], seeds: Any) -> dict[str, Choice]:
    varied = {name: _read_choice(name, values) for name, values in parameters.items()}
    if isinstance(seeds, str) or not isinstance(seeds, Iterable):
        raise ConfigError(f"must be several, got {seeds!r}", "such as range(200)", key="seeds")
    if chosen := checked_seeds([plain(seed) for seed in seeds], "seeds"):
        varied[SEED] = chosen
    return varied


def _read_choice(name: str, values: Any) -> Choice:
    """Return what a parameter takes; a text is read as after `--set`."""
    if isinstance(values, str):
        return parse_values(values, name)
    listed = list(values) if isinstance(values, Iterable) else [values]
    if not listed:
        raise ConfigError("has no values", key=name)
    return tuple(map(plain, listed))


def _add_variants(
    frame: pd.DataFrame, variants: Sequence[Mapping[str, Any]], runs: int, *, several: bool
) -> pd.DataFrame:
    """Return the table of runs with a column for each option that varies.

    Args:
        runs: How many runs there are of each variant of a program.
        several: Whether there are several programs.
    """
    names = [name for name in variants[0] if len({repr(one[name]) for one in variants}) > 1]
    numbers = [(run - 1) // runs % len(variants) for run in frame["run"]]
    for place, name in enumerate(names, start=1):
        values = [variants[number][name] for number in numbers]
        frame.insert(place, name, [_name_value(value) for value in values])
    return frame if several or "program" not in frame else frame.drop(columns="program")


def _name_value(value: object) -> object:
    """Return a value as a cell of a table."""
    return value if isinstance(value, bool | int | float | str) else str(value)
