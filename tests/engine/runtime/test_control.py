"""Pause, step, speed and user actions of a live run."""

from __future__ import annotations

from itertools import count

import pytest

from tests.running import PATIENCE_S, Start, until
from tuisim.engine.protocol import (
    Answer,
    Message,
    Paused,
    Resume,
    SetNoise,
    SetPose,
    SetSpeed,
    StepTicks,
)
from tuisim.engine.runs import handle
from tuisim.engine.runs.child import process

GOES_ON = "import time\nwhile True:\n    try: time.sleep(0.01)\n    except: pass"


def test_a_run_can_be_stopped_before_its_first_line(start: Start) -> None:
    run = start("while True: pass", live=True)
    run.stop()
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "stopped"


@pytest.mark.parametrize("speeds", [(0.0,), (0.5, 1000.0)], ids=str)
def test_the_speed_may_change_while_a_program_sleeps(
    start: Start, speeds: tuple[float, ...]
) -> None:
    run = start(
        "import time\nprint('A: 1')\ntime.sleep(500)\nprint('A: 2')", live=True, time_limit_s=1000.0
    )
    until(run, lambda: run.telemetry.count > 1)
    for speed in speeds:
        run.send(SetSpeed(speed))
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, [row.text for row in run.output.read_all_rows()]) == (
        "finished",
        ["A: 1", "A: 2"],
    )


def test_a_program_that_waits_for_a_busy_processor_is_not_called_stuck(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = start("print('A: 1')\n" + GOES_ON, live=True)
    until(run, lambda: run.output.length > 0)
    # So busy a machine that the program does nothing but wait, far longer at each look; any time at all is too long.
    waits_s, killed = count(1e6, 1e3), list[int]()
    monkeypatch.setattr(process, "measure_waited_s", lambda pid: next(waits_s))
    monkeypatch.setattr(process, "measure_computed_s", lambda pid: 0.0)
    monkeypatch.setattr(handle, "STUCK_AFTER_S", 0.0)
    monkeypatch.setattr(handle, "end_group", killed.append)
    run.stop()
    run.pump()
    run.pump()
    assert not killed


def test_a_paused_run_steps_by_ticks_and_resumes(start: Start) -> None:
    run = start("tank_drive.on(50, 50)\nimport time\ntime.sleep(0.2)", live=True, start_paused=True)
    until(run, lambda: run.paused)
    assert run.telemetry.count == 1
    seen: list[Message] = []
    run.send(StepTicks(3))
    until(run, lambda: any(isinstance(event, Paused) for event in seen), seen)
    assert run.telemetry.count == 4
    assert [event for event in seen if isinstance(event, Paused)][-1].tick == 3
    run.send(Resume())
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, ended.tick) == ("finished", 20)


def test_user_actions_take_effect_right_before_a_tick_and_are_written_down(start: Start) -> None:
    run = start("print(colorLeft.color)", live=True, start_paused=True)
    until(run, lambda: run.paused)
    run.send(SetPose(1500.0, 500.0, 90.0))
    run.send(SetNoise(0, 5))
    run.send(Resume())
    assert run.wait(PATIENCE_S) is not None
    assert [row.text for row in run.output.read_all_rows()] == ["1"]
    first = run.telemetry.record(0)
    assert (first.x_mm, first.heading_deg, first.actions) == (1500.0, 90.0, 2)
    assert (run.folder / "actions.jsonl").read_text().splitlines() == [
        '{"tick": 0, "kind": "set_pose", "x_mm": 1500.0, "y_mm": 500.0, "heading_deg": 90.0}',
        '{"tick": 0, "kind": "set_noise", "light": 0, "motor": 5}',
    ]


def test_input_gets_the_answer_that_the_user_sends(start: Start) -> None:
    run = start("print('hello ' + input('Name? '))", live=True, asks_user=True)
    until(run, lambda: run.waiting_for_input == "Name? ")
    run.send(Answer("Ada"))
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert [row.text for row in run.output.read_all_rows()] == ["Name? Ada", "hello Ada"]
