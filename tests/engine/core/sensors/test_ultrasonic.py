"""Ultrasonic sensor: walls, obstacles, flat angles, range."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.ultrasonic import measure_distance_mm, measure_rays_mm
from tuisim.engine.core.spec import Obstacle, UltrasonicSpec, WorldSpec

SENSOR = UltrasonicSpec()
WALLS = WorldSpec()
POST = WorldSpec(obstacles=(Obstacle(900, 500, 200, 200),))


@pytest.mark.parametrize(
    "heading_deg, expected_mm",
    [
        (0.0, 1342),
        (40.0, 1424),
        (40.1, 720),
        (139.9, 720),
        (140.1, 1041),
        (360.0, 1342),
        (-719.9 + 40.0, 720),
    ],
)
def test_the_ultrasonic_sensor_measures_the_distance_to_each_wall(
    heading_deg: float, expected_mm: int
) -> None:
    assert measure_distance_mm(Pose(1000, 500, heading_deg), SENSOR, WALLS) == expected_mm


@for_rows(
    "pose, world, expected_mm",
    {
        "post in front": (Pose(500, 600, 0), POST, 380),
        "post from the right": (Pose(1400, 600, 180), POST, 280),
        "post from below": (Pose(1000, 300, 90), POST, 180),
        "post from above": (Pose(1000, 1000, -90), POST, 280),
        "past the post": (Pose(500, 1000, 0), POST, 1842),
        "post behind": (Pose(500, 600, 180), POST, 480),
        "no echo": (Pose(500, 500, 0), WorldSpec(walls=False), 2550),
        "post, no walls": (
            Pose(500, 500, 0),
            WorldSpec(walls=False, obstacles=POST.obstacles),
            380,
        ),
        "outside, facing away": (Pose(3000, 500, 0), WALLS, 2550),
    },
)
def test_the_ultrasonic_distance_is_that_to_the_nearest_wall_or_box(
    pose: Pose, world: WorldSpec, expected_mm: int
) -> None:
    assert measure_distance_mm(pose, SENSOR, world) == expected_mm


def test_an_ultrasonic_sensor_reports_at_most_its_range() -> None:
    assert measure_distance_mm(Pose(500, 500, 0), UltrasonicSpec(max_range_mm=1000), WALLS) == 1000


def test_an_ultrasonic_sensor_mounted_backwards_measures_behind_the_robot() -> None:
    assert (
        measure_distance_mm(Pose(1000, 500, 0), UltrasonicSpec(angle_deg=180, y_mm=-20), WALLS)
        == 980
    )


def test_an_ultrasonic_reading_is_the_shortest_of_its_seven_rays() -> None:
    rays = measure_rays_mm(Pose(1000, 500, 30), SENSOR, WALLS)
    assert [angle for angle, _ in rays] == [9, 16, 23, 30, 37, 44, 51]
    assert round(min(length for _, length in rays)) == measure_distance_mm(
        Pose(1000, 500, 30), SENSOR, WALLS
    )
    assert all(0 < length <= 2550 for _, length in rays)
