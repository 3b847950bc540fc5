"""Every error that tuisim raises on purpose, and the checks of values that raise them.

TuisimError(message, hint, exit_code)
├─ ConfigError: file, key ── BackgroundError, RobotError, ObstacleError, ProfileError
├─ ProgramError: file, line ── NotSimulated
├─ HostError: child died, protocol mismatch
├─ LogError: file, row
└─ ExportError

A message says what was wrong and where; a hint says what is allowed. The same text
goes to stderr, to a notice in the app, and to the notebook.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar

SIGNALLED = 128
"""Exit codes above this come from a signal; no further program is then run."""
EXIT_BROKEN_PIPE = SIGNALLED + 13
"""The exit codes of a program that was ended by SIGINT or SIGPIPE."""
MOST_LISTED = 20
MOST_REASON = 500
"""Characters of a reason in a message."""
MOST_LINE = 1500
LINE_START = 1000
"""The most characters of a line of a message, and how many of them stand before the gap in a longer one."""
MOST_NAME = 80
"""The most characters of a listed name; a longer one comes from a damaged file."""


def shortened(text: str, most: int = MOST_REASON) -> str:
    """Return the first `most` characters of a text, followed by `…` if the text is longer.

    It is for texts from files: in a damaged file, a name can have any length.
    """
    return text if len(text) <= most else f"{text[:most]}…"


def listed(names: Iterable[str]) -> str:
    """Return names as a comma-separated list, shortened to `MOST_LISTED`; `none` if there are none."""
    every = [shortened(name, MOST_NAME) for name in names]
    more = len(every) - MOST_LISTED
    return ", ".join(every[:MOST_LISTED]) + (f" and {more} more" if more > 0 else "") or "none"


def counted(count: int, one: str, many: str = "") -> str:
    """Return a number with its noun, such as `1 row` or `1,500 rows`.

    Args:
        count: The number.
        one: The noun in the singular.
        many: The noun in the plural; empty for the singular and `s`.
    """
    return f"{count:,} {one if count == 1 else many or one + 's'}"


def closest(name: str, known: Iterable[str], most: int = 3, likeness: float = 0.6) -> list[str]:
    """Return the known names that are most similar to a name, the most similar first; case is ignored.

    Args:
        name: The name to compare.
        known: The known names.
        most: How many names to return, at most.
        likeness: Names with a lower similarity are left out: from 0 to 1, as `difflib` computes it.
    """
    from difflib import get_close_matches

    by_lower = {known_name.lower(): known_name for known_name in known}
    return [by_lower[lower] for lower in get_close_matches(name.lower(), by_lower, most, likeness)]


def nearest(name: str, allowed: Iterable[str]) -> str:
    """Return the hint for an unknown name: the allowed names most similar to it, or all if none is similar."""
    names = list(allowed)
    return did_you_mean(closest(name, names, 3, 0.55)) or f"one of {', '.join(names)}"


def among(name: str, allowed: Iterable[str], unlisted: Iterable[str] = ()) -> str:
    """Return the hint for an unknown name in a file: the name most similar to it, if any, and then all allowed names.

    Args:
        name: The unknown name.
        allowed: The allowed names, all of which the hint lists.
        unlisted: Further allowed names: the hint contains one of them only if it is the most similar name.
    """
    names = list(allowed)
    close = closest(name, [*names, *unlisted], 1)
    return f"{did_you_mean(list(map(repr, close)))} there are {listed(names)}".lstrip()


def see_page(topic: str) -> str:
    """Return the hint to read a page of the guide, such as `` see `tuisim guide marking` ``; `topic` is its name."""
    return f"see `tuisim guide {topic}`"


def did_you_mean(close: Sequence[str]) -> str:
    """Return a hint with the names that the user may have meant; empty if there are none."""
    return f"did you mean {' or '.join(close)}?" if close else ""


def printable(text: str) -> str:
    """Return a text as a single line that is safe in any terminal, font and file.

    Control characters, which may come from files, become U+FFFD; white space becomes a blank.
    """
    if text.isprintable():
        return text
    one_line = "".join(" " if letter.isspace() else letter for letter in text)
    return "".join(letter if letter.isprintable() else "\ufffd" for letter in one_line)


def _without_middle(line: str) -> str:
    """Return a line of at most `MOST_LINE` characters; if it is longer, with `…` in place of its middle."""
    return (
        line
        if len(line) <= MOST_LINE
        else f"{line[:LINE_START]} … {line[LINE_START - MOST_LINE :]}"
    )


class TuisimError(Exception):
    """The base class of all expected errors.

    Args:
        message: What was wrong and where, one line, no full stop needed.
        hint: What is allowed or what to do next; may be empty.
    """

    exit_code = 2
    """The exit code of the shell command for this error."""

    def __init__(self, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.hint = hint

    def __str__(self) -> str:
        text = f"{self.message} ({self.hint})" if self.hint else self.message
        return "\n".join(printable(_without_middle(line)) for line in text.split("\n"))


class ConfigError(TuisimError):
    """A file, option or value that describes a run is wrong.

    Args:
        file: The file that contains the wrong value; empty if it is not in a file.
        key: The key or option that is wrong, such as `ultrasonic.max_range_mm` or `-x`.
    """

    def __init__(self, message: str, hint: str = "", *, file: str = "", key: str = "") -> None:
        where = ": ".join(part for part in (file, key) if part)
        super().__init__(f"{where}: {message}" if where else message, hint)
        self.file = file
        self.key = key


class BackgroundError(ConfigError):
    """There is no such mat, or an image cannot be used as one."""


class RobotError(ConfigError):
    """A robot, or its file, is invalid."""


class ObstacleError(ConfigError):
    """An obstacle, or its file, is invalid."""


class ProfileError(ConfigError):
    """There is no such profile, or it is invalid."""


def _place(file: str, what: str, number: int) -> str:
    if number:
        return f"{file}, {what} {number}: "
    if file:
        return f"{file}: "
    return ""


class ProgramError(TuisimError):
    """The user's program failed.

    Args:
        file: The program's file.
        line: The line in it, from 1; 0 if unknown.
    """

    exit_code = 1

    def __init__(self, message: str, hint: str = "", *, file: str = "", line: int = 0) -> None:
        super().__init__(_place(file, "line", line) + message, hint)
        self.file = file
        self.line = line


class NotSimulated(ProgramError):
    """The program used a part of its library that is not simulated."""

    first: ClassVar[str] = ""
    """The message of the first one of a run. One that is also an error of the library does not count: a program may
    try what there is."""

    def __init__(self, message: str, hint: str = "", *, file: str = "", line: int = 0) -> None:
        super().__init__(message, hint, file=file, line=line)
        if type(self) is NotSimulated:
            NotSimulated.first = NotSimulated.first or self.message


class HostError(TuisimError):
    """Something other than the program and its settings failed: a child process, a cluster or this machine."""


class LogError(TuisimError):
    """A log or a stored run cannot be read.

    Args:
        file: The file.
        row: The row in it, from 1; 0 if unknown.
    """

    def __init__(self, message: str, hint: str = "", *, file: str = "", row: int = 0) -> None:
        super().__init__(_place(file, "row", row) + message, hint)
        self.file = file
        self.row = row


class ExportError(TuisimError):
    """An export could not be written; no partial file is left."""
