"""Logs as MCAP, which Foxglove and PlotJuggler show: a channel of JSON messages for the pose and for each variable."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from tuisim.base.atomic import replacing
from tuisim.base.errors import ConfigError, ExportError
from tuisim.engine.runs.arrays import FloatArray, IntArray
from tuisim.logs.export import check_place
from tuisim.logs.log import Log
from tuisim.logs.units import parse_unit

SUFFIX = ".mcap"
POSE = ("x_mm", "y_mm", "heading_deg")
FRAME_ID = "mat"
"""Coordinate frame of the poses: x to the right, y up on the mat, z towards the viewer."""
_TOLD_EVERY = 10_000
"""Messages between two updates of the progress."""


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
    times_ns: IntArray
    write: Callable[[int], str]
    """Returns the message with an index as JSON."""


def load_writer() -> ModuleType:
    """Return the module of the library mcap that writes files.

    Raises:
        ConfigError: it is not installed.
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
        names: The variables; x, y and heading are written as poses if `has_pose`.
        tell: Is given the fraction that has been written.
        has_pose: Whether to write the pose, if the log has one.

    Returns:
        Number of infinite values, which JSON does not have and which are left out.

    Raises:
        ConfigError: the library is not installed.
        ExportError: it cannot be written, or a time is before 0; an existing file is unchanged.
    """
    library = load_writer()
    check_place(path)
    is_posed = has_pose and set(POSE) <= set(log.table.column_names)
    values = [name for name in names if not (is_posed and name.partition(" #")[0] in POSE)]
    channels = [*map(_build_value_channel, [log] * len(values), values)]
    channels += _build_pose_channels(log) if is_posed else ()
    if any(len(channel.times_ns) and channel.times_ns.min() < 0 for channel in channels):
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
    """Write the messages of all channels in the order of their times."""
    ids = []
    for channel in channels:
        schema = json.dumps(channel.schema).encode()
        schema_id = writer.register_schema(channel.schema_name, "jsonschema", schema)
        ids.append(writer.register_channel(channel.topic, "json", schema_id))
    counts = [len(channel.times_ns) for channel in channels]
    times_ns = np.concatenate([np.empty(0, np.int64), *(stream.times_ns for stream in channels)])
    of_channel = np.repeat(np.arange(len(channels)), counts)
    index = np.arange(len(times_ns)) - np.repeat(np.cumsum([0, *counts])[:-1], counts)
    order = np.argsort(times_ns, kind="stable")
    rows = zip(*(part[order].tolist() for part in (times_ns, of_channel, index)), strict=True)
    for count, (time_ns, channel_index, message) in enumerate(rows):
        if not count % _TOLD_EVERY:
            tell(count / len(times_ns))
        text = channels[channel_index].write(message).encode()
        writer.add_message(ids[channel_index], time_ns, text, time_ns, count)


def _build_value_channel(log: Log, name: str) -> _Channel:
    series = log.series(name)
    known = np.isfinite(series.values)
    times_s, values = series.time_s[known].tolist(), series.values[known].tolist()
    base = name.partition(" #")[0]
    unit = log.metadata.get("units", {}).get(base) or parse_unit(base).words
    number = {"type": "number", "description": unit} if unit else _NUMBER
    schema = _build_object(name, time={"type": "number", "description": "s"}, value=number)
    return _Channel(
        f"/{name}",
        f"tuisim.{name}",
        schema,
        _round_nanoseconds(series.time_s[known]),
        lambda at: f'{{"time": {times_s[at]!r}, "value": {values[at]!r}}}',
    )


def _build_pose_channels(log: Log) -> Iterator[_Channel]:
    """Yield the poses of each run."""
    runs = log.numbers(log.layout.run) if log.layout.run else np.ones(log.rows)
    numbers = [log.numbers(name) for name in POSE]
    known = np.isfinite([runs, *numbers]).all(axis=0)
    ordinals = np.unique(runs[known]).tolist()
    for run in ordinals:
        of_run = known & (runs == run)
        topic = "/pose" if len(ordinals) == 1 else f"/pose #{run:.0f}"
        times_ns = _round_nanoseconds(log.times_s[of_run])
        write = _build_pose_writer(times_ns, *(column[of_run] for column in numbers))
        yield _Channel(topic, "foxglove.PoseInFrame", _POSE_SCHEMA, times_ns, write)


def _build_pose_writer(
    times_ns: IntArray, x_mm: FloatArray, y_mm: FloatArray, heading_deg: FloatArray
) -> Callable[[int], str]:
    half_rad = np.radians(heading_deg) / 2

    def write(at: int) -> str:
        seconds, nanoseconds = divmod(int(times_ns[at]), 10**9)
        position = {"x": x_mm[at] / 1000, "y": y_mm[at] / 1000, "z": 0.0}
        turn = {"x": 0.0, "y": 0.0, "z": np.sin(half_rad[at]), "w": np.cos(half_rad[at])}
        return json.dumps(
            {
                "timestamp": {"sec": seconds, "nsec": nanoseconds},
                "frame_id": FRAME_ID,
                "pose": {"position": position, "orientation": turn},
            }
        )

    return write


def _round_nanoseconds(times_s: FloatArray) -> IntArray:
    return np.rint(times_s * 1e9).astype(np.int64)
