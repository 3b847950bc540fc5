"""Programs in a notebook file, each with the world set up by the cells before it."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.base.source import PRELUDES, Program, source_lines
from tuisim.engine.files import read_bytes
from tuisim.programs.program_file import ProgramSource, resolve_files
from tuisim.settings.magic_line import parse_line, update_persistent

MAX_NOTEBOOK_BYTES = 64 << 20
SUFFIX = ".ipynb"

_MAGIC = re.compile(r"%(?P<cell>%)?(?P<name>sim_magic\w*)(?P<words>.*)")
_VARIABLE = re.compile(r"(?<!\$)\$[A-Za-z_][\w.]*|\{[^{}]+\}")
"""Variables that IPython expands in a magic line."""
_HEADING = re.compile(r"#+\s+(.*\S)")


@dataclass(frozen=True, slots=True)
class NotebookProgram:
    """A program in a cell of a notebook, with the world that the cells before it have set."""

    number: int
    """From 1, among the program cells."""
    title: str
    """The nearest heading above it, empty if there is none."""
    source: ProgramSource
    unknown: str = ""
    """A notebook variable in its magic line, such as `$x`; it can run only in the notebook. Empty if there is none."""
    notes: tuple[str, ...] = ()
    """Warnings about skipped parts of the cells between the previous program and this one."""


@dataclass(frozen=True, slots=True)
class _Words:
    """A parsed magic line of a notebook: its settings without those that contain variables of the notebook.

    `unknown` has these variables as text.
    """

    magic: re.Match[str]
    settings: Mapping[str, Any]
    unknown: str


def is_notebook(word: str) -> bool:
    """Return whether a word of the command line names a notebook, or a cell of one as `FILE#number`."""
    return word.partition("#")[0].endswith(SUFFIX)


def _read_cells(path: Path) -> Iterator[tuple[str, str]]:
    """Yield the type and the text of each cell of a notebook."""
    file_name = str(path)
    missing = "there is no such notebook"
    data = read_bytes(path, MAX_NOTEBOOK_BYTES, ConfigError, missing, folder=missing)
    if len(data) > MAX_NOTEBOOK_BYTES:
        raise ConfigError(f"is larger than {MAX_NOTEBOOK_BYTES >> 20} MiB", file=file_name)
    try:
        for cell in json.loads(data)["cells"]:
            source = cell["source"]
            yield str(cell["cell_type"]), source if isinstance(source, str) else "".join(source)
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ConfigError(
            "is not a readable notebook", "one of format 4, as Jupyter saves it", file=file_name
        ) from None


def read_notebook_programs(path: Path) -> list[NotebookProgram]:
    """Return the programs in a notebook, from the top, without settings that contain the notebook's variables.

    Raises:
        ConfigError: the file cannot be read, is no notebook, or has a wrong magic line.
    """
    programs: list[NotebookProgram] = []
    title = ""
    persistent = dict[str, Any]()
    notes = list[str]()
    folder = os.path.dirname(os.path.abspath(path))
    for place, (kind, text) in enumerate(_read_cells(path), 1):
        if kind == "markdown":
            headings = [match[1] for line in source_lines(text) if (match := _HEADING.match(line))]
            title = headings[-1] if headings else title
        if kind != "code":
            continue
        where = f"{path}, cell {place}"
        for words in _parse_magics(text, where):
            magic_options = resolve_files(path.parent, words.settings)
            persistent = update_persistent(persistent, magic_options)
            if words.magic["cell"]:
                number = len(programs) + 1
                # The magic's line is left empty, so that line numbers are those of the cell.
                start = text.index("%%")
                body = "\n" * (text.count("\n", 0, start) + 1) + text[start:].partition("\n")[2]
                prelude = str(magic_options.get("preload", PRELUDES[words.magic["name"]]))
                options = {**persistent, **magic_options}
                cell = Program(f"{path.name}#{number}", body, prelude, module_folder=folder)
                source = ProgramSource(cell, options, has_magic=True)
                programs.append(NotebookProgram(number, title, source, words.unknown, tuple(notes)))
                notes.clear()
            elif words.unknown:
                notes.append(
                    f"{where}: {words.unknown} is defined only in the notebook, and is ignored"
                )
    return programs


def _parse_magics(text: str, where: str) -> Iterator[_Words]:
    """Yield the parsed magic lines of a notebook cell.

    If the cell begins with a cell magic (`%%`), that is the only one; otherwise, every line can be a line magic (`%`).

    Args:
        text: The text of the cell.
        where: The place of the cell, for errors.

    Raises:
        ConfigError: a magic is not one of `PRELUDES`, or has a wrong option.
    """
    stripped = text.lstrip()
    lines = source_lines(stripped)
    if stripped.startswith("%%"):
        lines = lines[:1]
    for line in lines:
        match = _MAGIC.fullmatch(line.strip())
        if match is None:
            continue
        if match["name"] not in PRELUDES:
            known = nearest(match["name"], PRELUDES)
            raise ConfigError(
                f"no such magic %{match['cell'] or ''}{match['name']}", known, file=where
            )
        line_words, unknown = _drop_variables(match["words"])
        try:
            yield _Words(match, parse_line(line_words, match["name"]).settings, unknown)
        except ConfigError as error:
            raise ConfigError(error.message, error.hint, file=where) from None


def _drop_variables(words: str) -> tuple[str, str]:
    """Return a magic line without the options whose values contain notebook variables, and these variables as text."""
    unknown = ", ".join(_VARIABLE.findall(words))
    constant: list[str] = []
    # The pattern keeps a variable in braces, which may contain blanks, in one word.
    for word in re.findall(rf"(?:{_VARIABLE.pattern}|\S)+", words) if unknown else ():
        if not _VARIABLE.search(word):
            constant.append(word)
        elif not word.startswith("-") and constant and constant[-1].startswith("-"):
            constant.pop()
    return (" ".join(constant) if unknown else words), unknown


def choose_programs(word: str) -> list[NotebookProgram]:
    """Return the programs that `FILE` or `FILE#number` names.

    Raises:
        ConfigError: there is no such notebook or program, or the program uses a value that only the notebook defines.
    """
    name, sharp, cell = word.partition("#")
    programs = read_notebook_programs(Path(name))
    if not programs:
        raise ConfigError(
            "has no program cells", "a program cell begins with %%sim_magic", file=name
        )
    if not sharp:
        return programs
    if not cell.isdecimal() or not 1 <= int(cell) <= len(programs):
        raise ConfigError(f"no program {cell!r}", f"a number from 1 to {len(programs)}", file=name)
    chosen = programs[int(cell) - 1]
    if chosen.unknown:
        hint = "run the cell there, or write a value in its place"
        raise ConfigError(f"{chosen.unknown} is defined only in the notebook", hint, file=word)
    return [chosen]
