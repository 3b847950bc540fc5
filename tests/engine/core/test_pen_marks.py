"""The pen's marks on the mat, where sensors are to see them."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.pen_marks import PenMarks
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.sensors.color import measure_color, read_pixel_array
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    PenSpec,
    RobotSpec,
    RunSpec,
    WorldSpec,
)
from tuisim.engine.core.state import Instant
from tuisim.engine.core.tick_record import FLAG_PEN_DOWN

PIXELS = FIELD_WIDTH_MM * FIELD_HEIGHT_MM
WHITE_SUM = 305 * 255


@pytest.fixture(scope="module")
def white() -> Field:
    """A white mat whose sums are those of white everywhere (edges of the field aside)."""
    count = (FIELD_WIDTH_MM + 20) * (FIELD_HEIGHT_MM + 20) * 3
    sums = memoryview(bytearray(WHITE_SUM.to_bytes(4, "little") * count)).cast("I")
    return Field(FIELD_WIDTH_MM, FIELD_HEIGHT_MM, memoryview(b"\xff" * (3 * PIXELS)), {20: sums})


def drawn(white: Field, pen: PenSpec, heading_deg: float = 0.0) -> tuple[Simulation, PenMarks]:
    """Drive straight for a second with the pen."""
    world = WorldSpec(start=Pose(500.0, 500.0, heading_deg), pen_marks=True)
    sim = Simulation(RunSpec(RobotSpec(pen=pen), world, ROBOLAB), MemorySink())
    marks = PenMarks(white, sim.spec)
    commanded(sim.left).run(500.0)
    commanded(sim.right).run(500.0)
    for _ in range(10):
        sim.advance(10)
        marks.add_records(sim.read_records(marks.records))
    return sim, marks


def test_a_pen_draws_on_the_floor_around_a_mat(white: Field) -> None:
    pen = PenSpec(color="#00ff00", width_mm=40.0, down=True)
    world = WorldSpec(start=Pose(-300.0, 500.0, 180.0), pen_marks=True)
    spec = RunSpec(RobotSpec(pen=pen), world, ROBOLAB)
    record = (0, 0, -300.0, 500.0, 180.0, *[0] * 5, FLAG_PEN_DOWN, 0)
    on_floor = PenMarks(replace(white, floor_rgb=(250, 251, 252)), spec)
    off = PenMarks(white, spec)
    for marks in (on_floor, off):
        marks.add_records([record])
    corner = -300 - 10, FIELD_HEIGHT_MM - 500 - 10
    assert on_floor.field.sum_disc(20, *corner) == (0, 255 * 305, 0)
    assert off.field.sum_disc(20, *corner) == (0, 0, 0)
    assert on_floor.field_of_first(0).sum_disc(20, *corner) == (250 * 305, 251 * 305, 252 * 305)


@pytest.mark.parametrize("x_mm", [550.0, 467.0], ids=["on the line", "on its beginning"])
def test_colour_sensors_and_pixel_arrays_see_the_pens_line(white: Field, x_mm: float) -> None:
    _, marks = drawn(white, PenSpec(color="#102030", width_mm=10.0, down=True))
    sensor = RobotSpec().color_sensors[0]
    over = Instant(0, Pose(x_mm, 480.0, 0.0))
    seen = measure_color(sensor, over, marks.field)
    box = read_pixel_array(sensor, over, marks.field)
    inside = [
        pixel
        for pixel in zip(box[::3], box[1::3], box[2::3], strict=True)
        if pixel != (245, 226, 225)
    ]
    means = [sum(values) / 305 for values in zip(*inside, strict=True)]
    assert [seen.red, seen.green, seen.blue] == means
    assert seen.red < seen.green < seen.blue < 220
    assert measure_color(sensor, over, white).red == 255


def test_a_robot_with_its_pen_up_draws_nothing(white: Field) -> None:
    _, marks = drawn(white, PenSpec(down=False))
    assert not marks.field.marks


def test_placing_the_robot_elsewhere_draws_no_pen_line(white: Field) -> None:
    sim, marks = drawn(white, PenSpec(down=True))
    before = len(marks.field.marks)
    sim.place(Pose(1500.0, 900.0, 0.0))
    sim.actions += 1
    sim.update_record()
    sim.advance(1)
    marks.add_records(sim.read_records(marks.records))
    assert len(marks.field.marks) - before < 100


def test_pen_marks_are_the_same_from_records_at_once_or_one_by_one(white: Field) -> None:
    sim, marks = drawn(white, PenSpec(down=True, x_mm=20.0, y_mm=-30.0))
    again = PenMarks(white, replace(sim.spec))
    again.add_records(sim.read_records(0))
    assert again.field.marks == marks.field.marks


@pytest.mark.parametrize("heading_deg", [30.0, -110.0])
def test_a_slanted_line_is_as_wide_as_the_pen(white: Field, heading_deg: float) -> None:
    pen = PenSpec(color="#00ff00", width_mm=6.0, down=True)
    sim, marks = drawn(white, pen, heading_deg)
    turn = math.radians(heading_deg)
    way_mm = math.hypot(sim.pose.x_mm - 500.0, sim.pose.y_mm - 500.0)
    aside_mm = [
        (col + 0.5 - 500) * -math.sin(turn) + (FIELD_HEIGHT_MM - row - 0.5 - 500) * math.cos(turn)
        for col, row in marks.field.marks
    ]
    assert max(map(abs, aside_mm)) == pytest.approx(3.0, abs=0.2)
    assert len(aside_mm) == pytest.approx(6.0 * way_mm + math.pi * 9.0, rel=0.02)
