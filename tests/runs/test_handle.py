"""What a child says right before it goes is heard."""

from __future__ import annotations

import pytest

from tests.running import PATIENCE_S, Start
from tuisim.protocol import Message


def test_a_child_that_goes_while_its_events_are_read_has_not_crashed(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    handle = start("print('bye')")
    read = handle._events.read

    def read_then_let_it_end() -> list[Message]:
        events = read()
        handle._process.wait()
        return events

    monkeypatch.setattr(handle._events, "read", read_then_let_it_end)
    ended = handle.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "finished"
