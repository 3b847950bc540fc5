"""Recordings as pandas frames: printed samples, and the telemetry of every tick."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from tuisim.core.field import Field
from tuisim.core.simulation import NS_PER_S
from tuisim.core.spec import RunSpec
from tuisim.runs.mat import open_mat
from tuisim.runs.records import TELEMETRY_FILE
from tuisim.runs.run_folder import StoredRun
from tuisim.runs.samples import samples_of
from tuisim.runs.sensor_columns import sensor_columns

if TYPE_CHECKING:
    import numpy as np
    import pandas as pd

SAMPLE_COLUMNS = ("index", "variable", "value", "time", "run", "x_mm", "y_mm", "heading_deg", "line")
"""Columns of the samples frame, in order."""

MOTION_COLUMNS = (
    "x_mm",
    "y_mm",
    "heading_deg",
    "left_position_deg",
    "right_position_deg",
    "left_speed_dps",
    "right_speed_dps",
)
"""Columns of the telemetry frame that are copied from the recording."""

_MOST = 1e15
"""Larger values, in mm or degrees, count as damage: no motion gets this far."""

_POSE = ("x_mm", "y_mm", "heading_deg")


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


def telemetry_frame(run: StoredRun, field: Field | None = None) -> pd.DataFrame:
    """Return one row per tick, including tick 0 (the start); damaged records are omitted, see `damage_note`.

    Columns: `time` in s, simulated; MOTION_COLUMNS; those of every mounted sensor, such as
    `left_red` (0 … 255), `ultrasonic_mm`, `gyro_deg`, `gyro_rate_dps`; `line`, the source line
    that spent the time, 0 for none.

    Args:
        run: The run.
        field: The mat; by default that of the run.

    Raises:
        LogError: a recording is damaged, or the mat no longer exists.
    """
    import pandas as pd

    records = _sound(run.telemetry.array())
    columns: dict[str, Any] = {"time": tick_times_s(records, run.spec)}
    for name in MOTION_COLUMNS:
        columns[name] = records[name].astype("f8")
    columns.update(sensor_columns(records, run.spec, run.actions, open_mat(run) if field is None else field))
    columns["line"] = records["line"].astype("i8")
    return pd.DataFrame(columns)


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


def _sound(records: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the records that contain only plausible numbers."""
    import numpy as np

    whole = np.ones(len(records), np.bool_)
    for name in (*MOTION_COLUMNS, "gyro_zero_deg"):
        # Also false for NaN.
        whole &= np.abs(records[name]) < _MOST
    return records if whole.all() else records[whole]


def tick_times_s(records: np.ndarray[Any, Any], spec: RunSpec) -> np.ndarray[Any, Any]:
    """Return the time at which each tick is due, in simulated seconds, shape (n,)."""
    ticks = records["tick"].astype("i8")
    times: np.ndarray[Any, Any] = -(-ticks * NS_PER_S // spec.profile.tick_hz) / NS_PER_S
    return times
