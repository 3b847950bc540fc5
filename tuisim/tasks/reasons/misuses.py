"""Readings that a program takes once and uses again and again, tests that it makes only once, and lost values."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.conditions import COMPARE
from tuisim.programs.facts import LoopEnd
from tuisim.programs.uses import LoneStop
from tuisim.tasks.reasons.run_data import RunData, Series, list_distinct
from tuisim.tasks.reasons.unmet import Unmet, name_goal, round_value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_MAX_READINGS = 64
"""A line that reads more often does not read once."""
_MIN_STALE_S = 0.5
"""A loop that uses an old reading for less time may do so on purpose."""
_OTHER_SHARE = 0.3
"""Moves that depend on a reading are wrong if the reading changes by this share."""
_MIN_OTHER = 10.0
"""The reading must also change by at least this much, in its own unit."""
_APART_S = 1.0
"""A line that reads more often is in a loop that asks again."""
_SOON_S = 0.3
"""A program that reads again within this time, in s, repeats its test."""
_MIN_WAY_MM = 20.0
_MIN_TURN_DEG = 10.0
"""A missing stop does no harm if the robot moves by less than this."""


# The following functions find readings that were taken once and used many times.


def list_stale_reads(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each reading that the program took before a loop and still used in it when it was out of date.

    For example, `light = sensor.reflected_light_intensity` stands before `while light > 20`, not in the loop.
    """
    known = {end.line for end in data.facts.loop_ends if end.set_line}
    for use in data.facts.list_stale_reads():
        if use.line in known and _was_in_vain(data, use):
            continue
        for tick in data.find_read_ticks(use.read_line)[:_MAX_READINGS].tolist():
            if misuse := _compare_stale(data, use, tick):
                yield misuse


def _was_in_vain(data: RunData, use: LoopEnd) -> bool:
    """Return whether the run was ended from outside, for example by a limit, in the loop that uses an old reading.

    The reason why the run went wrong is then that the program waited in vain, and other functions report this.
    """
    line = data.records["line"][-1]
    return use.first_line <= line <= use.last_line and not data.is_finished


def _compare_stale(data: RunData, use: LoopEnd, read_tick: int) -> Unmet | None:
    """Return a fault at the first use of an old reading that differs from what the sensor or motor would read by then.

    The result is None if there is no such use. If it is not known what would be read, there is a fault only if the run
    ended in the loop.

    Args:
        data: The run.
        use: The loop that uses the reading, or a comparison or move in it.
        read_tick: The tick of the reading.
    """
    lines = data.records["line"]
    until = _find_next_reading(data, use.read_line, read_tick)
    is_inside = (lines >= use.first_line) & (lines <= use.last_line)
    ticks = np.flatnonzero(is_inside[read_tick + 1 : until]) + read_tick + 1
    if len(ticks) < _MIN_STALE_S * data.hz:
        return None
    when = f"at {read_tick / data.hz:.2f} s"
    inside = f"before the loop in line {use.first_line}: read it inside the loop"
    old = data.measure_ticks(use, np.array([read_tick]))
    seen = data.measure_ticks(use, ticks)
    if old is None or seen is None:
        is_stuck = use.line == use.first_line and until == len(data.records) == ticks[-1] + 1
        text = f"{use.name} never changes: line {use.read_line} read it only once, {when}, {inside}"
        return Unmet(float(ticks[0] / data.hz), use.line, text) if is_stuck else None
    first = float(old.values[0])
    if use.operator:
        differs = _compare(use, seen) != _compare(use, old)
    else:
        differs = abs(seen.values - first) >= max(_MIN_OTHER, _OTHER_SHARE * abs(first))
    if not differs.any():
        return None
    index = int(differs.argmax())
    text = (
        f"{seen.device} saw {_name(seen, seen.values[index])} here, but line {use.read_line} read it only "
        f"once, {when} ({_name(old, first)}), {inside}"
    )
    return Unmet(float(ticks[index] / data.hz), use.line, text)


def _compare(use: LoopEnd, series: Series) -> Array:
    """Return for each value whether a comparison is true, shape (n,).

    A comparison of a colour with a text of the wrong form is never true.

    Args:
        use: The comparison, with its constant.
        series: The values to compare with the constant.
    """
    if not isinstance(use.limit, str):
        return np.asarray(COMPARE[use.operator](series.values, use.limit))
    if series.column != "color" or (use.attribute == "color") is not use.limit.isupper():
        return np.zeros(len(series.values), bool)
    names = np.array([COLOR_NAMES[int(code)].lower() for code in series.values])
    return np.asarray(COMPARE[use.operator](names, use.color))


def _find_next_reading(data: RunData, line: int, tick: int) -> int:
    """Return the tick of the next reading, after `tick`, of the sensor or motor that a line of the program reads.

    If there is no further reading, the result is the number of ticks in the recording.
    """
    ports = list_distinct(data.readings["port"][data.readings["line"] == line])
    ticks = data.reading_ticks[np.isin(data.readings["port"], ports)]
    later = ticks[ticks > tick]
    return int(later[0]) if len(later) else len(data.records)


