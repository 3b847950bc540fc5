"""The plan of the next run: what a mat, a preset or a file decides goes with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from tests.cases import cases, for_rows
from tuisim.app.setup import next_run as plans
from tuisim.app.setup.fields import find
from tuisim.app.setup.next_run import NextRun, build_plan, edit_robot, plan_spec
from tuisim.base.errors import ConfigError
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import NO_PORT, NoiseSpec, Obstacle, RobotSpec
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.robots import ROBOTS, RobotChoice, save_robot

BOX = (Obstacle(1, 2, 3, 4),)


def sensor_xs_mm(plan: NextRun) -> list[float]:
    return [sensor.x_mm for sensor in plan.spec.robot.color_sensors]


def edited(plan: NextRun, field: str, text: str) -> NextRun:
    edit = find(plan, field)
    assert edit is not None
    return edit.write(plan, text)


def test_a_value_without_effect_is_told_when_it_is_chosen_and_not_again() -> None:
    plan = build_plan(Settings())
    light = edit_robot(plan, replace(plan.spec.robot, weight=3.0))
    under_ev3 = plans.change_profile(light, "ev3")
    (text,) = plans.list_notes(light, under_ev3)
    assert text.startswith("weight has no effect under profile ev3")
    assert plans.list_notes(plan, light) == plans.list_notes(under_ev3, under_ev3) == []


# What is done after starting on Grey_bands, and where the sensors are then.
WAYS: dict[str, tuple[list[Callable[[NextRun], NextRun]], list[float]]] = {
    "a mat moves the sensors": ([lambda p: plans.change_mat(p, "Radial_grey")], [-60, 60]),
    "and they go back": (
        [lambda p: plans.change_mat(p, "Radial_grey"), lambda p: plans.change_mat(p, "Loop")],
        [-20, 20],
    ),
    "another preset meanwhile": (
        [
            lambda p: plans.change_mat(p, "Radial_grey"),
            lambda p: plans.change_robot(p, "Small_Robot"),
            lambda p: plans.change_mat(p, "Loop"),
        ],
        [-10, 10],
    ),
    "an edit of another field": (
        [
            lambda p: plans.change_mat(p, "Radial_grey"),
            lambda p: edited(p, "wheel_diameter_mm", "40"),
            lambda p: plans.change_mat(p, "Loop"),
        ],
        [-20, 20],
    ),
    "a sensor that was placed there stays": (
        [
            lambda p: plans.change_mat(p, "Radial_grey"),
            lambda p: edited(p, "left.x_mm", "-33"),
            lambda p: plans.change_mat(p, "Loop"),
        ],
        [-33, 60],
    ),
    "until the robot is reset": (
        [
            lambda p: plans.change_mat(p, "Radial_grey"),
            lambda p: edited(p, "left.x_mm", "-33"),
            lambda p: plans.change_mat(p, "Loop"),
            plans.undo_robot_edits,
        ],
        [-20, 20],
    ),
}


@cases("steps, expected", WAYS)
def test_sensor_positions_of_one_mat_or_robot_are_not_kept_for_the_next(
    steps: list[Callable[[NextRun], NextRun]], expected: list[float]
) -> None:
    plan = build_plan(Settings({"background": "Grey_bands"}))
    for step in steps:
        plan = step(plan)
    assert sensor_xs_mm(plan) == expected


@pytest.mark.parametrize("name", list(ROBOTS))
def test_choosing_a_preset_robot_and_the_default_again_restores_the_run(name: str) -> None:
    plan = plans.change_robot(build_plan(Settings()), name)
    assert plan.spec.robot == ROBOTS[name]
    assert plans.change_robot(plan, "Default_Robot").spec == build_plan(Settings()).spec


def test_changing_the_mat_sets_its_obstacles_start_and_fit() -> None:
    plan = plans.change_obstacles(build_plan(Settings({"background_fit": "fit"})), BOX)
    plan = plans.move_start(plan, Pose(7, 8, 9))
    assert plans.change_mat(plan, "Obstacles_Test").spec == build_run_spec(
        Settings({"background": "Obstacles_Test"})
    )


def test_changing_the_profile_resets_whether_walls_are_solid() -> None:
    plan = plans.change_values(build_plan(Settings()), {"solid": True})
    assert plans.change_profile(plan, "nbev3devsim").spec.world.solid is False
    assert plans.change_profile(plan, "ev3").spec.world.solid is True


@pytest.mark.parametrize(
    "change",
    [
        lambda plan: plans.move_start(plan, Pose(7, 8, 9)),
        lambda plan: plans.change_noise(plan, NoiseSpec(3, 4)),
        lambda plan: plans.change_seed(plan, 99),
        lambda plan: plans.change_pen(plan, True),
        lambda plan: plans.change_obstacles(plan, BOX),
    ],
    ids=["pose", "noise", "seed", "pen", "obstacles"],
)
def test_a_quick_change_of_the_next_run_equals_building_it_from_its_settings(
    change: Callable[[NextRun], NextRun],
) -> None:
    plan = change(build_plan(Settings({"background": "Radial_grey", "noise.light": 1})))
    assert plan.spec == build_run_spec(plan.settings)


def test_a_robot_files_motor_noise_applies_until_the_user_sets_another(tmp_path: Path) -> None:
    (tmp_path / "old.json").write_text('{"wheelNoise": 12}')
    plan = plans.change_robot(build_plan(Settings()), str(tmp_path / "old.json"))
    assert plan.spec.world.noise.motor == 12
    lit = plans.change_noise(plan, NoiseSpec(5, 12))
    assert plans.change_robot(lit, "Small_Robot").spec.world.noise == NoiseSpec(5, 0)
    loud = plans.change_noise(plan, NoiseSpec(0, 80))
    assert plans.change_robot(loud, "Small_Robot").spec.world.noise.motor == 80


def test_changing_the_mat_does_not_read_the_robots_file_again(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text("wheel_diameter_mm = 77\n")
    plan = plans.change_robot(build_plan(Settings()), str(path))
    path.write_text("wheel_diameter_mm = 'oops'\n")
    assert plans.change_mat(plan, "Loop").spec.robot.wheel_diameter_mm == 77


def test_a_robot_is_saved_without_the_changes_that_the_mat_made(tmp_path: Path) -> None:
    plan = plans.change_mat(build_plan(Settings({"pen.color": "teal"})), "Radial_grey")
    save_robot(plans.build_saved_robot(plan), tmp_path / "mine.toml")
    saved = RobotChoice.load(str(tmp_path / "mine.toml")).spec
    assert saved == replace(RobotSpec(), pen=replace(RobotSpec().pen, color="teal"))


def test_a_plan_can_be_made_from_a_run_without_its_settings() -> None:
    spec = build_run_spec(
        Settings({"background": "Radial_grey", "start.x_mm": 5, "noise.light": 3})
    )
    plan = plan_spec(spec)
    assert plan.spec == spec
    assert sensor_xs_mm(plans.change_mat(plan, "Loop")) == [-20, 20]


# Field, what is typed, and what is said.
WRONG = [
    ("wheel_diameter_mm", "abc", "must be a number from 1 to 500, got 'abc'"),
    (
        "weight",
        "fat",
        "must be weightless, light, medium, heavy, or a number from 0 to 1000, got 'fat'",
    ),
    ("name", "  ", "must be one line of 1 to 100 characters"),
    ("left.diameter_mm", "7.5", "must be a whole number from 2 to 100, got '7.5'"),
    ("ultrasonic.ray_angles_deg", "0 up", "must be 1 to 100 numbers from -360 to 360, got '0 up'"),
    ("pen.color", "reddish", "no such colour 'reddish'"),
]


@pytest.mark.parametrize("field, typed, said", WRONG, ids=[f"{f} {t!r}" for f, t, _ in WRONG])
def test_a_wrong_value_in_the_settings_form_is_refused_with_the_reason(
    field: str, typed: str, said: str
) -> None:
    from tuisim.app.form import format_error

    with pytest.raises(ConfigError) as caught:
        edited(build_plan(Settings()), field, typed)
    assert format_error(caught.value).startswith(said)


def test_a_robot_without_wheels_gets_none_in_the_form() -> None:
    standing = replace(ROBOTS["Default_Robot"], left_port=NO_PORT, right_port=NO_PORT)
    with pytest.raises(ConfigError, match="has no wheels"):
        edited(edit_robot(build_plan(Settings()), standing), "left_port", "outA")


# Field, what is entered, and what the specification says then.
RIGHT: list[tuple[str, str, Callable[[NextRun], object], object]] = [
    ("preset", "Small_Robot", lambda p: p.spec.robot, ROBOTS["Small_Robot"]),
    ("name", " Robbie ", lambda p: p.spec.robot.name, "Robbie"),
    ("wheel_spacing_mm", "90,5", lambda p: p.spec.robot.wheel_spacing_mm, 90.5),
    ("weight", "Heavy", lambda p: p.spec.robot.weight, 9),
    (
        "left_port",
        "outD",
        lambda p: (p.spec.robot.left_port, p.spec.robot.right_port),
        ("outD", "outC"),
    ),
    (
        "left_port",
        "outC",
        lambda p: (p.spec.robot.left_port, p.spec.robot.right_port),
        ("outC", "outB"),
    ),
    (
        "left.port",
        "in4",
        lambda p: [s.port for s in p.spec.robot.sensors],
        ["in4", "in3", "in1", "in2"],
    ),
    ("right.strategy", "centre", lambda p: p.spec.robot.color_sensors[1].strategy, "centre"),
    ("left.used", "off", lambda p: [s.name for s in p.spec.robot.color_sensors], ["right"]),
    ("ultrasonic.used", "off", lambda p: p.spec.robot.ultrasonic, None),
    (
        "ultrasonic.ray_angles_deg",
        "-5, 0 5",
        lambda p: p.spec.robot.ultrasonic and p.spec.robot.ultrasonic.ray_angles_deg,
        (-5, 0, 5),
    ),
    ("pen.color", "Teal", lambda p: p.spec.robot.pen.color, "teal"),
    ("pen.down", "on", lambda p: p.spec.robot.pen.down, True),
    ("pen_marks", "on", lambda p: p.spec.world.pen_marks, True),
    ("profile", "ev3", lambda p: p.spec.profile.name, "ev3"),
    ("solid", "on", lambda p: p.spec.world.solid, True),
    ("background_fit", "centre", lambda p: p.spec.world.background_fit, "centre"),
]


@for_rows("field, entered, look, expected", RIGHT)
def test_a_right_value_in_the_settings_form_changes_the_plan(
    field: str, entered: str, look: Callable[[NextRun], object], expected: object
) -> None:
    plan = edited(build_plan(Settings()), field, entered)
    assert look(plan) == expected
    again = find(plan, field)
    assert again is not None
    assert edited(plan, field, again.read(plan)).spec == plan.spec or field == "preset"


def test_a_sensor_switched_off_comes_back_as_it_was() -> None:
    first = build_plan(Settings())
    for field in ("left.used", "ultrasonic.used", "gyro.used"):
        off = edited(first, field, "off")
        assert off.spec != first.spec
        assert edited(off, field, "on").spec == first.spec


def test_labels_of_the_settings_form_fit_beside_their_fields() -> None:
    from tuisim.app.setup.fields import MAX_LABEL, build_sections

    for section in build_sections(build_plan(Settings())):
        for edit in section.edits:
            assert len(edit.label) <= MAX_LABEL
            if edit.choices and edit.id != "preset":
                assert edit.read(build_plan(Settings())) in edit.choices
