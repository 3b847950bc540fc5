"""Dead reckoning over a log of every tick: where the wheels say that the robot is, and how far off that is."""

from __future__ import annotations

import numpy as np

from tuisim.core.spec import from_plain
from tuisim.datalog.analysis.reckoning import dead_reckoning, error_mm
from tuisim.datalog.opening.log import Log, Series
from tuisim.errors import LogError

NEEDED = ("left_position_deg", "right_position_deg", "x_mm", "y_mm", "heading_deg")
RECKONED = ("reckoned_x_mm", "reckoned_y_mm", "reckoned_heading_deg", "error_mm")


def reckoned_series(log: Log) -> list[Series]:
    """Return a series for each name of `RECKONED`.

    Raises:
        LogError: the log is none of every tick, or does not know the robot.
    """
    missing = [name for name in NEEDED if name not in log.table.column_names]
    if missing:
        raise LogError(f"no column {missing[0]!r}", "a stored run, or its telemetry exported", file=log.title)
    try:
        spec = from_plain({k: v for k, v in log.metadata["runs"][0].items() if k not in ("run", "program")})
    except (KeyError, IndexError, TypeError) as error:
        hint = "a stored run, or its telemetry exported to a file"
        raise LogError("does not know the robot", hint, file=log.title) from error
    left, right, x_mm, y_mm, _ = (log.numbers(name) for name in NEEDED)
    found = dead_reckoning(left, right, spec.world.start, spec.robot)
    made = (found.x_mm, found.y_mm, found.heading_deg, error_mm(found, x_mm, y_mm))
    base = next((log.series(name) for name in log.names if len(log.series(name).rows) == log.rows), None)
    time_s = base.time_s if base else np.arange(log.rows, dtype=np.float64)
    rows = base.rows if base else np.arange(log.rows)
    return [Series(name, time_s, values, rows) for name, values in zip(RECKONED, made, strict=True)]
