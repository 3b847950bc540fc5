"""What the footer says of a state of the app: the state is a value, and needs no app."""

from __future__ import annotations

from typing import Any

import pytest

from tests.app.panel_help import moment
from tuisim.app.setup.next_run import plan_of
from tuisim.app.snapshot import AppState, DebugState, RunPhase, Situation
from tuisim.config.options import Settings
from tuisim.protocol import End, Unended

BACK = DebugState(looks_back=True)


def app_state(debug: DebugState, playing: bool, **view: Any) -> AppState:
    now = moment(**view)
    situation = Situation(now.state, has_program=False, has_run=True)
    return AppState(None, plan_of(Settings()), now, debug, situation, playing)


@pytest.mark.parametrize(
    ("debug", "playing", "view", "status", "failed"),
    [
        (DebugState(), False, {"state": RunPhase.IDLE}, "idle", False),
        (DebugState(), False, {"state": RunPhase.RUNNING}, "running 1×", False),
        (DebugState(), False, {"state": RunPhase.PAUSED, "speed": 0.25}, "paused ¼×", False),
        (DebugState(), False, {"state": RunPhase.ENDED, "end": End.FINISHED}, "finished", False),
        (DebugState(), False, {"state": RunPhase.ENDED, "end": End.RAISED, "speed": 0.0}, "error max", True),
        (DebugState(), False, {"state": RunPhase.ENDED, "end": Unended.INTERRUPTED}, "interrupted", True),
        (BACK, False, {"state": RunPhase.PAUSED}, "past 3.21 s 1×", False),
        (BACK, True, {"state": RunPhase.PAUSED}, "playing 1×", False),
        (BACK, False, {"state": RunPhase.ENDED, "end": End.RAISED}, "past 3.21 s", False),
        (DebugState(busy=True), False, {"state": RunPhase.PAUSED}, "paused 1×", False),
    ],
)
def test_the_status_tells_phase_speed_and_past(
    debug: DebugState, playing: bool, view: dict[str, Any], status: str, failed: bool
) -> None:
    state = app_state(debug, playing, **view)
    assert (state.status, state.failed) == (status, failed)
