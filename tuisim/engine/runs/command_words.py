"""The commands of a program in words, with their values and units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum, auto
from math import isnan

from tuisim.base.data_class import dataclass
from tuisim.engine.core.commands.calls import Call
from tuisim.engine.core.commands.driver import COMMAND_CALLS, CONSTANTS, CONTROLS, STOP_ACTIONS
from tuisim.engine.core.commands.robot import decode_parts
from tuisim.engine.core.commands.servo import SETTINGS
from tuisim.engine.core.driver.motor import Command
from tuisim.engine.core.servo.control import Ending
from tuisim.engine.core.servo.settings import COUNTS_PER_DEG, FULL_ACTUATION
from tuisim.engine.core.servo.trajectory import MILLI


@dataclass(frozen=True, slots=True)
class Quantity:
    """The form in which one value of a command is shown: a number with a unit, or a name."""

    unit: str = ""
    share: float = 1.0
    """Factor from the value to `unit`."""
    names: Sequence[str] = ()
    """Names that the values 0, 1, … stand for; empty if the value is a number."""

    def write(self, low: float, high: float) -> str:
        """Return the value of a command as text, such as `500 °/s`.

        If the command was repeated with other values, return their range, such as `400 … 500 °/s`.

        Args:
            low, high: The lowest and the highest value; if they are equal, the text has one number.
        """
        if self.names:
            return self.names[int(low)] if 0 <= low < len(self.names) else f"{low:g}"
        ends = dict.fromkeys(f"{value * self.share:.5g}" for value in sorted((low, high)))
        return " … ".join(ends) + self.unit


_DEG, _DPS, _PLAIN = Quantity("°"), Quantity(" °/s"), Quantity()
_DPS2, _MS, _PERCENT = Quantity(" °/s²"), Quantity(" ms"), Quantity(" %")
_COUNTS, _COUNTS_PER_S = (Quantity(unit, 1 / COUNTS_PER_DEG) for unit in ("°", " °/s"))
_MILLI_COUNTS = Quantity("°", 1 / COUNTS_PER_DEG / MILLI)
_POWER, _US, _TICKS = Quantity(" %", 100 / FULL_ACTUATION), Quantity(" s", 1e-6), Quantity(" s")
_MM, _MM_PER_S, _MM_PER_S2 = Quantity(" mm"), Quantity(" mm/s"), Quantity(" mm/s²")
_ENDING = Quantity(names=[ending.name.lower().replace("none", "go on") for ending in Ending])
_SWITCH = Quantity(names=("off", "on"))
_SETTING = Quantity(names=[name.replace("_", " ") for name in SETTINGS])


class Aim(Enum):
    """The kind of motion that a command starts, which decides how its result is described."""

    NONE = auto()
    """Nothing that telemetry records."""
    SPEED = auto()
    """A speed or a power of a motor."""
    POSITION = auto()
    """A position of a motor."""
    ANGLE = auto()
    """A motor turns by an angle, and stops."""
    BASE_SPEED = auto()
    """A drive base drives on."""
    BASE_WAY = auto()
    """A drive base drives or turns so far, and stops."""


@dataclass(frozen=True, slots=True)
class CallWords:
    """The words for one kind of command, and how its values are shown in them."""

    text: str
    """The words, with the index of each value in braces, such as `run {0}`."""
    quantities: tuple[Quantity, ...] = ()
    """How the first values of the command are shown."""
    main: int = 0
    """The index of the value that differs most when the call is repeated."""
    aim: Aim = Aim.NONE
    part: str = ""
    """Name of the part that the command is for; empty for a motor or a drive base."""


def _name_driver_calls() -> dict[Call, CallWords]:
    """Return the words for the commands to a motor's driver in the brick's kernel, by the kind of command.

    All these commands have the same list of values.
    """
    action = Quantity(names=STOP_ACTIONS)
    points = _DPS, _DEG, _PERCENT, _MS, _MS, _MS, action
    texts = {
        Command.RUN_FOREVER: (" {0}", 0, Aim.SPEED),
        Command.RUN_TO_ABS_POS: (" {1} at {0}, then {6}", 1, Aim.POSITION),
        Command.RUN_TO_REL_POS: (" {1} at {0}, then {6}", 1, Aim.ANGLE),
        Command.RUN_TIMED: (" {3} at {0}, then {6}", 0, Aim.SPEED),
        Command.RUN_DIRECT: (" {2}", 2, Aim.SPEED),
        Command.STOP: (", {6}", 0, Aim.ANGLE),
        Command.RESET: ("", 0, Aim.ANGLE),
    }
    return {
        COMMAND_CALLS[command]: CallWords(command + text, points, main, aim)
        for command, (text, main, aim) in texts.items()
    }


CALL_WORDS: Mapping[Call, CallWords] = {
    Call.RESET_GYRO: CallWords("reset", part="gyro"),
    Call.SET_GYRO: CallWords("set angle {0}", (_DEG,), part="gyro"),
    Call.MOVE_PEN: CallWords("{0}", (Quantity(names=("up", "down")),), part="pen"),
    Call.PLUG: CallWords("plug in", part="ports"),
    Call.RUN: CallWords("run {0}", (_DPS,), aim=Aim.SPEED),
    Call.RUN_UNTIL: CallWords("run {0} until {1}", (_DPS, _TICKS), aim=Aim.SPEED),
    Call.RUN_TO: CallWords("run to {0} at {1}", (_DEG, _DPS), aim=Aim.POSITION),
    Call.STOP: CallWords("stop", aim=Aim.ANGLE),
    Call.SET_COUNT: CallWords("set position {0}", (_DEG,)),
    Call.LIMIT_RAMPS: CallWords("set ramps {0}, {1}", (_DPS2, _DPS2)),
    Call.SET_SPEED: CallWords("set speed {0}", (_DPS,), aim=Aim.SPEED),
    Call.SET_BACKWARDS: CallWords(
        "set direction {0}", (Quantity(names=("forwards", "backwards")),)
    ),
    Call.SET_ROLL: CallWords("set roll {0}", (_PLAIN,)),
    Call.SET_POLARITY: CallWords("set polarity {0}", (Quantity(names=("normal", "inversed")),)),
    **_name_driver_calls(),
    Call.SET_DUTY: CallWords("set duty {0}", (_PERCENT,), aim=Aim.SPEED),
    Call.RENUMBER: CallWords("set position {0}", (_DEG,)),
    Call.SET_CONSTANT: CallWords(
        "set {0} {1} {2}", (Quantity(names=CONTROLS), Quantity(names=CONSTANTS), _PLAIN), 2
    ),
    Call.SET_UP: CallWords("set up, direction {0}, gears {1}", (_PLAIN, _PLAIN)),
    Call.RUN_FREELY: CallWords("power {0}", (_POWER,), aim=Aim.SPEED),
    Call.SET_MILLI: CallWords("set angle {0}", (_MILLI_COUNTS,)),
    Call.HOLD: CallWords("hold", aim=Aim.ANGLE),
    Call.HOLD_MILLI: CallWords("track {0}", (_MILLI_COUNTS,), aim=Aim.POSITION),
    Call.RUN_AT: CallWords("run {0} for {2}", (_COUNTS_PER_S, _PLAIN, _US), aim=Aim.SPEED),
    Call.MOVE: CallWords(
        "run {3} {0} at {1}",
        (_COUNTS, _COUNTS_PER_S, _PLAIN, Quantity(names=("to", "by"))),
        aim=Aim.ANGLE,
    ),
    Call.FOLLOW: CallWords("then {0}", (_ENDING,)),
    Call.LIMIT_DUTY: CallWords("limit power {0}", (_POWER,)),
    Call.SET_CONTROL: CallWords("set {0} {1}", (_SETTING, _PLAIN), 1),
    Call.BUILD_BASE: CallWords("build, wheels {2}, track {3}", (_PLAIN, _PLAIN, _MM, _MM), 2),
    Call.MOVE_BASE: CallWords(
        "drive {0}, turn {1}, then {2}", (_MM, _DEG, _ENDING), aim=Aim.BASE_WAY
    ),
    Call.SET_SLOWING: CallWords("set slowing {0}, {1}", (_PLAIN, _PLAIN)),
    Call.USE_GYRO: CallWords("use gyro {0}", (_SWITCH,)),
    Call.DRIVE_BASE: CallWords("drive {0}, turn {1}", (_MM_PER_S, _DPS), 1, Aim.BASE_SPEED),
    Call.STOP_BASE: CallWords("stop, power {0}", (_POWER,), aim=Aim.BASE_WAY),
    Call.SET_BASE: CallWords("set {0}, {1}, {2}, {3}", (_MM_PER_S, _MM_PER_S2, _DPS, _DPS2)),
    Call.SET_BASE_CONTROL: CallWords(
        "set {0} {1} {2}", (Quantity(names=("distance", "heading")), _SETTING, _PLAIN), 2
    ),
}
"""How each kind of command is described in words."""
MOVES = tuple(call for call, words in CALL_WORDS.items() if words.aim is not Aim.NONE)
"""The commands that move or stop a motor or a drive base."""
_STOPS = (Call.STOP, Call.STOP_DRIVER, Call.RESET_DRIVER, Call.HOLD, Call.STOP_BASE)
WHEEL_WORDS = "still set to turn", "stopping", "last speeds"
"""How a program can have left a wheel that turns; the last words are for a move to a position."""
_WITHOUT: Mapping[Call, str] = {
    Call.RUN_FREELY: "coast",
    Call.RUN_AT: "run {0}",
    Call.LIMIT_DUTY: "limit power no longer",
    Call.STOP_BASE: "stop, coast",
}
"""Words for commands that lack a value which `CALL_WORDS` names."""


def describe_aim(call: Call, values: Sequence[float]) -> str:
    """Return what a command makes a turning wheel do: one of the texts in `WHEEL_WORDS`, such as `stopping`.

    Args:
        call: The kind of command, one of `MOVES`.
        values: The values of the command.
    """
    # NaN lets the motor coast.
    if call in _STOPS or (call is Call.RUN_FREELY and not abs(values[0]) > 0):
        return WHEEL_WORDS[1]
    return WHEEL_WORDS[0 if CALL_WORDS[call].aim in (Aim.SPEED, Aim.BASE_SPEED) else 2]


def describe_command(
    call: Call, values: Sequence[float], low: float, high: float, tick_hz: int
) -> str:
    """Return a command in words: `run 500 °/s`, or `run 400 … 500 °/s` if it was repeated with other values.

    Args:
        call: The kind of command.
        values: The values of the command, or of one of its repetitions.
        low, high: The lowest and the highest main value of the command and its repetitions; see `CallWords.main`.
        tick_hz: Ticks per second of the run, to show numbers of ticks in seconds.
    """
    if call is Call.PLUG:
        parts = decode_parts(values, 0)
        return "plug in " + ", ".join(f"{part.part} {part.port}" for part in parts)
    words = CALL_WORDS[call]
    texts = []
    for number, (quantity, value) in enumerate(zip(words.quantities, values, strict=False)):
        share = 1 / tick_hz if quantity is _TICKS else 1.0
        ends = (low, high) if number == words.main else (value, value)
        texts.append(quantity.write(ends[0] * share, ends[1] * share))
    named = [value for number, value in enumerate(values) if f"{{{number}}}" in words.text]
    text = _WITHOUT.get(call, words.text) if any(map(isnan, named)) else words.text
    return text.format(*texts)
