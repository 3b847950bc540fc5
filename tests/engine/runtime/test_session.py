"""User actions that are known before the run take effect at their ticks, as they did when the user made them."""

from __future__ import annotations

import pytest

from tests.running import Run
from tuisim.engine.protocol import (
    SetButtons,
    SetPen,
    SetPose,
    SetSpeed,
    UserAction,
)


def test_planned_user_actions_take_effect_at_their_ticks(run: Run) -> None:
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


def test_a_user_action_takes_effect_after_what_the_program_did_before_its_tick(run: Run) -> None:
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


def test_a_planned_press_holds_the_button_until_its_release(run: Run) -> None:
    done = run(
        "import time\nfrom ev3dev2.button import Button\nb = Button()\n"
        "for i in range(5):\n    print(b.buttons_pressed)\n    time.sleep(0.1)",
        actions=(UserAction(15, SetButtons(("enter",))), UserAction(35, SetButtons(()))),
    )
    assert done.lines == ["[]", "[]", "['enter']", "['enter']", "[]"]


def test_only_user_actions_can_be_planned_for_a_run() -> None:
    with pytest.raises(TypeError, match="user action"):
        UserAction(0, SetSpeed(1.0))
