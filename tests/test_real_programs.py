"""Programs as people write them for robots of their own run on the robot that is read from them, without any option.

What is on each port was written down from reading the program. Those for the older library are only read here.
Those in `blind` are by somebody who knew no rule of how they are read, and who told the robot of each in words.
"""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from tests.cases import for_each
from tests.conftest import ROOT, Command
from tuisim.commands.listings import list_ports
from tuisim.engine.core.spec import RobotSpec
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_file import read_program
from tuisim.programs.program_settings import read_source_facts
from tuisim.settings.robots import ROBOTS

USUAL = ROBOTS["Default_Robot"]
FOLDER = ROOT / "tests" / "real_programs"


@dataclass(frozen=True)
class Case:
    """What is expected of a program."""

    ports: str
    """The ports of its robot that differ from those of the default one; a port with - is empty."""
    printed: str | None
    """What it prints; None if it is for the older library. Of a program in `blind` the last line."""
    mechanics: Mapping[str, object] = field(default_factory=dict)
    """What is unusual about wheels; the end stops of a motor, and what presses a touch sensor, by port."""
    options: str = ""
    """What it is run with: a mat with a line where it looks for one, buttons that it waits for, a limit."""
    code: int = 0
    """The exit code; 3 for a program that never ends."""
    there_mm: tuple[int, int] | None = None
    """Where the robot is at the end; None if that is not looked at."""
    is_plugged: bool = False
    """Whether its text does not say the ports of all parts: they are plugged in when it asks for them."""


