"""Recordings as pandas frames: printed samples, and the telemetry of every tick with the readings of every sensor.

The readings are computed from the telemetry. They equal those of `core.sensors` bit by bit: the colour sums are looked
up for all ticks at once, everything else is measured tick by tick with the same functions.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from tuisim.core.columns import MOTION, measured_names
from tuisim.core.comparison import COMPARE, Operator
from tuisim.core.field import Field
from tuisim.core.pen_marks import PenMarks
from tuisim.core.profile import NS_PER_S
from tuisim.core.sensors import SENSORS, SensorKind, mounted
from tuisim.core.sensors.color import disc_pixels_of
from tuisim.core.spec import FIELD_HEIGHT_MM, ColorSensorSpec, NoiseSpec, RunSpec
from tuisim.core.tick_record import TICK_RECORD
from tuisim.protocol import SetNoise, UserAction
from tuisim.runs.records import TELEMETRY_FILE
from tuisim.runs.run_folder import StoredRun, noise_at, open_mat
from tuisim.runs.samples import samples_of
from tuisim.runs.views import TickRecord, instant_of

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

    Array = np.ndarray[Any, Any]

_POSE = ("x_mm", "y_mm", "heading_deg")
SAMPLE_COLUMNS = ("index", "variable", "value", "time", "run", *_POSE, "line")
"""Columns of the samples frame, in order."""

MOTION_COLUMNS = measured_names(MOTION)
"""Columns of the telemetry frame that are copied from the recording."""

_MOST = 1e15
"""Larger values, in mm or degrees, count as damage: no motion gets this far."""


def samples_frame(runs: Iterable[StoredRun]) -> pd.DataFrame:
    """Return the samples of one or more runs, in the order of the runs and of printing.

    Columns, as SAMPLE_COLUMNS: `index` timedelta64[ns] since the first sample of its run was
    printed; `variable` the name; `value`; `time` in s, simulated, of the print or as printed;
    `run` numbers the runs of this frame from 1; `x_mm`, `y_mm`, `heading_deg` the pose of the robot
    at the tick of the print, NaN if that tick was lost; `line` in the program.

    Raises:
        LogError: a recording is damaged.
    """
    import numpy as np
    import pandas as pd

    parts = [_samples_of_run(run, ordinal) for ordinal, run in enumerate(runs, 1)]
    joined: dict[str, Any] = {}
    for name in SAMPLE_COLUMNS:
        if name == "variable":
            joined[name] = pd.Series([text for part in parts for text in part[name]], dtype="str")
        else:
            empty = {"index": np.empty(0, "m8[ns]"), "run": np.empty(0, np.int64), "line": np.empty(0, np.int64)}
            joined[name] = np.concatenate([empty.get(name, np.empty(0)), *(part[name] for part in parts)])
    return pd.DataFrame(joined)


def _samples_of_run(run: StoredRun, ordinal: int) -> dict[str, Any]:
    import numpy as np

    samples = list(samples_of(run.output.rows()))
    times_ns = np.array([sample.time_ns for sample in samples], np.int64)
    records = run.telemetry.array()
    ticks = np.array([sample.tick for sample in samples], np.int64)
    known = ticks < len(records)
    columns: dict[str, Any] = {
        "index": (times_ns - times_ns[:1]).astype("m8[ns]"),
        "variable": [sample.name for sample in samples],
        "value": np.array([sample.value for sample in samples], np.float64),
        "time": np.array([sample.time_s for sample in samples], np.float64),
        "run": np.full(len(samples), ordinal, np.int64),
        "line": np.array([sample.line for sample in samples], np.int64),
    }
    for name in _POSE:
        columns[name] = np.full(len(samples), np.nan)
        columns[name][known] = records[name][ticks[known]]
    return columns


def telemetry_frame(run: StoredRun, field: Field | None = None, also: Iterable[str] = ()) -> pd.DataFrame:
    """Return one row per tick, including tick 0 (the start); damaged records are omitted, see `damage_note`.

    Columns: `time` in s, simulated; MOTION_COLUMNS; those of every mounted sensor, such as
    `left_red` (0 … 255), `ultrasonic_mm`, `gyro_deg`, `gyro_rate_dps`; `line`, the source line
    that spent the time, 0 for none.

    Args:
        field: The mat; by default that of the run.
        also: Names of further columns of `columns_of`, which come last.

    Raises:
        LogError: a recording is damaged, or the mat no longer exists.
    """
    import pandas as pd

    records = _sound(run.telemetry.array())
    columns: dict[str, Any] = {"time": tick_times_s(records, run.spec)}
    for name in MOTION_COLUMNS:
        columns[name] = records[name].astype("f8")
    mat = open_mat(run) if field is None else field
    columns.update(sensor_columns(records, run.spec, run.actions, mat))
    columns["line"] = records["line"].astype("i8")
    for name in also:
        columns[name] = column_values(name, records, run.spec, run.actions, mat)
    return pd.DataFrame(columns)


def column_values(name: str, records: Array, spec: RunSpec, actions: Sequence[UserAction], field: Field) -> Array:
    """Return a column at every tick: float64, shape (n,).

    Args:
        name: One of `columns_of` the robot.
        records: Telemetry from tick 0 on, structured as `TICK_FIELDS`, shape (n,).
        spec: The specification of the run.
        actions: The user's actions, which may have changed the noise.
        field: The mat.
    """
    import numpy as np

    robot = spec.robot
    owners = [(kind.columns(sensor), [(kind, sensor)]) for kind, sensor in mounted(robot)]
    columns, owner = next(one for one in [*owners, (MOTION, [])] if any(column.name == name for column in one[0]))
    if owner:
        measured = sensor_columns(records, spec, actions, field, owner)
    else:
        measured = {moved: records[moved].astype("f8") for moved in MOTION_COLUMNS}
    compute = next(column.of for column in columns if column.name == name)
    if compute is None:
        return measured[name]
    return np.array([compute(row, robot) for row in zip(*map(_listed, measured.values()), strict=True)], np.float64)


def ticks_when(values: Array, operator: Operator, number: float) -> Array:
    """Return the indices at which a column begins to meet a condition, in ascending order."""
    import numpy as np

    met = COMPARE[operator](values, number)
    began: Array = np.flatnonzero(met & ~np.concatenate(([False], met[:-1])))
    return began


def _listed(values: Array) -> list[float]:
    found: list[float] = values.tolist()
    return found


def damage_note(run: StoredRun) -> str:
    """Return a message with the number of damaged records; empty if there are none.

    Raises:
        LogError: a recording is damaged.
    """
    records = run.telemetry.array()
    lost = len(records) - len(_sound(records))
    return (
        f"{TELEMETRY_FILE}: {lost} of {len(records)} records {'is' if lost == 1 else 'are'} damaged and left out"
        if lost
        else ""
    )


def _sound(records: Array) -> Array:
    """Return the records that contain only plausible numbers."""
    import numpy as np

    whole = np.ones(len(records), np.bool_)
    for name in (*MOTION_COLUMNS, "gyro_zero_deg"):
        # Also false for NaN.
        whole &= np.abs(records[name]) < _MOST
    return records if whole.all() else records[whole]


def tick_times_s(records: Array, spec: RunSpec) -> Array:
    """Return the time at which each tick is due, in simulated seconds, shape (n,)."""
    ticks = records["tick"].astype("i8")
    times: Array = -(-ticks * NS_PER_S // spec.profile.tick_hz) / NS_PER_S
    return times


def sensor_columns(
    records: Array,
    spec: RunSpec,
    actions: Sequence[UserAction],
    field: Field,
    sensors: Sequence[tuple[SensorKind, Any]] | None = None,
) -> dict[str, Array]:
    """Return what sensors have measured, in the order of the telemetry frame.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        spec: The specification of the run.
        actions: The user's actions, which may have changed the noise.
        field: The mat.
        sensors: Some of `mounted`; None for all.

    Returns:
        Arrays of float64 with shape (n,), by column name.
    """
    noises = _noises(records, spec, actions)
    lit = any(noise.light for noise in noises)
    sensors = mounted(spec.robot) if sensors is None else sensors
    found: dict[str, Array] = {}
    slow = []
    for kind, sensor in sensors:
        if kind is SENSORS["color"] and not lit and sensor.strategy == "mean" and not spec.world.pen_marks:
            found.update(quiet_color_columns(records, sensor, field))
        else:
            slow.append((kind, sensor))
    found.update(_measured(records, slow, noises, spec, field))
    return {name: found[name] for kind, sensor in sensors for name in kind.names(sensor)}


def quiet_color_columns(records: Array, sensor: ColorSensorSpec, field: Field) -> dict[str, Array]:
    """Return red, green and blue of a colour sensor at every tick, for a run without light noise.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        sensor: The sensor.
        field: The mat; it must have sums of the sensor's diameter.
    """
    import numpy as np

    # The cosine of numpy may differ from that of `math` in the last bit, which can change a pixel.
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
    return {name: means[:, channel] for channel, name in enumerate(SENSORS["color"].names(sensor))}


def _noises(records: Array, spec: RunSpec, actions: Sequence[UserAction]) -> list[NoiseSpec]:
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

    names = [name for kind, sensor in sensors for name in kind.names(sensor)]
    rows = np.empty((len(records), len(names)))
    measures = [(kind.measure, sensor) for kind, sensor in sensors]
    pen = PenMarks(field, spec) if spec.world.pen_marks else None
    seen = field if pen is None else pen.field
    # One by one: all at once, as objects, the records of a long run take much memory.
    for at, (values, noise) in enumerate(zip(TICK_RECORD.iter_unpack(records.data), noises, strict=True)):
        if pen is not None:
            pen.take_in([values])
        instant = instant_of(TickRecord(*values), spec, noise)
        rows[at] = [value for measure, sensor in measures for value in measure(sensor, instant, spec, seen)]
    return {name: rows[:, at] for at, name in enumerate(names)}
