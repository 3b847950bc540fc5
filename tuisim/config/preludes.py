"""Preludes: source text that runs before a program and defines names for it, and the magics that choose it."""

from __future__ import annotations

from collections.abc import Mapping

_IMPORTS = """\
from ev3dev2.motor import MoveTank, MoveSteering, SpeedPercent, OUTPUT_B, OUTPUT_C
from ev3dev2.sensor import INPUT_1, INPUT_2, INPUT_3, INPUT_4
from ev3dev2.sensor.lego import ColorSensor, GyroSensor, UltrasonicSensor
from ev3dev2.sound import Sound
from ev3dev2_glue import get_clock
"""

_INSTANCES = """\
tank_turn = MoveSteering(OUTPUT_B, OUTPUT_C)
tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)
ultrasonic = UltrasonicSensor(INPUT_1)
colorLeft = ColorSensor(INPUT_2)
colorRight = ColorSensor(INPUT_3)
gyro = GyroSensor(INPUT_4)


def say(txt, wait=False, show=True):
    \"\"\"Print a text and speak it; wait=True lets the program wait until it is said.\"\"\"
    if show:
        print(txt)
    Sound().speak(str(txt).replace("'", "\\u2019"), play_type=0 if wait else 1)
"""

PRELUDE_TEXTS: Mapping[str, str] = {"none": "", "imports": _IMPORTS, "preloaded": _IMPORTS + _INSTANCES}
"""The text of each prelude, by name."""

PRELUDES: Mapping[str, str] = {
    "sim_magic": "none",
    "sim_magic_imports": "imports",
    "sim_magic_preloaded": "preloaded",
}
"""The prelude of each magic."""
