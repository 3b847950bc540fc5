"""The Python API: `simulate` runs a program once, `experiment` with many seeds and settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.handle import DEFAULT_TIME_LIMIT_S, RunOptions, start_run
from tuisim.engine.runs.presses import press_actions
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.programs.plugged_words import describe_plugged
from tuisim.programs.program_file import ProgramSource, find_program, program_of_text, read_program
from tuisim.programs.program_settings import ProgramSettings, program_settings
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import APP, OPTIONS, Option, Settings
from tuisim.settings.worlds import load_world

if TYPE_CHECKING:
    import pandas as pd
    from PIL.Image import Image

    from tuisim.batch.parameters import Choice
    from tuisim.tasks.task import Value


@dataclass(frozen=True, slots=True)
class SimulatedRun:
    """A finished run."""

    stored: StoredRun
    """The run in the run store."""
    note: str = ""
    """What the source of the program has decided about robot and profile, in words; empty for nothing."""

    @property
    def state(self) -> str:
        """How it ended: finished, raised, stopped, time_limit …"""
        return self.stored.state.value

    @property
    def error(self) -> str:
        """The program's own traceback, empty if there is none."""
        return self.stored.end.error if self.stored.end else ""

    @property
    def time_s(self) -> float:
        """Its duration in simulated seconds."""
        return self.stored.time_s

    @property
    def output(self) -> str:
        """The program's output on stdout."""
        return "".join(
            row.text + "\n" for row in self.stored.output.rows() if row.stream == Stream.STDOUT
        )

    @property
    def samples(self) -> pd.DataFrame:
        """One row per printed `NAME: number`; columns as in `engine.runs.frames.SAMPLE_COLUMNS`."""
        from tuisim.engine.runs.frames import samples_frame

        return samples_frame([self.stored])

    @property
    def telemetry(self) -> pd.DataFrame:
        """One row per tick; times in s, lengths in mm, angles in degrees."""
        from tuisim.engine.runs.frames import telemetry_frame

        return telemetry_frame(self.stored)

    def picture(self) -> Image:
        """Return the world at the end of the run, with the pen's trace, as a Pillow image."""
        from tuisim.pictures.scene.pictures import world_at_end

        return world_at_end(self.stored)


def _by_name() -> dict[str, Option]:
    """Return every option that affects a run, by its long names."""
    return {
        flag.lstrip("-").replace("-", "_"): option
        for option in OPTIONS
        if not option.panel and option.group != APP
        for flag in option.flags
        if flag.startswith("--")
    }


def choices_of(choices: Mapping[str, Any]) -> dict[str, Any]:
    """Convert keyword arguments to settings by path.

    Args:
        choices: Values by the long name of an option, such as `background` or `x`; None is ignored.

    Raises:
        ConfigError: there is no such option, or its value is wrong.
    """
    known, found = _by_name(), {}
    for name, value in choices.items():
        if name not in known:
            raise ConfigError(f"no such argument {name!r}", nearest(name, known))
        option = known[name]
        if value is None:
            continue
        found[option.path] = option.from_python(value, name)
    return found


def _source(program: str | Path) -> ProgramSource:
    if isinstance(program, str) and "\n" in program:
        return program_of_text(program, None, "program")
    return read_program(find_program(str(program)))


