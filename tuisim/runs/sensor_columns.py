"""Readings of every sensor at every tick, computed from the telemetry.

The values equal those of `core.sensors` bit by bit: the colour sums are looked up for
all ticks at once, everything else is measured tick by tick with the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from tuisim.core.field import Field
from tuisim.core.pen_marks import PenMarks
from tuisim.core.sensors import SENSORS, mounted
from tuisim.core.sensors.color import columns as color_columns
from tuisim.core.sensors.color import disc_pixels_of
from tuisim.core.spec import FIELD_HEIGHT_MM, ColorSensorSpec, NoiseSpec, RunSpec
from tuisim.protocol import SetNoise, UserAction
from tuisim.runs.run_folder import noise_at
from tuisim.runs.views import TickRecord, instant_of

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


def sensor_columns(records: Array, spec: RunSpec, actions: Sequence[UserAction], field: Field) -> dict[str, Array]:
    """Return the columns of every mounted sensor, in the order of the telemetry frame.

    Args:
        records: Telemetry, structured as `records.TICK_FIELDS`, shape (n,).
        spec: The specification of the run.
        actions: The user's actions, which may have changed the noise.
        field: The mat.

    Returns:
        Arrays of float64 with shape (n,), by column name.
    """
    noises = _noises(records, spec, actions)
    lit = any(noise.light for noise in noises)
    sensors = mounted(spec.robot)
    found: dict[str, Array] = {}
    slow = []
    for kind, sensor in sensors:
        if kind is SENSORS["color"] and not lit and sensor.strategy == "mean" and not spec.world.pen_marks:
            found.update(quiet_color_columns(records, sensor, field))
        else:
            slow.append((kind, sensor))
    found.update(_measured(records, slow, noises, spec, field))
    return {name: found[name] for kind, sensor in sensors for name in kind.columns(sensor)}


def quiet_color_columns(records: Array, sensor: ColorSensorSpec, field: Field) -> dict[str, Array]:
    """Return red, green and blue of a colour sensor at every tick, for a run without light noise.

    Args:
        records: Telemetry, structured as `records.TICK_FIELDS`, shape (n,).
        sensor: The sensor.
        field: The mat; it must have sums of the sensor's diameter.
    """
    import numpy as np

    # The cosine of numpy may differ from that of `math` in the last bit, and thereby a pixel.
    turns = [math.radians(heading - 90.0) for heading in records["heading_deg"].tolist()]
    cos, sin = np.array([math.cos(turn) for turn in turns]), np.array([math.sin(turn) for turn in turns])
    diameter = sensor.diameter_mm
    x_mm = records["x_mm"] + cos * sensor.x_mm - sin * sensor.y_mm
    y_mm = records["y_mm"] + sin * sensor.x_mm + cos * sensor.y_mm
    with np.errstate(invalid="ignore"):  # a position beyond all integers is off the mat either way
        col = (x_mm - diameter / 2).astype(np.int64) + diameter
        row = (FIELD_HEIGHT_MM - y_mm - diameter / 2).astype(np.int64) + diameter
    height, width = field.height_px + diameter, field.width_px + diameter
    inside = (col >= 0) & (col < width) & (row >= 0) & (row < height)
    sums = np.zeros((len(records), 3), np.uint32)
    table = np.frombuffer(field.sums[diameter], np.uint32).reshape(height, width, 3)
    sums[inside] = table[row[inside], col[inside]]
    means = sums / disc_pixels_of(diameter)
    return {name: means[:, channel] for channel, name in enumerate(color_columns(sensor))}


def _noises(records: Array, spec: RunSpec, actions: Sequence[UserAction]) -> list[NoiseSpec]:
    """Return the noise at every tick."""
    import numpy as np

    if not any(isinstance(action.command, SetNoise) for action in actions):
        return [spec.world.noise] * len(records)
    noises: list[NoiseSpec] = []
    # The noise can change only where the count of actions does.
    starts = [0, *(np.flatnonzero(np.diff(records["actions"])) + 1).tolist(), len(records)]
    for start, end in pairwise(starts):
        if end > start:
            noises += [noise_at(spec, actions, TickRecord(*records[start].item()))] * (end - start)
    return noises


def _measured(
    records: Array, sensors: Sequence[Any], noises: Sequence[NoiseSpec], spec: RunSpec, field: Field
) -> dict[str, Array]:
    """Return the columns of sensors that are measured tick by tick."""
    import numpy as np

    names = [name for kind, sensor in sensors for name in kind.columns(sensor)]
    rows = np.empty((len(records), len(names)))
    measures = [(kind.measure, sensor) for kind, sensor in sensors]
    pen = PenMarks(field, spec) if spec.world.pen_marks else None
    seen = field if pen is None else pen.field
    for at, (values, noise) in enumerate(zip(records.tolist(), noises, strict=True)):
        if pen is not None:
            pen.take_in([values])
        instant = instant_of(TickRecord(*values), spec, noise)
        rows[at] = [value for measure, sensor in measures for value in measure(sensor, instant, spec, seen)]
    return {name: rows[:, at] for at, name in enumerate(names)}
