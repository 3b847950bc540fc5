"""Long logs as files, made in a few seconds: what programs printed, and every tick of a recording."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
import pyarrow.parquet as pq

MILLION = 1_000_000
_GREYS = (100.0, 86.27450980392157, 100.0, 82.74509803921568, 100.0, 50.19607843137255, 100.0, 0.0)
_BAND_SAMPLES = 37


def _light(rows: int) -> pa.Array:
    return np.array(_GREYS)[np.arange(rows) // _BAND_SAMPLES % len(_GREYS)]


def samples(rows: int) -> pa.Table:
    """Return a log as four kinds of printed lines make it, columns as in an export."""
    chance = np.random.default_rng(7)
    at = np.arange(rows)
    light = _light(rows)
    values = np.choose(
        at % 4,
        (
            light + chance.normal(0.0, 0.3, rows),
            light,
            np.rint(2550 * chance.random(rows)),
            np.sin(at / 1e4) * 90,
        ),
    )
    names = pa.DictionaryArray.from_arrays(
        (at % 4).astype(np.int32), ["Colour", "Right", "Ultrasonic", "Gyro"]
    )
    return pa.table(
        {
            "index": pa.array(at * 50_000_000, pa.duration("ns")),
            "variable": names.cast(pa.string()),
            "value": values,
            "time": np.round(at * 0.05, 2),
            "run": np.ones(rows, np.int64),
            "x_mm": at % 2000 + chance.random(rows),
            "y_mm": np.full(rows, 500.0),
            "heading_deg": np.zeros(rows),
            "line": 9 + at % 4,
        }
    )


def telemetry(rows: int) -> pa.Table:
    """Return a log of every tick, columns as in an export."""
    chance = np.random.default_rng(8)
    at = np.arange(rows)
    columns = {
        "time": np.round(at * 0.01, 2),
        "x_mm": 1000 + 900 * np.sin(at / 3000),
        "y_mm": 500 + 400 * np.cos(at / 3000),
        "heading_deg": at / 50 % 360 - 180,
        "left_position_deg": at * 5.25,
        "right_position_deg": at * 5.25,
        "left_speed_dps": np.full(rows, 525.0),
        "right_speed_dps": np.full(rows, 525.0),
    }
    for side in ("left", "right"):
        for colour in ("red", "green", "blue"):
            columns[f"{side}_{colour}"] = np.round(
                2.55 * _light(rows) + chance.normal(0.0, 1.0, rows), 4
            )
    columns["ultrasonic_mm"] = np.rint(2550 * chance.random(rows))
    columns["gyro_deg"] = np.rint(at / 50) % 360
    columns["gyro_rate_dps"] = np.zeros(rows)
    columns["line"] = 9 + at % 7
    return pa.table(columns)


KINDS: Mapping[str, Callable[[int], pa.Table]] = {"samples": samples, "telemetry": telemetry}
"""Every kind of log by name."""


def written(table: pa.Table, path: Path) -> Path:
    """Write a log as CSV or Parquet, by the suffix, and return its path."""
    if path.suffix == ".parquet":
        pq.write_table(table, path)
        return path
    if "index" in table.column_names:
        table = table.set_column(
            table.column_names.index("index"), "index", _spans(table.column("index"))
        )
    pa_csv.write_csv(table, path, pa_csv.WriteOptions(quoting_style="none"))
    return path


def _spans(column: pa.ChunkedArray) -> pa.Array:
    """Return spans of time as pandas prints them."""
    micros = column.cast(pa.int64()).to_numpy() // 1000
    seconds = micros // MILLION

    def digits(numbers: pa.Array, width: int = 1) -> pa.Array:
        return pc.utf8_lpad(pc.cast(pa.array(numbers), pa.string()), width, "0")

    clock = (
        digits(seconds // 3600 % 24, 2),
        digits(seconds // 60 % 60, 2),
        digits(seconds % 60, 2),
    )
    whole = pc.binary_join_element_wise(*clock, ":")
    return pc.binary_join_element_wise(
        digits(seconds // 86400), " days ", whole, ".", digits(micros % MILLION, 6), ""
    )
