"""What `simulate` does: it runs a program once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tuisim.api.descriptions import plain, read_options, read_world, warn_all
from tuisim.api.run import Run
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.store import RunStore
from tuisim.programs.constants import set_constants
from tuisim.programs.function import read_function
from tuisim.programs.plugged_words import describe_plugged
from tuisim.programs.program_file import ProgramSource, build_program, find_program, read_program
from tuisim.programs.program_settings import ProgramSettings, build_program_settings
from tuisim.settings.build import build_run_spec, list_ineffective
from tuisim.settings.presses import press_actions

_NO_NAME = frozenset("\n(=:")
"""A text with one of these characters is the text of a program, not the name of a program or file."""


def read_source(program: str | Path | Callable[[], object]) -> ProgramSource:
    """Return the program that a caller gives as a file, the name of an example, a source text or a function.

    Raises:
        ConfigError: there is no such program, or its first line is wrong.
    """
    if not isinstance(program, str | Path):
        return read_function(program)
    name = str(program)
    if isinstance(program, Path) or name.endswith((".py", ".ipynb")) or _NO_NAME.isdisjoint(name):
        return read_program(find_program(name))
    return build_program(name, None, "program")


def prepare_program(
    source: ProgramSource,
    arguments: Sequence[str],
    *layers: Mapping[str, Any],
    constants: Mapping[str, object],
) -> tuple[Program, ProgramSettings]:
    """Return a program that is ready to start, and its settings.

    Args:
        source: The program.
        arguments: Its `sys.argv[1:]`; empty for those in the settings.
        layers: Settings by path, the later ones take precedence.
        constants: New values of the program's constants, by name. The robot that tuisim finds in the text of the
            program has the values in this text, not these.

    Raises:
        ConfigError: its settings do not fit it, or it has no such constant.
    """
    settings = build_program_settings(source, *layers)
    started = settings.apply(set_constants(source, constants).program)
    own = read_texts(arguments, "arguments")
    return replace(started, arguments=own) if own else started, settings


def build_run_options(timeout_s: float, answers: Sequence[str]) -> RunOptions:
    """Return the options of a run.

    Args:
        timeout_s: Limit in simulated seconds.
        answers: The answers to `input()`.

    Raises:
        ConfigError: the limit is no number above 0, or the answers are no list of texts.
    """
    limit_s = plain(timeout_s)
    if not isinstance(limit_s, int | float) or not limit_s > 0:
        raise ConfigError(f"must be a number above 0, got {timeout_s!r}", key="timeout_s")
    return RunOptions(time_limit_s=limit_s, answers=read_texts(answers, "answers"))


def read_texts(texts: Sequence[str], key: str) -> tuple[str, ...]:
    """Return a list of texts as a tuple; a single text is an error, as it would be read as a list of letters.

    Args:
        texts: The texts.
        key: The name of the argument, for errors.

    Raises:
        ConfigError: the argument is no list of texts.
    """
    if isinstance(texts, str) or not all(isinstance(text, str) for text in texts):
        raise ConfigError(f"must be a list of texts, got {texts!r}", key=key)
    return tuple(texts)


def run_program(
    program: str | Path | Callable[[], object],
    *,
    arguments: Sequence[str],
    answers: Sequence[str],
    timeout_s: float,
    world: Any,
    **options: Any,
) -> Run:
    """Run a program and return the run; the arguments are those of `tuisim.simulate`."""
    run_options = build_run_options(timeout_s, answers)
    chosen = read_options(options)
    in_world = read_world(world, chosen.get("mats"))
    started, settings = prepare_program(
        read_source(program), arguments, in_world, chosen, constants={}
    )
    spec = build_run_spec(settings.settings)
    warn_all(list_ineffective(spec))
    actions = press_actions(settings.settings["press"], spec.profile.tick_hz)
    handle = start_run(started, spec, replace(run_options, actions=actions), RunStore())
    try:
        handle.wait()
    finally:
        handle.close()
    run = handle.stored()
    return Run(run, "; ".join(filter(None, (settings.decided.note, describe_plugged(run)))))
