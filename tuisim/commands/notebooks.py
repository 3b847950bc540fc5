"""Notebooks on the command line: lists of their program cells, and tables of results."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, counted
from tuisim.commands import exit_status
from tuisim.commands.echo import draw_table, echo, echo_error, echo_json, echo_lines
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.programs.notebook_file import SUFFIX, NotebookProgram, choose_programs, is_notebook

NOT_RUN = "not_run"


def find_listed(words: Sequence[str], *, run_all: bool = False) -> list[NotebookProgram]:
    """Return the programs of a notebook that are to be listed, not run; empty if there are none.

    They are listed if the notebook is the only word, has several programs, and the word names no cell.

    Args:
        words: The words of the command line.
        run_all: Whether the user wants to run all programs.
    """
    if run_all or len(words) != 1 or not is_notebook(words[0]) or "#" in words[0]:
        return []
    programs = choose_programs(words[0])
    return programs if len(programs) > 1 else []


def print_list(word: str, programs: Sequence[NotebookProgram]) -> None:
    """Print the programs of a notebook, and how to run one of them."""
    rows = [
        (
            p.number,
            _format_title(p),
            p.source.options.get("background", ""),
            p.source.program.prelude,
        )
        for p in programs
    ]
    echo_lines(draw_table(("cell", "title", "mat", "names"), rows))
    echo()
    echo(
        f"tuisim '{word}#1' opens the first; tuisim run '{word}#1' runs it, tuisim run {word} --all runs all"
    )


def _format_title(program: NotebookProgram) -> str:
    needs = f"(needs {program.unknown} from the notebook)" if program.unknown else ""
    return " ".join(filter(None, (program.title, needs)))


def find_programs(word: str) -> list[NotebookProgram]:
    """Return the programs of a notebook or cell that can run outside the notebook.

    Args:
        word: The notebook `FILE`, or the cell `FILE#number`.

    Raises:
        ConfigError: there is no such notebook or program, or none of them can run.
    """
    known = drop_unknown(choose_programs(word))
    if not known:
        raise ConfigError(
            "has no program that runs outside the notebook", "run its cells in Jupyter", file=word
        )
    return known


def drop_unknown(programs: Sequence[NotebookProgram]) -> list[NotebookProgram]:
    """Return the programs that can run outside the notebook; print why the others are skipped."""
    known: list[NotebookProgram] = []
    for program in programs:
        for note in program.notes:
            echo_error(f"tuisim: {note}")
        if program.unknown:
            echo_error(
                f"tuisim: {program.source.program.name} is skipped: {program.unknown} is defined only in the notebook"
            )
        else:
            known.append(program)
    return known


@dataclass(frozen=True, slots=True)
class NotRun:
    """A program or notebook in a folder that cannot be run, with the reason."""

    label: str
    """Name of the program or notebook in the table and in messages."""
    error: ConfigError

    def report(self, *, as_json: bool) -> None:
        """Print the reason, as text on stderr or as JSON on stdout."""
        if as_json:
            facts = {"program": self.label, "state": NOT_RUN, "error": str(self.error)}
            echo_json({**facts, "exit_code": exit_status.EXIT_BAD_OUTPUT}, flush=True)
        else:
            echo_error(f"tuisim: {self.label} was not run: {self.error}")


def check_folder(word: str, *, run_all: bool) -> list[Path]:
    """Return the notebooks in a folder and its subfolders.

    Raises:
        ConfigError: there are none, or the option `--all` is missing.
    """
    notebooks = find_notebooks(Path(word))
    if not notebooks:
        main = os.path.join(word, "main.py")
        named = (
            f"its program {main}"
            if os.path.isfile(main)
            else "a program, or a folder with notebooks"
        )
        raise ConfigError("is a folder without notebooks", f"name {named}", file=word)
    if not run_all:
        hint = f"tuisim run {word} --all runs them all"
        raise ConfigError(f"is a folder of {counted(len(notebooks), 'notebook')}", hint, file=word)
    return notebooks


def print_results(results: Sequence[tuple[str, StoredRun | None]]) -> None:
    """Print a table of runs: label, state, samples, simulated time and number.

    Args:
        results: The label and the run of each program; the run is None for a program that was not run.
    """
    rows = [_build_row(label, run) for label, run in results]
    echo_lines(draw_table(("cell", "state", "samples", "time s", "run"), rows))


def _build_row(label: str, run: StoredRun | None) -> tuple[object, ...]:
    if run is None:
        return label, NOT_RUN, "", "", ""
    facts = exit_status.describe(run)
    return label, facts["state"], facts["samples"], f"{facts['time_s']:.3f}", facts["run"]


_NUMBERS = re.compile(r"([0-9]+)|([^0-9]+)")


def find_notebooks(folder: Path) -> list[Path]:
    """Return the notebooks in a folder and its subfolders, in natural order: 2 comes before 10.

    Hidden folders are left out, as Jupyter keeps earlier versions in them.
    """
    notebooks: list[Path] = []
    for place, folders, files in os.walk(folder):
        folders[:] = [name for name in folders if not name.startswith(".")]
        notebooks += [
            Path(place, name)
            for name in files
            if name.endswith(SUFFIX) and not name.startswith(".")
        ]
    return sorted(notebooks, key=lambda path: [_build_sort_key(part) for part in path.parts])


def _build_sort_key(name: str) -> list[tuple[int, str]]:
    """Return a sort key by which names are in natural order: 2 comes before 10."""
    return [
        (int(digits), "") if digits else (-1, text.lower())
        for digits, text in _NUMBERS.findall(name)
    ]
