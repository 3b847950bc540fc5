"""Logs for the tests of the analyser."""

from __future__ import annotations

import numpy as np
import pyarrow as pa

from tuisim.analysis.model import AnalysisModel
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log


def long_log(runs: int = 1) -> Log:
    """Two variables, ten samples each, of every run; the value of `Colour` falls from 90 to 0, `Left` rises."""
    rows: dict[str, list[object]] = {
        "variable": [],
        "value": [],
        "time": [],
        "run": [],
        "x_mm": [],
        "y_mm": [],
    }
    for run in range(1, runs + 1):
        for at in range(10):
            for name, value in (("Colour", 90.0 - 10 * at), ("Left", float(at))):
                row = (name, value, float(at * run), run, 100.0 * at, 500.0)
                for column, cell in zip(rows.values(), row, strict=True):
                    column.append(cell)
    table = pa.table(rows)
    return Log("test", table, choose_columns(table))


def wide_log(rows: int) -> Log:
    """One variable of many samples, a thousand a second."""
    time_s = np.arange(rows) / 1000.0
    table = pa.table({"time": time_s, "wave": np.sin(time_s) + (np.arange(rows) % 1013 == 0)})
    return Log("test", table, choose_columns(table))


def model_of(log: Log) -> AnalysisModel:
    return AnalysisModel(OpenedLog(LogRequest(), log))
