"""What the pen draws."""

from __future__ import annotations

import numpy as np
import pytest

from tests.pictures.scene.scenes import ROBOT, VIEW, at, painter
from tests.running import Run
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.spec import PenSpec, RobotSpec
from tuisim.pictures.scene.painter import SceneState
from tuisim.pictures.scene.pen import Piece, parse_pen_color, place_pen_mm
from tuisim.pictures.scene.view import Viewport


def test_the_pens_trace_is_drawn_and_extended() -> None:
    made = painter()
    scene = SceneState(ROBOT, Pose(2000, 1000, 0))
    made.trace.add(Piece.from_points(np.array([200.0, 300.0]), np.array([300.0, 300.0]), ROBOT.pen))
    made.paint(VIEW, scene)
    made.trace.add(Piece.from_points(np.array([400.0]), np.array([300.0]), ROBOT.pen))

    picture = made.paint(VIEW, scene)

    assert [at(picture, x, 300) for x in (205, 250, 350, 395)] == [parse_pen_color("red")] * 4
    assert at(picture, 450, 300) == (255, 255, 255)


def test_a_lifted_pen_leaves_a_gap() -> None:
    made = painter()
    xs = np.array([200.0, np.nan, 400.0, 500.0])
    ys = np.array([300.0, np.nan, 300.0, 300.0])
    made.trace.add(Piece.from_points(xs, ys, ROBOT.pen))

    picture = made.paint(VIEW, SceneState(ROBOT, Pose(2000, 1000, 0)))

    assert at(picture, 300, 300) == (255, 255, 255)
    assert at(picture, 450, 300) == parse_pen_color("red")


def test_each_stretch_of_a_pen_trace_keeps_its_colour_and_a_wiped_trace_vanishes() -> None:
    made = painter()
    scene = SceneState(ROBOT, Pose(2000, 1000, 0))
    made.trace.add(Piece.from_points(np.array([200.0, 300.0]), np.array([300.0, 300.0]), ROBOT.pen))
    made.trace.add(
        Piece.from_points(
            np.array([np.nan, 200.0, 300.0]),
            np.array([np.nan, 600.0, 600.0]),
            PenSpec(color="teal", width_mm=90),
        )
    )

    drawn = made.paint(VIEW, scene)
    again = made.paint(Viewport.fit_field(80, 38), scene)
    made.trace.clear()
    gone = made.paint(VIEW, scene)

    assert [at(drawn, 250, y) for y in (300, 340, 600, 640)] == [
        parse_pen_color("red"),
        (255, 255, 255),
        parse_pen_color("teal"),
        parse_pen_color("teal"),
    ]
    assert at(again, 250, 600, Viewport.fit_field(80, 38)) == parse_pen_color("teal")
    assert at(gone, 250, 300) == at(gone, 250, 600) == (255, 255, 255)


@pytest.mark.parametrize(
    "name, rgb",
    [("orange", (255, 165, 0)), ("#0a0b0c", (10, 11, 12)), ("#zzzzzz", (255, 0, 0))],
)
def test_names_of_pen_colours_have_their_colour(name: str, rgb: tuple[int, int, int]) -> None:
    assert parse_pen_color(name) == rgb


def test_a_pen_trace_covers_only_the_way_driven_with_the_pen_down(run: Run) -> None:
    program = "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 1)"
    for down, parts in ((False, 0), (True, 1)):
        done = run(program, pen=PenSpec(down=down), background="Empty_Map")
        trace = Piece.from_run(done.run.spec, done.run.telemetry.array())
        drawn = np.isfinite(trace.xs_mm)
        assert np.count_nonzero(np.diff(drawn, prepend=False) & drawn) == parts
    start, end = done.run.telemetry.record(0), done.run.telemetry.last()
    assert end is not None
    assert [round(x) for x in trace.xs_mm[drawn][[0, -1]]] == [round(start.x_mm), round(end.x_mm)]
    assert np.count_nonzero(drawn) < done.run.telemetry.count


def test_a_pen_traces_points_are_the_pens_positions_in_the_simulation() -> None:
    robot = RobotSpec(pen=PenSpec(x_mm=15.0, y_mm=-70.0))
    poses = [(100.0, 200.0, 0.0), (900.5, 300.25, -400.0)]
    records = np.array(poses, dtype=[("x_mm", float), ("y_mm", float), ("heading_deg", float)])
    expected = [world_point(Pose(*pose), 15.0, -70.0) for pose in poses]
    assert np.transpose(place_pen_mm(robot, records)) == pytest.approx(np.array(expected))
