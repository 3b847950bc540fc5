"""What further sensors showed is told tick by tick, the same as the program saw."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn
from tuisim.engine.runs.frames import compute_column_values

PROGRAM = """
from ev3dev2.motor import *
from ev3dev2.sensor.lego import *
tank, touch, eye = MoveTank('outB', 'outC'), TouchSensor(), InfraredSensor()
tank.on(20, 20)
touch.wait_for_pressed()
print(touch.is_pressed, eye.proximity)
"""


@pytest.mark.parametrize("profile", ["ev3", "robolab"])
def test_touch_and_infrared_columns_equal_what_the_program_reads(
    run_on: RunOn, profile: str
) -> None:
    done = run_on(PROGRAM, "eyes", "furnished", profile)
    names = ["touch_pressed", "infrared_proximity"]
    mat = done.run.field.open_field()
    columns = compute_column_values(names, done.run.telemetry.array(), done.run, [], mat)
    assert list(columns) == names
    pressed = columns["touch_pressed"]
    proximity = columns["infrared_proximity"]
    assert (pressed[0], pressed[-1]) == (0, 1)
    assert proximity[0] == 54
    assert done.lines == [f"1 {proximity[-1]:.0f}"]
