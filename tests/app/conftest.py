"""What the tests of the app share: terminals, and notices that stay."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from textual.notifications import Notification

from tests.app.terminals import Terminal


@pytest.fixture(autouse=True)
def _notices_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Keep notices until the app removes them, so that a test on a busy machine still finds them."""
    monkeypatch.setattr(Notification, "has_expired", False)
    monkeypatch.setattr(Notification, "time_left", 3600.0)


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
