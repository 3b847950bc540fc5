"""Messages between host and child as lines, and user actions as they are stored with a run."""

from __future__ import annotations

import json

import pytest

from tuisim.engine.protocol import (
    ACTIONS,
    COMMANDS,
    EVENTS,
    Message,
    Pause,
    RunToInstant,
    SetNoise,
    SetPose,
    Spoke,
    Stop,
    UserAction,
    describe_state,
    parse_command,
)

SENT: tuple[Message, ...] = (Stop(), SetPose(1.5, -2.0, 90.0), SetNoise(3, 4), RunToInstant(5, 6))


@pytest.mark.parametrize("message", SENT, ids=[message.kind for message in SENT])
def test_a_protocol_command_is_read_as_it_was_sent(message: Message) -> None:
    line = message.encode()
    assert line.endswith(b"\n") and line.count(b"\n") == 1
    assert parse_command(line) == message


def test_kinds_of_messages_are_class_names_in_snake_case_and_commands_differ_from_events() -> None:
    assert (SetPose.kind, RunToInstant.kind) == ("set_pose", "run_to_instant")
    assert not COMMANDS.keys() & EVENTS.keys()


def test_text_that_is_not_utf_8_is_sent_between_processes_as_escapes() -> None:
    line = Spoke("é\udcff", 7).encode()
    assert json.loads(line)["text"] == "é\\udcff"


@pytest.mark.parametrize(
    "line", [b"rubbish", b'{"kind": "fly"}', b'{"kind": "stop", "now": 1}', b'{"tick": 3}'], ids=str
)
def test_a_line_that_is_no_protocol_command_raises(line: bytes) -> None:
    with pytest.raises((ValueError, KeyError, TypeError)):
        parse_command(line)


def test_a_user_action_written_and_read_back_is_the_same() -> None:
    action = UserAction(12, SetNoise(1, 2))
    plain = action.to_plain()
    assert (plain["tick"], plain["kind"]) == (12, "set_noise")
    assert UserAction.from_plain(plain) == action
    assert all(kind.kind in COMMANDS for kind in ACTIONS)


def test_a_debugger_command_is_refused_as_user_action_of_a_run() -> None:
    with pytest.raises(TypeError, match="not a user action"):
        UserAction(1, Pause())


@pytest.mark.parametrize(
    "state, summary, words",
    [
        ("stopped", "stopped", "stopped"),
        (
            "stopped",
            "stopped in line 3, where it was stuck",
            "stopped in line 3, where it was stuck",
        ),
        ("time_limit", "stopped at the limit of 20 s", "time limit: stopped at the limit of 20 s"),
        ("finished", "", "finished"),
    ],
)
def test_the_description_of_a_runs_end_does_not_repeat_its_state(
    state: str, summary: str, words: str
) -> None:
    assert describe_state(state, summary) == words
