"""The robot from above."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot

import numpy as np
import pytest

from tests.pictures.scene.scenes import MIDDLE, ROBOT, WHITE, pixel, spec_of
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, NO_PORT
from tuisim.pictures.scene.pictures import draw_world
from tuisim.pictures.scene.robot import COLORED, draw_robot
from tuisim.pictures.scene.view import fit_field
from tuisim.settings.robots import ROBOTS


def near(x_mm: float, y_mm: float, places: Sequence[tuple[float, float]]) -> bool:
    return any(hypot(x_mm - x, y_mm - y) < 20 for x, y in places)


def test_drawing_a_robot_outside_the_picture_draws_nothing() -> None:
    picture = np.zeros((20, 40, 3), np.uint8)

    draw_robot(picture, fit_field(40, 20), Pose(9000, -9000, 0), build_outline(ROBOT), COLORED)

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
    view = fit_field(FIELD_WIDTH_MM, FIELD_HEIGHT_MM)
    picture = np.zeros_like(WHITE)
    pose = replace(MIDDLE, heading_deg=float(heading))

    draw_robot(picture, view, pose, outline, COLORED)

    rows, cols = np.nonzero(picture.any(axis=2))
    corners = np.array([view.to_px(*world_point(pose, *corner)) for corner in outline.corners_mm])
    assert [cols.min(), rows.min()] == pytest.approx(corners.min(axis=0), abs=1)
    assert [cols.max() + 1, rows.max() + 1] == pytest.approx(corners.max(axis=0), abs=1)
