"""The loop or the move that a run ended in, what would have ended it, and how near that came."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.profile import Library
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import Stream
from tuisim.programs.facts import LoopEnd
from tuisim.tasks.reasons.one_colour import describe_colors, name_limit, name_seen
from tuisim.tasks.reasons.read_columns import LIGHT_COLUMNS
from tuisim.tasks.reasons.run_data import RunData, Series

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


@dataclass(frozen=True, slots=True)
class Unmet:
    """A fault at a line of a program, such as a loop whose condition was not met or only just missed."""

    time_s: float
    line: int
    text: str
    """A text to follow "waited for", or a sentence on a miss; without a full stop."""
    is_endless: bool = False
    """Whether what was waited for could never come."""


def find_unmet(data: RunData) -> Unmet | None:
    """Return what the program waited for in its last loop or move.

    The result is None unless the run still goes on or was ended by a limit or the user. It is also None if the program
    waited for nothing, or if that is not known.

    Args:
        data: The run.
    """
    is_cut_off = data.run.end is None or data.run.end.end in _CUT_OFF
    return _find_first(_Search.find_unmet, data) if is_cut_off else None


def find_near_miss(data: RunData) -> Unmet | None:
    """Return where a loop that has ended just missed the light that it waited for; None if no loop did, or if unknown.

    Either no reading quite reached the light, or the light was there only between two readings.

    Args:
        data: The run.
    """
    return _find_first(_Search.find_near_misses, data)


def find_stale_angle(data: RunData) -> Unmet | None:
    """Return a loop that ended at its first reading because the gyro was not reset.

    The result is None if there is no such loop, or if that is not known.

    Args:
        data: The run.
    """
    return _find_first(_Search.find_stale_angles, data)


def find_recount(data: RunData) -> Unmet | None:
    """Return a line of the program that counted one band of the mat twice.

    The result is None if there is none, or if that is not known.

    Args:
        data: The run.
    """
    return _find_first(_Search.find_recounts, data)


def find_early_end(data: RunData) -> Unmet | None:
    """Return why a program ended too early: before its motors could turn, or because it only defines functions.

    Otherwise the result is None.

    Args:
        data: The run.
    """
    run = data.run
    if not data.is_finished or run.time_s >= _MIN_RUN_S:
        return None
    if idle := data.facts.idle_definition:
        return Unmet(run.time_s, *idle)
    line = data.facts.first_drive
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
    return _find_first(_Search.find_met, data) or Unmet(run.time_s, line, text)


def _find_first(search: Callable[[_Search], Iterator[Unmet]], data: RunData) -> Unmet | None:
    if not data.run.telemetry.count:
        return None
    try:
        return next(search(_Search(data)), None)
    except (LogError, ConfigError):
        return None


class _Search:
    """A search for what the program of a run waited for.

    Raises:
        LogError, ConfigError: a recording is damaged, or the mat no longer exists.
    """

    def __init__(self, data: RunData) -> None:
        self._data = data
        self._hz = data.hz
        self._records = data.records
        self._loops = data.facts.loop_ends
        self._has_codes = data.run.spec.profile.motor_law.library is not Library.PYBRICKS
        """Whether `color` is a number in the program's library."""

    def find_unmet(self) -> Iterator[Unmet]:
        """Yield what the program waited for in its last move and in each loop, the inner loops first."""
        if move := self._find_move():
            yield move
        for loop in self._loops:
            stay = self._find_stay(loop)
            is_long = stay and (loop.is_endless or self._is_long(stay[0]))
            is_inside = stay and is_long and stay[1] == len(self._records)
            if stay and is_inside and (text := self._describe(loop, stay)):
                yield Unmet(stay[0] / self._hz, loop.line, text, is_endless=loop.is_endless)

    def find_near_misses(self) -> Iterator[Unmet]:
        """Yield a fault for each loop that has ended and just missed the light that it waited for.

        Either the light came near its limit, or it passed the limit only between two readings of the loop.
        """
        for loop in self._loops:
            stay = self._find_stay(loop)
            has_left = self._data.is_finished or (stay and stay[1] < len(self._records))
            series = self._data.measure(loop, stay) if stay and has_left else None
            if not stay or not series or series.column not in LIGHT_COLUMNS:
                continue
            if miss := self._find_miss(loop, series):
                yield miss
            if skip := self._find_skip(loop, stay, series):
                tick, what = skip
                text = f"the value that this line waited for came between two reads: {what}"
                yield Unmet(tick / self._hz, loop.line, text)

    def find_met(self) -> Iterator[Unmet]:
        """Yield a fault for each loop that ended at its first reading, which already was what the loop waited for."""
        for loop in self._loops:
            series = self._data.measure(loop, (0, len(self._records)))
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
                    goal = name_goal(loop, f"{loop.limit:g}{series.unit}")
                    text = f"{text} {round_value(first)}{series.unit}, already {goal}"
                    yield Unmet(series.ticks[0] / self._hz, loop.line, text)

    def find_stale_angles(self) -> Iterator[Unmet]:
        """Yield loops that first waited for an angle of the gyro and, when run again, ended at their first reading."""
        import numpy as np

        lines = self._records["line"]
        for loop in self._loops:
            series = self._data.measure(loop, (0, len(self._records)))
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
                    f"{series.device} was at {round_value(series.values[stale[0]])}{series.unit} already when "
                    "the loop began again, so that it ended at once: reset the angle before the loop"
                )
                yield Unmet(series.ticks[stale[0]] / self._hz, loop.line, text)

    def find_recounts(self) -> Iterator[Unmet]:
        """Yield a fault for each line that counted one band twice, in successive readings of a moving robot."""
        for line, test in self._data.facts.counts:
            series = self._data.measure(test, (0, len(self._records)))
            if series is None or series.column not in LIGHT_COLUMNS or isinstance(test.limit, str):
                continue
            is_met = COMPARE[test.operator](series.values, test.limit)
            x_mm, y_mm = (self._records[name][series.ticks] for name in ("x_mm", "y_mm"))
            moves = (x_mm[1:] != x_mm[:-1]) | (y_mm[1:] != y_mm[:-1])
            again = is_met[1:] & is_met[:-1] & moves
            if again.any():
                first_s, next_s = series.ticks[again.argmax() :][:2] / self._hz
                goal = name_goal(test, f"{test.limit:g}{series.unit}")
                text = (
                    f"this line counted at {first_s:.2f} s and {next_s:.2f} s on the same band: "
                    f"it counts each reading that is {goal}, not each band"
                )
                yield Unmet(next_s, line, text)

    def _is_long(self, tick: int) -> bool:
        """Return whether the time from a tick to the end of the recording is long enough for a wait."""
        return len(self._records) - tick >= _MIN_STAY_S * self._hz

    def _find_move(self) -> Unmet | None:
        """Return the turn of the wheels that the program waits for; None if it waits for none."""
        import numpy as np

        line = int(self._records["line"][-1])
        turns = self._data.facts.find_turns(line)
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
        """Return as text what a loop waited for and what it read.

        The result is empty if the loop's condition was met, or if that is not known.

        Args:
            loop: The loop.
            stay: The first tick in the loop, and the tick after its last one.
        """
        if loop.is_silent and not loop.name:
            return "its endless loop to end, in which nothing waits, reads or breaks"
        if loop.set_line or loop.is_silent:
            goal = name_goal(loop, str(loop.limit))
            why = (
                f"but nothing changes it after line {loop.set_line}: read it inside the loop"
                if loop.set_line
                else "in a loop without a wait"
            )
            return f"{loop.name} to be {goal}, {why}"
        series = self._data.measure(loop, stay)
        if series is None:
            return ""
        if series.column == "color":
            return describe_colors(loop, series.device, series.values, self._has_codes)
        if isinstance(loop.limit, str) or COMPARE[loop.operator](series.values, loop.limit).any():
            return ""
        goal = name_goal(loop, f"{loop.limit:g}{series.unit}")
        skip = self._find_skip(loop, stay, series) if series.column in LIGHT_COLUMNS else None
        came = skip[1] if skip else self._name_nearest(loop, series)
        return f"{series.device} to read {goal}: {came}"

    def _name_nearest(self, loop: LoopEnd, series: Series) -> str:
        """Return as text which of the values came nearest to the limit of a loop, and when.

        If the first or the last value came nearest, the text says from which value to which they went.
        """
        values = series.values
        nearest = int(abs(values - loop.limit).argmin())
        if values[nearest] != values[0] and values[nearest] == values[-1]:
            return f"it went from {round_value(values[0])} to {round_value(values[-1])} only"
        if values[nearest] != values[0]:
            return f"{round_value(values[nearest])} at {series.ticks[nearest] / self._hz:.2f} s came nearest"
        if values[-1] == values[0]:
            return f"it stayed at {round_value(values[0])}"
        return f"it went from {round_value(values[0])} to {round_value(values[-1])}"

    def _find_miss(self, loop: LoopEnd, series: Series) -> Unmet | None:
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
        goal = name_goal(loop, f"{loop.limit:g}")
        text = f"{round_value(values[nearest])} just missed the {goal} that it waited for"
        return Unmet(ticks[nearest] / self._hz, loop.line, text)

    def _find_skip(
        self, loop: LoopEnd, stay: tuple[int, int], reads: Series
    ) -> tuple[int, str] | None:
        """Return the first tick at which the light met a loop's condition between two readings, and a description.

        The result is None if there is no such tick.

        Args:
            loop: The loop.
            stay: The first tick in the loop, and the tick after its last one.
            reads: The readings of the loop.
        """
        import numpy as np

        every = (
            None if isinstance(loop.limit, str) else self._data.measure(loop, stay, is_between=True)
        )
        if every is None:
            return None
        meets = COMPARE[loop.operator]
        # Only the first tick that meets the condition matters: after it, a reading may have ended the loop.
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
            f"it was {round_value(every.values[first])}{every.unit} at {tick / self._hz:.2f} s, but the program "
            f"read it only at {start / self._hz:.2f} s and {end / self._hz:.2f} s: "
            f"line {lines[counts.argmax()]} takes too long"
        )
        return tick, what


def round_value(value: float) -> str:
    """Return a value as text, with at most two decimals."""
    return f"{round(value, 2):g}"


def name_goal(loop: LoopEnd, limit: str) -> str:
    """Return in words for which values a comparison is true.

    Args:
        loop: The comparison.
        limit: Its limit, with the unit.
    """
    return _WORDS[loop.operator].format(limit)
