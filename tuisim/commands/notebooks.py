"""Notebooks on the command line: their program cells as a list, and what became of all of them."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.commands import outcome
from tuisim.commands.echo import echo, echo_error, echo_lines
from tuisim.commands.tables import table
from tuisim.datalog.runfile import StoredRun
from tuisim.errors import ConfigError
from tuisim.notebook.reading import NotebookProgram, chosen_programs, is_notebook


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
    known: list[NotebookProgram] = []
    for program in chosen_programs(word):
        for note in program.notes:
            echo_error(f"tuisim: {note}")
        if program.unknown:
            echo_error(f"tuisim: {program.source.name} is skipped: only the notebook knows {program.unknown}")
        else:
            known.append(program)
    if not known:
        raise ConfigError("has no program that runs outside the notebook", "run its cells in Jupyter", file=word)
    return known


def print_results(runs: Sequence[StoredRun]) -> None:
    """Print one row a run: how it ended, samples, simulated time."""
    rows = [
        (facts["program"], facts["state"], facts["samples"], f"{facts['time_s']:.3f}", facts["run"])
        for facts in map(outcome.describe, runs)
    ]
    echo_lines(table(("cell", "state", "samples", "time s", "run"), rows))
