"""The loop or the move that a run ended in, what would have ended it, and how near that came."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.hub_spec import HUB_PORTS, INSIDE
from tuisim.engine.core.profile import Library
from tuisim.engine.core.spec import (
    ColorSensorSpec,
    GyroSpec,
    InfraredSpec,
    SensorSpec,
    UltrasonicSpec,
)
from tuisim.engine.protocol import End
from tuisim.engine.runs.frames import compute_column_values
from tuisim.engine.runs.readings import READING_MODES, READING_PORTS, read_readings
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.programs.facts import LoopEnd, read_facts
from tuisim.tasks.goals.evidence import find_ticks
from tuisim.tasks.reasons.one_colour import describe_colors, name_limit, name_seen
from tuisim.tasks.reasons.read_columns import (
    COLUMNS,
    COLUMNS_BY_MODE,
    LIGHT_COLUMNS,
    RED,
    TURN_COLUMNS,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tuisim.engine.core.field import Field

    Array = NDArray[Any]

_MIN_STAY_S = 3.0
"""A program that has been in a loop for less time does not wait in it in vain."""
_CUT_OFF = (End.TIME_LIMIT, End.STOPPED, End.OUTPUT_LIMIT)
_MIN_RUN_S = 0.5
_MIN_WAY_MM = 5.0
_MIN_TURN_DEG = 5.0
"""A program that is over earlier, with its robot nearer to the start, gave its motors no time."""
_NEAR = 1.0
_AWAY = 5.0
"""Light that came so near to what was waited for, in percent, and went so far away again, was just missed."""
_MIN_PAUSE_S = 0.1
"""A loop that reads again sooner does not read too seldom."""
_WORDS = {
    ">=": "{} or more",
    ">": "more than {}",
    "<=": "{} or less",
    "<": "less than {}",
    "==": "exactly {}",
    "!=": "anything but {}",
}
_NOUNS: Mapping[type[SensorSpec], str] = {
    ColorSensorSpec: "colour sensor",
    UltrasonicSpec: "ultrasonic sensor",
    InfraredSpec: "infrared sensor",
    GyroSpec: "gyro",
}


@dataclass(frozen=True, slots=True)
class _Series:
    """The values that a loop read of one sensor or motor, in the unit in which the program reads them."""

    device: str
    """Kind and port of the sensor or motor."""
    column: str
    """The end of the name of its column."""
    unit: str
    """With a blank before it, if there is one; empty for none."""
    ticks: Array
    values: Array


@dataclass(frozen=True, slots=True)
class Unmet:
    """A fault at a line of a program, such as a loop whose condition was not met or only just missed."""

    time_s: float
    line: int
    text: str
    """A text to follow "waited for", or a sentence on a miss; without a full stop."""


def find_unmet(run: StoredRun, mat: Field | None = None) -> Unmet | None:
    """Return what a program waited for in its last loop or move, if its run goes on, or a limit or the user ended it.

    The result is None for any other run, if the program waited for nothing, or if that is not known.

    Args:
        run: The run.
        mat: Its mat; None opens it.
    """
    is_cut_off = run.end is None or run.end.end in _CUT_OFF
    return _find_first(_Search.find_unmet, run, mat) if is_cut_off else None


def find_near_miss(run: StoredRun, mat: Field | None = None) -> Unmet | None:
    """Return where a finished loop just missed the light that it waited for.

    No reading quite reached the light, or it was there only between two readings. The result is None if no loop missed
    it so, or if that is not known.

    Args:
        run: The run.
        mat: Its mat; None opens it.
    """
    return _find_first(_Search.find_near_misses, run, mat)


def find_stale_angle(run: StoredRun, mat: Field | None = None) -> Unmet | None:
    """Return a loop that ended at its first reading because the gyro was not reset.

    The result is None if there is no such loop, or if that is not known.

    Args:
        run: The run.
        mat: Its mat; None opens it.
    """
    return _find_first(_Search.find_stale_angles, run, mat)


def find_recount(run: StoredRun, mat: Field | None = None) -> Unmet | None:
    """Return a line of the program that counted one band of the mat twice.

    The result is None if there is none, or if that is not known.

    Args:
        run: The run.
        mat: Its mat; None opens it.
    """
    return _find_first(_Search.find_recounts, run, mat)


def find_early_end(run: StoredRun, mat: Field | None = None) -> Unmet | None:
    """Return why a program ended too early: before its motors could turn, or because it only defines functions.

    Otherwise the result is None.

    Args:
        run: The run.
        mat: Its mat; None opens it.
    """
    end = run.end
    if end is None or end.end is not End.FINISHED or run.time_s >= _MIN_RUN_S:
        return None
    if idle := read_facts(run.program).idle_definition:
        return Unmet(run.time_s, *idle)
    line = read_facts(run.program).first_drive
    last = run.telemetry.last()
    start = run.spec.world.start
    if not line or last is None:
        return None
    way_mm = math.dist((last.pose.x_mm, last.pose.y_mm), (start.x_mm, start.y_mm))
    turn_deg = abs(last.pose.heading_deg - start.heading_deg)
    has_turned_part = any(row.stream is Stream.MOTORS for row in run.output.rows())
    if way_mm >= _MIN_WAY_MM or turn_deg >= _MIN_TURN_DEG or has_turned_part:
        return None
    text = (
        "the program ended when the motors that this line starts had moved the robot by only "
        f"{way_mm:.1f} mm"
    )
    return _find_first(_Search.find_met, run, mat) or Unmet(run.time_s, line, text)


def _find_first(
    search: Callable[[_Search], Iterator[Unmet]], run: StoredRun, mat: Field | None
) -> Unmet | None:
    if not run.telemetry.count:
        return None
    try:
        return next(search(_Search(run, mat)), None)
    except (LogError, ConfigError):
        return None


class _Search:
    """A search for what the program of a run waited for.

    Raises:
        LogError, ConfigError: a recording is damaged, or the mat no longer exists.
    """

    def __init__(self, run: StoredRun, mat: Field | None) -> None:
        self._run = run
        self._mat = mat
        self._hz = run.spec.profile.tick_hz
        self._records = run.telemetry.array()
        self._loops = read_facts(run.program).loop_ends
        self._has_codes = run.spec.profile.motor_law.library is not Library.PYBRICKS
        """Whether `color` is a number in the program's library."""

    @cached_property
    def _readings(self) -> Array:
        """The readings of sensors and motors that the program took."""
        return read_readings(self._run.folder, is_over=self._run.end is not None).rows

    @cached_property
    def _scales(self) -> dict[str, float]:
        """The scales of motors by port: degrees in the program per degree of the motor.

        A port without an entry has the scale 1.
        """
        # Imported on demand: few runs wait for a motor.
        from tuisim.engine.runs.command_events import CommandIndex

        return {port: scale for _, port, scale in CommandIndex(self._run).read_scale_changes()}

    @cached_property
    def _field(self) -> Field:
        """The mat of the run, opened at the first use."""
        return self._run.open_mat() if self._mat is None else self._mat

    def find_unmet(self) -> Iterator[Unmet]:
        """Yield what the program waited for in its last move and in each loop, the inner loops first."""
        if move := self._find_move():
            yield move
        for loop in self._loops:
            stay = self._find_stay(loop)
            is_inside = stay and stay[1] == len(self._records) and self._is_long(stay[0])
            if stay and is_inside and (text := self._describe(loop, stay)):
                yield Unmet(stay[0] / self._hz, loop.line, text)

    def find_near_misses(self) -> Iterator[Unmet]:
        """Yield finished loops whose limit the light only just missed, or met only between two readings of the loop."""
        is_finished = self._run.end is not None and self._run.end.end is End.FINISHED
        for loop in self._loops:
            stay = self._find_stay(loop)
            has_left = is_finished or (stay and stay[1] < len(self._records))
            series = self._measure(loop, stay) if stay and has_left else None
            if not stay or not series or series.column not in LIGHT_COLUMNS:
                continue
            if miss := self._find_miss(loop, series):
                yield miss
            if skip := self._find_skip(loop, stay, series):
                tick, what = skip
                text = f"the value that this line waited for came between two reads: {what}"
                yield Unmet(tick / self._hz, loop.line, text)

    def find_met(self) -> Iterator[Unmet]:
        """Yield the loops whose first reading was already what they waited for."""
        for loop in self._loops:
            series = self._measure(loop, (0, len(self._records)))
            if series is None:
                continue
            text = f"the loop ended at once: {series.device} read"
            if series.column == "color":
                (name,) = name_seen(loop, series.values[:1], self._has_codes)
                if loop.operator == "!=" and name != name_limit(loop):
                    text = f"{text} {name}, not {name_limit(loop)}"
                    yield Unmet(series.ticks[0] / self._hz, loop.line, text)
            elif not isinstance(loop.limit, str):
                first = series.values[0]
                if COMPARE[loop.operator](first, loop.limit):
                    goal = _name_goal(loop, f"{loop.limit:g}{series.unit}")
                    text = f"{text} {_round(first)}{series.unit}, already {goal}"
                    yield Unmet(series.ticks[0] / self._hz, loop.line, text)

    def find_stale_angles(self) -> Iterator[Unmet]:
        """Yield loops that first waited for an angle of the gyro and, when run again, ended at their first reading."""
        import numpy as np

        lines = self._records["line"]
        for loop in self._loops:
            series = self._measure(loop, (0, len(self._records)))
            if series is None or series.column != "deg" or isinstance(loop.limit, str):
                continue
            if not series.device.startswith("the gyro"):
                continue
            left = np.cumsum((lines < loop.first_line) | (lines > loop.last_line))[series.ticks]
            begins = np.flatnonzero(np.diff(left)) + 1
            is_met = COMPARE[loop.operator](series.values, loop.limit)
            stale = begins[is_met[begins]]
            if len(stale) and not is_met[0]:
                text = (
                    f"{series.device} was at {_round(series.values[stale[0]])}{series.unit} already when "
                    "the loop began again, so that it ended at once: reset the angle before the loop"
                )
                yield Unmet(series.ticks[stale[0]] / self._hz, loop.line, text)

    def find_recounts(self) -> Iterator[Unmet]:
        """Yield lines of the program that counted two readings in a row of the same band while the robot moved."""
        for line, test in read_facts(self._run.program).counts:
            series = self._measure(test, (0, len(self._records)))
            if series is None or series.column not in LIGHT_COLUMNS or isinstance(test.limit, str):
                continue
            is_met = COMPARE[test.operator](series.values, test.limit)
            x_mm, y_mm = (self._records[name][series.ticks] for name in ("x_mm", "y_mm"))
            moves = (x_mm[1:] != x_mm[:-1]) | (y_mm[1:] != y_mm[:-1])
            again = is_met[1:] & is_met[:-1] & moves
            if again.any():
                first_s, next_s = series.ticks[again.argmax() :][:2] / self._hz
                goal = _name_goal(test, f"{test.limit:g}{series.unit}")
                text = (
                    f"this line counted at {first_s:.2f} s and {next_s:.2f} s on the same band: "
                    f"it counts each reading that is {goal}, not each band"
                )
                yield Unmet(next_s, line, text)

    def _is_long(self, tick: int) -> bool:
        """Return whether the program has waited long enough since a tick."""
        return len(self._records) - tick >= _MIN_STAY_S * self._hz

    def _find_move(self) -> Unmet | None:
        """Return the turn of the wheels that the program waits for; None if it waits for none."""
        import numpy as np

        line = int(self._records["line"][-1])
        turns = read_facts(self._run.program).find_turns(line)
        first = int(np.flatnonzero(self._records["line"] != line)[-1:].sum()) + 1
        if turns is None or not self._is_long(first):
            return None
        names = ("left_position_deg", "right_position_deg")
        turned = max(abs(np.ptp(self._records[name][first:])) for name in names)
        amount, unit = turns
        turned /= 360 if unit == "rotations" else 1
        if not 0 < turned < abs(amount):
            return None
        text = f"{amount:g} {unit} of the wheels: they had turned {turned:.1f}"
        return Unmet(first / self._hz, line, text)

    def _find_stay(self, loop: LoopEnd) -> tuple[int, int] | None:
        """Return the first tick in a loop, and the tick after its last one.

        The result is None if the loop was entered never or more than once.
        """
        # Imported on demand, as numpy is.
        from tuisim.engine.runs.arrays import find_spans

        lines = self._records["line"]
        is_in = (lines >= loop.first_line) & (lines <= loop.last_line)
        stays = find_spans(is_in).tolist()
        return (stays[0][0], stays[0][1]) if len(stays) == 1 else None

    def _describe(self, loop: LoopEnd, stay: tuple[int, int]) -> str:
        """Return what a loop waited for, and what it read.

        The result is empty if the loop's condition was met, or if that is not known.
        """
        if loop.is_silent and not loop.name:
            return "its endless loop to end, in which nothing waits, reads or breaks"
        if loop.set_line or loop.is_silent:
            goal = _name_goal(loop, str(loop.limit))
            why = (
                f"but nothing changes it after line {loop.set_line}"
                if loop.set_line
                else "in a loop without a wait"
            )
            return f"{loop.name} to be {goal}, {why}"
        series = self._measure(loop, stay)
        if series is None:
            return ""
        if series.column == "color":
            return describe_colors(loop, series.device, series.values, self._has_codes)
        if isinstance(loop.limit, str) or COMPARE[loop.operator](series.values, loop.limit).any():
            return ""
        goal = _name_goal(loop, f"{loop.limit:g}{series.unit}")
        skip = self._find_skip(loop, stay, series) if series.column in LIGHT_COLUMNS else None
        came = skip[1] if skip else self._name_nearest(loop, series)
        return f"{series.device} to read {goal}: {came}"

    def _name_nearest(self, loop: LoopEnd, series: _Series) -> str:
        """Return which value came nearest to the limit of a loop.

        If that was the first value, return how the values changed after it.
        """
        values = series.values
        nearest = int(abs(values - loop.limit).argmin())
        if values[nearest] != values[0] and values[nearest] == values[-1]:
            return f"it went from {_round(values[0])} to {_round(values[-1])} only"
        if values[nearest] != values[0]:
            return f"{_round(values[nearest])} at {series.ticks[nearest] / self._hz:.2f} s came nearest"
        if values[-1] == values[0]:
            return f"it stayed at {_round(values[0])}"
        return f"it went from {_round(values[0])} to {_round(values[-1])}"

    def _find_miss(self, loop: LoopEnd, series: _Series) -> Unmet | None:
        """Return where the light came within `_NEAR` % of a loop's limit without passing it; None if it did not.

        Before and after, the light was at least `_AWAY` % away from the limit.
        """
        import numpy as np

        if isinstance(loop.limit, str):
            return None
        ticks = series.ticks
        values = series.values
        misses = abs(values - loop.limit)
        away = np.flatnonzero(misses[:-1] >= _AWAY)
        if not len(away) or COMPARE[loop.operator](values[:-1], loop.limit).any():
            return None
        first, last = int(away[0]), int(away[-1])
        nearest = first + int(misses[first : last + 1].argmin())
        if misses[nearest] > _NEAR:
            return None
        goal = _name_goal(loop, f"{loop.limit:g}")
        text = f"{_round(values[nearest])} just missed the {goal} that it waited for"
        return Unmet(ticks[nearest] / self._hz, loop.line, text)

    def _find_skip(
        self, loop: LoopEnd, stay: tuple[int, int], reads: _Series
    ) -> tuple[int, str] | None:
        """Return the first tick at which the light met a loop's condition between two readings, and a description.

        Otherwise the result is None.
        """
        import numpy as np

        every = None if isinstance(loop.limit, str) else self._measure(loop, stay, is_between=True)
        if every is None:
            return None
        meets = COMPARE[loop.operator]
        # At the first tick that meets the condition, the reading may have ended the loop.
        first = int(meets(every.values, loop.limit).argmax())
        tick = int(every.ticks[first])
        after = int(np.searchsorted(reads.ticks, tick))
        is_met = meets(every.values[first], loop.limit)
        if not is_met or not 0 < after < len(reads.ticks):
            return None
        start, end = (int(reads.ticks[place]) for place in (after - 1, after))
        if end - start < _MIN_PAUSE_S * self._hz or meets(reads.values[after], loop.limit):
            return None
        lines, counts = np.unique(self._records["line"][start + 1 : end], return_counts=True)
        what = (
            f"it was {_round(every.values[first])}{every.unit} at {tick / self._hz:.2f} s, but the program "
            f"read it only at {start / self._hz:.2f} s and {end / self._hz:.2f} s: "
            f"line {lines[counts.argmax()]} takes too long"
        )
        return tick, what

    def _measure(
        self, loop: LoopEnd, stay: tuple[int, int], *, is_between: bool = False
    ) -> _Series | None:
        """Return the values that a loop read; with `is_between` the values that it would have read at every tick.

        The result is None if they are not known, or if noise or the pen's marks would make the computation slow.
        """
        import numpy as np

        rows = self._readings[self._readings["line"] == loop.read_line]
        ticks = np.unique(find_ticks(rows, self._hz))
        ticks = ticks[(ticks >= stay[0]) & (ticks < stay[1])]
        ports = [READING_PORTS[port] for port in np.unique(rows["port"])]
        sensors = [each for each in self._run.spec.robot.sensors if each.port in ports]
        if not len(ticks):
            return None
        if is_between:
            ticks = np.arange(ticks[0], ticks[-1] + 1)
        if wheel := self._find_wheel(ports):
            return self._measure_wheel(loop, wheel, ports[0], ticks)
        mode = READING_MODES[rows["mode"][0]]
        read = (
            COLUMNS_BY_MODE.get(mode) if loop.attribute == "value" else COLUMNS.get(loop.attribute)
        )
        if len(sensors) != 1 or read is None:
            return None
        return self._measure_sensor(loop, sensors[0], read, ticks)

    def _measure_wheel(self, loop: LoopEnd, wheel: str, port: str, ticks: Array) -> _Series | None:
        """Return the position in degrees of a wheel's motor at some ticks.

        The result is None if the loop reads another attribute of the motor.
        """
        if loop.attribute not in TURN_COLUMNS:
            return None
        column, factor, unit = TURN_COLUMNS[loop.attribute]
        values = self._records[f"{wheel}_position_{column}"][ticks] * factor
        values = values * self._scales.get(port, 1.0)
        return _Series(f"the motor on {port}", column, unit, ticks, values)

    def _measure_sensor(
        self, loop: LoopEnd, sensor: SensorSpec, read: tuple[str, float, str], ticks: Array
    ) -> _Series | None:
        """Return what a sensor measured at some ticks.

        The result is None if it has no such measurement, or if computing it would be slow.
        """
        import numpy as np

        spec, (column, factor, unit) = self._run.spec, read
        if spec.world.noise.light or spec.world.pen_marks:
            return None
        if loop.attribute == "reflection" and sensor.port in HUB_PORTS:
            # On a hub, the reflection is measured in all colours.
            column = "mean_pc"
        name = f"{sensor.name}_{column}"
        run = self._run
        mat = self._field
        columns = compute_column_values(
            (name,), self._records[ticks], run, run.actions, mat, lambda _: mat
        )
        if name not in columns:
            return None
        values = columns[name] * factor
        if read is RED:
            values = np.floor(values * spec.profile.reflected_max / 100)
        elif loop.attribute == "reflection":
            values = np.floor(values)
        device = f"the {_NOUNS.get(type(sensor), 'sensor')} {describe_place(sensor.port)}"
        return _Series(device, column, unit, ticks, values)

    def _find_wheel(self, ports: list[str]) -> str:
        """Return `left` or `right` if the only port is the port of that wheel's motor.

        The result is empty for other ports, or if the wheels have gears.
        """
        robot = self._run.spec.robot
        wheels = {
            robot.left_port: "left",
            robot.right_port: "right",
        }
        return wheels.get(ports[0], "") if len(ports) == 1 and robot.gear_ratio == 1 else ""


def describe_place(port: str) -> str:
    """Return where a sensor is in words, such as `on in1`."""
    return "in the hub" if port == INSIDE else f"on {port}"


def _round(value: float) -> str:
    return f"{round(value, 2):g}"


def _name_goal(loop: LoopEnd, limit: str) -> str:
    return _WORDS[loop.operator].format(limit)
