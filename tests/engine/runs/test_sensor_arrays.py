"""What sensors measure at all ticks at once: to the bit what their own functions say of each."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tests.cases import cases
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.field import Field
from tuisim.engine.core.sensors import list_mounted
from tuisim.engine.core.spec import (
    GyroSpec,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    UltrasonicSpec,
)
from tuisim.engine.core.tick_record import TICK_FIELDS
from tuisim.engine.runs.sensor_arrays import measure_array
from tuisim.engine.runs.views import TickRecord

BOXES = (Obstacle(300, 900, 50, 300), Obstacle(900, 500, 200, 200), Obstacle(1000, 560, 40, 900))
ROBOTS = {
    "default": RobotSpec(),
    "noisy": replace(RobotSpec(), ultrasonic=UltrasonicSpec(noise_mm=40.0)),
    "turned": replace(
        RobotSpec(),
        ultrasonic=UltrasonicSpec(x_mm=33.0, y_mm=-7.5, angle_deg=45.0, max_range_mm=700.5),
    ),
    "reversed": replace(RobotSpec(), left_reversed=True, gear_ratio=1.7, gyro=GyroSpec()),
}


def places(count: int) -> np.ndarray:
    """Records at random places, also outside the field, and with headings along the axes."""
    random = np.random.default_rng(5)
    records = np.zeros(count, np.dtype(list(TICK_FIELDS)))
    records["tick"] = np.arange(count)
    records["x_mm"], records["y_mm"] = (
        random.uniform(-50, 2100, count),
        random.uniform(-50, 1200, count),
    )
    records["heading_deg"] = np.where(
        random.random(count) < 0.3, random.integers(-8, 8, count) * 45.0, 0.0
    )
    records["heading_deg"] += np.where(
        records["heading_deg"] == 0.0, random.uniform(-720, 720, count), 0.0
    )
    for name in ("left_speed_dps", "right_speed_dps", "gyro_zero_deg"):
        records[name] = random.uniform(-900, 900, count)
    records["gyro_zero_deg"][::4] = records["heading_deg"][::4] + 0.5
    return records


@cases("robot", ROBOTS)
@pytest.mark.parametrize("walls", [True, False], ids=["walls", "open"])
@pytest.mark.parametrize("floor_rgb", [None, (255, 250, 130)], ids=["mat", "floor"])
def test_sensor_values_computed_as_arrays_equal_single_readings_exactly(
    robot: RobotSpec, walls: bool, spec: RunSpec, field: Field, floor_rgb: Rgb | None
) -> None:
    field = replace(field, floor_rgb=floor_rgb)
    run = replace(spec, robot=robot, world=replace(spec.world, walls=walls, obstacles=BOXES))
    records = places(400)
    for kind, sensor, *_ in list_mounted(robot):
        found = measure_array(sensor, records, run, field, has_light_noise=False)
        assert found is not None
        one_by_one = [
            kind.measure(
                sensor, TickRecord(*record.item()).build_instant(run, NoiseSpec()), run, field
            )
            for record in records
        ]
        for name, values, expected in zip(
            kind.names(sensor), found, zip(*one_by_one, strict=True), strict=True
        ):
            assert values.tobytes() == np.array(expected, float).tobytes(), name
    assert kind.names(sensor) == ("gyro_deg", "gyro_rate_dps")


def test_light_noise_is_measured_tick_by_tick(spec: RunSpec, field: Field) -> None:
    assert (
        measure_array(spec.robot.color_sensors[0], places(3), spec, field, has_light_noise=True)
        is None
    )


def test_a_damaged_record_has_no_reading_and_spoils_no_other(spec: RunSpec, field: Field) -> None:
    records = places(3)
    records["heading_deg"][1] = math.inf
    sensor = spec.robot.ultrasonic
    assert sensor is not None
    (before,) = measure_array(sensor, places(3), spec, field, has_light_noise=False) or ()
    (after,) = measure_array(sensor, records, spec, field, has_light_noise=False) or ()
    assert (after[0], after[2]) == (before[0], before[2])
