"""The record of the readings of a program, with their times: the file `READINGS_FILE`, its writer and reader.

Written in pure Python, because the child imports it. The format of the file is that of `records`: a header, then one
record of 16 bytes for each reading of a sensor, an encoder or buttons, and for each vain check of a socket or search
for a gamepad. The value follows from telemetry, world and user actions.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from struct import Struct
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.engine.core.hub_spec import CONTROLLERS, HUB_BUTTONS, HUB_PORTS, INSIDE
from tuisim.engine.core.spec import BUTTONS, INPUT_PORTS, OUTPUT_PORTS
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    READINGS_FILE,
    CountedWriter,
    read_counted,
)

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

READINGS_MAGIC = b"TUISIMRD"
READING_RECORD = Struct("<qIBB2x")
"""Simulated time in ns, source line (0: none), index into `READING_PORTS`, index into `READING_MODES`."""
_PACKED = Struct("<qIH2x")
"""`READING_RECORD` with a code of `READING_CODES` in place of both indices."""
_pack_into = _PACKED.pack_into
READING_FIELDS = (("time_ns", "<i8"), ("line", "<u4"), ("port", "u1"), ("mode", "u1"), ("", "V2"))
"""Name and type of each field of a record, the type as numpy writes it."""

BUTTONS_PORT = "buttons"
"""What stands for a port when the brick's buttons are read."""
HUB_BUTTONS_PORT = "hub"
"""What stands for a port when the buttons of a hub are read."""
KEYS_BY_PORT: Mapping[str, tuple[str, ...]] = {
    BUTTONS_PORT: BUTTONS,
    HUB_BUTTONS_PORT: HUB_BUTTONS,
    **CONTROLLERS,
}
"""Which of `PRESSABLE` are read, by what stands for the port."""
SOCKET_PORT = "socket"
"""What stands for a port when the program waits for a socket."""
GAMEPAD_PORT = "gamepad"
"""What stands for a port when the program looks for input devices."""
READING_PORTS = (
    *(*INPUT_PORTS, *OUTPUT_PORTS, BUTTONS_PORT, SOCKET_PORT, GAMEPAD_PORT),
    *(*HUB_PORTS, INSIDE, *CONTROLLERS, HUB_BUTTONS_PORT),
)
MODES_BY_KIND: Mapping[str, tuple[str, ...]] = {
    "color": ("COL-REFLECT", "COL-AMBIENT", "COL-COLOR", "REF-RAW", "RGB-RAW", "COL-CAL"),
    "ultrasonic": ("US-DIST-CM", "US-DIST-IN", "US-LISTEN", "US-SI-CM", "US-SI-IN"),
    "gyro": (
        *("GYRO-ANG", "GYRO-RATE", "GYRO-FAS", "GYRO-G&A", "GYRO-CAL"),
        *("TILT-ANG", "TILT-RATE"),
    ),
    "touch": ("TOUCH",),
    "infrared": ("IR-PROX", "IR-SEEK", "IR-REMOTE", "IR-REM-A", "IR-CAL"),
    "motor": ("position", "speed", "state"),
    "buttons": ("pressed",),
    "socket": ("accept", "receive"),
    "gamepad": ("list",),
}
"""What a program can read, by the kind of device: modes of sensors, attributes of motors, buttons, sockets,
gamepads."""
READING_MODES = tuple(mode for modes in MODES_BY_KIND.values() for mode in modes)
READING_CODES: Mapping[tuple[str, str], int] = {
    (port, mode): port_index | mode_index << 8
    for port_index, port in enumerate(READING_PORTS)
    for mode_index, mode in enumerate(READING_MODES)
}
"""The code for `ReadingsWriter.add`, by port and mode."""

MAX_READINGS = 1 << 22
"""Largest number of readings that are recorded of a run; further readings are only counted."""


class ReadingsWriter(CountedWriter):
    """A writer that appends to a run's record of when the program reads which sensor, encoder or button.

    Readers of the file can see each entry immediately.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(
            f"{folder}{os.sep}{READINGS_FILE}", READINGS_MAGIC, READING_RECORD.size, MAX_READINGS
        )
        self.newest_ns = -1

    def add(self, code: int, time_ns: int, line: int) -> None:
        """Append a reading to the record.

        Args:
            code: One of `READING_CODES`.
            time_ns: Simulated time, at least that of the previous reading.
            line: Source line; 0 for none.
        """
        self.newest_ns = time_ns
        count = self._count
        if count < self._room or self._extend(count):
            _pack_into(self._map, HEADER_BYTES + (count << 4), time_ns, line, code)
        self._count = self._length[0] = count + 1

    def has(self, code: int) -> bool:
        """Return whether a reading with this code is already recorded at the simulated time of the newest reading."""
        for index in range(min(self._count, self._room) - 1, -1, -1):
            time_ns, _, other = _PACKED.unpack_from(self._map, HEADER_BYTES + (index << 4))
            if time_ns != self.newest_ns:
                return False
            if other == code:
                return True
        return False


@dataclass(frozen=True, slots=True)
class Readings:
    """The record of when a program has read which sensor, encoder or button during a run, in order of time."""

    rows: Array
    """One row for each reading, with the fields of `READING_FIELDS`."""
    left_out: int = 0
    """Number of readings for which the file had no space."""

    def find(self, modes: tuple[str, ...]) -> Array:
        """Return those rows of the record in which a sensor was read in one of the given modes, in order of time.

        Args:
            modes: The names of the modes, such as `US-DIST-CM`.
        """
        import numpy as np

        rows: Array = self.rows[
            np.isin(self.rows["mode"], [READING_MODES.index(mode) for mode in modes])
        ]
        return rows


def read_readings(folder: Path, *, is_over: bool = True) -> Readings:
    """Return the record of what the program of a run has read so far.

    Args:
        folder: The run's folder.
        is_over: Whether the run is over; one that has just begun may have no record yet.

    Raises:
        LogError: the file is missing, damaged or of another version, or this machine cannot read it.
    """
    import numpy as np

    path = folder / READINGS_FILE
    if not is_over and not path.exists():
        return Readings(np.empty(0, np.dtype(list(READING_FIELDS))))
    rows, left_out = read_counted(path, READINGS_MAGIC, READING_FIELDS, MAX_READINGS, "read")
    if (
        (np.diff(rows["time_ns"], prepend=0) < 0).any()
        or (rows["port"] >= len(READING_PORTS)).any()
        or (rows["mode"] >= len(READING_MODES)).any()
    ):
        raise LogError("damaged: the records are not readings", file=str(path))
    return Readings(rows, left_out)
