"""The record of the values of the motors' drivers at each tick: the file `MOTORS_FILE`, its writer and reader.

Written in pure Python, because the child imports it. The format of the file is that of `records`: a header, then for
each tick one `MOTOR_RECORD` of each motor, in the order of `name_motors`.
"""

from __future__ import annotations

import mmap
import os
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import LogError
from tuisim.base.regular_file import of_the_machine, open_regular
from tuisim.engine.core.motor_columns import (
    MOTOR_FIELDS,
    MOTOR_RECORD,
    has_driver,
    name_motors,
)
from tuisim.engine.core.spec import OUTPUT_PORTS, RobotSpec, RunSpec
from tuisim.engine.core.state import MotorValues
from tuisim.engine.runs.records import HEADER_BYTES, MOTORS_FILE, MappedWriter, read_header

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

MOTORS_MAGIC = b"TUISIMMO"
_FIRST_BYTES = 1 << 16
MAX_MOTORS = 2 + len(OUTPUT_PORTS)
"""Records have places for two wheel motors, also of a robot without wheels."""


class MotorsWriter(MappedWriter):
    """A writer of the records of all motors, one record for each motor and tick.

    The number of ticks is written to the file only when it is closed. Until then, readers take it from the telemetry.

    Args:
        folder: The run folder.
        robot: The robot.
    """

    def __init__(self, folder: Path, robot: RobotSpec) -> None:
        self._size = MOTOR_RECORD.size * len(name_motors(robot))
        self._path = f"{folder}{os.sep}{MOTORS_FILE}"
        super().__init__(self._path, MOTORS_MAGIC, self._size, _FIRST_BYTES)

    def extend_buffer(self, ticks: int) -> mmap.mmap:
        """Return the memory map of the file, with space for the records of `ticks` ticks."""
        if (need := HEADER_BYTES + ticks * self._size) > self._capacity:
            self._make_room(need)
        return self._map

    def arrange(self, sources: Sequence[int | None], ticks: int) -> None:
        """Rewrite the records of the first `ticks` ticks for a new set of motors.

        Args:
            sources: For each motor of the new set its index in the old set; None for a motor that was not in it. Its
                records become 0, as it has been at rest.
            ticks: How many ticks are recorded.
        """
        before, after = self._size // MOTOR_RECORD.size, len(sources)
        recorded = self._map[HEADER_BYTES : HEADER_BYTES + ticks * self._size]
        arranged = arrange_records(recorded, before, sources, ticks)
        # A new file replaces the old one, so that a reader has one of the two, never a mixture.
        path = Path(self._path)
        full = self.full
        self._size = MOTOR_RECORD.size * after
        self._close(HEADER_BYTES)
        new = path.with_name(f"{path.name}.new")
        size = ticks * self._size
        try:
            super().__init__(str(new), MOTORS_MAGIC, self._size, max(_FIRST_BYTES, size))
        except OSError as error:
            raise full(error) from None
        self.full = full
        self._map[HEADER_BYTES : HEADER_BYTES + size] = arranged
        os.replace(new, path)

    def close(self, ticks: int) -> None:
        """Close the file, and cut off the space after the records of `ticks` ticks."""
        self._length[0] = ticks
        self._close(HEADER_BYTES + ticks * self._size)


def arrange_records(
    recorded: bytes, before: int, sources: Sequence[int | None], ticks: int
) -> bytes:
    """Return the records of all ticks, rewritten for a new set of motors.

    Args:
        recorded: The records of the old set.
        before: The number of motors in the old set.
        sources: For each motor of the new set its index in the old set; None for a motor that was not in it. Its
            records are 0.
        ticks: How many ticks are recorded.
    """
    numbers = array("Q", recorded)
    after = len(sources)
    arranged = array("Q", bytes(MOTOR_RECORD.size * after * ticks))
    for number, source in enumerate(sources):
        if source is not None:
            arranged[number::after] = numbers[source::before]
    return arranged.tobytes()


def read_motor_values(folder: Path, run: RunSpec, tick: int) -> tuple[MotorValues, ...]:
    """Return the values of all motors' drivers at the end of a tick; empty if none are recorded for it.

    Raises:
        LogError: the file is damaged, or this machine cannot read it.
    """
    if not has_driver(run):
        return ()
    return tuple(MOTOR_RECORD.iter_unpack(_read_part(folder, tick, tick + 1)[1]))


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
    first = int(ticks.min()) if len(ticks) else 0
    count, data = _read_part(folder, first, int(ticks.max()) + 1 if len(ticks) else 0)
    rows = np.frombuffer(data, np.dtype((np.dtype(list(MOTOR_FIELDS)), (count,))))
    known = ticks < first + len(rows)
    places = ticks[known].astype(np.int64) - first
    columns: dict[str, Array] = {}
    for number, name in enumerate(names):
        for field, _ in MOTOR_FIELDS:
            values = np.full(len(ticks), np.nan)
            if number < count:
                values[known] = rows[field][places, number]
            columns[f"{name}_{field}"] = values
    return columns


def _read_part(folder: Path, first: int, end: int) -> tuple[int, bytes]:
    """Return the number of motors, and the complete records of the ticks from `first` to before `end`.

    Ticks that are not recorded are left out; without a file, there are none.
    """
    path = folder / MOTORS_FILE
    try:
        with open_regular(path) as file:
            size, _ = read_header(file.read(HEADER_BYTES), MOTORS_MAGIC, str(path))
            if not size or size % MOTOR_RECORD.size or size > MOTOR_RECORD.size * MAX_MOTORS:
                raise LogError("not a recording of motors", file=str(path))
            file.seek(HEADER_BYTES + first * size)
            data: bytes = file.read((end - first) * size)
    except FileNotFoundError:
        return 1, b""
    except OSError as error:
        raise LogError(f"cannot be read: {error.strerror or error}", file=str(path)) from (
            error if of_the_machine(error) else None
        )
    return size // MOTOR_RECORD.size, data[: len(data) // size * size]
