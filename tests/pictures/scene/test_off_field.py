"""A robot off the field is told, and an arrow points to it."""

from __future__ import annotations

import numpy as np
import pytest

from tuisim.engine.core.geometry import Pose
from tuisim.pictures.scene.off_field import describe_off_field, draw_arrow
from tuisim.pictures.scene.view import Viewport


@pytest.mark.parametrize(
    "pose, words",
    [
        (Pose(0.0, 1143.0, 0.0), ""),
        (Pose(-2133.4, 500.0, 0.0), "robot off the mat: 2133 mm to the left"),
        (Pose(2400.0, -30.0, 0.0), "robot off the mat: 38 mm to the right, 30 mm below"),
    ],
)
def test_words_say_on_which_side_the_robot_left_the_field(pose: Pose, words: str) -> None:
    assert describe_off_field(pose) == words


@pytest.mark.parametrize(
    "pose, width, words",
    [
        (Pose(8825.0, 500.0, 0.0), 33, "robot off the mat: 6463 mm right"),
        (Pose(8825.0, 500.0, 0.0), 30, "off the mat: 6463 mm right"),
        (Pose(8825.0, -30.0, 0.0), 33, "6463 mm right, 30 mm below"),
    ],
)
def test_the_side_is_told_in_a_narrow_panel_too(pose: Pose, width: int, words: str) -> None:
    assert describe_off_field(pose, width) == words


@pytest.mark.parametrize(
    "pose", [Pose(-2000.0, 500.0, 0.0), Pose(500.0, 9000.0, 0.0), Pose(9000.0, -9000.0, 0.0)]
)
def test_the_arrow_to_a_robot_out_of_view_is_at_the_edge_towards_it(pose: Pose) -> None:
    view = Viewport.fit_field(80, 40)
    picture = np.zeros((40, 80, 3), np.uint8)
    draw_arrow(picture, view, pose, 5.0, (255, 255, 255))
    rows, cols = np.nonzero(picture[..., 0])
    assert 0 < len(rows) < 40
    touched = (cols.min() == 0, cols.max() == 79, rows.min() == 0, rows.max() == 39)
    assert touched == (pose.x_mm < 0, pose.x_mm > 2362, pose.y_mm > 1143, pose.y_mm < 0)


def test_no_arrow_points_to_a_robot_in_view() -> None:
    picture = np.zeros((40, 80, 3), np.uint8)
    draw_arrow(picture, Viewport.fit_field(80, 40), Pose(-60.0, 500.0, 0.0), 5.0, (255, 255, 255))
    assert not picture.any()
