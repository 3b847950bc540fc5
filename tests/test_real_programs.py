"""Programs as people write them for robots of their own run on the robot that is read from them, without any option.

What is on each port was written down from reading the program. Those for the older library are only read here.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tuisim.config.program_file import read_program
from tuisim.config.program_settings import facts_of
from tuisim.config.robots import ROBOTS, ports_of
from tuisim.core.spec import RobotSpec
from tuisim.runs.store import RunStore

USUAL = ROBOTS["Default_Robot"]
FOLDER = ROOT / "tests" / "real_programs"


@dataclass(frozen=True)
class Case:
    """What is expected of a program."""

    ports: str
    """The ports of its robot that differ from those of the default one; a port with - is empty."""
    printed: str | None
    """What it prints; None if it is for the older library."""
    mechanics: Mapping[str, object] = field(default_factory=dict)
    """What is unusual about wheels; the end stops of a motor, and what presses a touch sensor, by port."""


CASES: Mapping[str, Case] = {
    "any_touch": Case("1 touch, 4 ultrasonic, A left wheel, B -, C -, D right wheel", "0 6 True"),
    "argparse_defaults": Case("A left wheel, B medium motor, C -, D right wheel", "30 ev3-ports:outB"),
    "balancer": Case("1 touch, A right wheel, B -, C -, D left wheel", ""),
    "class_with_arguments": Case("A right wheel, B large motor, C -, D left wheel", "90"),
    "constants": Case("1 touch, 2 ultrasonic, 4 left, A left wheel, B medium motor, C -, D right wheel", "100 0 45"),
    "dict_of_motors": Case("A right wheel, C medium motor", "[180, 180, -30]"),
    "dict_ports": Case(
        "1 left, 2 right, 3 gyro, 4 ultrasonic, A left wheel, B right wheel, C medium motor", "True 100"
    ),
    "differential_own_wheel": Case("", "280", {"wheel_diameter_mm": 81.6, "wheel_spacing_mm": 115.5}),
    "differential_tire": Case(
        "A left wheel, B right wheel, C -", "True", {"wheel_diameter_mm": 43.2, "wheel_spacing_mm": 128.0}
    ),
    "differential_usual": Case("", "there"),
    "enum_ports": Case("4 touch, A medium motor, B -, C left wheel, D right wheel", "0 False"),
    "environment": Case("A left wheel, B right wheel, C -", "ev3-ports:outA ev3-ports:outB"),
    "every_sensor": Case("1 touch, 2 gyro, 4 ultrasonic", "0 0 White True"),
    "factory": Case("1 left, 2 ultrasonic, A left wheel, B -, D medium motor", "White 45"),
    "four_large": Case("A large motor, D large motor", "4"),
    "from_modules/main": Case("1 left, 2 ultrasonic, A left wheel, B medium motor, C -, D right wheel", "White 60"),
    "generic_motor": Case("1 left, 2 ultrasonic, A left wheel, B -, C -, D right wheel", "100 360"),
    "gyro_and_infrared": Case("1 infrared", "True 87"),
    "homing_arm_wait": Case("D medium motor", "True True", {"outD": (-245.0, 45.0)}),
    "homing_claw": Case("A medium motor", "80", {"outA": (-45.0, 225.0)}),
    "homing_stalled_state": Case("A medium motor", "closed True\nopen", {"outA": (-45.0, 225.0)}),
    "joystick": Case("A left wheel, B -", "ok"),
    "long_text_ports": Case("1 gyro, 4 ultrasonic, B -, D left wheel", "ev3-ports:in4 True"),
    "loop_of_ports": Case("1 middle, A left wheel, B -, C -, D right wheel", "[100, 100, 100]"),
    "medium_wheels": Case(
        "A left wheel (medium motor), B right wheel (medium motor), C medium motor", "lego-ev3-m-motor 1080"
    ),
    "module_alias": Case("1 left, 2 ultrasonic, 3 gyro, 4 right, A medium motor, C -, D right wheel", "White White"),
    "motor_set": Case(
        "A left wheel, B -, C medium motor, D right wheel", "['ev3-ports:outA', 'ev3-ports:outC', 'ev3-ports:outD']"
    ),
    "negative_speed": Case("", "True"),
    "optional_parts": Case("1 touch, A medium motor", "True True"),
    "own_library_only/main": Case("2 gyro, 4 left, A left wheel, B right wheel, C -", "True"),
    "plain_import": Case("3 touch, D medium motor", "lego-ev3-m-motor True"),
    "rc_tank": Case("1 infrared, A medium motor", "lego-ev3-ir", {"left_reversed": True, "right_reversed": True}),
    "reversed_tank": Case("", "inversed", {"left_reversed": True, "right_reversed": True}),
    "reversed_wheels": Case(
        "A left wheel, B right wheel, C -", "720 inversed", {"left_reversed": True, "right_reversed": True}
    ),
    "robot_class": Case("A left wheel, B -, C medium motor, D right wheel", "360 360 720"),
    "sensor_by_mode": Case("4 infrared", "lego-ev3-ir 100"),
    "star_import": Case("2 touch, A left wheel, B right wheel, C medium motor", "360 0"),
    "swapped_tank": Case("B right wheel, C left wheel", "ev3-ports:outC"),
    "tank_a_d": Case("A left wheel, B -, C -, D right wheel", "ev3-ports:outA 360"),
    "tank_subclass": Case("A medium motor", "120"),
    "text_ports": Case("1 infrared, 2 gyro, 4 left, A left wheel, B right wheel, C -, D medium motor", "far True"),
    "threads": Case("1 right, 3 ultrasonic, A left wheel, B medium motor, C -, D right wheel", "stopped"),
    "three_colors": Case("1 middle", "100 100 100"),
    "three_medium": Case("A medium motor, B left wheel (medium motor), C right wheel (medium motor)", "[40, 40, 40]"),
    "touch_at_the_top": Case("1 touch, A large motor", "at the top 1", {"outA": (-225.0, 45.0), "in1": "outA high"}),
    "two_sonars": Case("4 ultrasonic_left", "116 51"),
    "two_touches": Case("1 touch, 4 touch_right", "bump 1 1"),
    "unused_imports": Case("", "White"),
    "v1_alias": Case("1 infrared, 2 ultrasonic, 4 left, B -, C left wheel, D right wheel", None),
    "v1_core": Case("A left wheel, B right wheel, C large motor", None),
    "v1_helper": Case("1 infrared, A medium motor", None),
    "v1_motors": Case("1 touch, A left wheel, B medium motor, C -, D right wheel", None),
    "wheel_class": Case("A right wheel, B -, C left wheel", "90"),
}
RUN = [name for name, case in CASES.items() if case.printed is not None]


def file_of(name: str) -> Path:
    return FOLDER / f"{name}.py"


def ports_in(robot: RobotSpec) -> str:
    now, usual = dict(ports_of(robot)), dict(ports_of(USUAL))
    changed = [port for port in sorted({*now, *usual}) if now.get(port) != usual.get(port)]
    return ", ".join(f"{port[-1]} {now.get(port, '-')}" for port in changed)


def mechanics_of(robot: RobotSpec) -> dict[str, object]:
    keys = ("wheel_diameter_mm", "wheel_spacing_mm", "left_reversed", "right_reversed")
    found: dict[str, object] = {key: getattr(robot, key) for key in keys if getattr(robot, key) != getattr(USUAL, key)}
    found |= {one.port: (one.low_deg, one.high_deg) for one in robot.extra_motors if one.low_deg is not None}
    found |= {one.port: f"{one.pressed_by} {one.pressed_at}" for one in robot.touch_sensors if one.pressed_by}
    return found


def test_every_program_is_in_the_table() -> None:
    found = {*FOLDER.glob("*.py"), *FOLDER.glob("*/main.py")}
    assert {file_of(name) for name in CASES} == found


@pytest.mark.parametrize("name", CASES)
def test_the_robot_is_the_one_that_the_program_talks_about(name: str) -> None:
    facts = facts_of(read_program(file_of(name)).program)
    assert (facts.for_brick, facts.of_course) == (True, False)
    case = CASES[name]
    assert (facts.robot is None) == (not case.ports and not case.mechanics)
    robot = facts.robot.choice.spec if facts.robot else USUAL
    assert (ports_in(robot), mechanics_of(robot)) == (case.ports, case.mechanics)


@pytest.mark.parametrize("name", RUN)
@pytest.mark.quick_cases("tank_a_d", "robot_class", "from_modules/main", "homing_claw", "touch_at_the_top")
def test_it_runs_as_it_is_and_with_its_robot_in_a_file_to_the_bit(name: str, tmp_path: Path, here: Command) -> None:
    program = tmp_path / "programs" / f"{name}.py"
    shutil.copytree(FOLDER, tmp_path / "programs")
    as_it_is = here("run", program)
    assert (as_it_is.returncode, as_it_is.stdout.rstrip("\n")) == (0, CASES[name].printed), as_it_is.stderr
    assert here("robots", "--from", program, "--out", "robot.toml").returncode == 0
    with_file = here("run", program, "-r", "robot.toml")
    assert (with_file.returncode, with_file.stdout) == (0, as_it_is.stdout)
    first, second = (RunStore().load_run(info.id) for info in RunStore().runs()[-2:])
    assert first.spec == second.spec
    assert first.telemetry.array().tobytes() == second.telemetry.array().tobytes()
