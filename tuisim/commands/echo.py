"""Output of the shell commands; no other module in `commands` prints.

Names, messages and rows come from programs, files and the store, and may contain terminal control sequences, which
are removed. Only the output of a running program is passed on unchanged, by `relay`.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tuisim.commands.progress import aside
from tuisim.errors import printable


def echo(line: str = "") -> None:
    """Write one line to stdout."""
    with aside(sys.stdout):
        print(printable(line))


def echo_lines(text: str) -> None:
    """Write a text of any number of lines to stdout."""
    with aside(sys.stdout):
        for line in text.split("\n"):
            print(printable(line))


def echo_json(data: Any, *, flush: bool = False) -> None:
    """Write data to stdout as one line of JSON, with control characters escaped."""
    with aside(sys.stdout):
        print(_json(data), flush=flush)


def echo_json_head(key: str, items: Iterable[Any], rest: Mapping[str, Any]) -> None:
    """Write one JSON object to stdout: a list under a key, streamed item by item, then the other keys."""
    with aside(sys.stdout):
        sys.stdout.write(f'{{"{key}": [')
        for number, item in enumerate(items):
            sys.stdout.write((", " if number else "") + _json(item))
        sys.stdout.write("], " + _json(rest).removeprefix("{") + "\n")


def _json(data: Any) -> str:
    return json.dumps(data).replace("\x7f", "\\u007f")


def echo_error(line: str) -> None:
    """Write one line to stderr."""
    with aside(sys.stderr):
        print(printable(line), file=sys.stderr, flush=True)


def echo_error_lines(text: str) -> None:
    """Write a text of any number of lines to stderr."""
    with aside(sys.stderr):
        for line in text.split("\n"):
            print(printable(line), file=sys.stderr, flush=True)


def echo_chart(text: str) -> None:
    """Write a chart with its colour codes to stdout; its texts must already be printable."""
    with aside(sys.stdout):
        sys.stdout.write(text)


class CsvOut:
    """A text file that writes CSV to stdout: unchanged to a pipe, without control characters to a terminal."""

    def write(self, text: str) -> None:
        """Write text."""
        with aside(sys.stdout):
            sys.stdout.write("\n".join(map(printable, text.split("\n"))) if sys.stdout.isatty() else text)


def table(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return rows of text under their heads, with aligned columns; columns of numbers are right-aligned."""
    cells = [list(heads), *([printable(str(cell)) for cell in row] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    right = [bool(rows) and all(isinstance(row[at], int | float) for row in rows) for at in range(len(heads))]
    lines = [
        "  ".join(
            cell.rjust(width) if at_right else cell.ljust(width)
            for cell, width, at_right in zip(line, widths, right, strict=True)
        ).rstrip()
        for line in cells
    ]
    return "\n".join(lines)
