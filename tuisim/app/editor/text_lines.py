"""Lines of a text: edits behind the editor's keys, and the map between two versions."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from difflib import SequenceMatcher

from tuisim.base.source import source_lines

Change = Callable[[Sequence[str]], list[str]]
"""A function that takes lines of text and returns them edited."""

INDENT = "    "
_LEAVES = re.compile(r"\s*(return|pass|break|continue|raise)\b")


def compute_indent(line: str) -> str:
    """Return the indentation of the new line when Enter is pressed at the end of `line`."""
    here = line[: len(line) - len(line.lstrip())]
    code = _strip_comment(line).rstrip()
    if code.endswith((":", "(", "[", "{")):
        return here + INDENT
    if _LEAVES.match(code):
        return here.removesuffix(INDENT)
    return here


def _strip_comment(line: str) -> str:
    from tuisim.app.editor.syntax import find_spans

    return next((line[:start] for start, _, kind in find_spans(line)[0] if kind == "comment"), line)


def indent_lines(lines: Sequence[str]) -> list[str]:
    """Return lines indented by one more level; empty lines stay empty."""
    return [INDENT + line if line.strip() else line for line in lines]


def outdent_lines(lines: Sequence[str]) -> list[str]:
    """Return lines indented by one level less; a line without indentation is unchanged."""
    return [_outdent_line(line) for line in lines]


def _outdent_line(line: str) -> str:
    if line.startswith("\t"):
        return line[1:]
    blanks = len(line) - len(line.lstrip(" "))
    return line[(blanks - 1) % len(INDENT) + 1 if blanks else 0 :]


def count_deletable_blanks(before: str) -> int:
    """Return how many blanks backspace deletes behind the text `before`: one level of indentation.

    The number is 0 if `before` is not only indentation.
    """
    return (len(before) - 1) % len(INDENT) + 1 if before and not before.strip(" ") else 0


def toggle_comments(lines: Sequence[str]) -> list[str]:
    """Return lines as comments; if all of them are comments already, return them without the comment signs."""
    full = [line for line in lines if line.strip()]
    if full and all(line.lstrip().startswith("#") for line in full):
        return [re.sub(r"^(\s*)# ?", r"\1", line) for line in lines]
    margin = min((len(line) - len(line.lstrip()) for line in full), default=0)
    return [f"{line[:margin]}# {line[margin:]}" if line.strip() else line for line in lines]


def find_matches(lines: Sequence[str], search: str) -> list[tuple[int, int]]:
    """Return where lines contain a search text, as (line, column) from 0.

    Upper and lower case are different only if the search text has capitals.
    """
    if not search:
        return []
    flags = re.IGNORECASE if search == search.lower() else 0
    pattern = re.compile(re.escape(search), flags)
    return [
        (row, match.start()) for row, line in enumerate(lines) for match in pattern.finditer(line)
    ]


def count_differing_lines(text: str, other: str) -> int:
    """Return how many lines a diff of two texts changes.

    If a block of lines is replaced by a shorter or longer one, the lines of the longer block are counted.
    """
    matcher = SequenceMatcher(None, source_lines(text), source_lines(other), autojunk=False)
    changes = (op for op in matcher.get_opcodes() if op[0] != "equal")
    return sum(
        max(to - start, to_other - start_other) for _, start, to, start_other, to_other in changes
    )


def count_same_lines(lines: Sequence[str], other: Sequence[str]) -> int:
    """Return how many lines at the start of two texts are the same in both."""
    pairs = enumerate(zip(lines, other, strict=False))
    return next(
        (index for index, (ours, theirs) in pairs if ours != theirs), min(len(lines), len(other))
    )


MAX_COMPARED = 400
"""If the changed part of a text has more lines than this, its lines are not compared, and none is mapped."""


class LineMap:
    """Finds a line of the running text in the shown text, which the user may have edited since, and the reverse.

    Lines are numbered from 1; 0 stands for no line.

    Args:
        run: Lines of the running text.
        shown_lines: Lines of the shown text.
    """

    def __init__(self, run: Sequence[str], shown_lines: Sequence[str]) -> None:
        self._to_shown = [0] * (len(run) + 1)
        self._to_run = [0] * (len(shown_lines) + 1)
        same = count_same_lines(run, shown_lines)
        last = count_same_lines(run[same:][::-1], shown_lines[same:][::-1])
        self._join(0, 0, same)
        self._join(len(run) - last, len(shown_lines) - last, last)
        old, new = run[same : len(run) - last], shown_lines[same : len(shown_lines) - last]
        if max(len(old), len(new)) <= MAX_COMPARED:
            for block in SequenceMatcher(None, old, new, autojunk=False).get_matching_blocks():
                self._join(same + block.a, same + block.b, block.size)

    def _join(self, run_start: int, shown_start: int, count: int) -> None:
        for offset in range(1, count + 1):
            self._to_shown[run_start + offset], self._to_run[shown_start + offset] = (
                shown_start + offset,
                run_start + offset,
            )

    def find_shown_line(self, line: int) -> int:
        """Return the number that a line of the running text has in the shown text; 0 if it was changed or deleted."""
        return self._to_shown[line] if 0 <= line < len(self._to_shown) else 0

    def find_run_line(self, line: int) -> int:
        """Return the number that a line of the shown text has in the running text; 0 if it was changed or added."""
        return self._to_run[line] if 0 <= line < len(self._to_run) else 0
