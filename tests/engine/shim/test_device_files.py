"""What the device files of the brick cost."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn

READINGS = """
import time
from ev3dev2.motor import LargeMotor
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
motor, parts = LargeMotor('outB'), [ColorSensor('in2'), UltrasonicSensor(), GyroSensor()]

def cost(call):
    start = time.monotonic_ns()
    call()
    return time.monotonic_ns() - start

for device, name in [(motor, 'position'), (motor, 'state'), *((part, 'value0') for part in parts)]:
    with open(f'{device._path}/{name}') as file:
        print(cost(lambda: device.get_attr_string(None, name)) == cost(file.read) > 1_000_000)
"""


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_reading_a_file_costs_what_the_library_costs(run_on: RunOn, profile: str) -> None:
    assert run_on(READINGS, "default", profile=profile).lines == ["True"] * 5