OWN: Mapping[str, Case] = {
    "any_touch": Case("1 touch, 4 ultrasonic, A left wheel, B -, C -, D right wheel", "0 6 True"),
    "argparse_defaults": Case("A medium motor", "30 ev3-ports:outB", is_plugged=True),
    "balancer": Case("1 touch, A right wheel, B -, C -, D left wheel", ""),
    "class_with_arguments": Case("A right wheel, B large motor, C -, D left wheel", "91"),
    "constants": Case(
        "1 touch, 2 ultrasonic, 4 left, A left wheel, B medium motor, C -, D right wheel",
        "85 0 49",
    ),
    "dict_of_motors": Case("A right wheel, C medium motor", "[180, 180, -31]"),
    "dict_ports": Case(
        "1 left, 2 right, 3 gyro, 4 ultrasonic, A left wheel, B right wheel, C medium motor",
        "True 85",
    ),
    "differential_own_wheel": Case(
        "", "280", {"wheel_diameter_mm": 81.6, "wheel_spacing_mm": 115.5}
    ),
    "differential_tire": Case(
        "A left wheel, B right wheel, C -",
        "True",
        {"wheel_diameter_mm": 43.2, "wheel_spacing_mm": 128.0},
    ),
    "differential_usual": Case("", "there"),
    "enum_ports": Case("4 touch, A medium motor, B -, C left wheel, D right wheel", "0 False"),
    "environment": Case("A left wheel, B right wheel, C -", "ev3-ports:outA ev3-ports:outB"),
    "every_sensor": Case("1 touch, 2 gyro, 4 ultrasonic", "0 0 White True"),
    "factory": Case("1 left, 2 ultrasonic, A left wheel, B -, D medium motor", "White 48"),
    "four_large": Case("A large motor, D large motor", "4"),
    "from_modules/main": Case(
        "1 left, 2 ultrasonic, A left wheel, B medium motor, C -, D right wheel", "White 59"
    ),
    "generic_motor": Case("1 left, 2 ultrasonic, A left wheel, B -, C -, D right wheel", "85 360"),
    "gyro_and_infrared": Case("1 infrared", "True 87"),
    "homing_arm_wait": Case("D medium motor", "True True", {"outD": (-245.0, 45.0)}),
    "homing_claw": Case("A medium motor", "81", {"outA": (-45.0, 225.0)}),
    "homing_stalled_state": Case("A medium motor", "closed True\nopen", {"outA": (-45.0, 225.0)}),
    "joystick": Case("A left wheel, B -", "ok"),
    "long_text_ports": Case("1 gyro, 4 ultrasonic, B -, D left wheel", "ev3-ports:in4 True"),
    "loop_of_ports": Case(
        "1 left, 2 middle, A left wheel, B -, C -, D right wheel", "[85, 85, 85]"
    ),
    "medium_wheels": Case(
        "A left wheel (medium motor), B right wheel (medium motor), C medium motor",
        "lego-ev3-m-motor 1088",
    ),
    "module_alias": Case(
        "1 left, 2 ultrasonic, 3 gyro, 4 right, A medium motor, C -, D right wheel", "White White"
    ),
    "motor_set": Case(
        "A left wheel, B -, C medium motor, D right wheel",
        "['ev3-ports:outA', 'ev3-ports:outC', 'ev3-ports:outD']",
    ),
    "negative_speed": Case("", "True"),
    "optional_parts": Case("1 touch, A medium motor", "True True"),
    "own_library_only/main": Case("2 gyro, 4 left, A left wheel, B right wheel, C -", "True"),
    "plain_import": Case("3 touch, D medium motor", "lego-ev3-m-motor True"),
    "rc_tank": Case(
        "1 infrared, A medium motor", "lego-ev3-ir", {"left_reversed": True, "right_reversed": True}
    ),
    "reversed_tank": Case("", "inversed", {"left_reversed": True, "right_reversed": True}),
    "reversed_wheels": Case(
        "A left wheel, B right wheel, C -",
        "726 inversed",
        {"left_reversed": True, "right_reversed": True},
    ),
    "robot_class": Case("A left wheel, B -, C medium motor, D right wheel", "361 361 724"),
    "sensor_by_mode": Case("4 infrared", "lego-ev3-ir 100"),
    "star_import": Case("2 touch, A left wheel, B right wheel, C medium motor", "360 0"),
    "swapped_tank": Case("B right wheel, C left wheel", "ev3-ports:outC"),
    "tank_a_d": Case("A left wheel, B -, C -, D right wheel", "ev3-ports:outA 365"),
    "tank_subclass": Case("A medium motor", "125"),
    "text_ports": Case(
        "1 infrared, 2 gyro, 4 left, A left wheel, B right wheel, C -, D medium motor", "far True"
    ),
    "threads": Case(
        "1 right, 3 ultrasonic, A left wheel, B medium motor, C -, D right wheel", "stopped"
    ),
    "three_colors": Case("1 middle", "85 85 85"),
    "three_medium": Case("A medium motor, B medium motor, C medium motor", "[40, 40, 43]"),
    "touch_at_the_top": Case(
        "1 touch, A large motor", "at the top 1", {"outA": (-225.0, 45.0), "in1": "outA high"}
    ),
    "two_sonars": Case("4 ultrasonic_left", "116 51"),
    "two_touches": Case("1 touch, 4 touch_right", "bump 1 1"),
    "unused_imports": Case("", "White"),
    "v1_alias": Case("1 infrared, 2 ultrasonic, 4 left, B -, C left wheel, D right wheel", None),
    "v1_core": Case("A left wheel, B right wheel, C large motor", None),
    "v1_helper": Case("1 infrared, A medium motor", None),
    "v1_motors": Case("1 touch, A left wheel, B medium motor, C -, D right wheel", None),
    "wheel_class": Case("A right wheel, B -, C left wheel", "93"),
}
REVERSED = {"left_reversed": True, "right_reversed": True}
MIDDLE = (1181, 572)
LINE = "-b Line_Following_Test"
BANDS = "-b Coloured_bands"
BLIND: Mapping[str, Case] = {
    "baken_volger": Case(
        "4 infrared, A medium motor, B right wheel, C left wheel",
        "",
        {},
        "--world programs/beacon.toml --timeout 10",
        3,
        (1713, 835),
    ),
    "color_sorter": Case(
        "1 touch, A medium motor, D large motor",
        "",
        {"outA": (-585.0, 45.0), "outD": (-45.0, 575.0), "in1": "outD low"},
        "--press enter@20-21",
        0,
        MIDDLE,
    ),
    # Its gyro hangs upside down, so on this robot it turns for ever.
    "fetch_can": Case(
        "1 left, 2 gyro, 4 ultrasonic, A right wheel, B -, C medium motor, D left wheel",
        "",
        {"wheel_diameter_mm": 43.2, "outC": (-45.0, 225.0)},
        "--timeout 20",
        3,
        MIDDLE,
    ),
    "fll_2019/main": Case(
        "1 left, 2 ultrasonic, A medium motor, D medium motor",
        "run_crane 6.9",
        {"wheel_diameter_mm": 81.6},
        f"{BANDS} --press enter@5-5.2 --press backspace@20-20.5",
        0,
        (37, 796),
    ),
    "floor_scan/scan": Case("", "row 3: 236 samples", there_mm=(1802, -478), is_plugged=True),
    "gyro_square": Case(
        "2 gyro, 4 left, A left wheel, B -, C -, D right wheel",
        "side 4 gyro 8",
        {},
        "-x 1181 -y 200 -a 90",
        0,
        (1126, 155),
    ),
    # The head turns, but the ultrasonic sensor on it looks ahead.
    "laberinto": Case(
        "A left wheel, B medium motor, C -, D right wheel",
        "fin 60 pasos",
        {"wheel_spacing_mm": 121.0},
        "",
        0,
        (1150, 545),
    ),
    "line_pid_two": Case(
        "1 left, 2 ultrasonic, 3 gyro, 4 right",
        "stopped",
        {},
        f"{LINE} --timeout 7",
        3,
        (149, 1017),
    ),
    "mini_medium": Case(
        "1 infrared, B left wheel (medium motor), C right wheel (medium motor)",
        "",
        {"wheel_diameter_mm": 30.0, "wheel_spacing_mm": 88.0, **REVERSED},
        "--press enter@20-21",
        0,
        (1119, 595),
    ),
    "motorlevel": Case("1 touch", "parked 736 3215", REVERSED, "-b Grey_bands", 0, (1365, 142)),
    "odometry_tour": Case(
        "",
        "58 points saved",
        {"wheel_diameter_mm": 81.6, "wheel_spacing_mm": 136.0},
        "-x 1181 -y 900",
        0,
        (1562, 338),
    ),
    "plotter/plotter": Case(
        "A medium motor, B large motor, C large motor",
        "U 0.0 0.0",
        {"outB": (-45.0, None)},
        "",
        0,
        MIDDLE,
    ),
    "police_patrol": Case("1 gyro, 4 ultrasonic", "", {}, "--timeout 20", 3, (2055, 383)),
    "puppy": Case(
        "1 touch, 2 ultrasonic, 4 left, A large motor, B -, C medium motor, D large motor",
        "",
        {},
        "--timeout 20",
        3,
        MIDDLE,
    ),
    "radar": Case(
        "1 touch, 4 ultrasonic, A medium motor",
        "sweep 3 nearest 116.1 cm at 90 deg",
        {"outA": (-45.0, None), "in1": "outA low"},
        "",
        0,
        MIDDLE,
    ),
    "rob_subclass": Case(
        "1 gyro, 4 ultrasonic, A left wheel, B -", "[  14.49] bye", {}, LINE, 0, (212, 1033)
    ),
    "robot_arm": Case(
        "1 touch, A medium motor, B large motor, C large motor",
        "",
        {"outA": (-225.0, 45.0), "outC": (-45.0, 945.0), "in1": "outC low"},
        "",
        0,
        MIDDLE,
    ),
    "simple_line": Case(
        "A left wheel, B right wheel, C -",
        "Press a button",
        {},
        "-b Loop -x 315 -y 500 -a 90 --press enter@1 --press enter@6-6.3",
        0,
        (373, 925),
    ),
    "staubsauger": Case(
        "1 touch, 2 touch_right, A left wheel, B right wheel, C medium motor",
        "Hindernis Nr. 6",
        REVERSED,
        "--timeout 30",
        3,
        (208, 926),
    ),
    "suiveur3": Case("1 left, 2 middle", "", {}, f"{LINE} --timeout 7", 3, (123, 1010)),
    "sumo": Case(
        "1 touch, 4 infrared, A left wheel, B -, C medium motor, D right wheel",
        "",
        {},
        "--press enter@1 --press backspace@15-16",
        0,
        (564, 1018),
    ),
    "track3r_remote": Case(
        "1 infrared, A medium motor", "", {}, "--world programs/beacon.toml", 0, (1485, 570)
    ),
    "wallfollow": Case("4 touch", "", there_mm=(1215, 305), is_plugged=True),
    "wro_regular/main": Case(
        "1 left, 2 right, 3 middle, A medium motor, D medium motor",
        "",
        {
            "wheel_diameter_mm": 62.4,
            "wheel_spacing_mm": 178.0,
            "outA": (-45.0, 355.0),
            "outD": (-225.0, 45.0),
        },
        BANDS,
        0,
        (1180, 793),
    ),
}
CASES = {**OWN, **{f"blind/{name}": case for name, case in BLIND.items()}}
RUN = [name for name, case in CASES.items() if case.printed is not None]