def _name(series: Series, value: float) -> str:
    if series.column == "color":
        return COLOR_NAMES[int(value)].lower()
    return f"{round_value(value)}{series.unit}"


# The following functions find each `if` where a loop was meant.


def list_lone_stops(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each stop of the motors that never came because the program tested its condition only once.

    The `if` with the stop is in no `while` loop, and its condition was still false when it was tested.
    """
    for stop in data.facts.list_lone_stops():
        read_ticks = data.find_read_ticks(stop.read_line)[:_MAX_READINGS]
        if np.diff(read_ticks).min(initial=data.hz) < _APART_S * data.hz:
            continue
        for tick in read_ticks.tolist():
            if _is_unstopped(data, stop, tick):
                yield Unmet(tick / data.hz, stop.line, _describe_lone(data, stop, tick))


def _is_unstopped(data: RunData, stop: LoneStop, tick: int) -> bool:
    """Return whether the robot drove on after a reading, because the condition for its stop was not met then.

    The result is False if the program soon took another reading, or stopped the motors.

    Args:
        data: The run.
        stop: The `if` with the stop, and the line of its reading.
        tick: The tick of the reading.
    """
    soon = min(tick + round(_SOON_S * data.hz), len(data.records) - 1)
    next_tick = _find_next_reading(data, stop.read_line, tick)
    later = data.stop_ticks[data.stop_ticks >= tick]
    if next_tick <= soon or (len(later) and later[0] <= tick + 1):
        return False
    if not stop.is_direct and len(later):
        return False
    end = min([int(tick) for tick in later[:1]] + [next_tick])
    way = data.records[tick:end]
    moved_mm = np.hypot(*(np.ptp(way[name]) for name in ("x_mm", "y_mm")))
    is_met = stop.test is not None and _is_met(data, stop.test, tick)
    has_moved = moved_mm >= _MIN_WAY_MM or np.ptp(way["heading_deg"]) >= _MIN_TURN_DEG
    # The summary of a finished run names motors that would turn on.
    turns_on = data.run.end is not None and bool(data.run.end.summary)
    return (bool(has_moved) or turns_on) and not is_met


def _is_met(data: RunData, test: LoopEnd, tick: int) -> bool:
    seen = data.measure_ticks(test, np.array([tick]))
    if seen is None or isinstance(test.limit, str):
        return False
    return bool(COMPARE[test.operator](seen.values, test.limit).any())


def _describe_lone(data: RunData, stop: LoneStop, tick: int) -> str:
    text = "this line asked only once"
    test = stop.test
    seen = data.measure_ticks(test, np.array([tick])) if test else None
    if test and seen is not None and not isinstance(test.limit, str):
        goal = name_goal(test, f"{test.limit:g}{seen.unit}")
        text += f": {seen.device} read {_name(seen, seen.values[0])}, not {goal}"
    else:
        text += ", and the answer was no"
    return (
        f"{text}; so line {stop.stop_line} did not stop what line {stop.start_line} started: "
        "a while loop asks until it comes"
    )


def list_stopping_loops(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each loop that stopped the motors itself, so that its condition never changed.

    The run was still in the loop at its end.
    """
    lines = data.records["line"]
    for line, text, loop in data.facts.list_stopping_loops():
        is_inside = (lines >= loop.start) & (lines < loop.stop)
        if is_inside[-1] and not data.is_finished:
            yield Unmet(int(is_inside.argmax()) / data.hz, line, text)


# The following functions find assignments to a name that was not meant.


def list_lost_values(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each value that a function assigned to a local name, though a global name was probably meant.

    Functions that did not run are left out.
    """
    for lost in data.facts.list_lost_values():
        tick = _find_tick(data, *lost.lines)
        if tick is None and lost.call_line:
            tick = _find_tick(data, lost.call_line + 1, 1 << 31)
            if tick is None and data.is_finished and lost.is_certain:
                tick = len(data.records) - 1
        if tick is not None:
            text = (
                f"{lost.name} is a name of {lost.function}() alone here, so the {lost.name} of line "
                f"{lost.set_line} stays as it was: global {lost.name} in {lost.function}() changes that"
            )
            yield Unmet(tick / data.hz, lost.line, text)


def _find_tick(data: RunData, first_line: int, last_line: int) -> int | None:
    """Return the first tick at which the program ran one of the lines, or read a sensor or motor there.

    The result is None if the program never came to these lines.
    """
    ticks = []
    for lines, when in (
        (data.records["line"], np.arange(len(data.records))),
        (data.readings["line"], data.reading_ticks),
    ):
        ticks += when[(lines >= first_line) & (lines <= last_line)][:1].tolist()
    return min(ticks, default=None)
