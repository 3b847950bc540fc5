"""Where a robot that steered by a dark line lost it.

A robot follows a line if its program reads a light sensor over and over, the line was under or between its light
sensors for a good part of the way or came back to them several times, and the robot mostly turned otherwise soon after
what a sensor that is read saw had changed. It has lost the line where that was not under or between them for much
longer than ever before. Only the time in which the robot moves counts.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tuisim.base.data_class import dataclass
from tuisim.engine.core.spec import ColorSensorSpec
from tuisim.engine.runs.arrays import find_spans
from tuisim.tasks.reasons.run_data import RunData, compute_turns_deg, is_on_mat

if TYPE_CHECKING:
    Array = NDArray[Any]
    Bools = NDArray[np.bool_]

MIN_READINGS = 3
"""The least number of readings of a sensor by a program that looks for something."""
_MIN_CONTRAST_PC = 40.0
"""If the darkest and the brightest reading differ by less, in %, the sensor has seen no line."""
_DARKER_PC = 5.0
"""A sensor that reads less than the ground by this much, in %, sees at least the edge of a line."""
_GROUND_SHARE = 0.25
"""Of what is brighter than the middle, so much may be darker than the ground: a line's edge, another colour."""
_BLACK_PC = 25.0
"""A line that is darker than this is called black."""
_MIN_DARK_SHARE = 0.25
"""The robot follows a line if it is over it in at least this share of the ticks since it first came to it."""
_MIN_RETURNS = 3
"""The robot follows a line if it comes back to it at least this often."""
_MIN_GAP_S = 1.5
_LONGER = 3.0
"""The least factor between the duration of a loss and the longest time beside the line before it."""
_SOON_S = 0.4
_MIN_AWAY = 10
_MIN_AWAY_SHARE = 0.8
"""With so many readings at an edge, and this share of them at one that it turns away from, it has the wrong sign."""
_ASIDE_MM = 8.0
_MIN_SLOPE_PC = 20.0
"""At an edge, the light differs by so much between `_ASIDE_MM` left and right of the sensor."""
_LAG_S = 0.1
"""The time in which the wheels follow a reading."""
_MIN_CORRELATION = 0.5
_MIN_TURN_DPS = 5.0
"""A robot steers if its rate of turn changes by so much within this time."""


@dataclass(frozen=True, slots=True)
class LostLine:
    """A time in which a robot that followed a line did not see the line."""

    tick: int
    """The last tick at which a sensor saw the line."""
    sensor: str
    """The name of that sensor."""
    is_black: bool
    """Whether the line is black, and not just darker than its ground."""
    seen_again: tuple[str, int] | None
    """The sensor that saw the line again, and the tick; None if none did."""
    wrong_turn: str = ""
    """How the robot turned away from the line, if it steered with the wrong sign; else empty."""


def find_lost_lines(data: RunData) -> Iterator[LostLine]:
    """Yield each time that the robot lost the line, in order."""
    records, hz = data.records, data.hz
    eyes = data.run.spec.robot.color_sensors
    watched = {
        name: ticks for name, ticks in data.light_ticks.items() if len(ticks) >= MIN_READINGS
    }
    if not watched:
        return
    seen = _see_line(data, _find_points(eyes))
    if seen is None:
        return
    read = np.sort(np.concatenate([*watched.values()]))
    way = _Way(records, np.logical_or.reduce(seen.is_dark))
    looks = [dark for eye, dark in zip(eyes, seen.is_middle, strict=False) if eye.name in watched]
    is_steered = any(way.is_steered(look, hz) for look in looks)
    for number in way.find_long_gaps(hz):
        left, end = way.find_gap(number)
        is_looking = np.searchsorted(read, end) - np.searchsorted(read, left) >= MIN_READINGS
        if is_looking and way.was_followed(number):
            # `zip` takes only the sensors, which come first among the points.
            dark = {eye.name: true for eye, true in zip(eyes, seen.is_dark, strict=False)}
            turn = "the robot turned away from the sensor that saw it"
            if not _turns_away(records[: end + 1], eyes, dark, watched):
                turn = _find_wrong_turn(data, left + round(_SOON_S * hz), watched)
            if turn or is_steered:
                loss = _name_loss(dark, seen.is_black, watched, left, hz)
                yield replace(loss, wrong_turn=turn)