def file_of(name: str) -> Path:
    return FOLDER / f"{name}.py"


def ports_in(robot: RobotSpec) -> str:
    now = dict(list_ports(robot))
    usual = dict(list_ports(USUAL))
    changed = [port for port in sorted({*now, *usual}) if now.get(port) != usual.get(port)]
    return ", ".join(f"{port[-1]} {now.get(port, '-')}" for port in changed)


def mechanics_of(robot: RobotSpec) -> dict[str, object]:
    keys = ("wheel_diameter_mm", "wheel_spacing_mm", "left_reversed", "right_reversed")
    found: dict[str, object] = {
        key: getattr(robot, key) for key in keys if getattr(robot, key) != getattr(USUAL, key)
    }
    found |= {
        one.port: (one.low_deg, one.high_deg)
        for one in robot.extra_motors
        if (one.low_deg, one.high_deg) != (None, None)
    }
    found |= {
        one.port: f"{one.pressed_by} {one.pressed_at}"
        for one in robot.touch_sensors
        if one.pressed_by
    }
    return found


def test_every_real_program_is_in_the_tests_table() -> None:
    # Of a folder, the program is the file that starts it.
    files = [
        path
        for path in FOLDER.rglob("*.py")
        if path.parent in (FOLDER, FOLDER / "blind") or "#!" in path.read_text()[:2]
    ]
    assert {file_of(name) for name in CASES} == {*files, *FOLDER.glob("*/main.py")}


