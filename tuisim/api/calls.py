"""What `simulate` does: it runs a program once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.api.descriptions import read_options, read_world
from tuisim.api.run import Run
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.presses import press_actions
from tuisim.engine.runs.store import RunStore
from tuisim.programs.function import read_function
from tuisim.programs.plugged_words import describe_plugged
from tuisim.programs.program_file import ProgramSource, build_program, find_program, read_program
from tuisim.programs.program_settings import ProgramSettings, build_program_settings
from tuisim.settings.build import build_run_spec


def read_source(program: str | Path | Callable[[], object]) -> ProgramSource:
    """Return a program by its file, the name of an example, its text of several lines, or a function.

    Raises:
        ConfigError: there is no such program, or its first line is wrong.
    """
    if isinstance(program, str) and "\n" in program:
        return build_program(program, None, "program")
    if not isinstance(program, str | Path):
        return read_function(program)
    return read_program(find_program(str(program)))


def prepare_program(
    source: ProgramSource, arguments: Sequence[str], *layers: Mapping[str, Any]
) -> tuple[Program, ProgramSettings]:
    """Return a program to start, and its settings; arguments of the call take precedence over those of the settings.

    Raises:
        ConfigError: its settings do not fit it.
    """
    settings = build_program_settings(source, *layers)
    started = settings.apply(source.program)
    return replace(started, arguments=tuple(arguments)) if arguments else started, settings


def check_timeout(timeout_s: float) -> None:
    """Refuse a limit that no time is below."""
    if not timeout_s > 0:
        raise ConfigError(f"must be above 0, got {timeout_s!r}", key="timeout_s")


def run_program(
    program: str | Path | Callable[[], object],
    *,
    arguments: Sequence[str],
    answers: Sequence[str],
    timeout_s: float,
    world: Any,
    **options: Any,
) -> Run:
    """Run a program; arguments as of `tuisim.simulate`."""
    check_timeout(timeout_s)
    chosen = read_options(options)
    in_world = read_world(world, chosen.get("mats"))
    started, settings = prepare_program(read_source(program), arguments, in_world, chosen)
    spec = build_run_spec(settings.settings)
    actions = press_actions(settings.settings["press"], spec.profile.tick_hz)
    run_options = RunOptions(time_limit_s=timeout_s, answers=tuple(answers), actions=actions)
    handle = start_run(started, spec, run_options, RunStore())
    try:
        handle.wait()
    finally:
        handle.close()
    run = handle.stored()
    return Run(run, "; ".join(filter(None, (settings.decided.note, describe_plugged(run)))))
