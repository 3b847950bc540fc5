"""What a program compares its colour sensors with."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.cases import for_rows
from tests.programs.robot.reading import HEAD
from tuisim.base.source import Program
from tuisim.engine.core.sensors.color import LightRead
from tuisim.engine.core.spec import RobotSpec
from tuisim.programs.facts import read_facts
from tuisim.programs.program_settings import read_source_facts
from tuisim.programs.robot.thresholds import (
    find_light_read,
    find_light_reads,
    find_thresholds,
)

EV3DEV2 = (
    "from ev3dev2.sensor.lego import ColorSensor\nfrom ev3dev2.sensor import INPUT_2, INPUT_3\n"
)
PYBRICKS = (
    "from pybricks.ev3devices import ColorSensor\nfrom pybricks.parameters import Port, Color\n"
)


def found(text: str, prelude: str = "none") -> dict[str, list[str]]:
    thresholds = find_thresholds(Program("test.py", text, prelude), RobotSpec())
    return {
        name: [f"{one.read} {one.words} {one.line}" for one in some]
        for name, some in thresholds.items()
        if some
    }


@for_rows(
    "text, expected",
    {
        "as it is": (
            "while colorLeft.reflected_light_intensity_pc > 5:\n    pass\n",
            {"left": ["reflected_light_intensity_pc > 5 1"]},
        ),
        "by names, the other way round": (
            "LIMIT = 40\nseen = colorRight.reflected_light_intensity\nif LIMIT >= seen:\n    pass\n",
            {"right": ["reflected_light_intensity <= 40 3"]},
        ),
        "colours": (
            "def dark(value):\n    return value < 3\n\n"
            "if colorLeft.color == 5 or colorLeft.color_name == 'Blue':\n    pass\n",
            {"left": ["color == Red 4", "color_name == Blue 4"]},
        ),
        "an aim": (
            "error = int(colorLeft.full_reflected_light_intensity) - 50\n",
            {"left": ["full_reflected_light_intensity aim 50 1"]},
        ),
        "between": (
            "if 20 < colorLeft.reflected_light_intensity <= 60:\n  pass\n",
            {"left": ["reflected_light_intensity > 20 1", "reflected_light_intensity <= 60 1"]},
        ),
        "no number": (
            "if colorLeft.reflected_light_intensity > colorRight.reflected_light_intensity: pass\n",
            {},
        ),
        "others": ("if gyro.angle > 90: pass\nif len([]) > 3: pass\n", {}),
        "no Python": ("if (:\n", {}),
        "too deep": (
            f"if colorLeft.reflected_light_intensity < {'+'.join(['1'] * 5000)}: pass\n",
            {},
        ),
    },
)
def test_thresholds_of_a_program_with_predefined_sensors_are_found(
    text: str, expected: dict[str, list[str]]
) -> None:
    assert found(text, "preloaded") == expected


def test_thresholds_of_a_sensor_created_in_a_class_are_found() -> None:
    text = EV3DEV2 + (
        "class Eyes:\n    limit = 30\n    def __init__(self):\n        self.eye = ColorSensor(INPUT_3)\n"
        "    def on_line(self):\n        return self.eye.reflected_light_intensity < self.limit\n"
        "print(Eyes().on_line())\n"
    )
    assert found(text) == {"right": ["reflected_light_intensity < 30 8"]}


def test_thresholds_of_a_pybricks_program_are_found() -> None:
    text = (
        PYBRICKS
        + "eye = ColorSensor(Port.S2)\nwhile eye.color() != Color.BLACK and eye.reflection() > 9:\n    pass\n"
    )
    assert found(text) == {"left": ["color != Black 4", "reflection > 9 4"]}


@pytest.mark.parametrize(
    "text, read",
    [
        ("print(eye.reflection())", LightRead.REFLECTION),
        ("colorLeft.reflected_light_intensity_pc", LightRead.PERCENT),
        ("colorLeft.reflected_light_intensity", LightRead.REFLECTED),
        ("print(1)", LightRead.PERCENT),
    ],
)
def test_the_kind_of_light_that_a_program_reads_is_found(text: str, read: LightRead) -> None:
    assert find_light_read(text) is read


def test_the_light_value_that_the_program_reads_is_found_for_each_sensor() -> None:
    text = (
        "def look():\n    return colorRight.reflected_light_intensity\n"
        "print(colorLeft.color, colorLeft.reflected_light_intensity_pc, look())\n"
        "print(colorLeft.full_reflected_light_intensity)\n"
    )
    program = Program("p.py", text, "preloaded")
    reads = find_light_reads(program, RobotSpec())
    assert reads == {"left": LightRead.PERCENT, "right": LightRead.REFLECTED}
    compared = replace(
        program,
        text="from ev3dev2.sensor.lego import ColorSensor\neye = ColorSensor('in2')\n"
        "print(eye.reflected_light_intensity)\nwhile eye.full_reflected_light_intensity > 9: pass",
    )
    assert find_light_reads(compared, RobotSpec())["left"] is LightRead.MEAN
    unread = find_light_reads(replace(program, text="print(eye.reflection())"), RobotSpec())
    assert set(unread.values()) == {LightRead.REFLECTION}


def test_a_sensor_has_the_name_of_the_function_that_makes_it() -> None:
    text = f"{HEAD}def floor(number):\n    return ColorSensor('in%d' % number)\nfloor(1)\n"
    program = Program("p.py", text)
    robot = read_source_facts(program).robot
    assert robot is not None
    assert read_facts(program).find_sensor_names(robot.choice.spec) == {"in1": "floor"}