@for_each(name=CASES)
def test_the_robot_built_for_a_real_program_has_the_parts_it_uses(name: str) -> None:
    facts = read_source_facts(read_program(file_of(name)).program)
    assert (facts.library is not None, facts.of_course) == (True, False)
    case = CASES[name]
    assert (facts.robot is None) == (not case.ports and not case.mechanics)
    robot = facts.robot.choice.spec if facts.robot else USUAL
    assert (ports_in(robot), mechanics_of(robot)) == (case.ports, case.mechanics)


@pytest.mark.parametrize("name", RUN)
@pytest.mark.quick_cases(
    "tank_a_d",
    "robot_class",
    "from_modules/main",
    "homing_claw",
    "touch_at_the_top",
    "blind/floor_scan/scan",
)
def test_a_real_program_runs_the_same_with_its_robot_in_a_file(
    name: str, tmp_path: Path, here: Command
) -> None:
    program = tmp_path / "programs" / f"{name}.py"
    shutil.copytree(FOLDER, tmp_path / "programs")
    case = CASES[name]
    options = shlex.split(CASES[name].options)
    as_it_is = here("run", program, *options)
    printed = as_it_is.stdout.rstrip("\n")
    shown = printed.split("\n")[-1] if name.startswith("blind/") else printed
    assert (as_it_is.returncode, shown) == (case.code, case.printed), as_it_is.stderr
    first = RunStore().load_run(RunStore().runs()[-1].id)
    x_mm, y_mm = first.telemetry.array()[["x_mm", "y_mm"]][-1].item()
    assert case.there_mm in (None, (round(x_mm), round(y_mm)))
    assert bool(first.plugged) == case.is_plugged
    if case.is_plugged:
        return
    assert here("robots", "--from", program, "--out", "robot.toml").returncode == 0
    with_file = here("run", program, "-r", "robot.toml", *options)
    assert (with_file.returncode, with_file.stdout) == (case.code, as_it_is.stdout)
    second = RunStore().load_run(RunStore().runs()[-1].id)
    assert first.spec == second.spec
    assert first.telemetry.array().tobytes() == second.telemetry.array().tobytes()


@pytest.mark.slow
def test_swapping_the_robots_sides_works_like_an_upside_down_gyro(
    tmp_path: Path, here: Command
) -> None:
    program = file_of("blind/fetch_can")
    here("robots", "--from", program, "--out", "robot.toml")
    text = (tmp_path / "robot.toml").read_text()
    for key, port in (("left_port", "outA"), ("right_port", "outD")):
        text = re.sub(rf"^{key} = \S+", f'{key} = "{port}"', text, flags=re.MULTILINE)
    (tmp_path / "robot.toml").write_text(text)
    done = here("run", program, "-r", "robot.toml")
    assert (done.returncode, done.stdout.split(":")[0]) == (0, "nearest"), done.stderr
