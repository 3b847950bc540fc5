"""Recordings as columns and pandas frames: printed samples, and telemetry of every tick with readings of every sensor.

The readings are computed from the telemetry. They equal those of `engine.core.sensors` bit by bit: `sensor_arrays`
measures at all ticks together where it can, and everything else is measured tick by tick with the same functions.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import partial
from itertools import chain, pairwise, repeat
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import MOTION, Column, list_measured_names
from tuisim.engine.core.conditions import ValueCondition
from tuisim.engine.core.drive import compute_mm_per_degree
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.motor_columns import MOTOR_FIELDS, find_motor_owners, name_motors
from tuisim.engine.core.pen_marks import PenMarks
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.sensors import MountedSensor, list_columns, list_mounted, list_owners
from tuisim.engine.core.spec import NoiseSpec, RobotSpec, RunSpec
from tuisim.engine.core.tick_record import TICK_RECORD
from tuisim.engine.protocol import SetNoise, UserAction
from tuisim.engine.runs.command_events import CommandedRun, CommandIndex, ScaleChange
from tuisim.engine.runs.motor_records import read_motor_columns
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.records import TELEMETRY_FILE
from tuisim.engine.runs.run_folder import StoredRun, find_noise
from tuisim.engine.runs.samples import list_samples
from tuisim.engine.runs.views import TickRecord

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

    from tuisim.engine.runs.arrays import FloatArray

    Array = np.ndarray[Any, Any]


@dataclass(frozen=True, slots=True)
class DeadReckoning:
    """The poses of a robot by dead reckoning, from its wheels' encoders: arrays of shape (n,), in mm and degrees."""

    x_mm: FloatArray
    y_mm: FloatArray
    heading_deg: FloatArray

    def compute_error_mm(self, x_mm: FloatArray, y_mm: FloatArray) -> FloatArray:
        """Return how far each position by dead reckoning is from the robot's true position, in mm, shape (n,).

        Args:
            x_mm, y_mm: The true positions, each of shape (n,).
        """
        import numpy as np

        return np.hypot(self.x_mm - x_mm, self.y_mm - y_mm)


def compute_dead_reckoning(
    left_position_deg: FloatArray, right_position_deg: FloatArray, start: Pose, robot: RobotSpec
) -> DeadReckoning:
    """Return the poses that follow from the motors' positions alone, as if the wheels always gripped the floor.

    Between two ticks the robot drives an arc. The straight line from its start to its end points halfway between the
    headings at both.

    Args:
        left_position_deg: Position of the left wheel's motor at each tick, shape (n,).
        right_position_deg: Position of the right wheel's motor at each tick, shape (n,).
        start: Pose at the first tick.
        robot: The robot, with the sizes of its wheels.
    """
    import numpy as np

    left_per_degree, right_per_degree = compute_mm_per_degree(robot)
    left = np.diff(left_position_deg, prepend=left_position_deg[:1]) * left_per_degree
    right = np.diff(right_position_deg, prepend=right_position_deg[:1]) * right_per_degree
    turn_rad = (right - left) / robot.wheel_spacing_mm
    heading_rad = np.radians(start.heading_deg) + np.cumsum(turn_rad)
    halfway = heading_rad - turn_rad / 2.0
    # A chord is shorter than its arc; sinc is sin(pi x) / (pi x).
    chord = (left + right) / 2.0 * np.sinc(turn_rad / (2.0 * np.pi))
    return DeadReckoning(
        start.x_mm + np.cumsum(chord * np.cos(halfway)),
        start.y_mm + np.cumsum(chord * np.sin(halfway)),
        np.degrees(heading_rad),
    )


FieldAt: TypeAlias = Callable[[tuple[float, ...]], Field]
"""Returns the mat as the sensors see it in the tick of a record, which has the fields of `TICK_RECORD`."""


class RecordedRun(CommandedRun, Protocol):
    """A run, running or stored, with its folder and its spec, which includes parts that were plugged in so far."""

    @property
    def spec(self) -> RunSpec: ...


_POSE = ("x_mm", "y_mm", "heading_deg")
LINE = "line"
"""The column with the source line that spent the time, 0 for none."""
SAMPLE_COLUMNS = ("index", "variable", "value", "time", "run", *_POSE, LINE)
"""Columns of the samples frame, in order."""

