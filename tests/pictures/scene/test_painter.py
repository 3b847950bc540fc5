"""The world's picture: robot, trace, rays, obstacles, ghost."""

from __future__ import annotations

from dataclasses import replace
from zlib import crc32

import numpy as np
import pytest

from tests.pictures.scene.scenes import ROBOT, VIEW, at, painter
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.remote_spec import BeaconSpec
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    InfraredSpec,
    Obstacle,
    RobotSpec,
    TouchSpec,
)
from tuisim.pictures.scene.painter import (
    BEACON_CORE_RGB,
    BEACON_RGB,
    Faint,
    ScenePainter,
    SceneState,
)
from tuisim.pictures.scene.pen import PenTrace, Piece
from tuisim.pictures.scene.robot import COLORED
from tuisim.pictures.scene.view import Viewport
from tuisim.terminal.pixels import CellPoints, Pixels

HERE = Pose(1000.0, 500.0, 0.0)


def test_rays_end_at_their_length_and_at_the_field() -> None:
    scene = SceneState(ROBOT, HERE, rays=((0.0, 600.0), (90.0, 5000.0)))

    picture = painter().paint(VIEW, scene)

    assert at(picture, 1500, 500) != (255, 255, 255)
    assert at(picture, 1700, 500) == (255, 255, 255)
    assert {tuple(pixel) for pixel in picture[0].tolist()} <= {
        (9, 9, 9),
        (255, 255, 255),
        at(picture, 1020, 1130),
    }


@pytest.mark.parametrize("width_mm", [200.0, 1.0], ids=["a box", "thinner than a pixel"])
def test_thin_obstacles_are_drawn(width_mm: float) -> None:
    scene = SceneState(ROBOT, Pose(2000, 1000, 0), obstacles=(Obstacle(300, 200, width_mm, 300),))

    assert at(painter().paint(VIEW, scene), 301, 350) != (255, 255, 255)


def test_a_reused_painter_draws_each_scene_as_a_new_one_would() -> None:
    shared = painter()
    beacon = BeaconSpec(1700, 800)
    boxes = Obstacle(300, 200, 200, 300), Obstacle(900, 700, 100, 300)
    scenes = [
        SceneState(ROBOT, HERE),
        SceneState(ROBOT, HERE, boxes),
        SceneState(ROBOT, HERE, boxes, marked=1),
        SceneState(ROBOT, HERE, boxes, beacon=beacon),
        SceneState(ROBOT, HERE, beacon=beacon),
    ]
    for view in (VIEW, CLOSE, VIEW):
        for scene in scenes:
            assert np.array_equal(shared.paint(view, scene), painter().paint(view, scene))


TOUCHES = RobotSpec(
    touch_sensors=(TouchSpec(y_mm=90.0, width_mm=60.0),),
    infrared=InfraredSpec(x_mm=50.0, y_mm=30.0),
    color_sensors=(),
    ultrasonic=None,
    gyro=None,
)
CLOSE = Viewport(80, 78, 4.0, 1000 - 160.0, 500 + 156.0)


def test_a_bumper_is_a_bar_in_front_and_red_while_it_is_pressed() -> None:
    free = painter().paint(CLOSE, SceneState(TOUCHES, HERE))
    pressed = painter().paint(CLOSE, SceneState(TOUCHES, HERE, pressed=(True,)))
    # Beside the nose, as far as the bar goes.
    assert [at(free, 1090, 500 + aside, CLOSE) for aside in (-26, 26)] == [COLORED.bumper] * 2
    assert [at(pressed, 1090, 500 + aside, CLOSE) for aside in (-26, 26)] == [COLORED.pressed] * 2
    assert at(free, 1090, 540, CLOSE) == at(free, 1110, 526, CLOSE) == (255, 255, 255)


def test_an_infrared_sensor_is_drawn_at_its_position_on_the_robot() -> None:
    assert at(painter().paint(CLOSE, SceneState(TOUCHES, HERE)), 1030, 450, CLOSE) == COLORED.spot


@pytest.mark.parametrize(
    "view", [Viewport.fit_field(38, 19), VIEW, CLOSE], ids=["small", "middle", "close"]
)
def test_a_beacon_is_drawn_also_at_the_edge(view: Viewport) -> None:
    scene = SceneState(ROBOT, Pose(2000, 1000, 0), beacon=BeaconSpec(1000.0, 500.0))
    picture = painter().paint(view, scene)
    assert at(picture, 1000, 500, view) == BEACON_CORE_RGB
    assert (picture == np.array(BEACON_RGB)).all(axis=2).sum() >= 4
    painter().paint(view, replace(scene, beacon=BeaconSpec(0.0, 1143.0)))


def full_mat() -> Pixels:
    """Bands, a slanted line that ends at one, and a disc."""
    rows, cols = np.indices((FIELD_HEIGHT_MM, FIELD_WIDTH_MM))
    mat = np.full((*rows.shape, 3), 255, np.uint8)
    mat[203:907, 803:1205] = (200, 30, 30)
    mat[203:500, 1205:1411] = (30, 90, 200)
    mat[(np.abs(rows - 0.3 * cols - 200) < 12) & (cols < 803)] = 0
    mat[(rows - 700) ** 2 + (cols - 1700) ** 2 < 95**2] = (20, 160, 20)
    return mat


PEN = Piece(
    np.array([200.0, 900.0, 1000.0, 1010.0]),
    np.array([900.0, 950.0, 300.0, 300.0]),
    (9, 99, 9),
    8.0,
)
EVERYTHING = SceneState(
    replace(ROBOT, gyro=None, touch_sensors=(TouchSpec(port="in4", y_mm=90.0),)),
    Pose(1003.0, 507.0, 37.0),
    (Obstacle(300, 205, 209, 307), Obstacle(1900, 205, 207, 303)),
    ((37.0, 300.0), (52.0, 410.0)),
    faint=((Faint.BESIDE, Pose(507.0, 709.0, -71.0)), (Faint.NOW, Pose(1507.0, 613.0, 171.0))),
    marked=1,
    pressed=(True,),
    beacon=BeaconSpec(1777.0, 903.0),
)


@pytest.mark.parametrize(
    "view, options, checksum",
    [
        (VIEW, {}, 2822133340),
        (VIEW, {"for_file": True}, 359310167),
        (Viewport.fit_field(240, 120, CellPoints(2, 4)), {}, 3575795110),
        (Viewport.fit_field(100, 80, CellPoints(2, 4)), {"coarse": True}, 3450928851),
        (Viewport.fit_field(38, 19), {"grey": True}, 3672902916),
        (Viewport.fit_field(76, 60, CellPoints(2, 3)), {"mono": True}, 3418784859),
        (Viewport(140, 78, 4.0, 1003 - 280.0, 507 + 156.0), {"whole_cells": True}, 3233824671),
    ],
    ids=["middle", "for a file", "octants", "coarse", "small and grey", "mono", "close"],
)
def test_a_scene_with_everything_is_drawn_with_the_recorded_pixels(
    view: Viewport, options: dict[str, bool], checksum: int
) -> None:
    trace = PenTrace()
    trace.add(PEN)
    picture = ScenePainter(full_mat(), (230, 230, 230), trace, **options).paint(view, EVERYTHING)
    assert crc32(picture.tobytes()) == checksum
