"""What of the plan follows the source of the program: what nobody has chosen."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import pytest

from tests.cases import for_each
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.next_run import NextRun
from tuisim.engine.core.geometry import Pose
from tuisim.programs.program_file import parse_program
from tuisim.programs.program_settings import PROGRAM_PATHS
from tuisim.settings.options import Settings

CLAW = "from ev3dev2.motor import MediumMotor\nMediumMotor('outA').on(5)\n"
LIFT = CLAW.replace("outA", "outD")
USUAL = "from ev3dev2.motor import LargeMotor\nLargeMotor('outB').on(5)\n"
TOUCH = f"{USUAL}from ev3dev2.sensor.lego import TouchSensor\nTouchSensor('in1')\n"
COURSE = "tank_drive.on(5, 5)\n"
PYBRICKS = "from pybricks.ev3devices import Motor\nfrom pybricks.parameters import Port\nMotor(Port.A).run(100)\n"
MAGIC = f"# %%sim_magic\n{CLAW}"

Step = str | Callable[[NextRun], NextRun]


def done(steps: list[Step], free: tuple[str, ...] = PROGRAM_PATHS) -> NextRun:
    """The plan after programs were opened, and changes were made, in turn."""
    plan = plans.build_plan(Settings(), free)
    for step in steps:
        if isinstance(step, str):
            source = parse_program(step, "p.py")
            plan, _ = plans.follow_program(plans.apply_choices(plan, source.options), source)
        else:
            plan = step(plan)
    return plan


def robot(name: str) -> Step:
    return lambda plan: plans.change_robot(plan, name)


def mat(name: str) -> Step:
    return lambda plan: plans.change_mat(plan, name)


# What is done; then the motor ports besides the wheels, the robot's name, and the profile.
WAYS: Mapping[str, tuple[list[Step], tuple[list[str], str, str]]] = {
    "a program": ([CLAW], (["outA"], "Robot of p.py", "ev3")),
    "one for the usual robot": ([CLAW, USUAL], ([], "Default_Robot", "ev3")),
    "one of the course": ([CLAW, COURSE], ([], "Default_Robot", "robolab")),
    "one with a magic line": ([USUAL, MAGIC], (["outA"], "Robot of p.py", "robolab")),
    "a robot chosen before": ([robot("Explorer"), CLAW], (["outA"], "Explorer", "ev3")),
    "a robot chosen after": ([CLAW, robot("Explorer"), LIFT], (["outA"], "Explorer", "ev3")),
    "and the program's again": (
        [CLAW, robot("Explorer"), plans.follow_program_robot, LIFT],
        (["outD"], "Robot of p.py", "ev3"),
    ),
    "a profile chosen": (
        [CLAW, lambda plan: plans.change_profile(plan, "robolab"), LIFT],
        (["outD"], "Robot of p.py", "robolab"),
    ),
    "a mat chosen after": ([CLAW, mat("Loop"), LIFT], (["outD"], "Robot of p.py", "ev3")),
    "an edited robot": (
        [CLAW, lambda plan: plans.edit_robot(plan, plan.robot.spec), LIFT],
        (["outD"], "Robot of p.py", "ev3"),
    ),
    "and back": ([PYBRICKS, LIFT], (["outD"], "Robot of p.py", "ev3")),
    "a fitting profile chosen": (
        [PYBRICKS, lambda plan: plans.change_profile(plan, "pybricks4"), PYBRICKS],
        (["outA"], "Robot of p.py", "pybricks4"),
    ),
    "a profile chosen that does not fit the next one": (
        [CLAW, lambda plan: plans.change_profile(plan, "robolab"), PYBRICKS],
        (["outA"], "Robot of p.py", "lego-micropython"),
    ),
    "the other library on a mat": (
        [mat("Loop"), PYBRICKS],
        (["outA"], "Robot of p.py", "lego-micropython"),
    ),
}


@for_each(way=WAYS)
def test_robot_and_profile_follow_the_program_unless_somebody_chose_them(way: str) -> None:
    steps, expected = WAYS[way]
    spec = done(steps).spec
    assert (
        [motor.port for motor in spec.robot.extra_motors],
        spec.robot.name,
        spec.profile.name,
    ) == expected


PLACES: Mapping[str, tuple[list[Step], tuple[float, float]]] = {
    "a brick's program": ([CLAW], (1181, 571.5)),
    "then one of the course": ([CLAW, COURSE], (100, 800)),
    "a robot that was moved": (
        [CLAW, lambda plan: plans.move_start(plan, Pose(300, 400, 0)), LIFT],
        (300, 400),
    ),
    "a mat with a line": ([CLAW, mat("Loop"), LIFT], (280, 700)),
    "such a mat before": ([mat("Loop"), CLAW], (280, 700)),
    "such a mat, and one of the course": ([CLAW, mat("Loop"), COURSE], (500, 500)),
}


@pytest.mark.parametrize("way", PLACES)
def test_the_start_follows_the_program_until_the_robot_is_moved_or_a_mat_sets_it(way: str) -> None:
    steps, (x_mm, y_mm) = PLACES[way]
    start = done(steps).spec.world.start
    assert (start.x_mm, start.y_mm) == (x_mm, y_mm)


GROUNDS: Mapping[str, tuple[list[Step], tuple[bool, bool]]] = {
    "a brick's program": ([CLAW], (True, False)),
    "then one with a sensor for walls": ([CLAW, TOUCH], (True, True)),
    "then one of the course": ([CLAW, COURSE], (False, True)),
    "a mat": ([CLAW, mat("Loop")], (True, False)),
    "a mat, then another program": ([TOUCH, mat("Loop"), CLAW], (True, False)),
    "walls": ([CLAW, lambda plan: plans.apply_choices(plan, {"walls": True}), LIFT], (True, True)),
    "no walls, then a mat": (
        [TOUCH, lambda plan: plans.apply_choices(plan, {"walls": False}), mat("Loop")],
        (True, False),
    ),
}


@pytest.mark.parametrize("way", GROUNDS)
def test_floor_and_walls_follow_the_program_until_walls_are_chosen(way: str) -> None:
    steps, ground = GROUNDS[way]
    world = done(steps).spec.world
    assert (world.floor, world.walls) == ground


def test_a_program_changes_nothing_that_the_user_has_chosen() -> None:
    spec = done([CLAW], free=()).spec
    assert (spec.robot.name, spec.profile.name, spec.world.start.x_mm) == (
        "Default_Robot",
        "robolab",
        100,
    )


def test_the_robot_for_a_program_is_announced_only_when_it_changes() -> None:
    plan = done([CLAW])
    again, same = plans.follow_program(plan, parse_program(CLAW + "# more\n", "p.py"))
    _, other = plans.follow_program(again, parse_program(LIFT, "p.py"))
    assert (same.said, "outD" in other.said) == ("", True)
