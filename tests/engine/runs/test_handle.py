"""What a child says right before it goes is heard."""

from __future__ import annotations

import math

import pytest

from tests.running import PATIENCE_S, Start
from tuisim.engine.protocol import Message


def test_a_process_that_ends_while_its_events_are_read_is_not_called_crashed(
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


def test_the_whole_output_of_a_very_short_run_is_read(start: Start) -> None:
    handle = start("print('bye')")
    handle._look_at_s = math.inf
    handle.telemetry.hold()
    handle.output.hold()
    ended = handle.wait(PATIENCE_S)
    assert ended is not None
    assert ([row.text for row in handle.output.read_all_rows()], handle.telemetry.count) == (
        ["bye"],
        ended.tick + 1,
    )
