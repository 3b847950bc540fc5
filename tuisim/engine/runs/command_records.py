"""The record of the commands that a program gave, with their times: the file `COMMANDS_FILE`, its writer and reader.

Written in pure Python, because the child imports it. The format of the file is that of `records`: a header, then one
record of 72 bytes for each command.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from functools import cache
from pathlib import Path
from struct import Struct
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError
from tuisim.base.regular_file import open_regular
from tuisim.engine.core.commands.calls import MAX_VALUES, Call, SimulationCommand
from tuisim.engine.runs.records import (
    COMMANDS_FILE,
    HEADER_BYTES,
    CountedWriter,
    read_counted,
    read_header,
)

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

COMMANDS_MAGIC = b"TUISIMCM"
COMMAND_RECORD = Struct(f"<qBB6x{MAX_VALUES}d")
"""Simulated time in ns, part, call, values; those that a call does not take are 0."""
COMMAND_FIELDS = (
    ("time_ns", "<i8"),
    ("part", "u1"),
    ("call", "u1"),
    ("", "V6"),
    ("values", f"({MAX_VALUES},)<f8"),
)
"""Name and type of each field of a record, the type as numpy writes it."""
MAX_COMMANDS = 1 << 21
"""Further commands of a run are only counted."""
_PACKERS = tuple(Struct(f"<qBB6x{count}d").pack_into for count in range(MAX_VALUES + 1))
"""Functions that pack a command, by the number of its values."""
_CALLS = {call.value: call for call in Call}


class CommandsWriter(CountedWriter):
    """A writer that appends commands to the record of a run; readers can see each one immediately."""

    def __init__(self, folder: Path) -> None:
        super().__init__(
            f"{folder}{os.sep}{COMMANDS_FILE}", COMMANDS_MAGIC, COMMAND_RECORD.size, MAX_COMMANDS
        )

    def add(self, time_ns: int, part: int, call: int, values: tuple[float, ...]) -> None:
        """Append a command to the record; the arguments are the fields of a `SimulationCommand`."""
        count = self._count
        if count < self._room or self._extend(count):
            offset = HEADER_BYTES + count * COMMAND_RECORD.size
            _PACKERS[len(values)](self._map, offset, time_ns, part, call, *values)
        self._count = self._length[0] = count + 1


@dataclass(frozen=True, slots=True)
class RecordedCommands:
    """The commands of a run, in the order in which they were given."""

    rows: Array
    """One row of `COMMAND_FIELDS` for each."""
    left_out: int = 0
    """Number of commands for which the file had no space."""

    def unpack(self) -> Iterator[SimulationCommand]:
        """Yield the commands.

        Each has as many values as fit into a record. A kind of command that takes fewer values uses only the first
        ones; the others can be any numbers.

        Raises:
            ValueError: a record has a number that stands for no call.
        """
        for time_ns, part, call, *values in COMMAND_RECORD.iter_unpack(self.rows.tobytes()):
            yield SimulationCommand(time_ns, part, _CALLS.get(call) or Call(call), tuple(values))


@cache
def _find_kind() -> np.dtype[Any]:
    import numpy as np

    return np.dtype([*COMMAND_FIELDS])


def read_commands(folder: Path) -> RecordedCommands:
    """Return the commands that the program of a run has given so far.

    Raises:
        LogError: the file is missing, damaged or of another version, or this machine cannot read it.
    """
    path = folder / COMMANDS_FILE
    return RecordedCommands(
        *read_counted(path, COMMANDS_MAGIC, COMMAND_FIELDS, MAX_COMMANDS, "did")
    )


def read_command_rows(folder: Path, first: int, count: int) -> Array:
    """Return at most `count` rows of `COMMAND_FIELDS` from row `first` on; none if the file is invalid."""
    import numpy as np

    kind = _find_kind()
    path = folder / COMMANDS_FILE
    with suppress(OSError, LogError), open_regular(path) as handle:
        fd = handle.fileno()
        size, published = read_header(os.pread(fd, HEADER_BYTES, 0), COMMANDS_MAGIC, str(path))
        count = min(count, min(published, MAX_COMMANDS) - first)
        if size == kind.itemsize and count > 0:
            data = os.pread(fd, count * size, HEADER_BYTES + first * size)
            return np.frombuffer(data, kind, len(data) // size)
    return np.empty(0, kind)
