"""Intentions that a program tells in its comments, prints and names, where its run did something else."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.programs.facts import LoopEnd
from tuisim.tasks.reasons.read_columns import LIGHT_COLUMNS
from tuisim.tasks.reasons.run_data import RunData
from tuisim.tasks.reasons.unmet import Unmet, name_goal, round_value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Array = NDArray[Any]

_LIMITS = {"black": (15.0, "<"), "white": (85.0, ">")}
"""The light in % up to which, or from which, something has a colour."""
_AHEAD_MM = 1500
_STEP_MM = 4
_RIM_MM = 60
"""A sensor of a robot so near to the edge may be off the mat."""
_MIN_AHEAD_MM = 60
"""A band that begins nearer than this ahead of the robot is the one whose edge ended the loop."""
_MIN_ON_DEG = 90.0
_MIN_SPIN_DEG = 60.0
_MIN_TURN_DEG = 30.0
_MAX_SPOT_MM = 20.0
"""A robot that turns by so much, and gets no farther, turns on the spot."""


def list_wrong_bands(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each loop that was ended by another band than the one that the program's text names.

    For example, a comment says that the loop waits for black, but a grey band ended it.
    """
    loops = data.facts.loop_ends
    ends = [line for loop in loops for line in (loop.first_line, loop.last_line)]
    for loop in loops:
        color = data.facts.remarks.find_color(loop.first_line, loop.last_line, ends)
        if not color or loop.start_line or isinstance(loop.limit, str):
            continue
        series = data.measure(loop)
        is_other = loop.operator[0] != _LIMITS[color][1]
        if is_other or series is None or series.column not in LIGHT_COLUMNS:
            continue
        is_met = COMPARE[loop.operator](series.values, loop.limit)
        if not is_met[-1] or is_met[:-1].any():
            continue
        tick = int(series.ticks[-1])
        light = _measure_light(data, loop, data.records[tick : tick + 1])
        ahead = _measure_light(data, loop, _extend_way(data.records[tick]))
        limit, sign = _LIMITS[color]
        comes = COMPARE[sign](ahead, limit)
        index = int(comes.argmax()) if comes.any() else 0
        if len(light) and not COMPARE[sign](light[0], limit) and index * _STEP_MM >= _MIN_AHEAD_MM:
            nearest = ahead[index : index + 25]
            value = nearest.min() if sign == "<" else nearest.max()
            goal = name_goal(loop, f"{loop.limit:g}{series.unit}")
            text = (
                f"light of {round_value(light[0])} % ended this loop, since it is {goal}, but it is not {color}: "
                f"that reads {value:.0f} % and comes {(index + 1) * _STEP_MM} mm further on"
            )
            yield Unmet(tick / data.hz, loop.line, text)


def _measure_light(data: RunData, loop: LoopEnd, records: Array) -> Array:
    """Return the light in % that the sensor of a loop sees, one value for each record with the robot inside the mat.

    Inside means at least `_RIM_MM` mm from its edges. The result is empty if the light is not known.
    """
    is_on = (records["x_mm"] > _RIM_MM) & (records["x_mm"] < FIELD_WIDTH_MM - _RIM_MM)
    is_on &= (records["y_mm"] > _RIM_MM) & (records["y_mm"] < FIELD_HEIGHT_MM - _RIM_MM)
    percent = replace(loop, attribute="reflected_light_intensity_pc")
    series = data.measure_records(percent, records[is_on], np.arange(int(is_on.sum())))
    return np.empty(0) if series is None else series.values


def _extend_way(record: Array) -> Array:
    """Return records of a robot that drives straight on from its pose in `record`, one every `_STEP_MM` mm."""
    way_mm = np.arange(_STEP_MM, _AHEAD_MM, _STEP_MM)
    records = np.repeat(record[None], len(way_mm))
    heading = np.deg2rad(record["heading_deg"])
    records["x_mm"] += way_mm * np.cos(heading)
    records["y_mm"] += way_mm * np.sin(heading)
    return records


def list_spins(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each turn on the spot at a place where the program says that it drives straight on."""
    for spin in data.facts.remarks.list_spins():
        # The line after those that start motors is the one that waits.
        for start, end in data.find_stays(spin.first_line, spin.last_line + 1):
            way = data.records[start:end]
            turned_deg = float(np.ptp(way["heading_deg"]))
            spot_mm = max(np.ptp(way["x_mm"]), np.ptp(way["y_mm"]))
            if turned_deg >= _MIN_SPIN_DEG and spot_mm <= _MAX_SPOT_MM:
                text = (
                    f"the robot turned on the spot here, by {turned_deg:.0f}°: {spin.words} turn its wheels "
                    "against each other; equal signs drive it straight on"
                )
                yield Unmet(start / data.hz, spin.first_line, text)


def list_curves(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each move in a curve at a place where a comment says that the robot drives straight on."""
    for curve in data.facts.remarks.list_curves():
        for start, end in data.find_stays(curve.first_line, curve.last_line + 1):
            turned_deg = float(np.ptp(data.records["heading_deg"][start:end]))
            if turned_deg >= _MIN_TURN_DEG:
                text = f"the robot turned by {turned_deg:.0f}° here: {curve.words}"
                yield Unmet(start / data.hz, curve.first_line, text)


def list_wrong_sides(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for each part of the program that turns the robot to the wrong side whenever it runs.

    It is the wrong side if the name of the function, or a comment, says left for a turn to the right, or the reverse.
    """
    for turn in data.facts.remarks.list_named_turns():
        spans = data.find_stays(turn.first_line, turn.last_line)
        ways = [_measure_turn(data.records[start:end]) for start, end in spans]
        # A positive turn is one to the left.
        wrong_deg = [deg if turn.aim == "right" else -deg for deg in ways]
        if wrong_deg and min(wrong_deg) >= _MIN_TURN_DEG:
            other = "left" if turn.aim == "right" else "right"
            text = (
                f"{turn.words} says {turn.aim}, but the robot turned {other} here, "
                f"by {wrong_deg[0]:.0f}°: swap the signs"
            )
            yield Unmet(spans[0][0] / data.hz, turn.first_line, text)


def _measure_turn(way: Array) -> float:
    """Return by how many degrees the robot turned to the left on a way; 0 if it drove backwards."""
    first, last = way[0], way[-1]
    middle = np.deg2rad(first["heading_deg"] + last["heading_deg"]) / 2
    ahead_mm = (last["x_mm"] - first["x_mm"]) * np.cos(middle)
    ahead_mm += (last["y_mm"] - first["y_mm"]) * np.sin(middle)
    return float(last["heading_deg"] - first["heading_deg"]) if ahead_mm >= -_MAX_SPOT_MM else 0.0


def list_wrong_units(data: RunData) -> Iterator[Unmet]:
    """Yield each call that ran and whose numbers were probably meant in another unit or order."""
    lines = data.records["line"]
    for wrong in data.facts.remarks.list_wrong_units():
        ticks = np.flatnonzero(lines == wrong.line)
        is_stuck = not data.is_finished and lines[-1] == wrong.line
        if len(ticks) and (not wrong.is_endless or (is_stuck and _has_moved(data.records[ticks]))):
            yield Unmet(float(ticks[0] / data.hz), wrong.line, wrong.text)


def _has_moved(records: Array) -> bool:
    """Return whether a wheel turned in some records of telemetry, farther than a wheel that is coming to rest."""
    return any(
        np.ptp(records[name]) > _MIN_ON_DEG for name in ("left_position_deg", "right_position_deg")
    )
