"""The kinds of commands that a program can give to the simulation, and one such command with its time."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

Values = tuple[float, ...]
"""The values of a call; NaN stands for one that is not given."""

MAX_VALUES = 7
"""The largest number of values that a command has."""
MAX_NUMBER = float(2**53)
"""The largest value: up to this number, every whole number is an exact float."""


class Call(IntEnum):
    """The kinds of commands that a program gives to the simulation; recordings contain these numbers."""

    RESET_GYRO = 0
    MOVE_PEN = 1
    PLUG = 2
    SET_GYRO = 3
    # Commands to a motor of a brick or of the browser simulator.
    RUN = 10
    RUN_UNTIL = 11
    RUN_TO = 12
    STOP = 13
    SET_COUNT = 14
    LIMIT_RAMPS = 15
    SET_SPEED = 16
    SET_BACKWARDS = 17
    SET_ROLL = 18
    SET_POLARITY = 19
    # Commands to a motor with the kernel's driver, in the order of `driver.motor.Command`.
    RUN_FOREVER = 20
    RUN_TO_ABS_POS = 21
    RUN_TO_REL_POS = 22
    RUN_TIMED = 23
    RUN_DIRECT = 24
    STOP_DRIVER = 25
    RESET_DRIVER = 26
    SET_DUTY = 27
    RENUMBER = 28
    SET_CONSTANT = 29
    # Commands to a motor of the Pybricks firmware, and to its controller.
    SET_UP = 40
    RUN_FREELY = 41
    SET_MILLI = 42
    HOLD = 43
    HOLD_MILLI = 44
    RUN_AT = 45
    MOVE = 46
    FOLLOW = 47
    LIMIT_DUTY = 48
    SET_CONTROL = 49
    # Commands to a drive base.
    BUILD_BASE = 60
    MOVE_BASE = 61
    DRIVE_BASE = 62
    STOP_BASE = 63
    SET_BASE = 64
    SET_BASE_CONTROL = 65
    USE_GYRO = 66
    SET_SLOWING = 67


class SimulationCommand(NamedTuple):
    """One command of a program to the simulation, with its time and its values."""

    time_ns: int
    part: int
    """The number of a motor among `Simulation.motors`, or of a drive base among `Simulation.bases`; else 0."""
    call: Call
    values: Values
    """The values of the command: as many as the call takes."""


def find_index(numbers: Values, place: int, count: int) -> int:
    """Return the value of a command at the position `place`, which has to be an index below `count`.

    Raises:
        ValueError: the value is not a whole number from 0 to `count` - 1.
    """
    index = int(numbers[place])
    if not 0 <= index < count or index != numbers[place]:
        raise ValueError(f"no number below {count}: {numbers[place]!r}")
    return index
