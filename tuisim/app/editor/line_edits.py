"""Pure edits of lines behind the editor's keys: indentation, comments, matches of a text."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from tuisim.source import source_lines

Change = Callable[[Sequence[str]], list[str]]
"""A function that returns edited lines."""

INDENT = "    "
_LEAVES = re.compile(r"\s*(return|pass|break|continue|raise)\b")


def indent_after(line: str) -> str:
    """Return the indentation of the new line when Enter is pressed at the end of `line`."""
    here = line[: len(line) - len(line.lstrip())]
    code = _without_comment(line).rstrip()
    if code.endswith((":", "(", "[", "{")):
        return here + INDENT
    if _LEAVES.match(code):
        return here.removesuffix(INDENT)
    return here


def _without_comment(line: str) -> str:
    from tuisim.app.editor.syntax import spans

    return next((line[:start] for start, _, kind in spans(line)[0] if kind == "comment"), line)


def indented(lines: Sequence[str]) -> list[str]:
    """Return lines indented by one more level; empty ones stay empty."""
    return [INDENT + line if line.strip() else line for line in lines]


def outdented(lines: Sequence[str]) -> list[str]:
    """Return lines indented by one level less, if they are indented."""
    return [_outdented(line) for line in lines]


def _outdented(line: str) -> str:
    if line.startswith("\t"):
        return line[1:]
    blanks = len(line) - len(line.lstrip(" "))
    return line[(blanks - 1) % len(INDENT) + 1 if blanks else 0 :]


def blanks_to_delete(before: str) -> int:
    """Return how many blanks backspace deletes at once after `before`: one level of indentation, else 0."""
    return (len(before) - 1) % len(INDENT) + 1 if before and not before.strip(" ") else 0


def comment_toggled(lines: Sequence[str]) -> list[str]:
    """Return lines as comments, or uncommented if all of them are comments."""
    full = [line for line in lines if line.strip()]
    if full and all(line.lstrip().startswith("#") for line in full):
        return [re.sub(r"^(\s*)# ?", r"\1", line) for line in lines]
    margin = min((len(line) - len(line.lstrip()) for line in full), default=0)
    return [f"{line[:margin]}# {line[margin:]}" if line.strip() else line for line in lines]


def places(lines: Sequence[str], wanted: str) -> list[tuple[int, int]]:
    """Return the matches of a text, as (line, column) from 0; case matters only if the text has capitals."""
    if not wanted:
        return []
    flags = re.IGNORECASE if wanted == wanted.lower() else 0
    pattern = re.compile(re.escape(wanted), flags)
    return [(at, match.start()) for at, line in enumerate(lines) for match in pattern.finditer(line)]


def differing_lines(one: str, other: str) -> int:
    """Return how many lines differ between two texts."""
    import difflib

    matcher = difflib.SequenceMatcher(None, source_lines(one), source_lines(other), autojunk=False)
    changes = (op for op in matcher.get_opcodes() if op[0] != "equal")
    return sum(max(to - start, to_other - start_other) for _, start, to, start_other, to_other in changes)
