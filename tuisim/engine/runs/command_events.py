"""The commands of a run as events: what a part was commanded to do, how often, and with which result."""

from __future__ import annotations

import math
import re
from array import array
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.engine.core.commands.calls import MAX_VALUES, Call, SimulationCommand
from tuisim.engine.core.commands.robot import decode_parts
from tuisim.engine.core.commands.table import SCALING_CALLS, compute_scale
from tuisim.engine.core.plugged import plug_parts
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.core.spec import RobotSpec, RunSpec
from tuisim.engine.core.tick_record import FLAG_LEFT_RUNNING, FLAG_RIGHT_RUNNING, RUNNING_FLAGS
from tuisim.engine.runs.command_records import COMMAND_RECORD, read_command_rows
from tuisim.engine.runs.command_words import (
    CALL_WORDS,
    MOVES,
    WHEEL_WORDS,
    Aim,
    describe_aim,
    describe_command,
)
from tuisim.engine.runs.records import Mark
from tuisim.engine.runs.tick_changes import IMMEDIATE_CALLS

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.runs.views import TelemetryView

    Array = np.ndarray[Any, Any]

_REPEAT_NS = NS_PER_S // 4
"""A command that a part gets again within this time is a repetition of the one before."""
_MAX_EVENTS = 1 << 17
"""Largest number of events of a run; further commands are left out. At four a second, this is enough for nine hours."""
_MAX_SCALES = 1 << 10
"""Largest number of changes of scale (`ScaleChange`) of a run; further changes are left out."""
_PIECE = 1 << 15
"""Number of commands that are read at a time."""
_FINEST = 500
"""Events closer than the elapsed time divided by this have one mark, so that marks stay few."""
_STILL_DPS = 0.5
"""Speed in °/s below which a motor counts as standing still."""
_WORDS = re.compile(r"command(?:\s+(?P<words>.+))?", re.IGNORECASE)
_SPEEDS = (Aim.SPEED, Aim.BASE_SPEED)
_BASE_AIMS = (Aim.BASE_SPEED, Aim.BASE_WAY)


ScaleChange: TypeAlias = tuple[int, str, float]
"""A tick, a motor's port, and the degrees that a program counts from then on per degree of the motor (at first, 1)."""


class CommandedRun(Protocol):
    """A run, either running or stored, from which the commands of its program can be read."""

    @property
    def first_spec(self) -> RunSpec: ...
    @property
    def folder(self) -> Path: ...
    @property
    def telemetry(self) -> TelemetryView: ...


@dataclass(frozen=True, slots=True)
class CommandEvent:
    """A command that a program gave to a part of the robot, once or several times in a row."""

    time_s: float
    """Simulated time of the first command."""
    part: str
    """Name of the part, such as `left motor B`."""
    asked: str
    """The command in words, such as `run 500 °/s`."""
    count: int
    """How often the command was given, each time soon after the time before."""
    last_s: float
    """Simulated time of the last command."""
    came: str
    """The result of the command until the part got another one; empty if it is not known."""

    @property
    def words(self) -> str:
        """The command, how often it was given, and its result, in one line."""
        repeats = f", {self.count:,} times" if self.count > 1 else ""
        if self.last_s - self.time_s >= 0.01:
            repeats += f" until {self.last_s:.2f} s"
        came = f" → {self.came}" if self.came else ""
        return f"{self.asked}{repeats}{came}"


@dataclass(slots=True)
class _Event:
    """A command and its repetitions, as far as they have been read."""

    row: int
    """Row of the first command."""
    code: int
    """Robot, call and part, see `CommandIndex._read_codes`."""
    first_ns: int
    last_ns: int
    """Times of the first and of the last command."""
    count: int
    low: float
    high: float
    """The lowest and the highest main value."""

    @property
    def call(self) -> Call:
        """The kind of command."""
        return _find_call(self.code)


