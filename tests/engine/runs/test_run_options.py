"""Run options: what the host writes, the child reads again."""

from __future__ import annotations

import json

import pytest

from tests.cases import cases
from tuisim.engine.protocol import Answer, SetButtons, SetNoise, SetPose, UserAction
from tuisim.engine.runs.run_options import RunOptions

ACTIONS = (
    UserAction(0, SetPose(1.5, -2.0, 90.0)),
    UserAction(3, SetNoise(1, 2)),
    UserAction(3, SetButtons(("up", "left"))),
    UserAction(70, Answer(None, at_once=True)),
)


@cases(
    "options",
    {
        "default": RunOptions(),
        "live": RunOptions(live=True, speed=0.25, start_paused=True),
        "answers": RunOptions(answers=("yes", ""), asks_user=True, time_waits=True, replies=True),
        "actions": RunOptions(actions=ACTIONS),
        "debugged": RunOptions(breaks=("12 if x > 3",), trace_from_tick=7, hold_at=(7, 2)),
    },
)
def test_run_options_are_the_same_after_writing_and_reading(options: RunOptions) -> None:
    assert RunOptions.from_plain(json.loads(json.dumps(options.to_plain()))) == options


def test_an_unknown_run_option_is_refused() -> None:
    with pytest.raises(TypeError):
        RunOptions.from_plain({**RunOptions().to_plain(), "hurry": True})
