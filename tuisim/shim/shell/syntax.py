"""The syntax of the brick's shell: words, pipes and operators."""

from __future__ import annotations

import re
import shlex
from dataclasses import dataclass

NULL_FILE = "/dev/null"
NOT_THERE, NOT_SHELL = 127, 2
"""Exit status of a shell for a missing command, and for a syntax error."""

_PARTS = re.compile(
    r"""(?P<blank>[ \t]+|\\\n)
    |(?P<word>(?:[^\s;&|<>()'"\\`$]|\\[^\n]|'[^']*'|"(?:[^"\\`$]|\\.)*")+)
    |(?P<joint>&&|\|\||[;&|\n])""",
    re.VERBOSE | re.DOTALL,
)
_REDIRECTION = re.compile(
    r"""(?P<stream>[12]?)>>?[ \t]*
        (?:/dev/null(?=[\s;&|]|$)|(?P<joined>&[12])|(?P<file>/(?:sys|dev)/[^\s;&|<>()'"\\`$]+))
    |<[ \t]*/dev/null""",
    re.VERBOSE,
)
_UNKNOWN = {"$": "variables", "`": "commands in words", "(": "groups", ")": "groups", "<": "files", ">": "files"}
"""Meaning of characters in a real shell that the brick's shell does not support."""


class NotUnderstood(Exception):
    """A command line that the brick's shell rejects, with the reason and the shell's exit status."""

    def __init__(self, message: str, status: int = NOT_THERE) -> None:
        super().__init__(message)
        self.status = status


@dataclass(frozen=True, slots=True)
class Call:
    """One command with its words."""

    words: tuple[str, ...]
    silent: bool = False
    """Whether standard output is discarded."""
    silent_errors: bool = False
    """Whether standard error is discarded."""
    joined: bool = False
    """Whether standard error is redirected to standard output."""
    file: str = ""
    """The device file that standard output is written to; empty for none."""


@dataclass(frozen=True, slots=True)
class Pipeline:
    """Commands connected by pipes."""

    calls: tuple[Call, ...]
    joint: str = ""
    """The operator before it: `&&`, `||`, or empty."""


@dataclass(frozen=True, slots=True)
class Job:
    """Pipelines that run in sequence, each depending on its operator and the exit status before it."""

    pipelines: tuple[Pipeline, ...]
    background: bool = False
    """Whether the shell does not wait for it (`&`)."""


def read_line(text: str) -> tuple[Job, ...]:
    """Return the jobs of a command line.

    Raises:
        NotUnderstood: a quote is not closed, a command is missing, or the syntax is not supported.
    """
    jobs: list[Job] = []
    pipelines: list[Pipeline] = []
    calls: list[Call] = []
    words: list[str] = []
    redirected: list[re.Match[str]] = []
    joint = ""
    for kind, part, redirection in (*_parts(text), ("joint", "\n", None)):
        if kind == "word":
            words += shlex.split(part)
        elif redirection is not None:
            redirected.append(redirection)
        else:
            if words:
                calls.append(_call(words, redirected))
            elif redirected or calls or pipelines or part not in "\n":
                raise NotUnderstood(f"syntax error: no command before {part!r}", NOT_SHELL)
            words, redirected = [], []
            if part != "|" and calls:
                pipelines.append(Pipeline(tuple(calls), joint))
                calls = []
            if part in ("&&", "||"):
                joint = part
            elif part != "|" and pipelines:
                jobs.append(Job(tuple(pipelines), part == "&"))
                pipelines, joint = [], ""
    return tuple(jobs)


def _parts(text: str) -> list[tuple[str, str, re.Match[str] | None]]:
    found: list[tuple[str, str, re.Match[str] | None]] = []
    at = 0
    while at < len(text):
        # A digit belongs to a redirection only at the start of a word.
        begins = not found or found[-1][0] != "word" or text[at - 1] in " \t"
        redirection = _REDIRECTION.match(text, at) if begins or text[at] in "<>" else None
        if redirection is not None:
            found.append(("redirection", redirection[0], redirection))
            at = redirection.end()
            continue
        if text[at] == "#" and begins:
            at = len(text) if (end := text.find("\n", at)) < 0 else end
            continue
        part = _PARTS.match(text, at)
        if part is None:
            raise _complaint(text[at:])
        if part.lastgroup != "blank":
            found.append((str(part.lastgroup), part[0], None))
        at = part.end()
    return found


def _complaint(rest: str) -> NotUnderstood:
    """Return the error for the rest of a line that does not start with a valid token."""
    inside = re.search(r"(?<!\\)[`$]", rest) if rest[0] == '"' else re.match(r"[`$()<>]", rest)
    if inside is not None:
        return NotUnderstood(f"{rest[inside.start() :][:20]!r}: {_UNKNOWN[inside[0]]} are not simulated")
    return NotUnderstood("syntax error: a quote is not closed", NOT_SHELL)


def _call(words: list[str], redirected: list[re.Match[str]]) -> Call:
    call = {"silent": False, "silent_errors": False, "joined": False}
    file = ""
    for one in redirected:
        if one[0].startswith("<"):
            continue
        if one["joined"] == "&1" and one["stream"] == "2":
            # In order: `2>&1 >/dev/null` keeps standard error where the output went before.
            call["joined"], call["silent_errors"] = not call["silent"], call["silent"]
        elif one["file"] and one["stream"] != "2":
            file, call["silent"] = one["file"], False
        elif one["joined"] or one["file"]:
            raise NotUnderstood(f"{one[0]!r}: only 2>&1 and {NULL_FILE} are simulated")
        else:
            call["silent_errors" if one["stream"] == "2" else "silent"] = True
            if one["stream"] == "2":
                call["joined"] = False
            else:
                file = ""
    return Call(tuple(words), file=file, **call)
