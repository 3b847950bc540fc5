"""What presses a bumper."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors.touch import pressed
from tuisim.engine.core.spec import Obstacle, TouchSpec, WorldSpec

BOX = Obstacle(1000, 500, 100, 100)
BUMPER = TouchSpec(x_mm=10, y_mm=50, width_mm=40)


@for_rows(
    "x_mm, y_mm, heading_deg, walls, is_pressed",
    [
        (947, 560, 0, False, False),
        (949, 560, 0, False, True),
        (1153, 560, 180, False, False),
        (1151, 560, 180, False, True),
        (1040, 447, 90, False, False),
        (1040, 449, 90, False, True),
        (1040, 653, -90, False, False),
        (1040, 651, -90, False, True),
        # With the right end, the middle and the left end of the bumper.
        (949, 631, 0, False, True),
        (949, 633, 0, False, False),
        (949, 489, 0, False, True),
        (949, 487, 0, False, False),
        (53, 300, 180, True, False),
        (51, 300, 180, True, True),
        (51, 300, 180, False, False),
        (2309, 300, 0, True, False),
        (2311, 300, 0, True, True),
        (300, 53, -90, True, False),
        (300, 51, -90, True, True),
        (300, 1090, 90, True, False),
        (300, 1092, 90, True, True),
    ],
)
def test_a_bumper_is_pressed_within_2_mm_of_a_wall_or_box(
    x_mm: float, y_mm: float, heading_deg: float, walls: bool, is_pressed: bool
) -> None:
    world = WorldSpec(obstacles=(BOX,), walls=walls)
    assert pressed(Pose(x_mm, y_mm, heading_deg), BUMPER, world) == is_pressed
