"""What a run prints, on its way to the terminal or a file."""

from __future__ import annotations

import io
from typing import Any

import pytest

from tuisim.commands.relay import Follower
from tuisim.engine.runs.records import OutputRow, Stream


class _Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class _Ended:
    """A run that has printed a line and ended."""

    def __init__(self) -> None:
        self.output = self

    def wait(self, _timeout_s: float) -> bool:
        return True

    def read_new_rows(self) -> list[OutputRow]:
        return [OutputRow("\x1bc\x1b[1mHello", 0, 0, 1, Stream.STDOUT)]


@pytest.mark.parametrize(
    ("out", "shown"),
    [(_Terminal(), "\x1b[1mHello\n"), (io.StringIO(), "\x1bc\x1b[1mHello\n")],
    ids=["terminal", "pipe"],
)
def test_clearing_the_bricks_display_does_not_clear_the_terminal(
    out: io.StringIO, shown: str
) -> None:
    run: Any = _Ended()
    Follower(run, out).follow_to_end()
    assert out.getvalue() == shown
