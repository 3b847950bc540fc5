"""The loop or the move that a run ended in, what would have ended it, and how near that came."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import Stream
from tuisim.programs.facts import LoopEnd
from tuisim.tasks.reasons.one_colour import describe_colors, name_limit, name_seen
from tuisim.tasks.reasons.read_columns import LIGHT_COLUMNS
from tuisim.tasks.reasons.run_data import START_CALLS, RunData, Series, list_distinct

_MIN_STAY_S = 3.0
"""A program that has been in a loop for less time does not wait in it in vain."""
_CUT_OFF = (End.TIME_LIMIT, End.STOPPED, End.OUTPUT_LIMIT)
_MIN_RUN_S = 0.5
_MIN_WAY_MM = 5.0
_MIN_TURN_DEG = 5.0
"""A program that is over earlier, with its robot nearer to the start, gave its motors no time."""
_MAX_ABOVE = 2
"""A remark belongs to a loop if it stands at most this many lines above it."""
_FAR_CM = 100
"""A limit of at least this many cm was probably meant in mm."""
_NEAR = 1.0
_AWAY = 5.0
"""Light that came so near to what was waited for, in percent, and went so far away again, was just missed."""
_WORDS = {
    ">=": "{} or more",
    ">": "more than {}",
    "<=": "{} or less",
    "<": "less than {}",
    "==": "exactly {}",
    "!=": "anything but {}",
}

AWAY = "the other way"
"""The end of a text on readings of which the first one came nearest to what was waited for."""


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
    """Return what the program waited for in its last loop or move, in a run that goes on or was cut off.

    A run is cut off if a limit or the user ended it. The result is None for other runs. It is also None if the program
    waited for nothing, or if that is not known.

    Args:
        data: The run.
    """
    is_cut_off = data.run.end is None or data.run.end.end in _CUT_OFF
    return find_first(list_unmet, data) if is_cut_off else None


def find_early_end(data: RunData) -> Unmet | None:
    """Return why a program ended too early: before its motors could turn, or because it only defines functions.

    Otherwise the result is None.

    Args:
        data: The run.
    """
    import numpy as np

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
    if not np.isin(data.commands["call"], START_CALLS).any():
        text = "this line would drive the robot, but it never ran"
        if function := data.facts.find_place(line)[0]:
            text += f": nothing called the function of line {function}"
    return find_first(_list_met, data) or Unmet(run.time_s, line, text)


def find_first(search: Callable[[RunData], Iterator[Unmet]], data: RunData) -> Unmet | None:
    """Return the first fault that a search yields; None if it yields none, or if a recording or mat is missing."""
    try:
        return next(search(data), None) if len(data.records) else None
    except (LogError, ConfigError):
        return None


def list_unmet(data: RunData) -> Iterator[Unmet]:
    """Yield what a program waited for in its last move and in each loop, the inner loops first."""
    if move := _find_move(data):
        yield move
    for loop in data.facts.loop_ends:
        stay = _find_stay(data, loop)
        is_long = stay and (loop.set_line or _is_long(data, stay[0]))
        is_inside = stay and is_long and stay[1] == len(data.records)
        if stay and is_inside and (text := _describe(data, loop, stay)):
            yield Unmet(stay[0] / data.hz, loop.line, text, is_endless=bool(loop.set_line))


def list_near_misses(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each loop that has ended and whose light came near the limit, but did not pass it."""
    for loop in data.facts.loop_ends:
        stay = _find_stay(data, loop)
        has_left = data.is_finished or (stay and stay[1] < len(data.records))
        series = data.measure(loop, stay) if stay and has_left else None
        if series and series.column in LIGHT_COLUMNS and (miss := _find_miss(data, loop, series)):
            yield miss


