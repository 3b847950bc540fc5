"""User actions that are known before the run take effect at their ticks, as they did when the user made them."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.cases import cases
from tests.running import Run, Start, over, until_tick
from tuisim.protocol import (
    Answer,
    Message,
    SetButtons,
    SetNoise,
    SetPen,
    SetPose,
    SetSpeed,
    UserAction,
)

LOGGER = """
import time
tank_drive.on(SpeedPercent(40), SpeedPercent(30))
for i in range(60):
    print('Light:', colorLeft.reflected_light_intensity_pc)
    time.sleep(0.04)
"""
THREADS = """
import threading, time
def watch():
    for i in range(40):
        print('Gyro:', gyro.angle)
        time.sleep(0.03)
watcher = threading.Thread(target=watch)
watcher.start()
for i in range(30):
    tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(-20), 0.05)
watcher.join()
"""
ASKS = """
name = input('who? ')
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(30), 0.5)
print('hello', name, input('again? '))
"""


def test_actions_come_at_their_ticks(run: Run) -> None:
    done = run(
        "import time\ntime.sleep(1)",
        actions=(
            UserAction(10, SetPose(700.0, 500.0, 90.0)),
            UserAction(10, SetPen(True)),
            UserAction(50, SetPose(300.0, 400.0, 0.0)),
        ),
    )
    places = done.run.telemetry.array()["x_mm"]
    assert (places[9], places[10], places[49], places[50]) == (150.0, 700.0, 700.0, 300.0)
    last = done.run.telemetry.last()
    assert last is not None and last.actions == 3


def test_an_action_comes_after_what_a_program_does_before_its_tick(run: Run) -> None:
    # The driver notices the end of the move between two ticks, and the program goes on at once.
    text = """
import time
from ev3dev2.button import Button
button = Button()
tank_drive.left_motor.on_for_degrees(20, 30)
print(time.perf_counter_ns() // 10_000_000)
print(button.enter)
"""
    (tick, _) = run(text, profile="ev3").lines
    press = UserAction(int(tick), SetButtons(("enter",)))
    assert run(text, profile="ev3", actions=(press,)).lines == [tick, "False"]


def test_a_button_is_held_between_its_actions(run: Run) -> None:
    done = run(
        "import time\nfrom ev3dev2.button import Button\nb = Button()\n"
        "for i in range(5):\n    print(b.buttons_pressed)\n    time.sleep(0.1)",
        actions=(UserAction(15, SetButtons(("enter",))), UserAction(35, SetButtons(()))),
    )
    assert done.lines == ["[]", "[]", "['enter']", "['enter']", "[]"]


def test_only_actions_may_be_scripted() -> None:
    with pytest.raises(TypeError, match="user action"):
        UserAction(0, SetSpeed(1.0))


SCRIPTS: dict[str, tuple[str, tuple[Message, ...]]] = {
    "drive": (
        LOGGER,
        (SetPose(900.0, 500.0, 45.0), SetNoise(20, 50), SetPen(True), SetNoise(0, 0)),
    ),
    "threads": (
        THREADS,
        (SetNoise(0, 80), SetPose(900.0, 500.0, 45.0), SetButtons(("up", "enter"))),
    ),
    "answers": (ASKS, (Answer("Ada"), SetPose(900.0, 500.0, 45.0), Answer("bye"))),
}


@pytest.mark.quick_cases("drive")
@cases("text, actions", SCRIPTS)
def test_what_a_user_did_can_be_done_again(
    start: Start, run: Run, text: str, actions: tuple[Message, ...]
) -> None:
    live = start(text, live=True, speed=4.0, asks_user=True, noise=(5, 5))
    for number, action in enumerate(actions, 1):
        until_tick(live, 8 * number)
        live.send(action)
    first = over(live)
    rows = (live.folder / "actions.jsonl").read_text().splitlines()
    script = tuple(UserAction.from_plain(row) for row in map(json.loads, rows))
    assert [row.command for row in script] == list(actions)
    ways: tuple[dict[str, Any], ...] = ({}, {"live": True, "speed": 0.0})
    for options in ways:
        again = run(text, asks_user=True, noise=(5, 5), actions=script, **options)
        assert again.recording == first.recording
        assert (again.run.folder / "actions.jsonl").read_text().splitlines() == rows
