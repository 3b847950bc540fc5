"""The pictures of runs: what is drawn of many samples, and of a pen that is put down and lifted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from math import atan2, degrees, hypot
from typing import Any, TypeVar

import numpy as np
import pytest
from PIL import Image

from tests.charts.test_layout import log_of
from tests.running import Run
from tuisim.analysis.chart import View
from tuisim.analysis.chart import chart_of as plotted
from tuisim.app.render.mat import whole_field
from tuisim.charts.files import svg_of
from tuisim.charts.layout import ChartData, Stroke, Words, laid_out
from tuisim.charts.sample_chart import sample_chart
from tuisim.charts.world_image import (
    COLORED,
    draw_robot,
    pen_points_mm,
    pen_trace,
    world_picture,
    world_view,
)
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.config.robots import ROBOTS
from tuisim.core.geometry import Pose, world_point
from tuisim.core.outline import outline_of
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, NO_PORT, PenSpec, RobotSpec, RunSpec
from tuisim.notebook.display import CHART_SIZE
from tuisim.runs.samples import Sample

Kind = TypeVar("Kind", Stroke, Words)
chart_of = partial(sample_chart, columns=CHART_SIZE[0])


def samples(count: int, peak: float) -> list[Sample]:
    return [Sample("Grey", peak if at == count // 3 else at % 7, at / count, at, at, 1) for at in range(count)]


def drawn(chart: ChartData, kind: type[Kind]) -> list[Kind]:
    return [shape for shape in laid_out(chart, *CHART_SIZE, titled=False).shapes if isinstance(shape, kind)]


def test_a_single_peak_among_many_samples_is_seen() -> None:
    few, many = (drawn(chart_of(samples(count, 100.0)), Stroke)[-1].points[:, 1] for count in (900, 50_000))
    assert [many.min(), many.max()] == [few.min(), few.max()]
    assert many.max() - many.min() > CHART_SIZE[1] / 2


def test_samples_are_drawn_as_log_plot_draws_them() -> None:
    times, values = np.arange(5000) / 100, np.sin(np.arange(5000)) * 90
    here = chart_of([Sample("Gyro", v, t, 0, 0, 1) for t, v in zip(times, values, strict=True)])
    model = log_of({"time": times.tolist(), "Gyro": values.tolist()})
    there = plotted(model, View(), *CHART_SIZE)
    drawings = [laid_out(chart, *CHART_SIZE, titled=False) for chart in (here, there)]
    assert svg_of(replace(drawings[0], title="")) == svg_of(replace(drawings[1], title=""))


def test_a_trace_is_as_long_as_the_pen_is_down(run: Run) -> None:
    program = "tank_drive.on_for_seconds(SpeedPercent(50), SpeedPercent(50), 1)"
    for down, parts in ((False, 0), (True, 1)):
        done = run(program, pen=PenSpec(down=down), background="Empty_Map")
        trace = pen_trace(done.run.spec, done.run.telemetry.array())
        assert len(trace.lines) == parts
    (line,) = trace.lines
    start, end = done.run.telemetry.record(0), done.run.telemetry.last()
    assert end is not None
    assert [round(x) for x, _ in (line[0], line[-1])] == [round(start.x_mm), round(end.x_mm)]
    assert len(line) < done.run.telemetry.count


WHITE = np.full((FIELD_HEIGHT_MM, FIELD_WIDTH_MM, 3), 255, np.uint8)
CORNERS = [(x_mm, y_mm) for x_mm in (0, FIELD_WIDTH_MM) for y_mm in (0, FIELD_HEIGHT_MM)]
MIDDLE = Pose(1200, 570, 30)


def at(robot: str = "Default_Robot", **choices: Any) -> RunSpec:
    return build_run_spec(Settings({"robot": robot, **choices}))


def pixel(picture: Image.Image, robot: RobotSpec, place: tuple[float, float]) -> Any:
    """The colour at a point of the world."""
    x_px, y_px = world_view(robot).to_px(*place)
    return picture.getpixel((int(x_px), int(y_px)))


@pytest.mark.parametrize("corner", CORNERS, ids=str)
def test_a_white_mat_has_a_frame(corner: tuple[float, float]) -> None:
    spec = at()
    picture, (x_mm, y_mm) = world_picture(spec, WHITE, MIDDLE), corner
    inward, outward = (-3, 3) if x_mm else (3, -3)
    edge = pixel(picture, spec.robot, (x_mm + outward / 2, 570))
    assert pixel(picture, spec.robot, (x_mm + inward, y_mm + (-3 if y_mm else 3))) == (255, 255, 255)
    assert max(edge) < 100
    assert pixel(picture, spec.robot, (x_mm + 6 * outward, y_mm)) not in ((255, 255, 255), edge)


def near(x_mm: float, y_mm: float, places: Sequence[tuple[float, float]]) -> bool:
    return any(hypot(x_mm - x, y_mm - y) < 20 for x, y in places)


@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_is_filled_and_has_all_its_parts(robot: str) -> None:
    spec = at(robot)
    outline, picture = outline_of(spec.robot), world_picture(spec, WHITE, MIDDLE)
    wheel_mm = outline.half_width_mm - outline.wheel_width_mm / 2
    parts = {
        COLORED.body: [(side * 0.7 * (wheel_mm - outline.wheel_width_mm / 2), 0.0) for side in (-1, 1)],
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
    spec = at()
    standing = replace(spec, robot=replace(spec.robot, left_port=NO_PORT, right_port=NO_PORT))
    outline = outline_of(spec.robot)
    place = world_point(MIDDLE, outline.half_width_mm - outline.wheel_width_mm / 2, 0.0)
    drawn = [pixel(world_picture(one, WHITE, MIDDLE), one.robot, place) for one in (spec, standing)]
    assert [bool(np.abs(np.subtract(color, COLORED.wheel)).max() < 60) for color in drawn] == [True, False]


@pytest.mark.quick_cases("0-Small_Robot")
@pytest.mark.parametrize("robot", ROBOTS)
@pytest.mark.parametrize("heading", [0, *(pytest.param(turned, marks=pytest.mark.slow) for turned in (90, 180, -90))])
def test_the_robot_is_drawn_as_large_as_what_collides(robot: str, heading: int) -> None:
    # Bumpers are pressed before anything collides.
    outline = outline_of(replace(at(robot).robot, touch_sensors=()))
    view, picture = whole_field(FIELD_WIDTH_MM, FIELD_HEIGHT_MM), np.zeros_like(WHITE)
    pose = replace(MIDDLE, heading_deg=float(heading))

    draw_robot(picture, view, pose, outline, COLORED)

    rows, cols = np.nonzero(picture.any(axis=2))
    corners = np.array([view.to_px(*world_point(pose, *corner)) for corner in outline.corners_mm])
    assert [cols.min(), rows.min()] == pytest.approx(corners.min(axis=0), abs=1)
    assert [cols.max() + 1, rows.max() + 1] == pytest.approx(corners.max(axis=0), abs=1)


def test_the_pen_is_where_the_simulation_has_it() -> None:
    robot, poses = RobotSpec(pen=PenSpec(x_mm=15.0, y_mm=-70.0)), [(100.0, 200.0, 0.0), (900.5, 300.25, -400.0)]
    records = np.array(poses, dtype=[("x_mm", float), ("y_mm", float), ("heading_deg", float)])
    expected = [world_point(Pose(*pose), 15.0, -70.0) for pose in poses]
    assert np.transpose(pen_points_mm(robot, records)) == pytest.approx(np.array(expected))


@pytest.mark.quick_cases("Small_Robot")
@pytest.mark.parametrize("robot", ROBOTS)
def test_a_robot_on_the_edge_is_not_cut_off(robot: str) -> None:
    spec = at(robot)
    for x_mm, y_mm in CORNERS:
        outward = degrees(atan2(y_mm - FIELD_HEIGHT_MM / 2, x_mm - FIELD_WIDTH_MM / 2))
        picture = np.asarray(world_picture(spec, WHITE, Pose(x_mm, y_mm, outward)))
        border = np.concatenate([picture[0], picture[-1], picture[:, 0], picture[:, -1]])
        assert len(np.unique(border, axis=0)) == 1


@pytest.mark.parametrize(
    "values",
    [
        pytest.param([100.0] * 5, id="constant"),
        pytest.param([0.0] * 5, id="nothing"),
        pytest.param([1e300], id="huge"),
        pytest.param([0.0, 100.0], id="percent"),
        pytest.param([-1e308, 1e308], id="everything"),
        pytest.param([-1e149, 1e149], id="almost everything"),
    ],
)
def test_each_label_of_a_chart_stands_for_another_value(values: list[float]) -> None:
    rows = [Sample("Grey", value, at / 10, at, at, 1) for at, value in enumerate(values)]
    labels = [words.text for words in drawn(chart_of(rows), Words) if words.anchor == "end"]
    assert len(labels) == len(set(labels)) >= 3
    assert max(map(len, labels)) < 12
