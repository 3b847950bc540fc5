"""What the shell commands write in lines of their own; nothing else in `commands` prints.

Names, messages and rows come from programs, files and the store, and may hold what a terminal would obey. Only what
a running program prints is passed on as it is, by `follow`.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterable, Mapping
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
    """Write data to stdout as one line of JSON, which escapes what a terminal would obey."""
    with aside(sys.stdout):
        print(_json(data), flush=flush)


def echo_json_head(key: str, items: Iterable[Any], rest: Mapping[str, Any]) -> None:
    """Write one JSON object to stdout: a list under a key, item by item as they come, then what else it holds."""
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
    """Write a chart to stdout, whose colours are commands to the terminal; it holds no text that was not looked at."""
    with aside(sys.stdout):
        sys.stdout.write(text)


class CsvOut:
    """Standard output as a file of CSV: to the last byte in a pipe, without commands to a terminal on one."""

    def write(self, text: str) -> None:
        """Write lines."""
        with aside(sys.stdout):
            sys.stdout.write("\n".join(map(printable, text.split("\n"))) if sys.stdout.isatty() else text)