MOTION_COLUMNS = list_measured_names(MOTION)
"""Columns of the telemetry frame that are copied from the recording."""

_TURN_FIELDS = ("position_deg", "speed_dps", *(name for name, _ in MOTOR_FIELDS[:3]))
"""Columns of a motor whose sign and size depend on how the program counts its degrees."""

_MOST = 1e15
"""Values from this size on, in mm or degrees, are damage: no motion gets this far."""


def build_samples_frame(runs: Iterable[StoredRun]) -> pd.DataFrame:
    """Return the samples of one or more runs as a pandas frame, with the columns of `sample_columns`.

    Raises:
        LogError: a recording is damaged.
    """
    import pandas as pd

    columns = sample_columns(runs)
    return pd.DataFrame({**columns, "variable": pd.Series(columns["variable"], dtype="str")})


def sample_columns(runs: Iterable[StoredRun]) -> dict[str, Any]:
    """Return the samples of one or more runs as columns by name, in the order of the runs and of printing.

    The columns are those of `SAMPLE_COLUMNS`. `index` is the time since the first sample of the run was printed, as
    timedelta64[ns]. `variable` and `value` are the sample's name and number. `time` is the time in the printed line, or
    else the simulated time of the print, in s. `run` is the number of the run in the result, from 1. `x_mm`, `y_mm` and
    `heading_deg` are the robot's pose at the tick of the print, NaN if that tick was lost. `line` is the program's line
    that printed the sample.

    Raises:
        LogError: a recording is damaged.
    """
    import numpy as np

    parts = [_list_samples(run, ordinal) for ordinal, run in enumerate(runs, 1)]
    joined: dict[str, Any] = {}
    for name in SAMPLE_COLUMNS:
        if name == "variable":
            joined[name] = [text for part in parts for text in part[name]]
        else:
            empty = {
                "index": np.empty(0, "m8[ns]"),
                "run": np.empty(0, np.int64),
                "line": np.empty(0, np.int64),
            }
            joined[name] = np.concatenate(
                [empty.get(name, np.empty(0)), *(part[name] for part in parts)]
            )
    return joined


def _list_samples(run: StoredRun, ordinal: int) -> dict[str, Any]:
    import numpy as np

    samples = list_samples(run.output.rows())
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


def build_telemetry_frame(run: StoredRun, field: Field | None = None) -> pd.DataFrame:
    """Return the telemetry of a run as a pandas frame, with the columns of `build_telemetry_columns`.

    Raises:
        LogError: a recording is damaged, or the mat no longer exists.
    """
    import pandas as pd

    return pd.DataFrame(build_telemetry_columns(run, field))


def build_telemetry_columns(
    run: StoredRun, field: Field | None = None, names: Sequence[str] = ()
) -> dict[str, Array]:
    """Return the telemetry of a run as columns by name, with one row per tick, including tick 0 (the start).

    The first column is `time`, in simulated seconds. Then come those of the robot, such as `x_mm`, of every sensor,
    such as `left_red`, and of the motors if they are recorded, such as `left_asked_dps`. The last one is `line`, the
    program's line that ran at the tick, or 0 for none. Damaged records are left out; see `describe_damage`.

    Args:
        run: The run.
        field: The mat; by default that of the run.
        names: The columns to return after `time`: names of `list_columns`, or `line`. If it is empty, all of the above.

    Raises:
        LogError: a recording is damaged, or the mat no longer exists.
    """
    records = _select_sound(run.telemetry.array())
    mat = run.open_mat() if field is None else field
    exported = names or (*list_measured_names(list_columns(run.spec)), LINE)
    columns = [name for name in exported if name != LINE]
    values = compute_column_values(columns, records, run, run.actions, mat)
    values[LINE] = records[LINE].astype("i8")
    return {"time": tick_times_s(records, run.spec), **{name: values[name] for name in exported}}


