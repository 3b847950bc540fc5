"""Pictures for files: what the app shows at the same instant, in the same colours."""

from __future__ import annotations

from dataclasses import replace
from math import atan2, degrees, nan

import numpy as np
import pytest

from tests.pictures.scene.scenes import CORNERS, MIDDLE, pixel, spec_of
from tests.running import Run
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.remote_spec import BeaconSpec
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    Obstacle,
    PenSpec,
    RobotSpec,
    RunSpec,
    TouchSpec,
    WorldSpec,
)
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.runs.views import TickRecord
from tuisim.pictures.scene.painter import ScenePainter
from tuisim.pictures.scene.pen import PenTrace, Piece
from tuisim.pictures.scene.pictures import (
    build_painter,
    build_scene,
    build_world_view,
    draw_path,
    draw_world,
    find_area,
    find_view,
    fit_view,
    read_pose,
)
from tuisim.pictures.scene.robot import COLORED
from tuisim.pictures.scene.view import FIELD, Area, Viewport
from tuisim.terminal.pixels import Pixels

WHITE: Pixels = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)
HERE = Pose(900, 480, 25)
SPEC = RunSpec(
    RobotSpec(
        pen=PenSpec(color="teal", width_mm=9.0),
        gyro=None,
        touch_sensors=(TouchSpec(port="in4", y_mm=90.0),),
    ),
    WorldSpec(
        obstacles=(Obstacle(400, 300, 200, 150), Obstacle(985, 480, 60, 100)),
        beacon=BeaconSpec(1700, 800),
    ),
    ROBOLAB,
)
TRACE = Piece.from_points(np.array([700.0, 900.0]), np.array([900.0, 700.0]), SPEC.robot.pen)


@pytest.mark.slow
def test_a_picture_file_of_the_world_equals_what_the_screen_shows() -> None:
    view = build_world_view(SPEC.robot)
    trace = PenTrace()
    trace.add(TRACE)
    screen = ScenePainter(WHITE, (0, 0, 0), trace).paint(view, build_scene(SPEC, HERE))

    picture = np.asarray(draw_world(SPEC, WHITE, HERE, (TRACE,)))

    differs = np.argwhere((picture != screen).any(axis=2))
    places = np.array([view.to_mm(col + 0.5, row + 0.5) for row, col in differs.tolist()])
    outside = (places < 0).any(axis=1) | (places > (FIELD_WIDTH_MM, FIELD_HEIGHT_MM)).any(axis=1)
    assert len(places) and outside.mean() > 0.99


@pytest.mark.parametrize(
    "pose, rays, is_seen", [(HERE, True, True), (HERE, False, False), (None, True, False)]
)
def test_sensor_rays_are_drawn_only_for_a_robot_with_a_pose(
    pose: Pose | None, rays: bool, is_seen: bool
) -> None:
    assert bool(build_scene(SPEC, pose, rays=rays).rays) == is_seen


def test_runs_whose_pens_have_not_touched_are_not_joined() -> None:
    other = replace(TRACE, xs_mm=TRACE.xs_mm + 100, ys_mm=TRACE.ys_mm + 100)
    view = fit_view(SPEC.robot, 600, 400)
    scene = build_scene(SPEC, None)

    picture = build_painter(WHITE, (TRACE, other)).paint(view, scene)

    col, row = view.to_px(850, 850)
    assert tuple(picture[int(row), int(col)]) == (255, 255, 255)
    assert not (picture == COLORED.body).all(axis=2).any()


@pytest.mark.parametrize("corner", CORNERS, ids=str)
def test_a_white_mat_has_a_frame(corner: tuple[float, float]) -> None:
    spec = spec_of()
    picture, (x_mm, y_mm) = draw_world(spec, WHITE, MIDDLE), corner
    inward, outward = (-3, 3) if x_mm else (3, -3)
    edge = pixel(picture, spec.robot, (x_mm + outward / 2, 570))
    assert pixel(picture, spec.robot, (x_mm + inward, y_mm + (-3 if y_mm else 3))) == (
        255,
        255,
        255,
    )
    assert max(edge) < 100
    assert pixel(picture, spec.robot, (x_mm + 6 * outward, y_mm)) not in ((255, 255, 255), edge)


