"""What the footer says of a state of the app: the state is a value, and needs no app."""

from __future__ import annotations

from typing import Any

import pytest

from tests.app.panel_help import moment
from tests.cases import for_rows
from tuisim.app.snapshot import AppState, RunPhase, Situation, end_words, shorten_value
from tuisim.engine.protocol import End, Ended, Unended


def app_state(looks_back: bool, playing: bool, **run: Any) -> AppState:
    now = moment(**run)
    return AppState(now, Situation(now.state, has_program=False, has_run=True), looks_back, playing)


@for_rows(
    "looks_back, playing, run, status, failed",
    [
        (False, False, {"state": RunPhase.IDLE}, "idle", False),
        (False, False, {"state": RunPhase.RUNNING}, "running 1×", False),
        (False, False, {"state": RunPhase.PAUSED, "speed": 0.25}, "paused ¼×", False),
        (False, False, {"state": RunPhase.ENDED, "end": End.FINISHED}, "finished", False),
        (
            False,
            False,
            {"state": RunPhase.ENDED, "end": End.RAISED, "speed": 0.0},
            "error max",
            True,
        ),
        (False, False, {"state": RunPhase.ENDED, "end": Unended.INTERRUPTED}, "interrupted", True),
        (True, False, {"state": RunPhase.PAUSED}, "past 3.21 s 1×", False),
        (True, True, {"state": RunPhase.PAUSED}, "playing 1×", False),
        (True, False, {"state": RunPhase.ENDED, "end": End.RAISED}, "past 3.21 s", False),
    ],
)
def test_the_status_tells_phase_speed_and_past(
    looks_back: bool, playing: bool, run: dict[str, Any], status: str, failed: bool
) -> None:
    state = app_state(looks_back, playing, **run)
    assert (state.status, state.failed) == (status, failed)


@pytest.mark.parametrize(
    "text, expected",
    [
        ("16.0784313725", "16.08"),
        ("100.0", "100.0"),
        ("[1.23456789, 2]", "[1.235, 2]"),
        ("12345.678901", "12345.7"),
        ("1577836800.123456", "1577836800.12"),
        ("1.2345678e-07", "1.235e-07"),
        ("'v 1.23456789'", "'v 1.23456789'"),
    ],
)
def test_long_decimal_values_are_shown_with_four_digits(text: str, expected: str) -> None:
    assert shorten_value(text) == expected


def test_the_end_time_of_a_run_is_rounded_down() -> None:
    assert end_words(Ended(End.FINISHED, 4860, 48_607_000_000), "")[1] == "— finished at 48.60 s"
    assert end_words(Ended(End.FINISHED, 29, 290_000_000), "")[1] == "— finished at 0.29 s"


def test_the_end_of_the_output_names_the_line_that_raised() -> None:
    ended = Ended(End.RAISED, 30, 300_000_000, summary="NameError: no (line 3)", error_line=3)
    assert end_words(ended, "")[1] == "— line 3 at 0.30 s"
