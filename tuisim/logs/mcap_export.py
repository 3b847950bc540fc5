"""Logs as MCAP, which Foxglove and PlotJuggler show: a channel of JSON messages for the pose and for each variable."""

from __future__ import annotations

import heapq
import json
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import repeat
from operator import itemgetter
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from tuisim.base.atomic import replacing
from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.export import check_place
from tuisim.logs.log import Log
from tuisim.logs.signals import sort_known
from tuisim.logs.units import drop_run, parse_unit

SUFFIX = ".mcap"
POSE = ("x_mm", "y_mm", "heading_deg")
FRAME_ID = "mat"
"""Coordinate frame of the poses: x to the right, y up on the mat, z towards the viewer."""
_TOLD_EVERY = 10_000
"""Number of messages that are written between two reports of the progress."""


def _build_object(title: str, **properties: Any) -> dict[str, Any]:
    return {"type": "object", "title": title, "properties": properties}


_NUMBER = {"type": "number"}
_AXES = dict.fromkeys(("x", "y", "z"), _NUMBER)
_POSE_SCHEMA = _build_object(
    "foxglove.PoseInFrame",
    timestamp=_build_object("time", sec={"type": "integer"}, nsec={"type": "integer"}),
    frame_id={"type": "string"},
    pose=_build_object(
        "foxglove.Pose",
        position=_build_object("foxglove.Vector3", **_AXES),
        orientation=_build_object("foxglove.Quaternion", **_AXES, w=_NUMBER),
    ),
)


class _Channel(NamedTuple):
    topic: str
    schema_name: str
    schema: dict[str, Any]
    times_ns: list[int]
    """Times of the messages in ns, in ascending order; several may be equal."""
    messages: Iterator[dict[str, Any]]


def load_writer() -> ModuleType:
    """Return the module of the library mcap that writes files.

    Raises:
        ConfigError: the library is not installed.
    """
    try:
        import mcap.writer
    except ImportError as error:
        hint = "pip install -e '.[mcap]' in the clone of tuisim"
        raise ConfigError("MCAP files need the library mcap", hint, key="--out") from error
    return mcap.writer


def export_mcap(
    log: Log, names: Sequence[str], path: Path, tell: Callable[[float], None], *, has_pose: bool
) -> int:
    """Write variables of a log as an MCAP file, which replaces an existing one. Missing values have no message.

    Args:
        log: The log.
        names: The variables; x, y and heading are written as poses if `has_pose`.
        path: The file.
        tell: Receives the fraction that has been written.
        has_pose: Whether to write the pose, if the log has one.

    Returns:
        Number of infinite values, which are left out since JSON does not have them.

    Raises:
        ConfigError: the library is not installed.
        ExportError: the file cannot be written, or a time is before 0; an existing file is unchanged.
    """
    library = load_writer()
    check_place(path)
    is_posed = has_pose and set(POSE) <= set(log.table.column_names)
    values = [name for name in names if not (is_posed and drop_run(name) in POSE)]
    channels = [_build_value_channel(log, name) for name in values]
    channels += _build_pose_channels(log) if is_posed else ()
    if any(channel.times_ns and channel.times_ns[0] < 0 for channel in channels):
        raise ExportError(f"cannot write {path}: MCAP has no times before 0", "export to Parquet")
    try:
        with replacing(path) as handle:
            writer = library.Writer(handle)
            writer.start(library="tuisim")
            writer.add_metadata("tuisim", {"log": json.dumps(log.metadata, sort_keys=True)})
            _write_messages(writer, channels, tell)
            writer.finish()
    except OSError as error:
        raise ExportError(f"cannot write {path}: {error.strerror or error}") from error
    return sum(int(np.isinf(log.series(name).values).sum()) for name in values)


def _write_messages(
    writer: Any, channels: Sequence[_Channel], tell: Callable[[float], None]
) -> None:
    """Write the messages of all channels in order of time; `tell` receives the fraction that has been written."""
    streams = []
    for channel in channels:
        schema = json.dumps(channel.schema).encode()
        schema_id = writer.register_schema(channel.schema_name, "jsonschema", schema)
        channel_id = writer.register_channel(channel.topic, "json", schema_id)
        streams.append(zip(channel.times_ns, repeat(channel_id), channel.messages, strict=False))
    total = sum(len(channel.times_ns) for channel in channels)
    in_order = heapq.merge(*streams, key=itemgetter(0))
    for count, (time_ns, channel_id, message) in enumerate(in_order):
        if not count % _TOLD_EVERY:
            tell(count / total)
        writer.add_message(channel_id, time_ns, json.dumps(message).encode(), time_ns, count)


def _build_value_channel(log: Log, name: str) -> _Channel:
    series = log.series(name)
    rows = sort_known(series.time_s, series.values)
    times_s = series.time_s[rows]
    pairs = zip(times_s.tolist(), series.values[rows].tolist(), strict=True)
    base = drop_run(name)
    unit = log.metadata.get("units", {}).get(base) or parse_unit(base).words
    number = {"type": "number", "description": unit} if unit else _NUMBER
    schema = _build_object(name, time={"type": "number", "description": "s"}, value=number)
    messages = ({"time": time_s, "value": value} for time_s, value in pairs)
    return _Channel(f"/{name}", f"tuisim.{name}", schema, _round_nanoseconds(times_s), messages)


def _build_pose_channels(log: Log) -> Iterator[_Channel]:
    """Yield a channel with the poses of each run."""
    runs = log.numbers(log.layout.run) if log.layout.run else np.ones(log.rows)
    numbers = np.array([log.numbers(name) for name in POSE])
    known = np.isfinite([runs, *numbers]).all(axis=0)
    ordinals = np.unique(runs[known]).tolist()
    for run in ordinals:
        rows = sort_known(log.times_s, np.where(known & (runs == run), 1.0, np.nan))
        topic = "/pose" if len(ordinals) == 1 else f"/pose #{run:.0f}"
        times_ns = _round_nanoseconds(log.times_s[rows])
        poses = map(_build_pose, times_ns, *numbers[:, rows].tolist())
        yield _Channel(topic, "foxglove.PoseInFrame", _POSE_SCHEMA, times_ns, poses)


def _build_pose(time_ns: int, x_mm: float, y_mm: float, heading_deg: float) -> dict[str, Any]:
    seconds, nanoseconds = divmod(time_ns, 10**9)
    half_rad = math.radians(heading_deg) / 2
    position = {"x": x_mm / 1000, "y": y_mm / 1000, "z": 0.0}
    turn = {"x": 0.0, "y": 0.0, "z": math.sin(half_rad), "w": math.cos(half_rad)}
    return {
        "timestamp": {"sec": seconds, "nsec": nanoseconds},
        "frame_id": FRAME_ID,
        "pose": {"position": position, "orientation": turn},
    }


def _round_nanoseconds(times_s: FloatArray) -> list[int]:
    times_ns: list[int] = np.rint(times_s * 1e9).astype(np.int64).tolist()
    return times_ns
