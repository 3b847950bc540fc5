"""Names become specifications: robots, obstacles, mats and switches."""

from __future__ import annotations

import pytest

from tuisim.config.build import build_run_spec
from tuisim.config.mats import catalogue
from tuisim.config.obstacles import OBSTACLES
from tuisim.config.options import Settings, settings_of
from tuisim.config.robots import ROBOTS
from tuisim.config.shared_options import parse_words
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle, RobotSpec
from tuisim.core.tree import from_plain, to_plain
from tuisim.errors import BackgroundError, ConfigError, ObstacleError, ProfileError, RobotError

SHIPPED = {name: mat for name, mat in catalogue().items() if mat.shipped}


@pytest.mark.parametrize("name", SHIPPED)
def test_the_robot_starts_where_solid_walls_let_it_turn(name: str) -> None:
    spec = build_run_spec(Settings({"background": name, "profile": "ev3"}))
    reach, start, mat = outline_of(spec.robot).reach_mm, spec.world.start, SHIPPED[name].start
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


@pytest.mark.parametrize(
    "name, wheel_mm, spacing_mm, back_mm, weight, sensors, ultrasonic_y_mm",
    [
        ("Default_Robot", 56, 180, -120, 6, [(-20, 30, 20), (20, 30, 20)], 20),
        ("Small_Robot", 28, 90, -60, 0, [(-10, 15, 10), (10, 15, 10)], 10),
        ("Small_Robot_Wide_Eyes", 28, 90, -60, 0, [(-30, 15, 10), (30, 15, 10)], 10),
        ("Sensor_Diameter_Config", 56, 180, -120, 6, [(-20, 30, 30), (20, 30, 10)], 20),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_robots(
    name: str,
    wheel_mm: float,
    spacing_mm: float,
    back_mm: float,
    weight: float,
    sensors: list[tuple[float, float, int]],
    ultrasonic_y_mm: float,
) -> None:
    robot = ROBOTS[name]
    shape = (robot.wheel_diameter_mm, robot.wheel_spacing_mm, robot.back_mm, robot.weight)
    assert shape == (wheel_mm, spacing_mm, back_mm, weight)
    assert [(s.x_mm, s.y_mm, s.diameter_mm) for s in robot.color_sensors] == sensors
    assert [(s.name, s.port) for s in robot.color_sensors] == [("left", "in2"), ("right", "in3")]
    assert robot.ultrasonic is not None
    assert robot.ultrasonic.y_mm == ultrasonic_y_mm


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
def test_obstacles(name: str, boxes: set[Obstacle]) -> None:
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
    assert build_run_spec(settings_of(parse_words(words.split()))).world.start == start


def test_sensors_are_moved_on_the_mat_that_wants_it_and_nowhere_else() -> None:
    moved = build_run_spec(Settings({"background": "Radial_grey"})).robot
    assert [sensor.x_mm for sensor in moved.color_sensors] == [-60, 60]
    assert (
        build_run_spec(Settings({"background": "Grey_bands"})).robot.color_sensors
        == RobotSpec().color_sensors
    )


@pytest.mark.parametrize("name", SHIPPED)
def test_every_mat_makes_a_run_that_survives_its_plain_form(name: str) -> None:
    spec = build_run_spec(
        Settings(
            {"background": name, "seed": 7, "noise.light": 20, "noise.motor": 50, "pen.down": True}
        )
    )
    assert from_plain(to_plain(spec)) == spec
    assert (spec.world.background, spec.seed, spec.robot.pen.down) == (name, 7, True)
    assert (spec.world.noise.light, spec.world.noise.motor) == (20, 50)


@pytest.mark.parametrize(
    "settings, error, said",
    [
        (Settings({"background": "Grey_band"}), BackgroundError, "Grey_bands"),
        (Settings({"background": "qqqq"}), BackgroundError, "Empty_Map"),
        (Settings({"robot": "small_robot"}), RobotError, "Small_Robot"),
        (Settings({"obstacles": "Post"}), ObstacleError, "Central_post"),
        (Settings({"profile": "robolap"}), ProfileError, "robolab"),
    ],
    ids=["near mat", "far mat", "robot", "obstacles", "profile"],
)
def test_unknown_names_say_what_there_is(
    settings: Settings, error: type[ConfigError], said: str
) -> None:
    with pytest.raises(error, match=said):
        build_run_spec(settings)