def test_a_picture_file_of_the_world_stores_the_positions_of_its_edges() -> None:
    picture = draw_world(spec_of(), WHITE, MIDDLE)
    left_mm, right_mm, lower_mm, upper_mm = picture.info["extent_mm"]
    width_px, height_px = picture.size
    whites = np.argwhere((np.asarray(picture) == 255).all(axis=2))
    (top, left), (bottom, right) = whites.min(axis=0), whites.max(axis=0) + 1
    edges_mm = [left_mm + px / width_px * (right_mm - left_mm) for px in (left, right)]
    edges_mm += [upper_mm - px / height_px * (upper_mm - lower_mm) for px in (bottom, top)]
    assert edges_mm == pytest.approx([0, FIELD_WIDTH_MM, 0, FIELD_HEIGHT_MM], abs=3)


@pytest.mark.parametrize("size_px", [(300, 150), (300, 400), (900, 500), (1200, 401)])
def test_a_picture_of_the_world_fills_the_given_size(size_px: tuple[int, int]) -> None:
    view = fit_view(SPEC.robot, *size_px)
    room_px = size_px[0] - view.width_px, size_px[1] - view.height_px
    assert 0 <= min(room_px) <= 3


def test_a_robot_on_the_edge_is_not_cut_off() -> None:
    spec = spec_of("Small_Robot")
    for x_mm, y_mm in CORNERS:
        outward = degrees(atan2(y_mm - FIELD_HEIGHT_MM / 2, x_mm - FIELD_WIDTH_MM / 2))
        picture = np.asarray(draw_world(spec, WHITE, Pose(x_mm, y_mm, outward)))
        border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
        assert len(np.unique(border, axis=0)) == 1


def test_a_small_picture_shows_the_path_of_a_run(run: Run) -> None:
    done = run(
        "tank_drive.on_for_seconds(50, 50, 2)\n", background="Empty_Map", pose=(500.0, 500.0, 0.0)
    )
    picture = draw_path(done.run.stored(), Viewport.fit_field(50, 26), (0, 0, 0))
    reddish = (picture[..., 0] > 200) & (picture[..., 1] < 150)
    rows, columns = np.nonzero(reddish)
    assert len({*rows}) <= 2
    assert 5 < np.ptp(columns) < 20


def records_at(*places: tuple[float, float]) -> np.ndarray:
    records = np.zeros(len(places), np.dtype(list(TICK_FIELDS)))
    records["x_mm"], records["y_mm"] = zip(*places, strict=True)
    return records


def test_a_picture_shows_how_far_a_robot_has_left_the_field() -> None:
    on_floor = replace(SPEC, world=replace(SPEC.world, floor=True, walls=False))
    records = records_at((900.0, 480.0), (5362.0, 480.0), (900.0, -700.0), (nan, 0.0))
    area = find_area(records)
    assert area == Area(0.0, -700.0, 5362.0, FIELD_HEIGHT_MM)
    away = Pose(5362.0, -700.0, 0.0)
    view = find_view(on_floor, area)
    picture = draw_world(on_floor, WHITE, away, area=area)
    assert picture.size == (view.width_px, view.height_px)
    field = draw_world(on_floor, WHITE, HERE).size
    assert abs(picture.size[0] - field[0]) < 100
    col, row = (int(at) for at in view.to_px(away.x_mm, away.y_mm))
    assert (np.asarray(picture)[row - 3 : row + 4, col - 9 : col] == COLORED.body).all(2).any()


def test_a_robot_that_has_gone_very_far_does_not_make_the_field_tiny() -> None:
    far = find_area(records_at((1e9, 480.0)))
    assert FIELD.right < far.right < 4 * FIELD.right


def test_a_damaged_record_has_no_pose() -> None:
    record = TickRecord(12, 3, 1.0, 2.0, 30.0, 4.0, 5.0, 100.0, 200.0, 8.0, 0, 0)
    poses = [read_pose(one) for one in (None, replace(record, x_mm=nan), record)]
    assert poses == [None, None, record.pose]
