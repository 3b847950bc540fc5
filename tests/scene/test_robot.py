"""The robot from above."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np
import pytest

from tests.scene.scenes import MIDDLE, ROBOT, WHITE, painter, pixel, spec_of
from tuisim.config.robots import ROBOTS
from tuisim.core.geometry import Pose, world_point
from tuisim.core.outline import outline_of
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, NO_PORT
from tuisim.scene.painter import ScenePainter, SceneState
from tuisim.scene.pen import PenTrace
from tuisim.scene.pictures import world_picture
from tuisim.scene.robot import COLORED, draw_robot, drawn_scale
from tuisim.scene.view import whole_field
from tuisim.terminal.pixels import CellPoints

HERE = Pose(1000.0, 500.0, 0.0)


def near(x_mm: float, y_mm: float, places: Sequence[tuple[float, float]]) -> bool:
    return any(hypot(x_mm - x, y_mm - y) < 20 for x, y in places)


@pytest.mark.parametrize("width", [38, 76, 160, 400])
@pytest.mark.parametrize("heading", [0, 45, 90, 180, -120])
def test_the_marker_shows_the_heading(width: int, heading: int) -> None:
    view = whole_field(width, width)
    picture = np.full((view.height_px, view.width_px, 3), 255, np.uint8)

    draw_robot(picture, view, Pose(1181, 571, heading), outline_of(ROBOT), COLORED)

    yellow = (picture[..., 2] < 120) & (picture[..., 0] > 130)
    blue = (picture[..., 0] < 130) & (picture[..., 2] > 150)
    ahead = np.array([np.cos(np.radians(heading)), -np.sin(np.radians(heading))])
    centre = [np.argwhere(part).mean(axis=0)[::-1] for part in (yellow, blue)]
    assert yellow.sum() >= 3
    assert (centre[0] - centre[1]) @ ahead > 0


def test_a_robot_off_the_picture_is_left_out() -> None:
    picture = np.zeros((20, 40, 3), np.uint8)

    draw_robot(picture, whole_field(40, 20), Pose(9000, -9000, 0), outline_of(ROBOT), COLORED)

    assert not picture.any()


@pytest.mark.parametrize("heading", [0, 30, 45, 70])
@pytest.mark.parametrize("rows", [2, 3, 4], ids=["quadrants", "sextants", "octants"])
def test_the_nose_of_a_small_robot_fills_a_third_of_a_cell(rows: int, heading: int) -> None:
    view = whole_field(100, 20 * rows, CellPoints(2, rows))
    picture = painter().paint(view, SceneState(ROBOT, Pose(1181.0, 571.0, heading)))

    row, col = np.indices(picture.shape[:2]) + 0.5
    east, north = (
        view.left_mm + col * view.mm_per_px - 1181,
        view.top_mm - row * view.mm_per_row - 571,
    )
    angle, outline = math.radians(heading), outline_of(ROBOT)
    ahead = (east * math.cos(angle) + north * math.sin(angle)) / drawn_scale(
        outline, view
    ) > outline.front_mm
    yellow = (255 - picture[..., 2].astype(float))[ahead & (picture[..., 0] > 180)] / 255
    assert yellow.sum() >= 2 * rows / 3


@pytest.mark.parametrize("coarse", [False, True])
def test_a_robot_without_details_has_no_sensors_on_its_marker(coarse: bool) -> None:
    view = whole_field(100, 80, CellPoints(2, 4))
    picture = ScenePainter(WHITE, (9, 9, 9), PenTrace(), coarse=coarse).paint(
        view, SceneState(ROBOT, HERE)
    )

    red, green, blue = picture.reshape(-1, 3).astype(int).T
    assert coarse is not bool(
        ((red > 220) & (green < 190) & (abs(green - blue) < 90) & (blue > 30)).any()
    )


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_is_filled_and_has_all_its_parts(robot: str) -> None:
    spec = spec_of(robot)
    outline, picture = outline_of(spec.robot), world_picture(spec, WHITE, MIDDLE)
    wheel_mm = outline.half_width_mm - outline.wheel_width_mm / 2
    parts = {
        COLORED.body: [
            (side * 0.7 * (wheel_mm - outline.wheel_width_mm / 2), 0.0) for side in (-1, 1)
        ],
        COLORED.wheel: [(-wheel_mm, 0.0), (wheel_mm, 0.0)],
        COLORED.marker: [(0.0, outline.back_mm / 3), (0.0, outline.back_mm / 9)],
        # Another sensor in the same place lies on top of an eye.
        COLORED.sensor: [
            (x, y)
            for x, y, radius in outline.color_sensors_mm
            if radius > 5 and not near(x, y, outline.other_sensors_mm)
        ],
    }
    for color, places in parts.items():
        for place in places:
            found = pixel(picture, spec.robot, world_point(MIDDLE, *place))
            assert np.abs(np.subtract(found, color)).max() < 60, (color, place)


def test_an_eye_is_drawn_at_its_side_only() -> None:
    spec = spec_of()
    robot = replace(spec.robot, color_sensors=spec.robot.color_sensors[:1])
    ((x_mm, y_mm, _),) = outline_of(robot).color_sensors_mm
    picture = world_picture(replace(spec, robot=robot), WHITE, MIDDLE)
    drawn = [pixel(picture, robot, world_point(MIDDLE, side, y_mm)) for side in (x_mm, -x_mm)]
    assert [bool(np.abs(np.subtract(color, COLORED.sensor)).max() < 60) for color in drawn] == [
        True,
        False,
    ]


def test_a_robot_without_wheels_is_drawn_without_them() -> None:
    spec = spec_of()
    standing = replace(spec, robot=replace(spec.robot, left_port=NO_PORT, right_port=NO_PORT))
    outline = outline_of(spec.robot)
    place = world_point(MIDDLE, outline.half_width_mm - outline.wheel_width_mm / 2, 0.0)
    drawn = [pixel(world_picture(one, WHITE, MIDDLE), one.robot, place) for one in (spec, standing)]
    assert [bool(np.abs(np.subtract(color, COLORED.wheel)).max() < 60) for color in drawn] == [
        True,
        False,
    ]


@pytest.mark.parametrize("heading", [0, 90])
def test_the_robot_is_drawn_as_large_as_what_collides(heading: int) -> None:
    # Bumpers are pressed before anything collides.
    outline = outline_of(replace(spec_of("Small_Robot").robot, touch_sensors=()))
    view, picture = whole_field(FIELD_WIDTH_MM, FIELD_HEIGHT_MM), np.zeros_like(WHITE)
    pose = replace(MIDDLE, heading_deg=float(heading))

    draw_robot(picture, view, pose, outline, COLORED)

    rows, cols = np.nonzero(picture.any(axis=2))
    corners = np.array([view.to_px(*world_point(pose, *corner)) for corner in outline.corners_mm])
    assert [cols.min(), rows.min()] == pytest.approx(corners.min(axis=0), abs=1)
    assert [cols.max() + 1, rows.max() + 1] == pytest.approx(corners.max(axis=0), abs=1)
