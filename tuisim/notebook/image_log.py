"""The pixel arrays that programs log with `print('image_data left|right|both')`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine.runs.records import Stream

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.spec import ColorSensorSpec, NoiseSpec, RunSpec
    from tuisim.engine.runs.records import OutputRow
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.engine.runs.views import TickRecord

IMAGE_DATA, SENT_DATA = "image_data", "IMG_DATA"
"""Begin of a line that logs pixel arrays, and of one that also sends them to a responder."""

_LINE = re.compile(rf"({IMAGE_DATA}|{SENT_DATA})(?::?\s+(left|right|both))?\s*")


@dataclass(frozen=True, slots=True)
class LoggedArray:
    """The pixels under one colour sensor that a program has logged."""

    side: str
    """Name of the sensor."""
    rgba: bytes
    """Row by row, four bytes a pixel."""
    time_ns: int
    sent: bool
    """Whether the line was for a responder, which the old simulator did not log."""


def parse_side(row: OutputRow) -> str:
    """Return the side whose pixels a printed row logs: left, right or both; empty if it logs none."""
    # This quick test comes first, as most lines log no pixels.
    if row.stream != Stream.STDOUT or not row.text.startswith((IMAGE_DATA, SENT_DATA)):
        return ""
    match = _LINE.fullmatch(row.text)
    if match is None:
        return ""
    return match[2] or ("both" if match[1] == SENT_DATA else "")


def read_arrays(
    spec: RunSpec, record: TickRecord, noise: NoiseSpec, field: Field
) -> list[tuple[ColorSensorSpec, bytes]]:
    """Return each colour sensor with the pixels under it at a tick, as RGB bytes, row by row.

    Args:
        spec: The run.
        record: The telemetry of the tick.
        noise: The noise at the tick.
        field: The mat.
    """
    from tuisim.engine.core.sensors.color import read_pixel_array

    instant = record.build_instant(spec, noise)
    return [
        (sensor, read_pixel_array(sensor, instant, field)) for sensor in spec.robot.color_sensors
    ]


def add_alpha(rgb: bytes) -> bytes:
    """Return RGB bytes as RGBA, all opaque."""
    return b"".join(rgb[offset : offset + 3] + b"\xff" for offset in range(0, len(rgb), 3))


class ArrayReader:
    """Computes pixel arrays from the recording of a run, which may still be running."""

    def __init__(self, run: StoredRun) -> None:
        self._run = run
        self._field: Field | None = None

    def read_arrays(self, row: OutputRow) -> list[LoggedArray]:
        """Return the pixel arrays that a printed row logs.

        Raises:
            LogError: the recording is damaged, or its mat is gone.
        """
        side = parse_side(row)
        sent = row.text.startswith(SENT_DATA)
        return [
            LoggedArray(name, rgba, row.time_ns, sent)
            for name, rgba in (self.read_pixels(row) if side else {}).items()
            if side in (name, "both")
        ]

    def read_pixels(self, row: OutputRow) -> dict[str, bytes]:
        """Return the RGBA bytes of each sensor by name at the tick of a row; empty if that tick is not recorded yet.

        Raises:
            LogError: the recording is damaged, or its mat is gone.
        """

        run = self._run
        if row.tick >= run.telemetry.count:
            return {}
        self._field = self._field or run.open_mat()
        record = run.telemetry.record(row.tick)
        arrays = read_arrays(run.spec, record, run.find_noise(record), self._field)
        return {sensor.name: add_alpha(pixels) for sensor, pixels in arrays}


def list_logged_arrays(run: StoredRun) -> list[LoggedArray]:
    """Return all pixel arrays that a run has logged.

    Raises:
        LogError: the recording is damaged, or its mat is gone.
    """
    reader = ArrayReader(run)
    return [array for row in run.output.rows() for array in reader.read_arrays(row)]


class ImageLog:
    """The pixel arrays of a notebook's runs, each computed once.

    Arrays of a run in progress are added line by line: a function of the notebook that is called with a line gets the
    arrays up to this line, even if the program is further on.
    """

    def __init__(self) -> None:
        self._arrays: dict[str, list[LoggedArray]] = {}

    def begin(self, run: StoredRun) -> None:
        """Start to collect the arrays of a run; do nothing if it was started before."""
        self._arrays.setdefault(run.id, [])

    def add(self, run: StoredRun, array: LoggedArray) -> None:
        """Add an array of a run that was passed to `begin`."""
        self._arrays[run.id].append(array)

    def mark_incomplete(self, run: StoredRun) -> None:
        """Discard the arrays of a run whose lines were not all read; `list_arrays` computes them again."""
        self._arrays.pop(run.id, None)

    def clear(self) -> None:
        """Discard all arrays up to now; those that a run in progress logs later are added."""
        for arrays in self._arrays.values():
            arrays.clear()

    def list_arrays(self, runs: Iterable[StoredRun]) -> list[list[LoggedArray]]:
        """Return the arrays of each run.

        Raises:
            LogError: a recording is damaged, or its mat is gone.
        """
        return [self._list_run_arrays(run) for run in runs]

    def _list_run_arrays(self, run: StoredRun) -> list[LoggedArray]:
        if run.id not in self._arrays:
            self._arrays[run.id] = list_logged_arrays(run)
        return self._arrays[run.id]
