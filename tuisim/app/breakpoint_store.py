"""Breakpoints and watches, stored per program in the user's data folder."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

from tuisim.atomic import make_private_folder, replacing
from tuisim.breakpoints import Breakpoint, break_line_of, moved, parse_break
from tuisim.errors import ConfigError
from tuisim.source import source_lines

FOLDER = "breaks"
MAX_KEPT = 200
"""Breakpoints and watches of one program."""


@dataclass(frozen=True, slots=True)
class Kept:
    """The stored breakpoints and watches of one program."""

    breaks: tuple[Breakpoint, ...] = ()
    watches: tuple[str, ...] = ()


def _file(program: str) -> Path:
    from tuisim.config.folders import home_folder

    return home_folder() / FOLDER / f"{hashlib.sha256(program.encode(errors='surrogateescape')).hexdigest()[:24]}.json"


def load_kept(program: str) -> Kept:
    """Return what is stored for a program; empty if there is nothing or it cannot be read.

    Args:
        program: Its path, or its name if it is in no file.
    """
    try:
        data = json.loads(_file(program).read_bytes())
        breaks = tuple(parse_break(text) for text in data["breaks"][:MAX_KEPT])
        return Kept(breaks, tuple(str(text) for text in data["watches"][:MAX_KEPT]))
    except (OSError, ValueError, KeyError, TypeError, AttributeError, ConfigError):
        return Kept()


def keep(program: str, kept: Kept) -> None:
    """Store the breakpoints and watches of a program.

    Raises:
        ConfigError: they cannot be written.
    """
    file = _file(program)
    data = {"program": program, "breaks": [one.written() for one in kept.breaks], "watches": list(kept.watches)}
    try:
        make_private_folder(file.parent)
        with replacing(file, owner_only=True) as handle:
            handle.write(json.dumps(data).encode("ascii"))
    except OSError as error:
        raise ConfigError(f"breakpoints cannot be kept: {error.strerror or error}", file=str(file)) from None


def following(breaks: tuple[Breakpoint, ...], before: str, now: str) -> tuple[Breakpoint, ...]:
    """Move breakpoints along with their lines after one edit of the text; those on deleted lines are dropped."""
    old, new = source_lines(before), source_lines(now)
    shift = len(new) - len(old)
    if not shift:
        return breaks
    same = 0
    while same < min(len(old), len(new)) and old[same] == new[same]:
        same += 1
    kept = []
    for one in breaks:
        line = break_line_of(one)
        if line <= same or not line:
            kept.append(one)
        elif line + shift > same:
            kept.append(moved(one, line + shift))
    return tuple(kept)