def _list_met(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each loop that ended at its first reading, which already was what the loop waited for."""
    for loop in data.facts.loop_ends:
        series = data.measure(loop)
        if series is None:
            continue
        text = f"the loop ended at once: {series.device} read"
        if series.column == "color":
            (name,) = name_seen(loop, series.values[:1], data.has_codes)
            if loop.operator == "!=" and name != name_limit(loop):
                text = f"{text} {name}, not {name_limit(loop)}"
                yield Unmet(series.ticks[0] / data.hz, loop.line, text)
        elif not isinstance(loop.limit, str):
            first = series.values[0]
            if COMPARE[loop.operator](first, loop.limit):
                goal = name_goal(loop, f"{loop.limit:g}{series.unit}")
                text = f"{text} {round_value(first)}{series.unit}, already {goal}{_name_turned(loop, series)}"
                yield Unmet(series.ticks[0] / data.hz, loop.line, text)


def _name_turned(loop: LoopEnd, series: Series) -> str:
    """Return what to change in a comparison that was met at once: its unit, or its sign if the opposite was meant.

    The result is empty if the comparison is neither with `<` nor with `>`.
    """
    if series.unit == " cm" and not isinstance(loop.limit, str) and loop.limit >= _FAR_CM:
        return f"; {loop.limit:g} mm are {loop.limit / 10:g} cm"
    other = {">": "<", "<": ">"}.get(loop.operator[0], "")
    if not other or isinstance(loop.limit, str):
        return ""
    goal = name_goal(replace(loop, operator=other), f"{loop.limit:g}{series.unit}")
    return f"; turn its sign round to wait for {goal}"


def list_stale_angles(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each loop that ended at once when it ran again, because the gyro still had the earlier angle.

    When the loop ran first, it waited for the gyro to reach this angle.
    """
    import numpy as np

    lines = data.records["line"]
    for loop in data.facts.loop_ends:
        series = data.measure(loop)
        if series is None or series.column != "deg" or isinstance(loop.limit, str):
            continue
        if series.device.startswith("the motor"):
            continue
        left = np.cumsum((lines < loop.first_line) | (lines > loop.last_line))[series.ticks]
        is_last = np.append(np.diff(left) > 0, True)
        begins = np.flatnonzero(is_last[:-1]) + 1
        is_met = COMPARE[loop.operator](series.values, loop.limit)
        stale = begins[is_met[begins] & is_last[begins]]
        if len(stale) and not is_met[0]:
            text = (
                f"{series.device} was at {round_value(series.values[stale[0]])}{series.unit} already when "
                "the loop began again, so that it ended at once: reset the angle before the loop"
            )
            yield Unmet(series.ticks[stale[0]] / data.hz, loop.line, text)


def list_recounts(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each line that counted one band twice, in successive readings of a moving robot."""
    for line, test in data.facts.counts:
        series = data.measure(test)
        if series is None or series.column not in LIGHT_COLUMNS or isinstance(test.limit, str):
            continue
        is_met = COMPARE[test.operator](series.values, test.limit)
        x_mm, y_mm = (data.records[name][series.ticks] for name in ("x_mm", "y_mm"))
        moves = (x_mm[1:] != x_mm[:-1]) | (y_mm[1:] != y_mm[:-1])
        again = is_met[1:] & is_met[:-1] & moves
        if again.any():
            first_s, next_s = series.ticks[again.argmax() :][:2] / data.hz
            goal = name_goal(test, f"{test.limit:g}{series.unit}")
            text = (
                f"this line counted at {first_s:.2f} s and {next_s:.2f} s on the same band: "
                f"it counts each reading that is {goal}, not each band"
            )
            yield Unmet(next_s, line, text)


def _is_long(data: RunData, tick: int) -> bool:
    """Return whether the time from a tick to the end of the recording is long enough for a wait."""
    return len(data.records) - tick >= _MIN_STAY_S * data.hz


def _find_move(data: RunData) -> Unmet | None:
    """Return the turn of the wheels that the program waits for; None if it waits for none."""
    import numpy as np

    lines = data.records["line"]
    line = int(lines[-1])
    turns = data.facts.find_turns(line)
    first = int(np.flatnonzero(lines != line)[-1:].sum()) + 1
    if turns is None or not _is_long(data, first):
        return None
    names = ("left_position_deg", "right_position_deg")
    turned = max(abs(np.ptp(data.records[name][first:])) for name in names)
    amount, unit = turns
    turned /= 360 if unit == "rotations" else 1
    if not 0 < turned < abs(amount):
        return None
    text = f"{amount:g} {unit} of the wheels: they had turned {turned:.1f}"
    return Unmet(first / data.hz, line, text)


def _find_stay(data: RunData, loop: LoopEnd) -> tuple[int, int] | None:
    """Return the first tick in a loop, and the tick after its last one.

    The result is None if the loop was entered never or more than once.
    """
    import numpy as np

    # Imported on demand, as numpy is.
    from tuisim.engine.runs.arrays import find_spans

    lines = data.records["line"]
    is_in = (lines >= loop.first_line) & (lines <= loop.last_line)
    if loop.is_count:
        places = {line: data.facts.find_place(line)[0] for line in list_distinct(lines).tolist()}
        called = [line for line, first in places.items() if first in loop.called_lines]
        is_in |= np.isin(lines, called)
    stays = find_spans(is_in).tolist()
    # A loop that counts nothing cannot be left.
    is_once = len(stays) == 1 or (stays and loop.is_count)
    return (stays[0][0], stays[-1][1]) if is_once else None


def _describe(data: RunData, loop: LoopEnd, stay: tuple[int, int]) -> str:
    """Return as text what a loop waited for and what it read.

    The result is empty if the loop's condition was met, or if that is not known.

    Args:
        data: The run.
        loop: The loop.
        stay: The first tick in the loop, and the tick after its last one.
    """
    if loop.set_line:
        goal = name_goal(loop, str(loop.limit))
        remedy = f"count {loop.name} in the loop" if loop.is_count else "read it inside the loop"
        return (
            f"{loop.name} to be {goal}, but nothing changes it after line {loop.set_line}: {remedy}"
        )
    series = data.measure(loop, stay)
    if series is None:
        return ""
    if series.column == "color":
        return describe_colors(loop, series.device, series.values, data.has_codes)
    if isinstance(loop.limit, str) or COMPARE[loop.operator](series.values, loop.limit).any():
        return ""
    verb = "change by" if loop.start_line else "read"
    goal = name_goal(loop, f"{loop.limit:g}{series.unit}")
    nearest = _name_nearest(loop, series, data.hz)
    return f"{series.device} to {verb} {goal}: {nearest}{_name_remedy(data, loop, series)}"


def _name_remedy(data: RunData, loop: LoopEnd, series: Series) -> str:
    """Return what to change in a comparison that never was met; empty if that is not known."""
    limit = loop.limit
    if isinstance(limit, str):
        return ""
    if loop.operator == "==" and series.values.min() < limit < series.values.max():
        return "; it passed without being equal: ask with < or >"
    lines = range(loop.first_line - _MAX_ABOVE, loop.last_line + 1)
    is_wrong = series.unit == " mm" and any(
        data.facts.remarks.has_centimetres(line, float(limit)) for line in lines
    )
    return f"; {limit:g} cm are {limit * 10:g} mm" if is_wrong else ""


def _name_nearest(loop: LoopEnd, series: Series, hz: int) -> str:
    """Return as text which of the values that a loop read came nearest to its limit, and when.

    If that is the first or the last value, the text has both, to show how the values changed.
    """
    values = series.values
    nearest = int(abs(values - loop.limit).argmin())
    if values[nearest] != values[0] and values[nearest] == values[-1]:
        return f"it went from {round_value(values[0])} to {round_value(values[-1])} only"
    if values[nearest] != values[0]:
        return f"{round_value(values[nearest])} at {series.ticks[nearest] / hz:.2f} s came nearest"
    if values[-1] == values[0]:
        return f"it stayed at {round_value(values[0])}"
    return f"it went from {round_value(values[0])} to {round_value(values[-1])}, {AWAY}"


def _find_miss(data: RunData, loop: LoopEnd, series: Series) -> Unmet | None:
    """Return a fault if the light came within `_NEAR` % of a loop's limit without passing it; None if it did not.

    This counts only between two readings that were at least `_AWAY` % away from the limit.
    """
    import numpy as np

    if isinstance(loop.limit, str):
        return None
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
    return Unmet(series.ticks[nearest] / data.hz, loop.line, text)


def round_value(value: float) -> str:
    """Return a value as text, with at most two decimals."""
    return f"{round(value, 2):g}"


def name_goal(loop: LoopEnd, limit: str) -> str:
    """Return in words for which values a comparison is true, such as `less than 20 %`.

    Args:
        loop: The comparison.
        limit: Its limit, with the unit.
    """
    return _WORDS[loop.operator].format(limit)
