"""Names become specifications: robots, obstacles, mats and switches."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.cases import for_each
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle, RobotSpec
from tuisim.engine.mats import catalogue
from tuisim.engine.obstacles import OBSTACLES
from tuisim.settings.build import build_run_spec, list_ineffective
from tuisim.settings.options import Settings
from tuisim.settings.robots import ROBOTS, RobotChoice
from tuisim.settings.shared_options import parse_words

SHIPPED = {name: mat for name, mat in catalogue().items() if mat.shipped}


@for_each(name=SHIPPED)
def test_on_each_mat_the_robot_starts_where_it_can_turn_between_solid_walls(name: str) -> None:
    spec = build_run_spec(Settings({"background": name, "profile": "ev3"}))
    reach = build_outline(spec.robot).reach_mm
    start = spec.world.start
    mat = SHIPPED[name].start
    assert reach <= start.x_mm <= FIELD_WIDTH_MM - reach
    assert reach <= start.y_mm <= FIELD_HEIGHT_MM - reach
    assert start.heading_deg == mat.heading_deg
    assert build_run_spec(Settings({"background": name})).world.start == mat
    assert (
        build_run_spec(
            Settings({"background": name, "profile": "ev3", "start.x_mm": 90.0})
        ).world.start.x_mm
        == 90.0
    )


def test_default_robot_is_the_default_of_the_specification() -> None:
    assert ROBOTS["Default_Robot"] == RobotSpec()


WEIGHT = "weight has no effect under profile ev3 (only robolab, nbev3devsim)"
MASS = "mass_kg has no effect under profile robolab (only ev3, lego-micropython, pybricks4)"


@pytest.mark.parametrize(
    "robot, profile, sentences",
    [
        (RobotSpec(name="Mine", weight=3), "ev3", [WEIGHT]),
        (RobotSpec(name="Mine", weight=3, mass_kg=2), "robolab", [MASS]),
        (RobotSpec(name="Mine"), "ev3", []),
        (RobotSpec(name="Mine", mass_kg=2, battery_v=7), "pybricks4", []),
        (ROBOTS["Small_Robot"], "ev3", []),
        (replace(ROBOTS["Small_Robot"], weight=6), "ev3", [WEIGHT]),
    ],
)
def test_what_a_profile_does_not_use_of_a_robot_is_named(
    robot: RobotSpec, profile: str, sentences: list[str]
) -> None:
    spec = build_run_spec(Settings({"robot": RobotChoice(robot), "profile": profile}))
    assert list_ineffective(spec) == sentences


@pytest.mark.parametrize(
    "name, boxes",
    [
        ("None", set()),
        ("Central_post", {Obstacle(900, 500, 200, 200)}),
        (
            "Square_posts",
            {
                Obstacle(x, y, 100, 100)
                for x, y in ((500, 200), (500, 700), (1500, 200), (1500, 700))
            },
        ),
        ("Wall", {Obstacle(1500, 200, 200, 800)}),
    ],
    ids=["none", "post", "posts", "wall"],
)
def test_each_built_in_set_of_obstacles_has_its_boxes(name: str, boxes: set[Obstacle]) -> None:
    assert set(OBSTACLES[name]) == boxes


@pytest.mark.parametrize(
    "words, start",
    [
        ("-b Grey_bands", Pose(150, 500, 0)),
        ("-b Grey_bands -x 100", Pose(100, 500, 0)),
        ("-b Grey_bands -y 643", Pose(150, 643, 0)),
        ("-b Grey_bands -a -90", Pose(150, 500, -90)),
        ("-b Lollipop", Pose(750, 375, -180)),
        ("-b Lollipop -a 0 -x 0 -y 0", Pose(0, 0, 0)),
        ("", Pose(100, 800, 0)),
    ],
    ids=lambda value: value or "nothing" if isinstance(value, str) else "",
)
def test_start_pose_is_the_mats_unless_given(words: str, start: Pose) -> None:
    assert build_run_spec(Settings.merge(parse_words(words.split()))).world.start == start


def test_only_the_mat_radial_grey_moves_the_colour_sensors() -> None:
    moved = build_run_spec(Settings({"background": "Radial_grey"})).robot
    assert [sensor.x_mm for sensor in moved.color_sensors] == [-60, 60]
    assert (
        build_run_spec(Settings({"background": "Grey_bands"})).robot.color_sensors
        == RobotSpec().color_sensors
    )


@pytest.mark.parametrize(
    "robot, drift, scale_pc",
    [
        ("Default_Robot", "typical", 2.0),
        ("Prime_Robot", "typical", 0.0),
        ("Prime_Robot", "typical gyro_dps=0", 0.0),
        ("Prime_Robot", "typical gyro_scale_pc=1", 1.0),
        ("Prime_Robot", "gyro_scale_pc=2", 2.0),
    ],
)
def test_the_gyro_of_a_hub_has_no_typical_scale_of_an_ev3(
    robot: str, drift: str, scale_pc: float
) -> None:
    spec = build_run_spec(Settings.merge(parse_words(["-r", robot, "--drift", drift])))
    assert spec.world.drift.gyro_scale_pc == scale_pc
