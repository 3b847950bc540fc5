"""The robot with parts that were plugged in: what gives way, where the new parts sit, in which order."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tuisim.engine.core.plugged import LEFT, RIGHT, PluggedPart, plug_parts
from tuisim.engine.core.spec import NO_PORT, MotorSpec, RobotSpec

USUAL = RobotSpec()


def plug(robot: RobotSpec, *parts: tuple[str, ...]) -> RobotSpec:
    return plug_parts(robot, [PluggedPart(port, part, 0, 1, *role) for port, part, *role in parts])


def on_ports(robot: RobotSpec) -> dict[str, str]:
    motors = {motor.port: motor.kind for motor in robot.motors}
    return motors | {sensor.port: sensor.name for sensor in robot.sensors}


def test_a_sensor_takes_the_place_of_another_on_its_port() -> None:
    robot = plug(USUAL, ("in1", "TouchSensor"), ("in2", "InfraredSensor"))
    assert robot.ultrasonic is None
    assert [sensor.name for sensor in robot.color_sensors] == ["right"]
    assert {port: on_ports(robot)[port] for port in ("in1", "in2")} == {
        "in1": "touch",
        "in2": "infrared",
    }


def test_four_sensors_of_one_kind_get_different_names_and_positions() -> None:
    ports = ("in1", "in2", "in3", "in4")
    for part in ("ColorSensor", "TouchSensor", "UltrasonicSensor", "InfraredSensor"):
        robot = plug(USUAL, *((port, part) for port in ports))
        assert len({sensor.name for sensor in robot.sensors}) == 4
        places = {(one.x_mm, one.y_mm) for one in robot.sensors}  # type: ignore[attr-defined]
        assert len(places) == 4, part


def test_plugging_in_a_gyro_replaces_the_robots_former_one() -> None:
    robot = plug(USUAL, ("in2", "GyroSensor"))
    assert robot.gyro is not None
    assert (robot.gyro.port, on_ports(robot).get("in4")) == ("in2", None)


def test_motors_are_added_behind_the_others() -> None:
    robot = replace(USUAL, extra_motors=(MotorSpec("outD", "large"),))
    robot = plug(robot, ("outA", "MediumMotor"))
    assert [motor.port for motor in robot.extra_motors] == ["outD", "outA"]


def test_wheels_plugged_in_at_other_ports_become_the_robots_wheels() -> None:
    robot = plug(USUAL, ("outA", "LargeMotor", LEFT), ("outD", "LargeMotor", RIGHT))
    assert (robot.left_port, robot.right_port) == ("outA", "outD")
    assert robot.extra_motors == ()
    assert plug_parts(USUAL, [PluggedPart("outA", "LargeMotor", 0, 1, LEFT)]) == USUAL


def test_a_motor_on_the_port_of_a_wheel_leaves_no_wheels() -> None:
    robot = plug(USUAL, ("outB", "MediumMotor"), ("outC", "LargeMotor"))
    assert (robot.left_port, robot.right_port) == (NO_PORT, NO_PORT)
    assert robot.extra_motors == (MotorSpec("outB", "medium"), MotorSpec("outC", "large"))


def test_a_plugged_in_part_is_stored_and_read_back() -> None:
    for part in (
        PluggedPart("in1", "TouchSensor", 53, 9),
        PluggedPart("outA", "LargeMotor", 0, 0, LEFT),
    ):
        assert PluggedPart.from_plain(part.to_plain()) == part
    assert PluggedPart("in1", "TouchSensor", 53, 9).to_plain() == {
        "port": "in1",
        "class": "TouchSensor",
        "tick": 53,
        "line": 9,
    }


@pytest.mark.parametrize(
    ("port", "part", "role"),
    [
        ("in1", "LargeMotor", ""),
        ("outA", "GyroSensor", ""),
        ("in1", "Pixy", ""),
        ("outA", "LargeMotor", "up"),
    ],
)
def test_an_unknown_part_cannot_be_plugged_in(port: str, part: str, role: str) -> None:
    with pytest.raises(ValueError, match="no part"):
        PluggedPart(port, part, 0, 0, role)
