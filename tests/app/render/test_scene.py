"""The world's picture: robot, trace, rays, obstacles, ghost."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tuisim.app.render.mat import whole_field
from tuisim.app.render.scene import BEACON_CORE_RGB, BEACON_RGB, PenTrace, ScenePainter, SceneState, pen_rgb
from tuisim.charts.world_image import COLORED, Viewport, draw_robot, drawn_scale
from tuisim.core.geometry import Pose
from tuisim.core.outline import outline_of
from tuisim.core.spec import BeaconSpec, InfraredSpec, Obstacle, PenSpec, RobotSpec, TouchSpec
from tuisim.terminal.pixels import CellPoints, Pixels

MAT = np.full((1143, 2362, 3), 255, np.uint8)
VIEW = whole_field(160, 78)
ROBOT = RobotSpec()
HERE = Pose(1000.0, 500.0, 0.0)


def painter() -> ScenePainter:
    return ScenePainter(MAT, (9, 9, 9), PenTrace())


def at(picture: Pixels, x_mm: float, y_mm: float, view: Viewport = VIEW) -> tuple[int, ...]:
    col, row = view.to_px(x_mm, y_mm)
    return tuple(picture[int(row), int(col)].tolist())


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


def test_the_trace_is_drawn_and_goes_on() -> None:
    made = painter()
    scene = SceneState(ROBOT, Pose(2000, 1000, 0))
    made.trace.add(np.array([200.0, 300.0]), np.array([300.0, 300.0]), ROBOT.pen)
    made.paint(VIEW, scene)
    made.trace.add(np.array([400.0]), np.array([300.0]), ROBOT.pen)

    picture = made.paint(VIEW, scene)

    assert [at(picture, x, 300) for x in (205, 250, 350, 395)] == [pen_rgb("red")] * 4
    assert at(picture, 450, 300) == (255, 255, 255)


def test_a_lifted_pen_leaves_a_gap() -> None:
    made = painter()
    xs, ys = np.array([200.0, np.nan, 400.0, 500.0]), np.array([300.0, np.nan, 300.0, 300.0])
    made.trace.add(xs, ys, ROBOT.pen)

    picture = made.paint(VIEW, SceneState(ROBOT, Pose(2000, 1000, 0)))

    assert at(picture, 300, 300) == (255, 255, 255)
    assert at(picture, 450, 300) == pen_rgb("red")


def test_each_stretch_keeps_its_pen_and_a_wiped_trace_is_gone() -> None:
    made, scene = painter(), SceneState(ROBOT, Pose(2000, 1000, 0))
    made.trace.add(np.array([200.0, 300.0]), np.array([300.0, 300.0]), ROBOT.pen)
    made.trace.add(
        np.array([np.nan, 200.0, 300.0]), np.array([np.nan, 600.0, 600.0]), PenSpec(color="teal", width_mm=90)
    )

    drawn = made.paint(VIEW, scene)
    again = made.paint(whole_field(80, 38), scene)
    made.trace.clear()
    gone = made.paint(VIEW, scene)

    assert [at(drawn, 250, y) for y in (300, 340, 600, 640)] == [
        pen_rgb("red"),
        (255, 255, 255),
        pen_rgb("teal"),
        pen_rgb("teal"),
    ]
    assert at(again, 250, 600, whole_field(80, 38)) == pen_rgb("teal")
    assert at(gone, 250, 300) == at(gone, 250, 600) == (255, 255, 255)


def test_the_obstacle_at_hand_has_another_edge() -> None:
    boxes = (Obstacle(300, 200, 200, 300), Obstacle(900, 200, 200, 300))
    plain = painter().paint(VIEW, SceneState(ROBOT, Pose(2000, 1000, 0), obstacles=boxes))
    marked = painter().paint(VIEW, SceneState(ROBOT, Pose(2000, 1000, 0), obstacles=boxes, marked=1))

    assert at(plain, 305, 350) == at(marked, 305, 350) != (255, 255, 255)
    assert at(plain, 905, 350) != at(marked, 905, 350)
    assert at(plain, 1000, 350) == at(marked, 1000, 350)


def test_rays_end_at_their_length_and_at_the_field() -> None:
    scene = SceneState(ROBOT, HERE, rays=((0.0, 600.0), (90.0, 5000.0)))

    picture = painter().paint(VIEW, scene)

    assert at(picture, 1500, 500) != (255, 255, 255)
    assert at(picture, 1700, 500) == (255, 255, 255)
    assert {tuple(pixel) for pixel in picture[0].tolist()} <= {(9, 9, 9), (255, 255, 255), at(picture, 1020, 1130)}


@pytest.mark.parametrize("width_mm", [200.0, 1.0], ids=["a box", "thinner than a pixel"])
def test_obstacles_are_drawn(width_mm: float) -> None:
    scene = SceneState(ROBOT, Pose(2000, 1000, 0), obstacles=(Obstacle(300, 200, width_mm, 300),))

    assert at(painter().paint(VIEW, scene), 301, 350) != (255, 255, 255)


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


def test_an_infrared_sensor_is_drawn_where_it_is() -> None:
    assert at(painter().paint(CLOSE, SceneState(TOUCHES, HERE)), 1030, 450, CLOSE) == COLORED.spot


@pytest.mark.parametrize("view", [whole_field(38, 19), VIEW, CLOSE], ids=["small", "middle", "close"])
def test_a_beacon_is_drawn_also_at_the_edge(view: Viewport) -> None:
    scene = SceneState(ROBOT, Pose(2000, 1000, 0), beacon=BeaconSpec(1000.0, 500.0))
    picture = painter().paint(view, scene)
    assert at(picture, 1000, 500, view) == BEACON_CORE_RGB
    assert (picture == np.array(BEACON_RGB)).all(axis=2).sum() >= 4
    painter().paint(view, replace(scene, beacon=BeaconSpec(0.0, 1143.0)))


def test_the_ghost_is_drawn_below_the_robot() -> None:
    alone = painter().paint(VIEW, SceneState(ROBOT, HERE))
    both = painter().paint(VIEW, SceneState(ROBOT, HERE, ghost=replace(HERE, x_mm=500.0)))

    assert at(both, 500, 500) != (255, 255, 255)
    assert at(both, 1000, 500) == at(alone, 1000, 500)


@pytest.mark.parametrize(
    ("name", "rgb"), [("orange", (255, 165, 0)), ("#0a0b0c", (10, 11, 12)), ("#zzzzzz", (255, 0, 0))]
)
def test_pen_colours(name: str, rgb: tuple[int, int, int]) -> None:
    assert pen_rgb(name) == rgb


@pytest.mark.parametrize("heading", [0, 30, 45, 70])
@pytest.mark.parametrize("rows", [2, 3, 4], ids=["quadrants", "sextants", "octants"])
def test_the_nose_of_a_small_robot_fills_a_third_of_a_cell(rows: int, heading: int) -> None:
    view = whole_field(100, 20 * rows, CellPoints(2, rows))
    picture = painter().paint(view, SceneState(ROBOT, Pose(1181.0, 571.0, heading)))

    row, col = np.indices(picture.shape[:2]) + 0.5
    east, north = view.left_mm + col * view.mm_per_px - 1181, view.top_mm - row * view.mm_per_row - 571
    angle, outline = math.radians(heading), outline_of(ROBOT)
    ahead = (east * math.cos(angle) + north * math.sin(angle)) / drawn_scale(outline, view) > outline.front_mm
    yellow = (255 - picture[..., 2].astype(float))[ahead & (picture[..., 0] > 180)] / 255
    assert yellow.sum() >= 2 * rows / 3


@pytest.mark.parametrize("coarse", [False, True])
def test_a_robot_without_details_has_no_sensors_on_its_marker(coarse: bool) -> None:
    view = whole_field(100, 80, CellPoints(2, 4))
    picture = ScenePainter(MAT, (9, 9, 9), PenTrace(), coarse=coarse).paint(view, SceneState(ROBOT, HERE))

    red, green, blue = picture.reshape(-1, 3).astype(int).T
    assert coarse is not bool(((red > 220) & (green < 190) & (abs(green - blue) < 90) & (blue > 30)).any())
