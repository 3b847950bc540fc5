"""The robot from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np
import pytest
from PIL import Image, ImageDraw

from tests.cases import for_each
from tests.pictures.scene.scenes import MIDDLE, ROBOT, WHITE, pixel, spec_of
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, NO_PORT
from tuisim.pictures.scene.pictures import draw_world
from tuisim.pictures.scene.robot import COLORED, GHOST, draw_robot
from tuisim.pictures.scene.view import Viewport
from tuisim.settings.robots import ROBOTS
from tuisim.terminal.pixels import CellPoints


def near(x_mm: float, y_mm: float, places: Sequence[tuple[float, float]]) -> bool:
    return any(hypot(x_mm - x, y_mm - y) < 20 for x, y in places)


def test_drawing_a_robot_outside_the_picture_draws_nothing() -> None:
    picture = np.zeros((20, 40, 3), np.uint8)

    draw_robot(
        picture, Viewport.fit_field(40, 20), Pose(9000, -9000, 0), build_outline(ROBOT), COLORED
    )

    assert not picture.any()


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_is_filled_and_has_all_its_parts(robot: str) -> None:
    spec = spec_of(robot)
    outline = build_outline(spec.robot)
    picture = draw_world(spec, WHITE, MIDDLE)
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


def test_a_robot_without_wheels_is_drawn_without_them() -> None:
    spec = spec_of()
    standing = replace(spec, robot=replace(spec.robot, left_port=NO_PORT, right_port=NO_PORT))
    outline = build_outline(spec.robot)
    place = world_point(MIDDLE, outline.half_width_mm - outline.wheel_width_mm / 2, 0.0)
    drawn = [pixel(draw_world(one, WHITE, MIDDLE), one.robot, place) for one in (spec, standing)]
    assert [bool(np.abs(np.subtract(color, COLORED.wheel)).max() < 60) for color in drawn] == [
        True,
        False,
    ]


@pytest.mark.parametrize("heading", [0, 90])
def test_the_robot_is_drawn_as_large_as_what_collides(heading: int) -> None:
    # Bumpers are pressed before anything collides.
    outline = build_outline(replace(spec_of("Small_Robot").robot, touch_sensors=()))
    view = Viewport.fit_field(FIELD_WIDTH_MM, FIELD_HEIGHT_MM)
    picture = np.zeros_like(WHITE)
    pose = replace(MIDDLE, heading_deg=float(heading))

    draw_robot(picture, view, pose, outline, COLORED)

    rows, cols = np.nonzero(picture.any(axis=2))
    corners = np.array([view.to_px(*world_point(pose, *corner)) for corner in outline.corners_mm])
    assert [cols.min(), rows.min()] == pytest.approx(corners.min(axis=0), abs=1)
    assert [cols.max() + 1, rows.max() + 1] == pytest.approx(corners.max(axis=0), abs=1)


@for_each(cell=[CellPoints(1, 2), CellPoints(2, 2), CellPoints(2, 4)], heading=range(0, 360, 19))
def test_the_marker_of_a_small_robot_points_where_the_robot_heads(
    cell: CellPoints, heading: int
) -> None:
    pose = Pose(1200, 570, float(heading))
    view = Viewport.fit_field(58 * cell.cols, 15 * cell.rows, cell)
    picture = np.zeros((view.height_px, view.width_px, 3), np.uint8)

    draw_robot(picture, view, pose, build_outline(ROBOT), COLORED)

    robot, marker = picture.any(axis=2), (picture == COLORED.marker).all(axis=2)
    (row, col), (tip_row, tip_col) = (np.argwhere(part).mean(axis=0) for part in (robot, marker))
    aspect = view.mm_per_row / view.mm_per_px
    shown_deg = degrees(atan2((row - tip_row) * aspect, tip_col - col))
    assert abs((shown_deg - heading + 180) % 360 - 180) < 30
    assert (picture == COLORED.wheel).all(axis=2).sum() >= 4 * cell.cols


@pytest.mark.parametrize("cell", [CellPoints(1, 2), CellPoints(2, 2), CellPoints(2, 4)])
@pytest.mark.parametrize("cols", [37, 78, 118, 156, 198])
def test_the_nose_of_a_robot_of_few_pixels_is_in_front_of_all_else(
    cell: CellPoints, cols: int
) -> None:
    view = Viewport.fit_field(cols * cell.cols, cols // 4 * cell.rows, cell)
    for heading in range(0, 360, 15):
        picture = np.zeros((view.height_px, view.width_px, 3), np.uint8)

        draw_robot(picture, view, Pose(1200, 570, float(heading)), build_outline(ROBOT), COLORED)

        rows, cols_px = np.nonzero(picture.any(axis=2))
        ahead = cols_px * view.mm_per_px * cos(radians(heading))
        ahead -= rows * view.mm_per_row * sin(radians(heading))
        front = ahead >= ahead.max() - view.mm_per_row
        marker = (picture[rows, cols_px] == COLORED.marker).all(axis=1)
        assert marker[front].mean() >= 0.5, heading


@for_each(cols=[58, 118, 198], heading=range(0, 360, 19))
def test_the_outline_of_the_robot_now_has_no_gap(cols: int, heading: int) -> None:
    view = Viewport.fit_field(2 * cols, cols, CellPoints(2, 2))
    picture = np.zeros((view.height_px, view.width_px, 3), np.uint8)

    draw_robot(picture, view, Pose(1200, 570, float(heading)), build_outline(ROBOT), GHOST)

    image = Image.fromarray(picture.any(axis=2).astype(np.uint8))
    ImageDraw.floodfill(image, (0, 0), 2)
    assert (np.asarray(image) == 0).any(), "the ground flows into the outline"
