"""Drags that move the robot."""

from __future__ import annotations

import pytest

from tuisim.app.panels.pose_grip import PoseGrip
from tuisim.engine.core.geometry import Pose

START = Pose(1000.0, 500.0, 30.0)


@pytest.mark.parametrize(
    ("on_floor", "to_mm", "at_mm"),
    [
        (False, (3000.4, 700.0), (2362.0, 690.0)),
        (False, (-500.0, -80.0), (0.0, 0.0)),
        (True, (3000.4, 700.0), (2990.0, 690.0)),
        (True, (-500.0, -80.0), (-510.0, -90.0)),
        (True, (1e6, -1e6), (10_000.0, -10_000.0)),
    ],
)
def test_a_drag_ends_at_the_edge_of_the_field_but_on_a_floor(
    on_floor: bool, to_mm: tuple[float, float], at_mm: tuple[float, float]
) -> None:
    grip = PoseGrip(START, 1010.0, 510.0, turns=False, on_floor=on_floor)
    assert grip.drag_pose(*to_mm) == Pose(*at_mm, 30.0)


def test_a_drag_that_turns_the_robot_does_not_move_it() -> None:
    grip = PoseGrip(START, 1100.0, 500.0, turns=True, on_floor=True)
    assert grip.drag_pose(1000.0, 900.0) == Pose(1000.0, 500.0, 120.0)
