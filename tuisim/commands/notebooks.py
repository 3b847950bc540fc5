"""Notebooks on the command line: their program cells as a list, and what became of all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tuisim.commands import exit_status
from tuisim.commands.echo import echo, echo_error, echo_json, echo_lines
from tuisim.commands.tables import table
from tuisim.errors import ConfigError
from tuisim.notebook.cells import NotebookProgram, chosen_programs, is_notebook, notebook_programs, notebooks_in
from tuisim.runs.run_folder import StoredRun

NOT_RUN = "not_run"


def to_list(words: Sequence[str], *, run_all: bool = False) -> list[NotebookProgram]:
    """Return the programs of a notebook that is named without saying which; none if there is nothing to choose."""
    if run_all or len(words) != 1 or not is_notebook(words[0]) or "#" in words[0]:
        return []
    programs = chosen_programs(words[0])
    return programs if len(programs) > 1 else []


def print_list(word: str, programs: Sequence[NotebookProgram]) -> None:
    """Print the programs of a notebook and how to name one."""
    rows = [(p.number, _titled(p), p.source.switches.get("background", ""), p.source.prelude) for p in programs]
    echo_lines(table(("cell", "title", "mat", "names"), rows))
    echo()
    echo(f"tuisim '{word}#1' opens the first; tuisim run '{word}#1' runs it, tuisim run {word} --all runs all")


def _titled(program: NotebookProgram) -> str:
    needs = f"(needs {program.unknown} of the notebook)" if program.unknown else ""
    return " ".join(filter(None, (program.title, needs)))


def known_programs(word: str) -> list[NotebookProgram]:
    """Return the programs that a word means, without those that run in the notebook only; notes on stderr tell which.

    Raises:
        ConfigError: there is no such notebook or program, or it runs in the notebook only.
    """
    known = _known(chosen_programs(word))
    if not known:
        raise ConfigError("has no program that runs outside the notebook", "run its cells in Jupyter", file=word)
    return known


def known_programs_of(path: Path) -> list[NotebookProgram]:
    """Return the programs of one of many notebooks, as `known_programs` does; there may be none.

    Raises:
        ConfigError: it is no notebook, or a magic line in it is wrong.
    """
    return _known(notebook_programs(path))


def _known(programs: Sequence[NotebookProgram]) -> list[NotebookProgram]:
    known: list[NotebookProgram] = []
    for program in programs:
        for note in program.notes:
            echo_error(f"tuisim: {note}")
        if program.unknown:
            echo_error(f"tuisim: {program.source.name} is skipped: only the notebook knows {program.unknown}")
        else:
            known.append(program)
    return known


@dataclass(frozen=True, slots=True)
class NotRun:
    """A program, or a whole notebook of a folder, that cannot be run."""

    label: str
    """What it is called in the table."""
    error: ConfigError

    def report(self, *, as_json: bool) -> None:
        """Tell why it is not run."""
        if as_json:
            facts = {"program": self.label, "state": NOT_RUN, "error": str(self.error)}
            echo_json({**facts, "exit_code": exit_status.EXIT_BAD_OUTPUT}, flush=True)
        else:
            echo_error(f"tuisim: {self.label} is not run: {self.error}")


def check_folder(word: str, *, run_all: bool) -> list[Path]:
    """Return the notebooks in the folder that a word names.

    Raises:
        ConfigError: there are none, or nobody says that all of them are to be run.
    """
    found = notebooks_in(Path(word))
    if not found:
        raise ConfigError("is a folder without notebooks", "name a program, or a folder that has some", file=word)
    if not run_all:
        hint = f"tuisim run {word} --all runs them all"
        raise ConfigError(f"is a folder of {len(found)} notebook{'s' * (len(found) > 1)}", hint, file=word)
    return found


def print_results(results: Sequence[tuple[str, StoredRun | None]]) -> None:
    """Print one row a program: how it ended, samples, simulated time, run.

    Args:
        results: What each is called, and its run; None for one that was not run.
    """
    rows = [_row(label, run) for label, run in results]
    echo_lines(table(("cell", "state", "samples", "time s", "run"), rows))


def _row(label: str, run: StoredRun | None) -> tuple[object, ...]:
    if run is None:
        return label, NOT_RUN, "", "", ""
    facts = exit_status.describe(run)
    return label, facts["state"], facts["samples"], f"{facts['time_s']:.3f}", facts["run"]
