"""What the source of a program decides about its run, and what stands above it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases, for_each, for_rows
from tuisim.base.errors import ProfileError, RobotError
from tuisim.engine.core.profile import PROFILES
from tuisim.programs.program_file import parse_program, read_program
from tuisim.programs.program_settings import (
    FOR_SPIKE,
    build_program_settings,
    choose_robot,
    require_library,
)
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

BRICK = "from ev3dev2.motor import MediumMotor, MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C\n"
CLAW = f"{BRICK}MediumMotor(OUTPUT_A).on(5)\n"
USUAL = f"{BRICK}MoveTank(OUTPUT_B, OUTPUT_C).on(5, 5)\n"
SENSOR = "from ev3dev2.sensor.lego import ColorSensor\nprint(ColorSensor('in2').reflected_light_intensity)\n"
PYBRICKS = "from pybricks.ev3devices import Motor\nfrom pybricks.parameters import Port\nMotor(Port.B).run(200)\n"
BASE = f"from pybricks.robotics import DriveBase\n{PYBRICKS}DriveBase(Motor(Port.B), Motor(Port.C), 55.5, 104)\n"
MIDDLE = (1181.0, 571.5)
MAT = (100.0, 800.0)
LINE = (280.0, 700.0)
LOOP = (500.0, 500.0)

# The text, the arguments of `build_program_settings`; profile, the robot's name, and the place.
CASES: Mapping[str, tuple[str, dict[str, Any], tuple[str, str, tuple[float, float]]]] = {
    "a brick's program": (USUAL, {}, ("ev3", "Default_Robot", MIDDLE)),
    "with another robot": (CLAW, {}, ("ev3", "Robot of p.py", MIDDLE)),
    "-r": (CLAW, {"above": {"robot": "Explorer"}}, ("ev3", "Explorer", MIDDLE)),
    "-x": (CLAW, {"above": {"start.x_mm": 300.0}}, ("ev3", "Robot of p.py", (300, 571.5))),
    "-y": (CLAW, {"above": {"start.y_mm": 300.0}}, ("ev3", "Robot of p.py", (1181, 300))),
    "-a": (USUAL, {"above": {"start.heading_deg": 90.0}}, ("ev3", "Default_Robot", MIDDLE)),
    "-b": (CLAW, {"above": {"background": "Loop"}}, ("ev3", "Robot of p.py", LINE)),
    "-b and -y": (
        CLAW,
        {"above": {"background": "Loop", "start.y_mm": 500.0}},
        ("ev3", "Robot of p.py", (280, 500)),
    ),
    "-b without a line": (
        CLAW,
        {"above": {"background": "Grey_bands"}},
        ("ev3", "Robot of p.py", (150, 500)),
    ),
    "-b of the usual mat": (
        USUAL,
        {"above": {"background": "Empty_Map"}},
        ("ev3", "Default_Robot", MIDDLE),
    ),
    "--profile": (CLAW, {"above": {"profile": "robolab"}}, ("robolab", "Robot of p.py", MIDDLE)),
    "--profile ev3": (SENSOR, {"above": {"profile": "ev3"}}, ("ev3", "Default_Robot", MIDDLE)),
    "--profile ev3 on a mat": (
        USUAL,
        {"above": {"profile": "ev3", "background": "Loop"}},
        ("ev3", "Default_Robot", LINE),
    ),
    "a magic line": (f"# %%sim_magic\n{CLAW}", {}, ("robolab", "Robot of p.py", MAT)),
    "a magic line with a robot": (
        f"# %%sim_magic -r Explorer\n{CLAW}",
        {},
        ("robolab", "Explorer", MAT),
    ),
    "a magic line with the profile": (
        f"# %%sim_magic --profile ev3\n{USUAL}",
        {},
        ("ev3", "Default_Robot", (157, 800)),
    ),
    "a preloaded program": (
        f"# %%sim_magic_preloaded\n{CLAW}",
        {},
        ("robolab", "Default_Robot", MAT),
    ),
    "--preload": (CLAW, {"above": {"preload": "preloaded"}}, ("robolab", "Default_Robot", MAT)),
    "another seed": (CLAW, {"above": {"seed": 1}}, ("ev3", "Robot of p.py", MIDDLE)),
    "the course's robot and profile": (
        CLAW,
        {"above": {"robot": "Default_Robot", "profile": "robolab"}},
        ("robolab", "Default_Robot", MIDDLE),
    ),
    "a preloaded program on a mat": (
        "tank_drive.on(5, 5)\n",
        {"above": {"background": "Loop"}},
        ("robolab", "Default_Robot", LOOP),
    ),
    "the user's profile": (
        CLAW,
        {"below": {"profile": "robolab"}},
        ("robolab", "Robot of p.py", MIDDLE),
    ),
    "the user's robot": (CLAW, {"below": {"robot": "Explorer"}}, ("ev3", "Explorer", MIDDLE)),
    "the user's mat": (CLAW, {"below": {"background": "Loop"}}, ("ev3", "Robot of p.py", LINE)),
    "the course's percents": (
        SENSOR.replace("intensity)", "intensity_pc)"),
        {},
        ("robolab", "Default_Robot", MAT),
    ),
    "a percentage of its own": (
        f"{SENSOR}class C:\n    def reflected_light_intensity_pc(self): pass\nC().reflected_light_intensity_pc()\n",
        {},
        ("ev3", "Default_Robot", MIDDLE),
    ),
    "the course's clock": (
        f"{SENSOR}from ev3dev2_glue import get_clock\n",
        {},
        ("robolab", "Default_Robot", MAT),
    ),
    "names of the prelude": (f"{USUAL}say('hello')\n", {}, ("robolab", "Default_Robot", MAT)),
    "such names of its own": (
        f"{USUAL}def say(text): pass\nsay(1)\n",
        {},
        ("ev3", "Default_Robot", MIDDLE),
    ),
    "imports of everything": (
        "from ev3dev2.motor import *\nMoveTank(OUTPUT_B, OUTPUT_C).on(SpeedPercent(5), 5)\n",
        {},
        ("ev3", "Default_Robot", MIDDLE),
    ),
    "no library": ("print(1)\n", {}, ("robolab", "Default_Robot", MAT)),
    "pybricks": (PYBRICKS, {}, ("lego-micropython", "Default_Robot", MIDDLE)),
    "pybricks by the first line": (
        "#!/usr/bin/env pybricks-micropython\n",
        {},
        ("lego-micropython", "Default_Robot", MIDDLE),
    ),
    "pybricks with its robot": (BASE, {}, ("lego-micropython", "Robot of p.py", MIDDLE)),
    "pybricks on a mat": (
        BASE,
        {"above": {"background": "Loop"}},
        ("lego-micropython", "Robot of p.py", LINE),
    ),
    "a hub and a mat in a magic line": (
        "# %sim_magic -b Loop\nfrom pybricks.hubs import PrimeHub\nhub = PrimeHub()\n",
        {},
        ("pybricks4", "Robot of p.py", LINE),
    ),
    "pybricks and a magic line": (
        f"# %%sim_magic\n{BASE}",
        {},
        ("lego-micropython", "Robot of p.py", (136, 800)),
    ),
    "--profile pybricks4": (
        PYBRICKS,
        {"above": {"profile": "pybricks4"}},
        ("pybricks4", "Default_Robot", MIDDLE),
    ),
    "pybricks and the user's profile": (
        PYBRICKS,
        {"below": {"profile": "robolab"}},
        ("lego-micropython", "Default_Robot", MIDDLE),
    ),
    "pybricks and the user's fitting one": (
        PYBRICKS,
        {"below": {"profile": "pybricks4"}},
        ("pybricks4", "Default_Robot", MIDDLE),
    ),
    "names of Pybricks 4": (
        f"{PYBRICKS}from pybricks.tools import run_task\n",
        {},
        ("pybricks4", "Default_Robot", MIDDLE),
    ),
    "names of Pybricks 4 and the earlier profile": (
        f"{PYBRICKS}from pybricks.tools import run_task\n",
        {"above": {"profile": "lego-micropython"}},
        ("lego-micropython", "Default_Robot", MIDDLE),
    ),
    "names of Pybricks 4 and a magic line": (
        f"# %%sim_magic\n{BASE}base.arc(100, 90)\n",
        {},
        ("pybricks4", "Robot of p.py", (136, 800)),
    ),
    "device files without a library": (
        "open('/sys/class/tacho-motor/motor0/command', 'w').write('run-forever')\n",
        {},
        ("ev3", "Default_Robot", MIDDLE),
    ),
    "device files and a magic line": (
        "# %%sim_magic\nprint(open('/sys/class/lego-sensor/sensor0/value0').read())\n",
        {},
        ("robolab", "Default_Robot", MAT),
    ),
    "the older library": (
        "from ev3dev.ev3 import *\nm = LargeMotor('outB')\n",
        {},
        ("ev3", "Default_Robot", MIDDLE),
    ),
}


@for_each(case=CASES)
def test_a_program_decides_profile_robot_and_place(case: str) -> None:
    text, given, (profile, robot, place) = CASES[case]
    above = [given["above"]] if "above" in given else []
    rest = {key: value for key, value in given.items() if key != "above"}
    found = build_program_settings(parse_program(text, "p.py"), *above, **rest)
    spec = build_run_spec(found.settings)
    assert (spec.profile.name, spec.robot.name) == (profile, robot)
    assert (spec.world.start.x_mm, spec.world.start.y_mm) == place
    assert bool(found.decided.note) == bool({"robot", "profile"} & found.decided.layer.keys())


MISFITS: Mapping[str, tuple[str, dict[str, Any], str]] = {
    "a profile of the other library": (
        PYBRICKS,
        {"profile": "ev3"},
        "profile: p.py uses pybricks, and the profile ev3 is for ev3dev2",
    ),
    "a profile of pybricks": (
        USUAL,
        {"profile": "pybricks4"},
        "profile: p.py uses ev3dev2, and the profile pybricks4 is for pybricks",
    ),
    "a profile of the EV3 for a hub": (
        "from pybricks.hubs import PrimeHub\n",
        {"profile": "lego-micropython"},
        "profile: p.py uses the PrimeHub, and the profile lego-micropython is for an EV3",
    ),
    "names of a prelude": (
        "tank_drive.on(5, 5)\n",
        {"profile": "lego-micropython"},
        "p.py uses ev3dev2, and the profile lego-micropython",
    ),
    "a prelude before pybricks": (
        f"# %%sim_magic_preloaded\n{PYBRICKS}",
        {},
        "preload: p.py uses pybricks, and its predefined names",
    ),
}


@pytest.mark.parametrize("case", MISFITS)
def test_a_profile_or_prelude_for_another_library_than_the_programs_is_refused(case: str) -> None:
    text, above, told = MISFITS[case]
    with pytest.raises(ProfileError, match=told):
        build_program_settings(parse_program(text, "p.py"), above)


SPIKE: Mapping[str, str] = {
    "lego": "import motor, runloop\nfrom hub import port\n",
    "old lego": "from spike import PrimeHub\n",
}


@pytest.mark.parametrize("case", SPIKE)
def test_a_program_for_another_hub_gets_no_advice_that_cannot_help(case: str) -> None:
    source = parse_program(SPIKE[case], "p.py")
    told = f"p.py: it is {FOR_SPIKE}"
    assert build_program_settings(source).decided.note == ""
    with pytest.raises(RobotError, match=told):
        choose_robot(source, "it")


def test_the_name_that_chooses_pybricks_4_is_said() -> None:
    source = parse_program(f"{BASE}base.straight(100, wait=False)\n", "p.py")
    note = build_program_settings(source).decided.note
    assert "Pybricks 4, whose wait= of straight() it uses (profile pybricks4)" in note


@pytest.mark.parametrize(
    "text",
    [
        "from pybricks.hubs import PrimeHub\n",
        "from pybricks.pupdevices import Motor\nfrom pybricks.parameters import Port\nMotor(Port.A)\n",
    ],
)
def test_a_program_for_a_hub_runs_on_a_robot_with_it(text: str) -> None:
    settings = build_program_settings(parse_program(text, "p.py")).settings
    robot = settings["robot"].spec
    assert (settings["profile"], robot.hub, robot.gyro.port) == ("pybricks4", "PrimeHub", "inside")
    assert (robot.wheel_diameter_mm, robot.wheel_spacing_mm, robot.sensors) == (
        56,
        112,
        (robot.gyro,),
    )


def test_a_pybricks_program_importing_several_hubs_gets_the_ev3s_profile() -> None:
    both = (
        f"{PYBRICKS}try:\n    from pybricks.hubs import PrimeHub\nexcept ImportError:\n    pass\n"
    )
    assert (
        build_program_settings(parse_program(both, "p.py")).settings["profile"]
        == "lego-micropython"
    )
    assert build_program_settings(parse_program(both, "p.py")).decided.note


def test_an_own_module_with_the_name_of_one_of_a_hub_is_no_sign_of_it(tmp_path: Path) -> None:
    (tmp_path / "motor.py").write_text(
        "from ev3dev2.motor import MediumMotor\narm = MediumMotor('outA')\n"
    )
    (tmp_path / "p.py").write_text("import motor\n")
    assert (
        "medium motor on outA"
        in build_program_settings(read_program(tmp_path / "p.py")).decided.note
    )


def test_a_program_with_a_profile_for_the_other_library_can_be_opened() -> None:
    found = build_program_settings(
        parse_program(PYBRICKS, "p.py"), {"profile": "ev3"}, insists=False
    )
    assert found.settings["profile"] == "lego-micropython"


@pytest.mark.parametrize(
    "text, fitting, other",
    [
        (PYBRICKS, "pybricks4", "ev3"),
        (USUAL, "robolab", "pybricks4"),
        ("tank_drive.on(5, 5)\n", "ev3", "pybricks4"),
        ("from pybricks.hubs import PrimeHub\n", "pybricks4", "lego-micropython"),
    ],
    ids=["pybricks", "ev3dev2", "a prelude", "a hub"],
)
def test_a_profile_is_required_to_be_for_the_library_of_the_program(
    text: str, fitting: str, other: str
) -> None:
    program = parse_program(text, "p.py").program
    require_library(program, PROFILES[fitting])
    with pytest.raises(ProfileError, match=f"the profile {other} is for"):
        require_library(program, PROFILES[other])


def test_a_program_without_a_library_is_allowed_under_every_profile() -> None:
    for profile in PROFILES.values():
        require_library(parse_program("print(1)\n", "p.py").program, profile)


def test_a_program_of_predefined_names_gets_no_settings_of_its_own() -> None:
    text = "tank_drive.on(5, 5)\nprint('A: 1')\n"
    assert build_program_settings(parse_program(text, "p.py")).settings == Settings()


def test_an_imported_module_may_bring_the_library_and_predefined_names(
    tmp_path: Path,
) -> None:
    (tmp_path / "hardware.py").write_text(f"{BRICK}gyro = MediumMotor(OUTPUT_A)\n")
    source = parse_program(
        "from hardware import *\nprint(gyro.position)\n", "p.py", str(tmp_path / "p.py")
    )
    assert source.program.prelude == "none"
    found = build_program_settings(source)
    assert found.settings["profile"] == "ev3"
    assert "robot" in found.decided.layer


def test_a_course_program_with_a_module_that_imports_ev3dev2_stays_a_course_program(
    tmp_path: Path,
) -> None:
    (tmp_path / "hardware.py").write_text(f"{BRICK}arm = MediumMotor(OUTPUT_A)\n")
    source = parse_program(
        "from hardware import *\ntank_drive.on(5, 5)\n", "p.py", str(tmp_path / "p.py")
    )
    assert source.program.prelude == "preloaded"
    assert build_program_settings(source).settings == Settings()


def test_the_line_about_the_robot_names_what_was_built_and_how_to_change_it() -> None:
    source = parse_program(CLAW, "my claw.py", "a folder/my claw.py")
    assert build_program_settings(source).decided.note == (
        "my claw.py runs on a robot built from it: medium motor on outA; as on a brick (profile ev3). "
        "-r or --profile to change it; `tuisim robots --from 'a folder/my claw.py'` shows the robot"
    )
    assert build_program_settings(source, {"robot": "Explorer"}).decided.note == (
        "my claw.py runs as on a brick (profile ev3). --profile to change it"
    )
    assert build_program_settings(replace(source, has_magic=True)).decided.hint.startswith(
        "-r to change it"
    )


READS_LIGHT = """\
from ev3dev2.sensor.lego import ColorSensor
print(ColorSensor("in2").reflected_light_intensity)
"""


@cases(
    "text, above, is_told",
    {
        "a magic line": (f"# %sim_magic -b Loop\n{READS_LIGHT}", {}, True),
        "predefined names beside": (f"# %%sim_magic_preloaded\n{READS_LIGHT}", {}, True),
        "predefined names alone": (
            "# %%sim_magic_preloaded\nprint(colorLeft.reflected_light_intensity)\n",
            {},
            False,
        ),
        "the brick's rules": (READS_LIGHT, {}, False),
        "a chosen profile": (f"# %sim_magic\n{READS_LIGHT}", {"profile": "robolab"}, False),
        "the course's names": (f"# %sim_magic\n{READS_LIGHT}".replace(")\n", "_pc)\n"), {}, False),
        "no light": (f"# %sim_magic\n{READS_LIGHT}".replace("reflected_", "ambient_"), {}, False),
    },
)
def test_a_program_for_the_brick_with_a_magic_line_is_told_the_scale_of_light(
    text: str, above: dict[str, str], is_told: bool
) -> None:
    note = build_program_settings(parse_program(text, "p.py"), above).decided.note
    assert ("light is 0 to 255 (with --profile ev3 0 to 100)" in note) is is_told


ON_USUAL_PORTS = """\
from ev3dev2.motor import OUTPUT_B, OUTPUT_C, MoveDifferential
from ev3dev2.wheel import EV3Tire
MoveDifferential(OUTPUT_C, OUTPUT_B, EV3Tire, 120)
"""


@cases(
    "magic, above, is_built",
    {
        "nothing is chosen": ("", {}, True),
        "magic line": ("# %%sim_magic\n", {}, False),
        "mat": ("", {"background": "Loop"}, True),
        "profile": ("", {"profile": "robolab"}, True),
        "start": ("", {"start.x_mm": 300.0}, True),
    },
)
def test_a_robot_is_built_from_sizes_in_the_text_only_if_the_program_sets_the_profile(
    magic: str, above: Mapping[str, Any], is_built: bool
) -> None:
    source = parse_program(magic + ON_USUAL_PORTS, "program.py")
    assert ("robot" in build_program_settings(source, above).decided.layer) is is_built


FORMATTED = "from pybricks.tools import wait\nprint(f'{1}')\n"


@pytest.mark.parametrize(
    "text, above, refusal",
    [
        (FORMATTED, {}, "p.py:2: the brick's Python would refuse this line (f-string)"),
        (
            f"{FORMATTED}x: int = 1\n",
            {},
            "p.py:2: the brick's Python would refuse this line (f-string), and 1 more",
        ),
        (FORMATTED, {"profile": "pybricks4"}, ""),
        (
            f"import time\n{FORMATTED}",
            {},
            "p.py:3: the brick's Python would refuse this line (f-string)",
        ),
        (
            f"import time\n{FORMATTED}",
            {"profile": "pybricks4"},
            "p.py:1: the brick's Python would refuse this line (time)",
        ),
        (FORMATTED.replace("f'", "'"), {}, ""),
        (f"{USUAL}print(f'')\n", {}, ""),
    ],
)
def test_lines_that_the_bricks_python_refuses_are_told_for_brick_programs_only(
    text: str, above: Mapping[str, Any], refusal: str
) -> None:
    assert build_program_settings(parse_program(text, "p.py"), above).decided.refusal == refusal


TOUCH = "from ev3dev2.sensor.lego import TouchSensor\nTouchSensor('in1').wait_for_pressed()\n"
SONAR = "from pybricks.ev3devices import UltrasonicSensor\nprint(UltrasonicSensor(Port.S4).distance())\n"
OPEN = (True, False)
WALLED = (True, True)
AS_EVER = (False, True)

# The text, what is chosen, and whether there are a floor and walls.
GROUNDS: Mapping[str, tuple[str, dict[str, Any], tuple[bool, bool]]] = {
    "no sensor": (USUAL, {}, OPEN),
    "Pybricks": (BASE, {}, OPEN),
    "a colour sensor": (f"{USUAL}{SENSOR}", {}, OPEN),
    "a touch sensor": (f"{USUAL}{TOUCH}", {}, WALLED),
    "an ultrasonic sensor": (f"{BASE}{SONAR}", {}, WALLED),
    "--walls on": (USUAL, {"walls": True}, WALLED),
    "--walls off": (f"{BASE}{SONAR}", {"walls": False}, OPEN),
    "a place": (USUAL, {"start.x_mm": 300.0}, OPEN),
    "a robot": (USUAL, {"robot": "Explorer"}, OPEN),
    "--profile ev3": (USUAL, {"profile": "ev3"}, OPEN),
    "--profile robolab": (USUAL, {"profile": "robolab"}, AS_EVER),
    "-b": (USUAL, {"background": "Loop"}, OPEN),
    "-b and a touch sensor": (f"{USUAL}{TOUCH}", {"background": "Loop"}, WALLED),
    "-b and --profile ev3": (USUAL, {"background": "Empty_Map", "profile": "ev3"}, OPEN),
    "a world": (USUAL, {"floor": False, "profile": "ev3"}, AS_EVER),
    "a world with a floor": (USUAL, {"floor": True, "walls": False, "profile": "ev3"}, OPEN),
    "a magic line": (f"# %%sim_magic --profile ev3\n{USUAL}", {}, AS_EVER),
    "a course program": ("tank_drive.on(5, 5)\n", {"profile": "ev3"}, AS_EVER),
    "no library": ("print(1)\n", {"profile": "ev3"}, AS_EVER),
}


@for_rows("text, chosen, ground", GROUNDS)
def test_a_brick_program_drives_on_an_open_floor_unless_walls_are_chosen(
    text: str, chosen: dict[str, Any], ground: tuple[bool, bool]
) -> None:
    settings = build_program_settings(parse_program(text, "p.py"), chosen).settings
    world = build_run_spec(settings).world
    assert (world.floor, world.walls) == ground
    assert world.is_open == (ground == OPEN)
