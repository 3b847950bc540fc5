"""Readings of sensors at many ticks together, equal to those of `engine.core.sensors` to the last bit.

To add a kind of sensor: a function of its spec, the records, the run and the mat, and a line in `_MEASURES`. A kind
without one is measured tick by tick.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tuisim.engine.core.drift import draw_echo_bias_mm, find_drift, sense_turn_rate_dps
from tuisim.engine.core.field import Field, build_disc_mask, count_disc_pixels
from tuisim.engine.core.noise import generate_bytes
from tuisim.engine.core.sensors import SENSORS
from tuisim.engine.core.sensors.color import (
    EVEN,
    WHITE,
    compute_light,
    find_response,
)
from tuisim.engine.core.sensors.ultrasonic import MAX_ECHO_DEG, MIN_ECHO_DEG, Edge, find_surfaces
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    ColorSensorSpec,
    GyroSpec,
    RunSpec,
    SensorSpec,
    UltrasonicSpec,
)
from tuisim.engine.runs.arrays import compute_cos_and_sin, compute_world_points_mm

Array = NDArray[Any]


def measure_array(
    sensor: SensorSpec, records: Array, run: RunSpec, field: Field, has_light_noise: bool
) -> tuple[Array, ...] | None:
    """Return the measured columns of a sensor at all ticks, each of shape (n,), in the order of the sensor's columns.

    Return None if the columns must be computed tick by tick, such as with light noise.

    Args:
        sensor: The sensor.
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        run: The specification of the run.
        field: The mat.
        has_light_noise: Whether there is light noise at any of the ticks.
    """
    if isinstance(sensor, ColorSensorSpec) and (
        has_light_noise or sensor.strategy != "mean" or run.world.pen_marks
    ):
        return None
    if isinstance(sensor, UltrasonicSpec) and find_drift(run).echo_loss_pc:
        return None
    measure = _MEASURES.get(type(sensor))
    if measure is None:
        return None
    # NumPy must not warn: a ray may be parallel to an edge, and a damaged record may contain any numbers.
    with np.errstate(all="ignore"):
        return measure(sensor, records, run, field)


def measure_quiet_color(
    records: Array, sensor: ColorSensorSpec, run: RunSpec, field: Field
) -> dict[str, Array]:
    """Return red, green and blue of a colour sensor at every tick without light noise, by the name of the column.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        sensor: The sensor.
        run: The specification of the run.
        field: The mat, prepared for the diameter of the disc that the sensor sees.
    """
    x_mm, y_mm = compute_world_points_mm(records, sensor.x_mm, sensor.y_mm)
    diameter = sensor.diameter_mm
    with np.errstate(invalid="ignore"):  # a position beyond all integers is off the mat either way
        col = (x_mm - diameter / 2).astype(np.int64) + diameter
        row = (FIELD_HEIGHT_MM - y_mm - diameter / 2).astype(np.int64) + diameter
    sums, inside = _sum_discs(col, row, diameter, field)
    means = sums / count_disc_pixels(diameter)
    response = find_response(sensor, run.profile)
    drift = find_drift(run)
    if response != EVEN:
        means = response.dark * inside[:, None] + means * response.span / WHITE
    if drift.light_pc or drift.light_gain_pc:
        light = np.broadcast_to(compute_light(x_mm, y_mm, sensor, drift, run.seed), x_mm.shape)
        means = np.minimum(means * light[:, None], WHITE)
    return {name: means[:, channel] for channel, name in enumerate(SENSORS["color"].names(sensor))}


def _sum_discs(col: Array, row: Array, diameter: int, field: Field) -> tuple[Array, Array]:
    """Return the sums of red, green and blue over discs, and whether each disc is over the mat or the floor.

    Args:
        col, row: Upper left corners of the boxes around the discs, shape (n,). Column and row 0 are `diameter` pixels
            before those of the mat.
        diameter: Diameter of the discs in pixels.
        field: The mat.
    """
    height, width = field.height_px + diameter, field.width_px + diameter
    inside = (col >= 0) & (col < width) & (row >= 0) & (row < height)
    sums = np.zeros((len(col), 3), np.uint32)
    table = np.frombuffer(field.sums[diameter], np.uint32).reshape(height, width, 3)
    sums[inside] = table[row[inside], col[inside]]
    if field.floor_rgb is None:
        return sums, inside
    counts = np.zeros((diameter + 1, diameter + 1), np.uint32)
    counts[1:, 1:] = np.array(build_disc_mask(diameter)).cumsum(0).cumsum(1)
    left, right = (np.clip(end - col, 0, diameter) for end in (diameter, width))
    upper, lower = (np.clip(end - row, 0, diameter) for end in (diameter, height))
    on_mat = counts[lower, right] - counts[upper, right] - counts[lower, left] + counts[upper, left]
    beside = (counts[-1, -1] - on_mat)[:, None] * np.array(field.floor_rgb, np.uint32)
    return sums + beside, np.ones(len(col), np.bool_)


def _measure_color(
    sensor: ColorSensorSpec, records: Array, run: RunSpec, field: Field
) -> tuple[Array, ...]:
    return tuple(measure_quiet_color(records, sensor, run, field).values())


def _measure_gyro(
    sensor: GyroSpec, records: Array, run: RunSpec, field: Field
) -> tuple[Array, ...]:
    left_dps: Any = records["left_speed_dps"].astype("f8")
    right_dps: Any = records["right_speed_dps"].astype("f8")
    angle_deg = records["gyro_zero_deg"].astype("f8") - records["heading_deg"]
    fastest = run.profile.gyro_max_dps or np.inf
    rate_dps: Any = np.clip(-sense_turn_rate_dps(left_dps, right_dps, run), -fastest, fastest)
    return _round_numbers(angle_deg), _round_numbers(rate_dps)


def _measure_ultrasonic(
    sensor: UltrasonicSpec, records: Array, run: RunSpec, field: Field
) -> tuple[Array, ...]:
    start = compute_world_points_mm(records, sensor.x_mm, sensor.y_mm)
    facing_deg = records["heading_deg"] + sensor.angle_deg
    surfaces = find_surfaces(run.world)
    nearest_mm = np.full(len(records), sensor.max_range_mm)
    for ray_deg in sensor.ray_angles_deg:
        cos, sin = compute_cos_and_sin(facing_deg + ray_deg)
        nearest_mm = _cut_off(
            nearest_mm, surfaces.upright, start, (cos, sin), _is_echoing(90.0, facing_deg)
        )
        nearest_mm = _cut_off(
            nearest_mm, surfaces.level, start[::-1], (sin, cos), _is_echoing(0.0, facing_deg)
        )
    distance_mm = _round_numbers(nearest_mm)
    farthest = float(round(sensor.max_range_mm))
    is_near = distance_mm < run.profile.min_echo_mm
    drift = find_drift(run)
    if drift.echo_bias_mm:
        bias_mm = draw_echo_bias_mm(sensor.port, drift, run.seed)
        biased_mm = np.clip(distance_mm + bias_mm, 0.0, farthest)
        distance_mm = np.where(distance_mm < farthest, biased_mm, distance_mm)
    distance_mm = np.where(is_near, farthest, distance_mm)
    if not sensor.noise_mm:
        return (distance_mm,)
    drawn = (generate_bytes(run.seed, tick, sensor.name, 4) for tick in records["tick"].tolist())
    shares = np.array([int.from_bytes(four, "little") / 2147483647.5 - 1 for four in drawn])
    noisy_mm = _round_numbers(distance_mm + sensor.noise_mm * shares)
    return (np.clip(noisy_mm, 0.0, farthest),)


def _cut_off(
    nearest_mm: Array,
    edges: tuple[Edge, ...],
    start: tuple[Array, Array],
    step: tuple[Array, Array],
    echoes: Array,
) -> Array:
    """Return the lengths of rays, cut off at the first edge that each ray hits; see `ultrasonic.find_first_hit_mm`.

    Args:
        nearest_mm: The lengths without these edges, shape (n,).
        edges: Edges parallel to one axis.
        start: Where the rays begin: their coordinates across the edges, and those along the edges.
        step: How much each of these coordinates changes per mm along a ray.
        echoes: Whether the edges return an echo at each tick.
    """
    across, along = start
    across_step, along_step = step
    echoes = echoes & (np.abs(across_step) >= 1e-12)
    for place, low, high in edges:
        way_mm = (place - across) / across_step
        place_along = along + way_mm * along_step
        ahead = np.where(across_step > 0, place >= across, place <= across)
        hits = (
            echoes
            & ahead
            & (way_mm < nearest_mm)
            & (low - 1e-9 <= place_along)
            & (place_along <= high + 1e-9)
        )
        nearest_mm = np.where(hits, way_mm, nearest_mm)
    return nearest_mm


def _is_echoing(edge_deg: float, facing_deg: Array) -> Array:
    angle_deg = np.abs(edge_deg - facing_deg) % 180.0
    return (angle_deg > MIN_ECHO_DEG) & (angle_deg < MAX_ECHO_DEG)


def _round_numbers(values: Array) -> Array:
    """Return the values rounded to whole numbers as Python rounds; -0.0 becomes 0.0."""
    rounded: Array = np.rint(values) + 0.0
    return rounded


_MEASURES: Mapping[type[SensorSpec], Callable[..., tuple[Array, ...]]] = {
    ColorSensorSpec: _measure_color,
    UltrasonicSpec: _measure_ultrasonic,
    GyroSpec: _measure_gyro,
}
