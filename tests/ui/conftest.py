"""What the tests of the app share: terminals."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.ui.terminals import Terminal


@pytest.fixture
def open_terminal(tmp_path: Path) -> Iterator[Callable[[], Terminal]]:
    """`open_terminal()`: another terminal, closed at the end of the test."""
    opened: list[Terminal] = []

    def another() -> Terminal:
        opened.append(Terminal(f"tuisim-{os.getpid()}-{tmp_path.name[-20:]}-{len(opened)}", tmp_path))
        return opened[-1]

    yield another
    for terminal in opened:
        terminal.end()


@pytest.fixture
def terminal(open_terminal: Callable[[], Terminal]) -> Terminal:
    """The one terminal of a test."""
    return open_terminal()