def compute_column_values(
    names: Collection[str],
    records: Array,
    run: RecordedRun,
    actions: Sequence[UserAction],
    field: Field,
    field_at: FieldAt | None = None,
) -> dict[str, Array]:
    """Return the values of columns at every tick, by the names of the columns: float64, shape (n,).

    Args:
        names: Names of columns from `list_columns`.
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        run: The run.
        actions: The user's actions, which may have changed the noise.
        field: The mat.
        field_at: Returns the mat with the pen's marks, as the sensors saw it, for a tick record. With None, the marks
            follow from the records, which must then begin with tick 0 and have no gaps.
    """
    spec = run.spec
    sensors = [
        mount
        for mount in list_mounted(spec.robot)
        if any(column.name in names for column in mount.columns)
    ]
    measured = {name: records[name].astype("f8") for name in MOTION_COLUMNS}
    measured |= _measure_columns(
        records, sensors, _list_noises(records, spec, actions), spec, field, field_at
    )
    motors = [
        columns
        for columns, _ in find_motor_owners(spec)
        if any(column.name in names for column in columns)
    ]
    if motors:
        measured |= read_motor_columns(run.folder, spec.robot, records["tick"])
    changes = list_scale_changes(run)
    for prefix, scales in compute_scales(records["tick"], spec.robot, changes).items():
        for name in measured.keys() & {f"{prefix}_{field}" for field in _TURN_FIELDS}:
            # Adding 0.0 turns -0.0 into 0.0.
            measured[name] = measured[name] * scales + 0.0
    arrays = {}
    for columns in (MOTION, *(mount.columns for mount in sensors), *motors):
        for column in columns:
            if column.name not in names:
                continue
            if column.of is None:
                arrays[column.name] = measured[column.name]
            else:
                arrays[column.name] = _compute_column(column.of, columns, measured, spec)
    return arrays


def list_scale_changes(run: CommandedRun) -> list[ScaleChange]:
    """Return each change of a motor's scale in a run, as a tuple of a tick, the motor's port, and the new scale.

    A scale is the number of degrees that the program counts while the motor turns by one degree.
    """
    if isinstance(run, Recording):
        return run.commands.scale_changes
    return CommandIndex(run).read_scale_changes()


def compute_scales(
    ticks: Array, robot: RobotSpec, changes: Iterable[ScaleChange]
) -> dict[str, FloatArray]:
    """Return the scale of each motor at some ticks: how many degrees the program counts while it turns by one degree.

    The keys are the prefixes of the motors' columns, such as `left`; the values have shape (n,). Motors whose scale
    never changed are missing: their scale is 1.

    Args:
        ticks: Numbers of ticks, shape (n,).
        robot: The robot.
        changes: The changes of the scales, from `list_scale_changes`.
    """
    import numpy as np

    names = {
        motor.port: name for motor, name in zip(robot.motors, name_motors(robot), strict=False)
    }
    scales: dict[str, FloatArray] = {}
    for tick, port, scale in changes:
        if port in names:
            scales.setdefault(names[port], np.ones(len(ticks)))[ticks >= tick] = scale
    return scales


def _compute_column(
    of: Callable[[Iterable[Sequence[float]], RunSpec], list[float]],
    columns: Iterable[Column],
    measured: Mapping[str, Array],
    spec: RunSpec,
) -> Array:
    """Return a column that is computed from measured ones: its value at every tick, shape (n,).

    Args:
        of: Computes the values of the column from rows of measured values, one row for each tick.
        columns: All columns of the sensor or motor to which the column belongs.
        measured: The measured columns by name.
        spec: The run.
    """
    import numpy as np

    rows = zip(*(measured[name].tolist() for name in list_measured_names(columns)), strict=True)
    return np.array(of(rows, spec), np.float64)


def find_lacking_columns(
    spec: RunSpec, names: Collection[str], read: Callable[[str], Array]
) -> dict[str, Callable[[], Array]]:
    """Return functions that compute those columns of a run that its telemetry lacks, by the name of the column.

    Each function returns the values of its column at every tick. A column that cannot be computed has no function.

    Args:
        spec: The run.
        names: The columns that the telemetry has.
        read: Returns the values of a column that the telemetry has, by its name.
    """

    def compute(of: Any, columns: Sequence[Column]) -> Array:
        return _compute_column(
            of, columns, {name: read(name) for name in list_measured_names(columns)}, spec
        )

    present = set(names)
    return {
        column.name: partial(compute, column.of, columns)
        for columns, _ in list_owners(spec)
        for column in columns
        if column.of is not None
        and column.name not in present
        and present.issuperset(list_measured_names(columns))
    }


def evaluate_condition(condition: ValueCondition, values: Array) -> Array:
    """Return whether a condition is true at each tick, as an array of booleans.

    Args:
        condition: The condition on the values of a column.
        values: The values of this column.

    Raises:
        ValueError: the condition compares with something that is not a number.
    """
    import numpy as np

    true: Array = condition.test()(values, np.concatenate(([np.nan], values[:-1])))
    return true


