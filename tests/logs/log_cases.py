"""What must come of an input that is read as a log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from tuisim.base.errors import LogError
from tuisim.logs.log import Log
from tuisim.logs.reader import open_log


@dataclass(frozen=True)
class Read:
    """What must be read of an input."""

    rows: int
    names: tuple[str, ...] = ("red",)
    left_out: int = 0
    note: str = ""
    """Part of some note."""
    check: Callable[[Log], bool] = lambda log: True


def values(log: Log, name: str = "red") -> list[float]:
    return list(log.series(name).values)


def times(log: Log, name: str = "red") -> list[float]:
    return list(log.series(name).time_s)


Case = tuple[str, bytes | Callable[[], bytes], Read | str]
"""Name of the file, its content, and what is read or the error."""


def check_input(path: Path, content: bytes | Callable[[], bytes], expected: Read | str) -> None:
    """Write a file, and see that what is read of it is as expected."""
    path.write_bytes(content if isinstance(content, bytes) else content())
    if isinstance(expected, str):
        with pytest.raises(LogError, match=expected) as caught:
            open_log(path)
        assert str(path) in str(caught.value)
        return
    log = open_log(path)
    said = "; ".join(log.notes)
    if expected.rows >= 0:
        assert (log.rows, log.left_out) == (expected.rows, expected.left_out), said
        assert log.names == expected.names
    else:
        assert log.rows > 0
    assert expected.note in said
    assert expected.check(log)