def _name_loss(
    dark: Mapping[str, Bools],
    is_black: Bools,
    watched: Collection[str],
    left: int,
    hz: int,
) -> LostLine:
    """Return a loss of the line, with the sensor that saw the line last.

    If several sensors saw it last, one that the program reads is preferred.

    Args:
        dark: For each sensor, by name, whether it saw the line at each tick.
        is_black: Whether black was under or between the sensors, at each tick.
        watched: The names of the sensors that the program reads.
        left: The tick at which the line was last seen.
        hz: Ticks per second.
    """
    seen = {name: _find_last(true[: left + 1]) for name, true in dark.items()}
    recent = [name for name in watched if seen[name] >= left - _MIN_GAP_S * hz]
    sensor = max(recent or seen, key=lambda name: seen[name])
    rests = {name: true[left + 1 :] for name, true in dark.items()}
    again = [(left + 1 + int(rest.argmax()), name) for name, rest in rests.items() if rest.any()]
    tick, name = min(again, default=(0, ""))
    last = max(0, seen[sensor])
    has_black = is_black[max(0, last - round(_MIN_GAP_S * hz)) : last + 1].any()
    return LostLine(last, sensor, bool(has_black), (name, tick) if name else None)


def _find_wrong_turn(data: RunData, end: int, watched: Mapping[str, Array]) -> str:
    """Return in words how a robot with the wrong sign in its steering turned away from the line; empty if it did not.

    Such a robot turns to the brighter side when a sensor gets brighter.

    Args:
        data: The run.
        end: The tick of the loss of the line.
        watched: The ticks at which the program read each sensor, by its name.
    """
    for eye in data.run.spec.robot.color_sensors:
        ticks = watched.get(eye.name, ())
        if side := _find_wrong_side(data, end, eye, np.asarray(ticks, np.int64)):
            return f"as it got brighter, the robot turned {side}, away from the line"
    return ""


def _find_wrong_side(data: RunData, end: int, eye: ColorSensorSpec, ticks: Array) -> str:
    """Return the side to which a robot turned when a sensor got brighter, if this was away from the line; else empty.

    Only the time before the line was lost counts: after that, the robot may reach the other edge of the line, at which
    it must turn to the other side.

    Args:
        data: The run.
        end: The tick of the loss of the line.
        eye: The sensor.
        ticks: The ticks at which the program read the sensor.
    """
    records = data.records[:end]
    lag = round(_LAG_S * data.hz)
    ticks = ticks[ticks < len(records) - lag - 1]
    turned_deg = compute_turns_deg(records)[ticks + lag]
    light, left, right = (
        _measure_percent(data, replace(eye, x_mm=eye.x_mm + aside_mm), records[ticks])
        for aside_mm in (0, -_ASIDE_MM, _ASIDE_MM)
    )
    is_edge = np.abs(left - right) > _MIN_SLOPE_PC
    if is_edge.sum() < _MIN_AWAY:
        return ""
    covariance = np.mean((light - light.mean()) * (turned_deg - turned_deg.mean()))
    if abs(covariance) < _MIN_CORRELATION * light.std() * turned_deg.std():
        return ""
    # A positive turn is one to the left.
    brighter = np.sign(left - right)[is_edge]
    is_away = brighter * covariance > 0
    away_dps = np.mean(brighter * turned_deg[is_edge]) * data.hz
    is_wrong = is_away.mean() >= _MIN_AWAY_SHARE and away_dps >= _MIN_TURN_DPS
    return ("left" if covariance > 0 else "right") if is_wrong else ""


def _turns_away(
    records: Array,
    eyes: Sequence[ColorSensorSpec],
    dark: Mapping[str, Bools],
    watched: Collection[str],
) -> bool:
    """Return whether a robot with two light sensors mostly turned away from the line while one of them saw it.

    Args:
        records: Telemetry up to the loss of the line.
        eyes: The light sensors.
        dark: For each light sensor, by name, whether it saw the line at each tick.
        watched: The names of the light sensors that the program reads.
    """
    pair = sorted((eye for eye in eyes if eye.name in watched), key=lambda eye: eye.x_mm)
    if len(pair) != 2 or not pair[0].x_mm < 0 < pair[1].x_mm:
        return False
    on_left, on_right = (dark[eye.name][: len(records) - 1] for eye in pair)
    # A positive turn is one to the left.
    towards_deg = compute_turns_deg(records) * (on_left.astype(int) - on_right)
    towards_deg = towards_deg[towards_deg != 0]
    is_away = towards_deg < 0
    return len(is_away) >= _MIN_AWAY and bool(is_away.mean() >= _MIN_AWAY_SHARE)


def _measure_percent(data: RunData, sensor: ColorSensorSpec, records: Array) -> Array:
    """Return what a light sensor reads of the mat without noise, in percent, shape (n,)."""
    percent: Array = data.measure_channels(sensor, records)[0] / 2.55
    return percent


@dataclass(frozen=True, slots=True)
class _Seen:
    """The ticks at which the line was under each of several sensors, real or imagined."""

    is_dark: list[Bools]
    """Whether at least its edge was under each, at each tick."""
    is_middle: list[Bools]
    """Whether each read less than half of the way from the line to its ground."""
    is_black: Bools
    """Whether black was under any of them, at each tick."""


