"""From the words of a command line to what is run: program, settings, specification."""

from __future__ import annotations

from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path

from tuisim.config import build_run_spec
from tuisim.core.spec import RunSpec
from tuisim.host import Program
from tuisim.programfile import ProgramSource, read_program
from tuisim.switches import Settings, given, settings_of


@dataclass(frozen=True, slots=True)
class Prepared:
    """All that starting a run, or the app, needs."""

    program: Program | None
    settings: Settings
    spec: RunSpec


def _find(word: str) -> Path:
    """The file that a word means: a path, else the name of an example program."""
    path = Path(word)
    if not path.name or path.parent != Path() or path.exists():
        return path
    from tuisim.assets import programs_folder

    for name in (path.name, f"{path.name}.py"):
        if (example := programs_folder() / name).is_file():
            return example
    return path


def _program(file: ProgramSource, settings: Settings) -> Program:
    return Program(name=file.name, text=file.text, prelude=settings.preload or file.prelude, path=file.path)


def prepare(word: str | None, arguments: Namespace) -> Prepared:
    """Read a program and make its run; the command line's switches win over the magic line's.

    Args:
        word: The program as the user named it; None for the app without a program.
        arguments: The parsed command line.

    Raises:
        ConfigError: program, magic line or switches are wrong.
    """
    if word is None:
        settings = settings_of(given(arguments))
        return Prepared(None, settings, build_run_spec(settings))
    file = read_program(_find(word))
    settings = settings_of(file.switches, given(arguments))
    return Prepared(_program(file, settings), settings, build_run_spec(settings))
