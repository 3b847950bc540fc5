"""The breakpoints and watches that are stored for each program, and how they follow the lines of an edited text."""

from __future__ import annotations

import json
from collections.abc import Iterable

from tuisim.app.editor.text_file import find_program_data, write_json
from tuisim.app.editor.text_lines import count_same_lines
from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.base.regular_file import read_regular
from tuisim.base.source import source_lines
from tuisim.engine.breakpoints import Breakpoint
from tuisim.engine.files import MAX_FILE_BYTES

FOLDER = "breaks"
MAX_KEPT = 200
"""Maximum number of stored breakpoints of a program that are read, and of its watches; further ones are ignored."""


@dataclass(frozen=True, slots=True)
class StoredBreaks:
    """The stored breakpoints and watches of one program."""

    breaks: tuple[Breakpoint, ...] = ()
    watches: tuple[str, ...] = ()


def load_kept(program: str) -> StoredBreaks:
    """Return the stored breakpoints and watches of a program; empty if none are stored, or they cannot be read.

    Args:
        program: Its path, or its name if it is in no file.
    """
    try:
        data = json.loads(read_regular(find_program_data(FOLDER, program), MAX_FILE_BYTES))
        breaks = tuple(Breakpoint.parse(text) for text in data["breaks"][:MAX_KEPT])
        return StoredBreaks(breaks, tuple(str(text) for text in data["watches"][:MAX_KEPT]))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError, ConfigError):
        return StoredBreaks()


def keep(program: str, stored: StoredBreaks) -> None:
    """Store the breakpoints and watches of a program in place of those that were stored before.

    Raises:
        ConfigError: they cannot be written.
    """
    file = find_program_data(FOLDER, program)
    data = {
        "program": program,
        "breaks": [entry.written() for entry in stored.breaks],
        "watches": list(stored.watches),
    }
    try:
        write_json(file, data)
    except OSError as error:
        raise ConfigError(
            f"breakpoints cannot be saved: {error.strerror or error}", file=str(file)
        ) from None


def break_lines(breaks: Iterable[Breakpoint]) -> dict[int, Breakpoint]:
    """Return the breakpoints that are on lines, by line number.

    If a line has several breakpoints, the result has an enabled one, if there is one.
    """
    by_line: dict[int, Breakpoint] = {}
    for point in sorted(breaks, key=lambda point: not point.disabled):
        line = point.find_line()
        if line:
            by_line[line] = point
    return by_line


def choose_sign(entry: Breakpoint) -> str:
    """Return the sign of a breakpoint beside its line: `○` if it is disabled, `◆` if it has a condition, else `●`."""
    if entry.disabled:
        return "○"
    return "◆" if entry.has_expression else "●"


def follow_edit(breaks: tuple[Breakpoint, ...], before: str, now: str) -> tuple[Breakpoint, ...]:
    """Return the breakpoints after an edit of the text: they move with their lines, or are deleted with them.

    Args:
        breaks: The breakpoints before the edit.
        before: The text before the edit.
        now: The text after it.
    """
    old, new = source_lines(before), source_lines(now)
    shift = len(new) - len(old)
    if not shift:
        return breaks
    same = count_same_lines(old, new)
    kept = []
    for entry in breaks:
        line = entry.find_line()
        if line <= same or not line:
            kept.append(entry)
        elif line + shift > same:
            kept.append(entry.move(line + shift))
    return tuple(kept)
