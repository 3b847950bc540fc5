"""What the drivers knew of the motors at each tick: `MOTORS_FILE` of a run folder, and its writer and reader.

Written in pure Python: the child imports it. The file is one of `records`: a header, then for each tick one
`MOTOR_RECORD` of each motor, in the order of `name_motors`.
"""

from __future__ import annotations

import mmap
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.core.motor_columns import (
    MOTOR_FIELDS,
    MOTOR_RECORD,
    has_driver,
    name_motors,
)
from tuisim.core.spec import RobotSpec, RunSpec
from tuisim.core.state import MotorValues
from tuisim.errors import LogError
from tuisim.regular_file import of_the_machine, open_regular
from tuisim.runs.records import HEADER_BYTES, MappedWriter, published_length
from tuisim.runs.side_files import MOTORS_FILE

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

MOTORS_MAGIC = b"TUISIMMO"
_FIRST_BYTES = 1 << 16


class MotorsWriter(MappedWriter):
    """The records of all motors. Telemetry says how many ticks there are: this file's own length is told at its end.

    Args:
        folder: The run folder.
        robot: The robot.
    """

    def __init__(self, folder: Path, robot: RobotSpec) -> None:
        self._size = MOTOR_RECORD.size * len(name_motors(robot))
        super().__init__(f"{folder}{os.sep}{MOTORS_FILE}", MOTORS_MAGIC, self._size, _FIRST_BYTES)

    def extend_buffer(self, ticks: int) -> mmap.mmap:
        """Return the map, with space for the records of so many ticks."""
        if (need := HEADER_BYTES + ticks * self._size) > self._capacity:
            self._make_room(need)
        return self._map

    def close(self, ticks: int) -> None:
        """Truncate the file to its true size."""
        self._length[0] = ticks
        self._close(HEADER_BYTES + ticks * self._size)


def read_motor_values(folder: Path, run: RunSpec, tick: int) -> tuple[MotorValues, ...]:
    """Return what the drivers of all motors knew at the end of a tick; empty where nothing is recorded.

    Raises:
        LogError: the file is damaged, or this machine cannot read it.
    """
    if not has_driver(run):
        return ()
    size = MOTOR_RECORD.size * len(name_motors(run.robot))
    return tuple(MOTOR_RECORD.iter_unpack(_read_part(folder, size, tick, tick + 1)))


def read_motor_columns(folder: Path, robot: RobotSpec, ticks: Array) -> dict[str, Array]:
    """Return the measured columns of all motors at some ticks: float64, shape (n,), NaN where nothing is recorded.

    Args:
        folder: The run folder.
        robot: The robot.
        ticks: Numbers of ticks, shape (n,).

    Raises:
        LogError: the file is damaged, or this machine cannot read it.
    """
    import numpy as np

    names = name_motors(robot)
    kind = np.dtype((np.dtype(list(MOTOR_FIELDS)), (len(names),)))
    first = int(ticks.min()) if len(ticks) else 0
    rows = np.frombuffer(
        _read_part(folder, kind.itemsize, first, int(ticks.max()) + 1 if len(ticks) else 0),
        kind,
    )
    known = ticks < first + len(rows)
    places = ticks[known].astype(np.int64) - first
    columns: dict[str, Array] = {}
    for number, name in enumerate(names):
        for field, _ in MOTOR_FIELDS:
            values = np.full(len(ticks), np.nan)
            values[known] = rows[field][places, number]
            columns[f"{name}_{field}"] = values
    return columns


def _read_part(folder: Path, size: int, first: int, end: int) -> bytes:
    """Return the records of some ticks, as far as there are any: whole ones."""
    path = folder / MOTORS_FILE
    try:
        with open_regular(path) as file:
            published_length(file.read(HEADER_BYTES), MOTORS_MAGIC, str(path))
            file.seek(HEADER_BYTES + first * size)
            data: bytes = file.read((end - first) * size)
    except FileNotFoundError:
        return b""
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from (
            error if of_the_machine(error) else None
        )
    return data[: len(data) // size * size]
