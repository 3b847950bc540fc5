"""Robots with further parts, and what an infrared sensor meets, from files on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import Command

ASKS = (
    "from ev3dev2.sensor.lego import {0}\nfrom ev3dev2.sensor import INPUT_1\nprint({0}(INPUT_1))\n"
)


def test_a_bumper_of_a_robot_file_touches_a_wall_of_an_obstacle_file(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "robot.toml").write_text(
        "ultrasonic = false\n[touch_sensors.nose]\nport = 'in1'\ny_mm = 60\n"
    )
    (tmp_path / "boxes.toml").write_text(
        "[[obstacle]]\nx_mm = 1000\ny_mm = 400\nwidth_mm = 50\nheight_mm = 400\n"
    )
    (tmp_path / "prog.py").write_text(
        "# %%sim_magic_imports -r robot.toml -o boxes.toml -x 600 -y 600 --solid\n"
        "from ev3dev2.sensor.lego import TouchSensor\n"
        "tank, nose = MoveTank(OUTPUT_B, OUTPUT_C), TouchSensor(INPUT_1)\n"
        "tank.on(SpeedPercent(30), SpeedPercent(30))\n"
        "while not nose.is_pressed:\n    pass\n"
        "tank.off()\nprint('Pressed:', nose.value())\n"
        "tank.on_for_rotations(SpeedPercent(-30), SpeedPercent(-30), 0.5)\nprint('Pressed:', nose.value())\n"
    )
    done = here("run", "prog.py")
    assert done.stdout.split() == ["Pressed:", "1", "Pressed:", "0"], done.stderr
    assert "x 85" in done.stderr


WORLD = """
robot = "Explorer"
[start]
x_mm = 500
y_mm = 500
heading_deg = 0
[beacon]
x_mm = 500
y_mm = 900
channel = 2
[[remote]]
buttons = ["top_left", "top_right"]
from_s = 0.5
until_s = 1.5
"""


def test_a_program_reads_the_beacon_and_remote_of_a_world_file(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "lab.toml").write_text(WORLD)
    (tmp_path / "prog.py").write_text(
        "# %%sim_magic_imports\nfrom time import sleep\nfrom ev3dev2.sensor.lego import InfraredSensor\n"
        "eye = InfraredSensor(INPUT_3)\nprint(eye.heading(2) < 0, eye.distance(1))\n"
        "for _ in range(3):\n    print(eye.buttons_pressed(1))\n    sleep(0.8)\n"
    )
    done = here("run", "lab.toml", "prog.py")
    assert done.stdout.splitlines() == ["True None", "[]", "['top_left', 'top_right']", "[]"], (
        done.stderr
    )


@pytest.mark.parametrize(
    "sensor, robot, hint",
    [
        ("TouchSensor", "Default_Robot", "in1 lego-ev3-us"),
        ("UltrasonicSensor", "Explorer", "in1 lego-ev3-touch"),
    ],
)
def test_missing_part_tells_which_ports_have_what(
    here: Command, tmp_path: Path, sensor: str, robot: str, hint: str
) -> None:
    (tmp_path / "prog.py").write_text(ASKS.format(sensor))
    done = here("run", "prog.py", "-r", robot)
    assert done.returncode == 1
    assert f"DeviceNotFound: {sensor}(ev3-ports:in1) is not connected" in done.stderr
    assert hint in done.stderr
    assert "line 3" in done.stderr


WITHOUT_WHEELS = "left_port = 'outA'\nright_port = 'outD'\nultrasonic = false\n"
TEAM = (
    "from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_D\n"
    "def go():\n    MoveTank(OUTPUT_A, OUTPUT_D).on_for_rotations(20, 20, 1)\n"
)


@pytest.mark.parametrize(
    "text",
    [
        "from lib import go\ngo()\nprint('Gone')\n",
        "# %%sim_magic_preloaded\nsay('Gone')\n",
        "print(colorLeft and 'Gone')",
    ],
    ids=["own module", "magic", "another part"],
)
def test_missing_parts_of_the_prelude_are_no_error_while_unused(
    here: Command, tmp_path: Path, text: str
) -> None:
    (tmp_path / "robot.toml").write_text(WITHOUT_WHEELS)
    (tmp_path / "lib.py").write_text(TEAM)
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", "-r", "robot.toml")
    assert (done.returncode, done.stdout.splitlines()[:1]) == (0, ["Gone"]), done.stderr


@pytest.mark.parametrize(
    "use, missing",
    [
        ("tank_drive.on(10, 10)", "LargeMotor(ev3-ports:outB)"),
        ("tank_turn.off()", "LargeMotor(ev3-ports:outB)"),
        ("x = ultrasonic.distance_centimeters", "UltrasonicSensor(ev3-ports:in1)"),
        ("ultrasonic.mode = 'US-LISTEN'", "UltrasonicSensor(ev3-ports:in1)"),
        ("print(ultrasonic)", "UltrasonicSensor(ev3-ports:in1)"),
        ("hasattr(tank_drive, 'on')", "LargeMotor(ev3-ports:outB)"),
    ],
    ids=["call", "other call", "read", "write", "print", "hasattr"],
)
def test_a_missing_predefined_part_is_an_error_at_the_line_that_uses_it(
    here: Command, tmp_path: Path, use: str, missing: str
) -> None:
    (tmp_path / "robot.toml").write_text(WITHOUT_WHEELS)
    (tmp_path / "prog.py").write_text(
        f"# %%sim_magic_preloaded -r robot.toml\nprint('First')\n{use}\n"
    )
    done = here("run", "prog.py")
    assert (done.returncode, done.stdout) == (1, "First\n")
    assert f"DeviceNotFound: {missing} is not connected" in done.stderr
    assert "line 3" in done.stderr


MEDIUM_WHEELS = "ultrasonic = false\n[motors]\noutB = 'medium'\noutC = 'medium'\n"
DRIVES = """# %%sim_magic -r robot.toml -x 500 -y 500
from ev3dev2.motor import *
tank = MoveTank(OUTPUT_B, OUTPUT_C, motor_class=MediumMotor)
tank.on_for_rotations(SpeedPercent(50), SpeedPercent(50), 2)
motor = MediumMotor(OUTPUT_B)
print(motor.driver_name, motor.max_speed, motor.count_per_rot, motor.position)
tank.on_for_seconds(SpeedPercent(100), SpeedPercent(100), 2.2, brake=False, block=False)
tank.wait(lambda _: motor.speed > 1200, 4000)
print(motor.speed > 1200, tank.left_motor.max_speed)
tank.off()
print(MediumMotor().address)
try:
    LargeMotor(OUTPUT_B)
