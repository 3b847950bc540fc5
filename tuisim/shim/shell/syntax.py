"""What the brick's shell understands of a line: a command, a pipe into `aplay`, and output to a device file."""

from __future__ import annotations

import os
import re
import shlex

from tuisim.data_class import dataclass

PLAYER = "aplay"
"""The only command behind a pipe."""
NOT_THERE, NOT_SHELL = 127, 2
"""Exit status of a shell for a missing command, and for a syntax error."""

_PARTS = re.compile(
    r"""(?P<blank>[ \t]+)
    |>[ \t]*(?P<file>/(?:sys|dev)/[^\s;&|<>()'"\\`$]+)
    |(?P<word>(?![12]>)(?:[^\s;&|<>()'"\\`$]|\\[^\n]|'[^']*'|"(?:[^"\\`$]|\\.)*")+)
    |(?P<pipe>\|)(?!\|)""",
    re.VERBOSE | re.DOTALL,
)
_OPERATOR = re.compile(r"\|\||&&|[12]?>>?|[;&\n`$()<|]")
_UNKNOWN = {
    "$": "variables are not simulated",
    "`": "commands in words are not simulated",
    "(": "groups are not simulated",
    ")": "groups are not simulated",
    "<": "files are not simulated",
    "&": "a command beside the program is not simulated: use subprocess.Popen",
    "|": f"pipes are not simulated, but for one into {PLAYER}",
    **dict.fromkeys((">", ">>"), "files are not simulated, but for those of devices"),
    **dict.fromkeys(
        ("1>", "2>", "1>>", "2>>"), "other streams are not simulated: use subprocess.run"
    ),
    **dict.fromkeys((";", "&&", "||", "\n"), "one line is one command: others are not simulated"),
}
"""What of a real shell the brick's does not have."""


class NotUnderstood(Exception):
    """A command line that the brick's shell rejects, with the reason and the shell's exit status."""

    def __init__(self, message: str, status: int = NOT_THERE) -> None:
        super().__init__(message)
        self.status = status


@dataclass(frozen=True, slots=True)
class ShellLine:
    """A line of the shell."""

    calls: tuple[tuple[str, ...], ...]
    """The words of the command, and of `aplay` if a pipe leads into it; empty for an empty line."""
    file: str = ""
    """The device file that standard output is written to; empty for none."""


def read_line(text: str) -> ShellLine:
    """Return what a command line says.

    Raises:
        NotUnderstood: a quote is not closed, a command is missing, or the syntax is not simulated.
    """
    calls: list[list[str]] = [[]]
    file = ""
    text = text.strip()
    at = 0
    while at < len(text):
        part = _PARTS.match(text, at)
        if part is None or (part["pipe"] and len(calls) > 1):
            raise _complaint(text[at:])
        if part["word"]:
            calls[-1] += shlex.split(part["word"])
        elif part["pipe"]:
            calls.append([])
        file = part["file"] or file
        at = part.end()
    if not all(calls) and text:
        raise NotUnderstood("syntax error: a command is missing", NOT_SHELL)
    if len(calls) > 1 and os.path.basename(calls[1][0]) != PLAYER:
        raise _complaint(f"| {calls[1][0]}")
    return ShellLine(tuple(map(tuple, filter(None, calls))), file)


def _complaint(rest: str) -> NotUnderstood:
    """Return the error for the rest of a line that does not start with what is understood."""
    inside = re.search(r"(?<!\\)[`$]", rest) if rest[0] == '"' else _OPERATOR.match(rest)
    if inside is not None:
        return NotUnderstood(f"{rest[inside.start() :][:20]!r}: {_UNKNOWN[inside[0]]}")
    return NotUnderstood("syntax error: a quote is not closed", NOT_SHELL)