def _find_points(eyes: Sequence[ColorSensorSpec]) -> list[ColorSensorSpec]:
    """Return the light sensors, and imagined sensors in the gaps between them.

    The imagined sensors are so close together that a line cannot pass between two of them unseen.
    """
    points = [*eyes]
    for eye, other in pairwise(eyes):
        apart_mm = np.hypot(other.x_mm - eye.x_mm, other.y_mm - eye.y_mm)
        count = int(apart_mm // (eye.diameter_mm / 2))
        for share in (number / count for number in range(1, count)):
            x_mm = eye.x_mm + share * (other.x_mm - eye.x_mm)
            y_mm = eye.y_mm + share * (other.y_mm - eye.y_mm)
            points.append(replace(eye, x_mm=x_mm, y_mm=y_mm))
    return points


def _see_line(data: RunData, points: Sequence[ColorSensorSpec]) -> _Seen | None:
    """Return at which ticks the line was under each point.

    The result is None if all that the points saw of the mat is about equally bright.
    """
    on = [is_on_mat(data.records, point) for point in points]
    light = [_measure_percent(data, point, data.records) for point in points]
    there = np.concatenate([percent[is_on] for percent, is_on in zip(light, on, strict=True)])
    if not len(there) or np.ptp(there) < _MIN_CONTRAST_PC:
        return None
    middle = (there.min() + there.max()) / 2
    bright = np.sort(there[there > middle])
    # This is `np.quantile`, which imports `numpy.ma`.
    ground = np.interp(_GROUND_SHARE * (len(bright) - 1), np.arange(len(bright)), bright)
    limits = ground - _DARKER_PC, middle, _BLACK_PC
    edges, middles, blacks = (
        [is_on & (percent < limit) for percent, is_on in zip(light, on, strict=True)]
        for limit in limits
    )
    return _Seen(edges, middles, np.logical_or.reduce(blacks))


class _Way:
    """The stretches of a run in which a sensor was over the dark line, and the gaps between.

    Ticks without movement are left out.

    Args:
        records: The telemetry.
        is_dark: Whether a sensor was over the dark line, at each tick.
    """

    def __init__(self, records: NDArray[Any], is_dark: Bools) -> None:
        moved = np.zeros(len(records), np.bool_)
        for name in ("x_mm", "y_mm", "heading_deg"):
            moved[1:] |= np.diff(records[name]) != 0
        self._ticks = np.flatnonzero(moved)
        self._turned_deg = np.append(0.0, compute_turns_deg(records))[moved]
        self._is_dark = is_dark[moved]
        self._starts, self._ends = find_spans(self._is_dark).T
        """Where the stretches over the dark begin and end, the end exclusive."""
        self._next = np.append(self._starts[1:], len(self._ticks))
        self._last_tick = len(records) - 1

    def find_long_gaps(self, hz: int) -> list[int]:
        """Return the indices of the dark stretches followed by a gap so long that the line may have been lost.

        Args:
            hz: Ticks per second.
        """
        gaps = self._next - self._ends
        longest = np.maximum.accumulate(np.append(0, gaps[:-1]))
        long_enough = (gaps >= _MIN_GAP_S * hz) & (gaps > _LONGER * longest)
        return np.flatnonzero(long_enough).tolist() if len(gaps) else []

    def find_gap(self, number: int) -> tuple[int, int]:
        """Return the last tick of a dark stretch, and the first tick of the next one.

        For the last dark stretch, the second result is the run's last tick.

        Args:
            number: Index of the dark stretch.
        """
        index = int(self._next[number])
        end = self._ticks[index] if index < len(self._ticks) else self._last_tick
        return int(self._ticks[self._ends[number] - 1]), int(end)

    def was_followed(self, number: int) -> bool:
        """Return whether the robot followed the line up to a dark stretch: it was mostly over the line or came back."""
        share = self._is_dark[self._starts[0] : self._ends[number]].mean()
        return number >= _MIN_RETURNS or bool(share >= _MIN_DARK_SHARE)

    def is_steered(self, is_dark: Bools, hz: int) -> bool:
        """Return whether the robot steered by a sensor.

        It did if its turning mostly changed soon after the sensor came to the line or left it.

        Args:
            is_dark: Whether the sensor was over the line, at each tick.
            hz: Ticks per second.
        """
        soon = round(_SOON_S * hz)
        turned_deg = self._turned_deg
        changes = np.flatnonzero(np.diff(is_dark[self._ticks])) + 1
        steered = 0
        for change in changes:
            before_deg = turned_deg[max(0, change - soon) : change].mean()
            after_deg = turned_deg[change : change + soon].mean()
            steered += abs(after_deg - before_deg) * hz >= _MIN_TURN_DPS
        return 0 < steered >= len(changes) / 2


def _find_last(true: Bools) -> int:
    """Return the index of the last true value, -1 if there is none."""
    places = np.flatnonzero(true)
    return int(places[-1]) if len(places) else -1