def _in_world(world: str | Path | None, given: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the settings of a world file; none without one."""
    return (
        load_world(find_program(str(world)), given.get("mats")).settings
        if world is not None
        else {}
    )


def _prepared(
    program: str | Path,
    arguments: Sequence[str],
    *layers: Mapping[str, Any],
) -> tuple[Program, ProgramSettings]:
    """Return a program to start, and its settings; arguments of the call take precedence over those of the settings."""
    source = _source(program)
    found = program_settings(source, *layers)
    started = found.applied_to(source.program)
    return replace(started, arguments=tuple(arguments)) if arguments else started, found


def _check_timeout(timeout_s: float) -> None:
    if not timeout_s > 0:
        raise ConfigError(f"must be above 0, got {timeout_s!r}", key="timeout_s")


def simulate(
    program: str | Path,
    *,
    arguments: Sequence[str] = (),
    answers: tuple[str, ...] = (),
    timeout_s: float = DEFAULT_TIME_LIMIT_S,
    world: str | Path | None = None,
    **choices: Any,
) -> SimulatedRun:
    """Run a program as fast as possible, block until it ends, and return its results.

    An exception in the program is not raised here: see `state` and `error`.

    Args:
        program: A file, the name of an example, or source text of several lines.
        arguments: The program's `sys.argv[1:]`.
        answers: The return values of successive `input()` calls.
        timeout_s: Limit in simulated seconds.
        world: A world file; it takes precedence over the program's first line, and `choices` over it.
        choices: Switches by their long names: `background="Grey_bands", x=100, seed=7`.

    Raises:
        ConfigError: the program, its first line, the world or a choice is wrong; nothing was run.
        KeyboardInterrupt: ctrl-C; the run has been stopped, and its log is stored.
    """
    _check_timeout(timeout_s)
    given = choices_of(choices)
    started, found = _prepared(program, arguments, _in_world(world, given), given)
    spec = build_run_spec(found.settings)
    actions = press_actions(found.settings["press"], spec.profile.tick_hz)
    options = RunOptions(time_limit_s=timeout_s, answers=tuple(answers), actions=actions)
    handle = start_run(started, spec, options, RunStore())
    try:
        handle.wait()
    finally:
        handle.close()
    run = handle.stored()
    return SimulatedRun(run, "; ".join(filter(None, (found.decided.note, describe_plugged(run)))))


def experiment(
    program: str | Path | Sequence[str | Path],
    *,
    seeds: str | Iterable[int] = (),
    parameters: Mapping[str, str | Value | Iterable[Value]] | None = None,
    expressions: Mapping[str, str] | None = None,
    goals: str | Path | None = None,
    jobs: int = 0,
    arguments: Sequence[str] = (),
    answers: tuple[str, ...] = (),
    timeout_s: float = DEFAULT_TIME_LIMIT_S,
    keep: str = "none",
    world: str | Path | None = None,
    **choices: Any,
) -> pd.DataFrame:
    """Run a program with all combinations of seeds and parameters, block until they end, and return the results.

    An exception in a program is not raised here: see the columns `end` and `summary`.

    Args:
        program: As for `simulate`; or several.
        seeds: The seeds, such as `range(200)` or `"0..199"`; empty for the one in `choices`.
        parameters: Values by key of a world or robot file: `{"noise.motor": [0, 20, 50]}`; a text is read as after
            `--set`, such as `"54:58:0.5"`.
        expressions: Further columns by name, such as `{"error_mm": "hypot(x_mm - 750, y_mm - 850)"}`.
        goals: A goals file; its world is used without a `world`, where `choices` say nothing else.
        jobs: Number of worker processes; 0 is one for each processor. The results do not depend on it.
        arguments, answers, timeout_s: As for `simulate`.
        keep: Which runs to store: `all`, `failed` or `none`.
        world, choices: World and options of all runs, as for `simulate`.

    Returns:
        One row for each run, in the order of the parameters, the seed varying fastest; columns as in `tuisim batch`.

    Raises:
        ConfigError: a program, a parameter, an expression, a goal or a choice is wrong; nothing was run.
        KeyboardInterrupt: ctrl-C; the runs have been stopped.
    """
    from tuisim.batch.parameters import SEED, checked_seeds, parse_seeds
    from tuisim.batch.plan import Plan, Subject
    from tuisim.batch.sweep import Sweep, Workers
    from tuisim.tasks.goals.files import load_goals
    from tuisim.tasks.task import MAX_JOBS, Keep

    _check_timeout(timeout_s)
    if keep not in [*Keep]:
        raise ConfigError(f"no such value {keep!r}", f"one of {', '.join(Keep)}", key="keep")
    if jobs not in range(MAX_JOBS + 1):
        raise ConfigError(f"must be a whole number from 0 to {MAX_JOBS}, got {jobs!r}", key="jobs")
    given = choices_of(choices)
    task = load_goals(goals) if goals is not None else None
    pressed = task.presses if task else {}
    in_world = task.settings if task and world is None else {**_in_world(world, given), **pressed}
    subjects = []
    for one in [program] if isinstance(program, str | Path) else program:
        started, found = _prepared(one, arguments, in_world, given)
        subjects.append(Subject(started, found.settings, frozenset(given)))
    if not subjects:
        raise ConfigError("no program is named", key="program")
    varied = {name: _choice(name, values) for name, values in (parameters or {}).items()}
    if not isinstance(seeds, Iterable):
        raise ConfigError(
            f"must be several, got {seeds!r}", "such as range(200) or '0..199'", key="seeds"
        )
    chosen = (
        parse_seeds(seeds, "seeds")
        if isinstance(seeds, str)
        else checked_seeds(list(seeds), "seeds")
    )
    if chosen:
        varied[SEED] = chosen
    options = RunOptions(
        time_limit_s=timeout_s, answers=tuple(answers) or (task.answers if task else ())
    )

    def options_of(spec: RunSpec, settings: Settings) -> RunOptions:
        return replace(options, actions=press_actions(settings["press"], spec.profile.tick_hz))

    judged = task.goals if task else ()
    plan = Plan(tuple(subjects), varied, Path("parameters"), judged, Keep(keep), options_of)
    plan.check_expressions(expressions or {})
    sweep = Sweep(plan, expressions or {})
    sweep.run(Workers(jobs))
    return sweep.build_frame()


def _choice(name: str, values: str | Value | Iterable[Value]) -> Choice:
    """Return what a parameter takes: a text is read as on the command line, numbers of NumPy become plain."""
    from tuisim.batch.parameters import parse_values

    if isinstance(values, str):
        return parse_values(values, name)
    listed = [values] if isinstance(values, bool | int | float) else list(values)
    if not listed:
        raise ConfigError("has no values", key=name)
    return tuple(value.item() if hasattr(value, "item") else value for value in listed)
