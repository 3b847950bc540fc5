"""What a child says right before it goes is heard."""

from __future__ import annotations

import pytest

from tests.running import PATIENCE_S, Start
from tuisim.protocol import Message
from tuisim.runs.handle import RunHandle


def test_a_child_that_goes_while_its_events_are_read_has_not_crashed(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    read = RunHandle._read_events

    def read_then_let_it_end(run: RunHandle) -> list[Message]:
        events = read(run)
        run._process.wait()
        return events

    monkeypatch.setattr(RunHandle, "_read_events", read_then_let_it_end)
    ended = start("print('bye')").wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "finished"
