"""Where further sensors sit."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.programs.robot.reading import USUAL, built
from tuisim.engine.core.spec import UltrasonicSpec


def test_bumpers_reach_to_the_corners_of_the_robot() -> None:
    found = built(
        "MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 130)\nl, r = TouchSensor('in1'), TouchSensor('in4')"
    )
    assert found is not None
    robot = found.choice.spec
    reach = [
        (touch.x_mm - touch.width_mm / 2, touch.x_mm + touch.width_mm / 2)
        for touch in robot.touch_sensors
    ]
    half_mm = (130 + robot.wheel_width_mm) / 2
    assert reach == [(-half_mm, 0), (0, half_mm)]


@pytest.mark.parametrize("port", ["in1", "in2", "in4"])
@pytest.mark.parametrize(
    ("name", "angle_deg"),
    [("side", -90.0), ("us_left", 90.0), ("right_eye", -90.0), ("rear", 180.0), ("front", 0.0)],
)
def test_a_sensor_is_placed_to_look_where_its_name_says_on_every_port(
    port: str, name: str, angle_deg: float
) -> None:
    found = built(f"{name} = UltrasonicSensor('{port}')")
    robot = found.choice.spec if found else USUAL
    assert robot.ultrasonic is not None
    assert (robot.ultrasonic.port, robot.ultrasonic.angle_deg) == (port, angle_deg)


def test_names_say_which_sensor_looks_ahead_and_which_aside() -> None:
    found = built("us_left, us_front = UltrasonicSensor('in1'), UltrasonicSensor('in4')")
    assert found is not None
    looks = {one.port: one for one in found.choice.spec.sensors if isinstance(one, UltrasonicSpec)}
    assert {port: one.angle_deg for port, one in looks.items()} == {"in1": 90.0, "in4": 0.0}


SIDES: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "swapped": ("left, right = ColorSensor('in3'), ColorSensor('in2')", ("in3", "in2")),
    "swapped in Spanish": (
        "sensor_izq = ColorSensor(INPUT_3)\nsensor_der = ColorSensor(INPUT_2)",
        ("in3", "in2"),
    ),
    "only the right one": ("right = ColorSensor(INPUT_2)", ("in3", "in2")),
    "as usual": ("left, right = ColorSensor('in2'), ColorSensor('in3')", ("in2", "in3")),
    "without sides": ("a, b = ColorSensor('in3'), ColorSensor('in2')", ("in2", "in3")),
    "in front": ("front = ColorSensor('in2')", ("in2", "in3")),
}


@pytest.mark.parametrize("case", SIDES)
def test_colour_sensors_are_on_the_sides_that_their_names_say(case: str) -> None:
    text, ports = SIDES[case]
    found = built(text)
    eyes = (found.choice.spec if found else USUAL).color_sensors
    assert {eye.name: eye.port for eye in eyes} == dict(zip(("left", "right"), ports, strict=True))
