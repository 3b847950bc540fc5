"""What an infrared sensor measures: surfaces, a beacon, and the remote control."""

from __future__ import annotations

import pytest

from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.remote_spec import BeaconSpec, RemotePress
from tuisim.engine.core.sensors.infrared import compute_remote_bits, proximity, remote, seek
from tuisim.engine.core.spec import InfraredSpec, Obstacle, WorldSpec

EYE = InfraredSpec(x_mm=0, y_mm=50)


@pytest.mark.parametrize(
    ("x_mm", "y_mm", "heading_deg", "percent"),
    [
        (600, 550, 0, 50),
        (880, 550, 0, 10),
        (250, 550, 0, 100),
        (600, 400, 0, 100),
        (1500, 550, 180, 50),
        (1050, 170, 90, 40),
        # The outermost ray meets the box, and is longer than the others would be.
        (600, 450, 0, 51),
    ],
)
def test_an_infrared_sensor_reads_the_nearest_surface_ahead(
    x_mm: float, y_mm: float, heading_deg: float, percent: int
) -> None:
    world = WorldSpec(obstacles=(Obstacle(1000, 500, 100, 100),), walls=False)
    assert proximity(Pose(x_mm, y_mm, heading_deg), EYE, world) == percent


@pytest.mark.parametrize(
    ("x_mm", "y_mm", "found"),
    [
        (1450, 500, (0, 50)),
        (450, 1500, (-22, 50)),
        (450, 100, (22, 20)),
        (50, 500, (0, -128)),
        (2460, 500, (0, -128)),
        (750, 500, (0, 15)),
    ],
    ids=["ahead", "left", "right", "behind", "too far", "near"],
)
def test_a_beacon_is_seen_on_its_channel(x_mm: float, y_mm: float, found: tuple[int, int]) -> None:
    world = WorldSpec(walls=False, beacon=BeaconSpec(x_mm, y_mm, 3))
    seen = seek(Pose(400, 500, 0), EYE, world)
    assert seen == (0, -128, 0, -128, *found, 0, -128)
    assert seek(Pose(400, 500, 0), EYE, WorldSpec()) == (0, -128) * 4
    hidden = WorldSpec(walls=False, beacon=world.beacon, obstacles=(Obstacle(440, 400, 300, 300),))
    assert seek(Pose(400, 500, 0), EYE, hidden) == (0, -128) * 4


def test_the_later_of_two_overlapping_presses_of_the_remote_counts() -> None:
    world = WorldSpec(
        remote=(
            RemotePress(("top_left",), 1.0, 3.0),
            RemotePress(("top_left", "bottom_right"), 2.0, 4.0),
            RemotePress(("bottom_left",), 2.0, 4.0, 4),
        )
    )
    times_s = (0.9, 1.0, 1.9, 2.0, 3.9, 4.0)
    assert [remote(time_s, world) for time_s in times_s] == [
        (0, 0, 0, 0),
        (1, 0, 0, 0),
        (1, 0, 0, 0),
        (6, 0, 0, 2),
        (6, 0, 0, 2),
        (0, 0, 0, 0),
    ]
    assert [compute_remote_bits(time_s, world) for time_s in times_s] == [
        262,
        278,
        278,
        406,
        406,
        262,
    ]
