"""Notebooks on the command line: their program cells as a list, and what became of all of them."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.commands import outcome
from tuisim.commands.echo import echo, echo_lines
from tuisim.commands.tables import table
from tuisim.datalog.runfile import StoredRun
from tuisim.notebook.reading import NotebookProgram, chosen_programs, is_notebook


def to_list(words: Sequence[str], *, run_all: bool = False) -> list[NotebookProgram]:
    """Return the programs of a notebook that is named without saying which; none if there is nothing to choose."""
    if run_all or len(words) != 1 or not is_notebook(words[0]) or "#" in words[0]:
        return []
    programs = chosen_programs(words[0])
    return programs if len(programs) > 1 else []


def print_list(word: str, programs: Sequence[NotebookProgram]) -> None:
    """Print the programs of a notebook and how to name one."""
    rows = [(p.number, p.title, p.source.switches.get("background", ""), p.source.prelude) for p in programs]
    echo_lines(table(("cell", "title", "mat", "names"), rows))
    echo()
    echo(f"tuisim '{word}#1' opens the first; tuisim run '{word}#1' runs it, tuisim run {word} --all runs all")


def print_results(runs: Sequence[StoredRun]) -> None:
    """Print one row a run: how it ended, samples, simulated time."""
    rows = [
        (facts["program"], facts["state"], facts["samples"], f"{facts['time_s']:.3f}", facts["run"])
        for facts in map(outcome.describe, runs)
    ]
    echo_lines(table(("cell", "state", "samples", "time s", "run"), rows))
