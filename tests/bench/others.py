"""Other programs for tables in a terminal, on the same log, where they are installed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from tests.bench.figures import NOT_MEASURED, Figure
from tests.bench.viewer import Viewer

VISIDATA, TOOLONG = ("VisiData", "TUISIM_BENCH_VD", "vd"), ("toolong", "TUISIM_BENCH_TL", "tl")
"""Name, the environment variable with the path of its command, and the command that is looked for otherwise."""
_TO_TIME_AND_VALUE = (b"gh", b"%", b"!", b"cleft_red\r", b"%")
"""In VisiData: the first column as a number and key, then the cursor on another column of numbers."""


def others(path: Path) -> Iterator[Figure]:
    """Yield what others need for a log of every tick, until they have nothing left to do.

    Args:
        path: A CSV file whose columns are `time`, first, and `left_red` among others.
    """
    yield from _visidata(path)
    yield from _toolong(path)


def command_of(program: tuple[str, str, str]) -> str | None:
    """Return where a program is, None if it is not installed."""
    _, variable, command = program
    return os.environ.get(variable) or shutil.which(command)


def _visidata(path: Path) -> Iterator[Figure]:
    command = command_of(VISIDATA)
    if command is None:
        yield Figure("VisiData on the same file: not installed", NOT_MEASURED, "")
        return
    with Viewer([command, str(path)]) as viewer:
        opened_s = viewer.until_calm()
        yield Figure("VisiData on the same file: open to all rows, no chart", opened_s, "s CPU")
        moves = [1e3 * viewer.key_s(key) for key in (b"j", b"j", b"k", b"l", b"l")]
        yield Figure("VisiData on the same file: cursor, median", median(moves), "ms CPU")
        for keys in _TO_TIME_AND_VALUE:
            viewer.work_s(keys)
        chart_s = viewer.work_s(b".")
        yield Figure(
            "VisiData on the same file: open to the chart of all rows", opened_s + chart_s, "s CPU"
        )
        zooms = [1e3 * viewer.work_s(key) for key in (b"+", b"+", b"-")]
        yield Figure("VisiData on the same file: zoom, median", median(zooms), "ms CPU")
        yield Figure("VisiData on the same file: peak of memory", viewer.peak_bytes() / 1e6, "MB")


def _toolong(path: Path) -> Iterator[Figure]:
    command = command_of(TOOLONG)
    if command is None:
        yield Figure("toolong on the same file: not installed", NOT_MEASURED, "")
        return
    with Viewer([command, str(path)]) as viewer:
        yield Figure(
            "toolong on the same file: open to its last lines, no chart",
            viewer.until_calm(),
            "s CPU",
        )
        pages = [1e3 * viewer.work_s(b"\x1b[5~") for _ in range(5)]
        yield Figure("toolong on the same file: page up, median", median(pages), "ms CPU")
        yield Figure("toolong on the same file: peak of memory", viewer.peak_bytes() / 1e6, "MB")