except Exception as error:
    print(error)
"""


@pytest.mark.parametrize(
    "profile, position",
    [("robolab", "720"), ("ev3", "738"), ("nbev3devsim", "809.6000000000001")],
)
def test_wheels_of_medium_motors_are_read_as_medium_motors(
    here: Command, tmp_path: Path, profile: str, position: str
) -> None:
    (tmp_path / "robot.toml").write_text(MEDIUM_WHEELS)
    (tmp_path / "prog.py").write_text(DRIVES)
    done = here("run", "prog.py", "--profile", profile)
    *values, error = done.stdout.splitlines()
    assert values == [f"lego-ev3-m-motor 1560 360 {position}", "True 1560", "ev3-ports:outB"], (
        done.stderr
    )
    there = "This robot has: outB lego-ev3-m-motor, outC lego-ev3-m-motor."
    assert error.startswith(f"LargeMotor(ev3-ports:outB) is not connected. {there} ")


def test_several_infrared_sensors_each_read_what_is_before_them(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "robot.toml").write_text(
        "ultrasonic = false\ngyro = false\n[infrared]\nport = 'in1'\n"
        "[infrareds.back]\nport = 'in4'\nangle_deg = 180\ny_mm = -60\n"
    )
    (tmp_path / "prog.py").write_text(
        "# %%sim_magic -r robot.toml -x 2200 -y 500\n"
        "from ev3dev2.sensor import INPUT_1, INPUT_4\nfrom ev3dev2.sensor.lego import InfraredSensor\n"
        "print(InfraredSensor(INPUT_1).proximity, InfraredSensor(INPUT_4).proximity)\n"
    )
    done = here("run", "prog.py", "--telemetry", "log.csv")
    assert done.stdout == "20 100\n", done.stderr
    assert (
        (tmp_path / "log.csv")
        .read_text()
        .partition("\n")[0]
        .endswith("infrared_proximity,back_proximity,line")
    )
