"""What the program would read where it is paused, within a tick."""

from __future__ import annotations

import pytest

from tests.engine.runtime.debugging import Driver
from tests.running import Done, Start
from tuisim.engine.core.motor_columns import RUNNING
from tuisim.engine.core.state import Present
from tuisim.engine.protocol import LineStep, Resume, StepLine

LINES = """\
tank_drive.on_for_rotations(30, 30, 0.2)
tank_drive.left_motor.position = 0
tank_drive.on(30, 30)
time.sleep(0.3)
tank_drive.left_motor.position = 7
tank_drive.off()
print("end")
"""


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_each_step_shows_what_its_line_has_changed(start: Start, profile: str) -> None:
    text = f"import time\n{LINES}"
    driver = Driver(start(text, profile=profile, live=True, speed=0.0, breaks=("2",)))
    driver.paused()
    shown: list[Present] = []
    for _ in LINES.splitlines()[:-1]:
        driver.do(StepLine(LineStep.OVER))
        present = driver.look().present
        assert present is not None
        shown.append(present)
    (moved, _), (zero, speed), *_ = (present.turns[0] for present in shown)
    assert round(moved) in (range(70, 90) if profile == "ev3" else (72,))
    assert zero == 0 and (profile == "ev3" or speed == 0)
    driving, (set_to, set_speed), (stopped_at, stopped_dps) = (
        present.turns[0] for present in shown[3:]
    )
    assert driving[0] > 30 and driving[1] > 250
    assert round(set_to) == 7 and set_speed > 250
    assert 7 <= round(stopped_at) < 10
    if profile == "robolab":
        assert stopped_dps == 0
    else:
        states = [present.motors[0][3] for present in shown[3:]]
        assert [bool(state & RUNNING) for state in states] == [True, True, False]
    assert driver.finish(StepLine(LineStep.OVER)).end == "finished"


def test_a_look_into_a_tick_changes_nothing_in_the_recording(start: Start) -> None:
    text = f"import time\n{LINES}"
    recordings = []
    for breaks in ((), ("3", "4", "6", "7", "8")):
        driver = Driver(start(text, profile="ev3", live=True, speed=0.0, breaks=breaks))
        for _ in breaks:
            driver.paused()
            assert driver.look().present is not None
            driver.run.send(Resume())
        recordings.append(Done(driver.run, driver.finish()).recording)
    assert recordings[0] == recordings[1]
