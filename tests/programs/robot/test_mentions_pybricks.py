"""The sensors that programs for Pybricks make."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.programs.robot.reading import PYBRICKS_HEAD, changed

SENSORS: Mapping[str, tuple[str, str]] = {
    "the usual ones": (
        "ColorSensor(Port.S3)\nUltrasonicSensor(Port.S1)\nGyroSensor(Port.S4, Direction.COUNTERCLOCKWISE)",
        "",
    ),
    "others": ("TouchSensor(Port.S1)\nInfraredSensor(port=Port.S4)", "1 touch, 4 infrared"),
    "modules": (
        "import pybricks.ev3devices as dev\nfrom pybricks import parameters\ndev.TouchSensor(parameters.Port.S1)",
        "1 touch",
    ),
    "a port by name": ("TouchSensor(getattr(Port, 'S1'))", "1 touch"),
    "everything imported": (
        "from pybricks.parameters import *\nLINE = Port.S1\nColorSensor(LINE)",
        "1 left, 2 ultrasonic",
    ),
    "of LEGO's older brick": (
        "from pybricks.nxtdevices import TouchSensor as Touch\nTouch(Port.S1)",
        "",
    ),
    "a motor's port": ("TouchSensor(Port.A)", ""),
}


@pytest.mark.parametrize("case", SENSORS)
def test_sensors_of_a_pybricks_program_are_on_the_robot(case: str) -> None:
    text, expected = SENSORS[case]
    assert changed(text, PYBRICKS_HEAD) == expected