def describe_damage(run: StoredRun) -> str:
    """Return a message with the number of damaged records; empty if there are none.

    Raises:
        LogError: a recording is damaged.
    """
    records = run.telemetry.array()
    lost = len(records) - len(_select_sound(records))
    return (
        f"{TELEMETRY_FILE}: {lost} of {len(records)} records {'is' if lost == 1 else 'are'} damaged and left out"
        if lost
        else ""
    )


def _select_sound(records: Array) -> Array:
    """Return those tick records in which every number is plausible, and none is NaN."""
    import numpy as np

    whole = np.ones(len(records), np.bool_)
    for name in (*MOTION_COLUMNS, "gyro_zero_deg"):
        # This comparison is false for NaN, too.
        whole &= np.abs(records[name]) < _MOST
    return records if whole.all() else records[whole]


def tick_times_s(records: Array, spec: RunSpec) -> Array:
    """Return the time at which each tick is due, in simulated seconds from the start, shape (n,).

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        spec: The run, whose profile has the tick rate.
    """
    ticks = records["tick"].astype("i8")
    times: Array = -(-ticks * NS_PER_S // spec.profile.tick_hz) / NS_PER_S
    return times


def _list_noises(
    records: Array, spec: RunSpec, actions: Sequence[UserAction]
) -> list[tuple[NoiseSpec, int]]:
    """Return the noise settings of a run in order of time, each with the number of ticks for which it applied.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`.
        spec: The run, as it began.
        actions: The user's actions, which may have changed the noise.
    """
    import numpy as np

    if not any(isinstance(action.command, SetNoise) for action in actions):
        return [(spec.world.noise, len(records))]
    # The noise can change only at ticks at which the count of the user's actions changes.
    starts = [0, *(np.flatnonzero(np.diff(records["actions"])) + 1).tolist(), len(records)]
    return [
        (find_noise(spec, actions, TickRecord(*records[start].item())), end - start)
        for start, end in pairwise(starts)
        if end > start
    ]


def _measure_columns(
    records: Array,
    sensors: Sequence[MountedSensor],
    noises: Sequence[tuple[NoiseSpec, int]],
    spec: RunSpec,
    field: Field,
    field_at: FieldAt | None,
) -> dict[str, Array]:
    """Return the measured columns of sensors by name, computed with arrays where possible, else tick by tick.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`, shape (n,).
        sensors: The sensors.
        noises: The result of `_list_noises`.
        spec: The run.
        field: The mat.
        field_at: Returns the mat with the pen's marks, as the sensors saw it, for a tick record. With None, the marks
            follow from the records.
    """
    import numpy as np

    from tuisim.engine.runs.sensor_arrays import measure_array

    arrays: dict[str, Array] = {}
    slow: list[MountedSensor] = []
    lit = any(noise.light for noise, _ in noises)
    for mount in sensors:
        values = measure_array(mount.sensor, records, spec, field, lit)
        if values is None:
            slow.append(mount)
        else:
            arrays.update(zip(mount.names, values, strict=True))
    if not slow:
        return arrays
    names = [name for mount in slow for name in mount.names]
    rows = np.empty((len(records), len(names)))
    field_at = field_at or _field_with_marks(field, spec)
    every = chain.from_iterable(repeat(noise, count) for noise, count in noises)
    # The records are unpacked one by one: as objects, all records of a long run would take much memory.
    for index, (record, noise) in enumerate(
        zip(TICK_RECORD.iter_unpack(records.data), every, strict=True)
    ):
        instant = TickRecord(*record).build_instant(spec, noise)
        seen = field_at(record)
        rows[index] = [
            value
            for mount in slow
            for value in mount.kind.measure(mount.sensor, instant, spec, seen)
        ]
    return {**arrays, **{name: rows[:, index] for index, name in enumerate(names)}}


def _field_with_marks(field: Field, spec: RunSpec) -> FieldAt:
    """Return a function that returns the mat with its pen marks at a tick record.

    It must be called with every record in turn, from tick 0 on.
    """
    if not spec.world.pen_marks:
        return lambda _: field
    pen = PenMarks(field, spec)

    def field_at(record: tuple[float, ...]) -> Field:
        pen.add_records([record])
        return pen.field

    return field_at