def parse_command_search(text: str) -> str | None:
    """Return the words after `command` in a text such as `command left run`; empty for `command` alone.

    Return None if the text does not begin with the word `command`.
    """
    match = _WORDS.fullmatch(text.strip())
    return (match["words"] or "").strip() if match else None


class CommandIndex:
    """The commands of a run as events, in their order. A command and its repetitions are one event.

    The run may still be running.

    Args:
        run: The run; without a record of commands there are no events.
    """

    def __init__(self, run: CommandedRun) -> None:
        self._run = run
        self._hz = run.first_spec.profile.tick_hz
        self._robots: list[RobotSpec] = [run.first_spec.robot]
        """The robot at the start, and after each time that parts were plugged in."""
        self._end = self._newest_ns = 0
        self._changes, self._change_ticks = bytearray(), array("I")
        """The records and the ticks of the commands of `IMMEDIATE_CALLS`."""
        self._events: list[_Event] = []
        self._wheels: dict[int, str] = {}
        """What the last command to the left (0) and the right (1) wheel's motor asks of it, of `WHEEL_WORDS`."""
        self._latest: dict[int, _Event] = {}
        """The latest event by its code."""
        self._ends: list[int] = []
        self._newest_scales: dict[str, float] = {}
        self.scale_changes: list[ScaleChange] = []
        """In order, as far as the commands have been read."""
        self.marks: list[tuple[int, Mark]] = []
        """Ticks of events, in order."""

    def __len__(self) -> int:
        return len(self._events)

    # Reading

    def read_piece(self) -> bool:
        """Read further commands from the record; return whether there were any."""
        rows = read_command_rows(self._run.folder, self._end, _PIECE)
        if len(rows):
            self._take(rows)
            self._note_wheels(rows)
            self._end += len(rows)
        return bool(len(rows))

    def read_scale_changes(self) -> list[ScaleChange]:
        """Return all changes of motors' scales that are recorded so far, after reading the commands that are new.

        A scale is the number of degrees that the program counts while a motor turns by one degree.
        """
        import numpy as np

        while len(rows := read_command_rows(self._run.folder, self._end, _PIECE)):
            self._end += len(rows)
            rows = rows[np.isin(rows["call"], (*SCALING_CALLS, Call.PLUG))]
            self._take_scales(rows, rows["time_ns"], self._read_codes(rows))
        return self.scale_changes

    def read_all(self) -> None:
        """Read all commands that have been recorded so far."""
        while self.read_piece():
            pass

    def _take(self, rows: Array) -> None:
        """Group rows of recorded commands into events, and add the events; repetitions of a command join its event.

        Args:
            rows: The rows, in the order of the record.
        """
        import numpy as np

        times = np.maximum.accumulate(np.maximum(rows["time_ns"], self._newest_ns))
        self._newest_ns = int(times[-1])
        self._note_changes(rows, times)
        codes = self._read_codes(rows)
        self._take_scales(rows, times, codes)
        mains = rows["values"][np.arange(len(rows)), _find_mains()[rows["call"]]]
        order = np.argsort(codes, kind="stable")
        order = order[np.isin(rows["call"][order], [*CALL_WORDS])]
        if not len(order):
            return
        codes = codes[order]
        times = times[order]
        mains = mains[order]
        begins = np.flatnonzero(
            np.concatenate(([True], (np.diff(codes) != 0) | (np.diff(times) > _REPEAT_NS)))
        )
        ends = np.append(begins[1:], len(order)) - 1
        columns = (order[begins], codes[begins], times[begins], times[ends], ends - begins + 1)
        spreads = (np.fmin.reduceat(mains, begins), np.fmax.reduceat(mains, begins))
        turn = np.argsort(columns[0])
        lists = [column[turn].tolist() for column in (*columns, *spreads)]
        for row, *values in zip(*lists, strict=True):
            self._add(_Event(self._end + row, *values))

    def _note_changes(self, rows: Array, times: Array) -> None:
        """Store those commands that change what the program reads before the next tick, such as a reset of the gyro.

        Args:
            rows: Rows of recorded commands.
            times: Their times in ns.
        """
        import numpy as np

        changes = np.flatnonzero(np.isin(rows["call"], IMMEDIATE_CALLS))
        changes = changes[: _MAX_EVENTS - len(self._change_ticks)]
        self._changes += rows[changes].tobytes()
        self._change_ticks.extend((times[changes] * self._hz // NS_PER_S).tolist())

    def _note_wheels(self, rows: Array) -> None:
        """Store for each wheel what its last command makes it do, as one of `WHEEL_WORDS` such as `stopping`.

        Commands to a drive base count for both wheels.

        Args:
            rows: Rows of recorded commands; those that do not move or stop a wheel are ignored.
        """
        import numpy as np

        moves = np.isin(rows["call"], MOVES)
        for part in (0, 1):
            is_part = (rows["part"] == part) | (rows["call"] >= Call.BUILD_BASE)
            for row in rows[moves & is_part][-1:]:
                self._wheels[part] = describe_aim(Call(int(row["call"])), row["values"].tolist())

    def describe_wheels(self) -> str:
        """Return how the program has left its wheels: one of the texts in `WHEEL_WORDS`, such as `still set to turn`.

        If the two wheels differ, return the text that comes first in `WHEEL_WORDS`.
        """
        return min(self._wheels.values(), key=WHEEL_WORDS.index, default=WHEEL_WORDS[-1])

    def _take_scales(self, rows: Array, times: Array, codes: Array) -> None:
        import numpy as np

        scales = np.isin(rows["call"], SCALING_CALLS)
        columns = (column[scales].tolist() for column in (times, codes, rows["values"]))
        # A program can give a million of these commands: the ports of a robot are not listed for each.
        ports: dict[int, list[str]] = {}
        for time_ns, code, values in zip(*columns, strict=True):
            if len(self.scale_changes) == _MAX_SCALES:
                return
            scale = compute_scale(code >> 8 & 0xFF, values)
            number, part = code >> 16, code & 0xFF
            if number not in ports:
                ports[number] = [motor.port for motor in self._robots[number].motors]
            # The program may have damaged the record.
            if part >= len(ports[number]) or not scale or not math.isfinite(scale):
                continue
            port = ports[number][part]
            if self._newest_scales.get(port, 1.0) != scale:
                self._newest_scales[port] = scale
                self.scale_changes.append((self._find_tick(time_ns), port, scale))

    def _read_codes(self, rows: Array) -> Array:
        """Return a number for each command. Commands have the same number if their robot, kind and part are the same.

        If a command adds parts to the robot, the robot with these parts is stored for the commands after it.

        Args:
            rows: Rows of recorded commands.
        """
        import numpy as np

        plugs = rows["call"] == Call.PLUG
        robots = np.cumsum(plugs) + (len(self._robots) - 1)
        for values in rows["values"][plugs].tolist():
            self._robots.append(self._plug_parts(values))
        codes: Array = (robots << 16) | (rows["call"].astype(np.int64) << 8) | rows["part"]
        return codes

    def _plug_parts(self, values: list[float]) -> RobotSpec:
        """Return the robot with the parts that a command's values describe; the same robot if they do not fit."""
        with suppress(ValueError, IndexError, TuisimError):
            return plug_parts(self._robots[-1], decode_parts(values, 0))
        return self._robots[-1]

    def _add(self, event: _Event) -> None:
        """Add an event; if it only repeats the latest one of its code, join the two."""
        latest = self._latest.get(event.code)
        if latest is not None and event.first_ns - latest.last_ns <= _REPEAT_NS:
            latest.last_ns = event.last_ns
            latest.count += event.count
            latest.low = min(latest.low, event.low)
            latest.high = max(latest.high, event.high)
            return
        if len(self) == _MAX_EVENTS:
            return
        self._latest[event.code] = event
        tick = self._find_tick(event.first_ns)
        if not self.marks or tick - self.marks[-1][0] > tick // _FINEST:
            self.marks.append((tick, Mark.COMMAND))
        self._events.append(event)

    def _find_tick(self, time_ns: int) -> int:
        return time_ns * self._hz // NS_PER_S

    # Finding

    def find_scales(self, tick: int) -> dict[str, float]:
        """Return the scales of the motors at a tick, by the motor's port.

        A scale is the number of degrees that the program counts while a motor turns by one degree. It is 1 for a port
        that is missing in the result.
        """
        return {port: scale for when, port, scale in self.scale_changes if when <= tick}

    def list_changes(self, tick: int) -> list[SimulationCommand]:
        """Return the commands in a tick that change immediately what the program reads: those of `IMMEDIATE_CALLS`.

        They are in the order in which they were given.
        """
        first, end = (side(self._change_ticks, tick) for side in (bisect_left, bisect_right))
        size = COMMAND_RECORD.size
        records = COMMAND_RECORD.iter_unpack(self._changes[first * size : end * size])
        return [
            SimulationCommand(time_ns, part, Call(call), tuple(values))
            for time_ns, part, call, *values in records
        ]

    def find_events(self, text: str = "") -> list[int]:
        """Return the indices of the events in whose part and command all words of a text occur.

        With an empty text, return the indices of all events.
        """
        words = text.lower().split()
        names = {
            code: f"{self._name_part(code)} {_name_call(_find_call(code))} {CALL_WORDS[_find_call(code)].text}".lower()
            for code in self._latest
        }
        matching = {code for code, name in names.items() if all(word in name for word in words)}
        return [number for number, event in enumerate(self._events) if event.code in matching]

    def tick(self, number: int) -> int:
        """Return the tick at which an event began; `number` is the event's index."""
        return self._find_tick(self._events[number].first_ns)

    def time_s(self, number: int) -> float:
        """Return the simulated time in seconds at which an event began; `number` is the event's index."""
        return self._events[number].first_ns / NS_PER_S

    def event(self, number: int) -> CommandEvent:
        """Return an event, with its command in words; `number` is the event's index."""
        event = self._events[number]
        rows = read_command_rows(self._run.folder, event.row, 1)
        # There is no such row if the program has changed the record meanwhile.
        values = rows["values"][0].tolist() if len(rows) else [0.0] * MAX_VALUES
        call = event.call
        text = _name_call(call)
        with suppress(ValueError, IndexError):
            text = describe_command(call, values, event.low, event.high, self._hz)
        return CommandEvent(
            self.time_s(number),
            self._name_part(event.code),
            text,
            event.count,
            event.last_ns / NS_PER_S,
            self._measure(number, _find_aim(call, values)),
        )

    def _name_part(self, code: int) -> str:
        """Return the name of the part to which a command was given, such as `left motor B`.

        `code` is the command's number from `_read_codes`.
        """
        call = _find_call(code)
        number = code & 0xFF
        if CALL_WORDS[call].part:
            return CALL_WORDS[call].part
        if call >= Call.BUILD_BASE:
            return f"drive base {number + 1}" if number else "drive base"
        motors = self._robots[code >> 16].motors
        port = motors[number].port[-1:] if number < len(motors) else ""
        return f"{('left ', 'right ', '')[min(number, 2)]}motor {port}".rstrip()

    # Results of commands

    def _measure(self, number: int, aim: Aim) -> str:
        """Return in words what a command to a wheel or a drive base caused, such as `turned 360° by 1.50 s`.

        The result is empty for other commands, and if nothing was recorded after the command.

        Args:
            number: The number of the event with the command.
            aim: The kind of motion that the command starts.
        """
        import numpy as np

        event = self._events[number]
        part = event.code & 0xFF
        is_speed = aim in _SPEEDS
        if aim is Aim.NONE or part > 1:
            return ""
        start = self._find_tick(event.first_ns if is_speed else event.last_ns)
        records = self._run.telemetry.array(start)[: self._find_end(number) - start + 1]
        if len(records) < 2:
            return ""
        flags = records["flags"][1:]
        after = records[1:]
        if aim in _BASE_AIMS:
            speeds = np.abs(after["left_speed_dps"]) + np.abs(after["right_speed_dps"])
            is_running = flags & RUNNING_FLAGS != 0
        else:
            side = ("left", "right")[part]
            speeds = after[f"{side}_speed_dps"].astype(float)
            is_running = flags & (FLAG_LEFT_RUNNING, FLAG_RIGHT_RUNNING)[part] != 0
        idle = np.flatnonzero(~is_running & (is_speed | (np.abs(speeds) < _STILL_DPS)))
        if aim is Aim.BASE_SPEED:
            idle = idle[:0]
        count = int(idle[0]) + 1 if len(idle) else len(after)
        when = f"by {(start + count) / self._hz:.2f} s"
        if aim in _BASE_AIMS:
            driven_mm, turned_deg = _measure_way(records[: count + 1])
            if aim is Aim.BASE_SPEED:
                rate = self._hz / count
                return f"mean {_round(driven_mm * rate)} mm/s, {_round(turned_deg * rate)} °/s"
            return f"{_round(driven_mm)} mm, {_round(turned_deg)}° {when}"
        if is_speed:
            return f"mean {_round(speeds[:count].mean())} °/s"
        if aim is Aim.POSITION:
            return f"{_round(after[f'{side}_position_deg'][count - 1])}° {when}"
        return f"turned {_round(speeds[:count].sum() / self._hz)}° {when}"

    def _find_end(self, number: int) -> int:
        """Return the tick at which an event's part got its next command to move; if it got none, the newest tick."""
        if len(self._ends) != len(self):
            self._ends = self._list_ends()
        return self._ends[number]

    def _list_ends(self) -> list[int]:
        """Return for each event the tick at which its part got its next command to move, or else the newest tick."""
        newest = self._run.telemetry.count - 1
        ends = [0] * len(self)
        following: dict[tuple[bool, int], int] = {}
        for number in range(len(self) - 1, -1, -1):
            event = self._events[number]
            part = (event.call >= Call.BUILD_BASE, event.code & 0xFF)
            ends[number] = min(following.get(part, newest), newest)
            if CALL_WORDS[event.call].aim is not Aim.NONE:
                following[part] = self.tick(number)
        return ends


def _round(value: float) -> str:
    return f"{value + 0.0:.0f}" if abs(value) >= 0.5 else "0"


def _find_call(code: int) -> Call:
    return Call(code >> 8 & 0xFF)


def _find_aim(call: Call, values: Sequence[float]) -> Aim:
    """Return the kind of motion that a command with these values starts."""
    is_to_position = call is Call.MOVE and not values[3]
    return Aim.POSITION if is_to_position else CALL_WORDS[call].aim


def _name_call(call: Call) -> str:
    return call.name.lower().replace("_", " ")


def _find_mains() -> Array:
    """Return for each kind of command the index of its main value.

    If a command is repeated with other values, the range of this value is shown. The index in the result is the number
    of the kind of command, a `Call`.
    """
    import numpy as np

    mains = np.zeros(256, np.int64)
    for call, words in CALL_WORDS.items():
        mains[call] = words.main
    return mains


def _measure_way(records: Array) -> tuple[float, float]:
    """Return how far the robot drove in tick records, in mm, and by how many degrees it turned, clockwise."""
    import numpy as np

    steps = np.hypot(np.diff(records["x_mm"]), np.diff(records["y_mm"]))
    return float(steps.sum()), float(records["heading_deg"][0] - records["heading_deg"][-1])
