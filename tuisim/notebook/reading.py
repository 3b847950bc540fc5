"""The programs in a notebook file, each with the world that the cells before it have set."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tuisim.errors import ConfigError
from tuisim.notebook.words import lasting_after, parse_line
from tuisim.programfile import PRELUDES, ProgramSource, beside
from tuisim.switches import nearest

MAX_NOTEBOOK_BYTES = 64 << 20
SUFFIX = ".ipynb"

_MAGIC = re.compile(r"%(?P<cell>%)?(?P<name>sim_magic\w*)(?P<words>.*)")
_HEADING = re.compile(r"#+\s+(.*\S)")


@dataclass(frozen=True, slots=True)
class NotebookProgram:
    """One program cell."""

    number: int
    """From 1, among the program cells."""
    title: str
    """The nearest heading above it, empty if there is none."""
    source: ProgramSource


def is_notebook(word: str) -> bool:
    """Return whether a word of the command line means a notebook, or a cell of one as `FILE#number`."""
    return word.partition("#")[0].endswith(SUFFIX)


def _cells(path: Path) -> Iterator[tuple[str, str]]:
    """Yield (cell type, text)."""
    shown = str(path)
    try:
        if not path.is_file():
            raise ConfigError("there is no such notebook", file=shown)
        with path.open("rb") as file:
            data = file.read(MAX_NOTEBOOK_BYTES + 1)
    except OSError as error:
        raise ConfigError(f"cannot be read: {error.strerror or error}", file=shown) from None
    if len(data) > MAX_NOTEBOOK_BYTES:
        raise ConfigError(f"is larger than {MAX_NOTEBOOK_BYTES >> 20} MiB", file=shown)
    try:
        for cell in json.loads(data)["cells"]:
            source = cell["source"]
            yield str(cell["cell_type"]), source if isinstance(source, str) else "".join(source)
    except (ValueError, KeyError, TypeError, RecursionError):
        raise ConfigError(
            "is no notebook that can be read", "one of format 4, as Jupyter saves it", file=shown
        ) from None


def notebook_programs(path: Path) -> list[NotebookProgram]:
    """Return the programs in a notebook, from the top.

    Raises:
        ConfigError: it cannot be read, is no notebook, or a magic line in it is wrong.
    """
    found: list[NotebookProgram] = []
    title, lasting = "", dict[str, Any]()
    for place, (kind, text) in enumerate(_cells(path), 1):
        if kind == "markdown":
            headings = [match[1] for line in text.splitlines() if (match := _HEADING.match(line))]
            title = headings[-1] if headings else title
        if kind != "code":
            continue
        for magic, words in _magics(text, f"{path}, cell {place}"):
            said = beside(path.parent, words)
            lasting = lasting_after(lasting, said)
            if magic["cell"]:
                number = len(found) + 1
                # The magic's line stays, empty, so that lines count as in the cell.
                at = text.index("%%")
                body = "\n" * (text.count("\n", 0, at) + 1) + text[at:].partition("\n")[2]
                prelude = str(said.get("preload", PRELUDES[magic["name"]]))
                source = ProgramSource(f"{path.name}#{number}", "", body, prelude, {**lasting, **said})
                found.append(NotebookProgram(number, title, source))
    return found


def _magics(text: str, where: str) -> Iterator[tuple[re.Match[str], Mapping[str, Any]]]:
    """Yield each magic that sets the world, with what it says; a cell's own magic is its first line."""
    stripped = text.lstrip()
    lines = stripped.splitlines()[:1] if stripped.startswith("%%") else stripped.splitlines()
    for line in lines:
        match = _MAGIC.fullmatch(line.strip())
        if match is None:
            continue
        if match["name"] not in PRELUDES:
            known = nearest(match["name"], PRELUDES)
            raise ConfigError(f"no such magic %{match['cell'] or ''}{match['name']}", known, file=where)
        try:
            yield match, parse_line(match["words"], match["name"]).settings
        except ConfigError as error:
            raise ConfigError(error.message, error.hint, file=where) from None


def chosen_programs(word: str) -> list[NotebookProgram]:
    """Return the programs that `FILE` or `FILE#number` means.

    Raises:
        ConfigError: there is no such notebook or program.
    """
    name, sharp, cell = word.partition("#")
    programs = notebook_programs(Path(name))
    if not programs:
        raise ConfigError("has no program cells", "they begin with %%sim_magic", file=name)
    if not sharp:
        return programs
    if not cell.isdecimal() or not 1 <= int(cell) <= len(programs):
        raise ConfigError(f"no program {cell!r}", f"a number from 1 to {len(programs)}", file=name)
    return [programs[int(cell) - 1]]
