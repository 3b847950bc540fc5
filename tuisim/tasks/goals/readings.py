"""Conditions on what the sensors see, and on what the program reads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import counted
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, ColorSensorSpec
from tuisim.engine.runs.readings import MODES_BY_KIND
from tuisim.tasks.goals.condition import UnjudgedError
from tuisim.tasks.goals.evidence import (
    Evidence,
    EvidencePoint,
    EvidenceSpan,
    Finding,
    find_motion_line,
    find_ticks,
    share_words,
)
from tuisim.tasks.goals.spec import FollowCondition, Range, ReadCondition, Reading, select_place

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

NOUNS: Mapping[Reading, str] = {
    Reading.COLOR: "colour sensor",
    Reading.ULTRASONIC: "ultrasonic sensor",
    Reading.GYRO: "gyro",
    Reading.MOTOR: "motors",
}
_MODES: Mapping[Reading, tuple[str, ...]] = {
    Reading.COLOR: MODES_BY_KIND["color"],
    Reading.ULTRASONIC: MODES_BY_KIND["ultrasonic"],
    Reading.GYRO: MODES_BY_KIND["gyro"],
    # The mode `state` is left out, as it is also read by commands that wait for a motor.
    Reading.MOTOR: ("position", "speed"),
}
_ABOVE = 0.5
_BELOW = 1.0
"""By how much a printed level may be below the reading, as programs round it or cut off decimals."""
_NOISE_SHARE = 0.1
"""The additional tolerance for each percent of the light noise."""


def describe_ranges(place: Mapping[str, Range]) -> str:
    """Return ranges of the robot's position as text, such as `x from 100 to 200 mm and y from 0 to 50 mm`.

    Args:
        place: The ranges in mm by `x_mm` and `y_mm`, from `select_place`.
    """
    return " and ".join(
        f"{key[0]} from {low:g} to {high:g} mm" for key, (low, high) in place.items()
    )


def read_ticks(reading: Reading, evidence: Evidence) -> Array:
    """Return the ticks in which the program read sensors or motors of a kind, in ascending order, shape (n,)."""
    import numpy as np

    name = f"ticks with {reading}"
    if name not in evidence.memo:
        evidence.memo[name] = np.unique(_find_readings(reading, evidence)[0])
    ticks: Array = evidence.memo[name]
    return ticks


def _find_readings(reading: Reading, evidence: Evidence) -> tuple[Array, Array]:
    """Return tick and source line of each time that the program read a sensor or motor of a kind, in ascending order.

    Raises:
        UnjudgedError: the readings are not all recorded.
    """
    name = f"{reading} is read"
    if name not in evidence.memo:
        if evidence.readings.left_out:
            raise UnjudgedError("The program read more often than a run records")
        rows = evidence.readings.find(_MODES[reading])
        ticks = find_ticks(rows, evidence.spec.profile.tick_hz)
        count = int(ticks.searchsorted(len(evidence.records)))
        evidence.memo[name] = ticks[:count], rows["line"][:count]
    readings: tuple[Array, Array] = evidence.memo[name]
    return readings


def filter_ticks(ticks: Array, place: Mapping[str, Range], evidence: Evidence) -> Array:
    """Return only those ticks at which the robot was in a place.

    Args:
        ticks: The ticks, shape (n,).
        place: The ranges in mm of `x_mm` and `y_mm`, from `select_place`.
        evidence: The recording.
    """
    for key, (low, high) in place.items():
        values = evidence.records[key][ticks]
        ticks = ticks[(values >= low) & (values <= high)]
    return ticks


def describe_place(tick: int, place: Mapping[str, Range], evidence: Evidence) -> str:
    """Return where the robot was at a tick, such as `x_mm = 120 mm`, for the axes that a condition limits."""
    position = dict(zip(("x_mm", "y_mm"), evidence.place_mm(tick), strict=True))
    return " and ".join(f"{key[0]} = {position[key]:.0f} mm" for key in place)


def is_as_read(value: float, ticks: Array, evidence: Evidence) -> bool:
    """Return whether a level of light equals what a colour sensor measured in at least one of the given ticks.

    Args:
        value: The level: percent of red, percent of all channels together, or red from 0 to 255.
        ticks: Ticks in which the program read a colour sensor, from `read_ticks`.
        evidence: The recording.
    """
    import numpy as np

    every = read_ticks(Reading.COLOR, evidence)
    if "light as read" not in evidence.memo:
        evidence.memo["light as read"] = _compute_light(evidence.records[every], evidence)
    scatter = _NOISE_SHARE * evidence.spec.world.noise.light
    missing = evidence.memo["light as read"][:, np.isin(every, ticks)] - value
    return bool(((missing >= -_ABOVE - scatter) & (missing <= _BELOW + scatter)).any())


def _compute_light(records: Array, evidence: Evidence) -> Array:
    """Return three levels of light for each colour sensor, without noise, shape (levels, ticks).

    They are the percentage of red, the percentage of all channels together, and red from 0 to 255.
    """
    import numpy as np

    from tuisim.engine.runs.sensor_arrays import measure_quiet_color

    rows = []
    for sensor in evidence.spec.robot.color_sensors:
        channels = measure_quiet_color(records, sensor, evidence.spec, evidence.mat)
        red, green, blue = (channel.astype("i8") for channel in channels.values())
        rows += [red / 255 * 100, (red + green + blue) / 765 * 100, red]
    return np.array(rows).reshape(len(rows), len(records))


def find_read(condition: ReadCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the program had taken as many readings as a condition needs.

    If there are too few readings, the finding has no moment, and says how many are needed.
    """
    noun = NOUNS[condition.reading]
    every, lines = _find_readings(condition.reading, evidence)
    ticks = every[(every >= span.first_tick) & (every < span.end_tick)]
    ticks = filter_ticks(ticks, place := select_place(condition), evidence)
    if len(ticks) >= condition.times:
        tick = int(ticks[condition.times - 1])
        return Finding(EvidencePoint(tick), line=int(lines[every.searchsorted(tick)]))
    if not len(every):
        return Finding(None, f"The program did not read the {noun}.")
    where = f" at {describe_ranges(place)}" if place else ""
    when = " in that time" if span.first_tick else ""
    times = counted(len(ticks), "time")
    text = f"The program read the {noun} {times}{where}{when}; {condition.times:,} are needed."
    return Finding(None, text, int(lines[0]))


def find_off_line(condition: FollowCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding at the end of a span if the robot was on a line for too small a share of the time.

    The result is `Finding()` if the share is large enough so far.
    """
    import numpy as np

    named = {sensor.name: sensor for sensor in evidence.spec.robot.color_sensors}
    unknown = [name for name in condition.sensors if name not in named]
    if unknown:
        known = ", ".join(named) or "none"
        text = f"The robot has no colour sensor {unknown[0]}; it has: {known}."
        return Finding(EvidencePoint(max(0, span.first_tick)), text, 0)
    records = evidence.records[span.ticks]
    if not len(records):
        return Finding()
    if condition.point_mm is not None:
        on_line = _is_line(
            condition, _compute_light_percent(records, *condition.point_mm, evidence)
        )
    else:
        on_line = np.zeros(len(records), np.bool_)
        for name in condition.sensors:
            on_line |= _is_line(
                condition, _compute_reflected_percent(records, named[name], evidence)
            )
    share = float(on_line.mean())
    if share >= condition.share:
        return Finding()
    gap = _find_longest_gap(on_line)
    lost = span.first_tick + gap
    what = f"The sensor {' or '.join(condition.sensors)}" if condition.sensors else "The robot"
    text = (
        f"{what} was on the line for {share_words(share)} of the time, {share_words(condition.share)} are needed; it "
        f"was off for longest from {evidence.time_words(lost)}."
    )
    decided = span.stop or (evidence.last if span.over else None)
    return Finding(decided, text, find_motion_line(records, gap))


def _compute_light_percent(records: Array, x_mm: float, y_mm: float, evidence: Evidence) -> Array:
    """Return the light in percent of the mat's pixel under a point of the robot at every tick, shape (n,).

    Off the mat, the result is the light of the floor.
    """
    import numpy as np

    mat = evidence.mat
    from tuisim.engine.runs.arrays import compute_world_points_mm

    world_x_mm, world_y_mm = compute_world_points_mm(records, x_mm, y_mm)
    col = np.floor(world_x_mm)
    row = np.floor(FIELD_HEIGHT_MM - world_y_mm)
    inside = (col >= 0) & (col < mat.width_px) & (row >= 0) & (row < mat.height_px)
    pixels = np.frombuffer(mat.pixels, np.uint8).reshape(mat.height_px, mat.width_px, 3)
    percent = np.full(len(records), mat.pixel(-1, -1)[0] / 255 * 100)
    percent[inside] = pixels[row[inside].astype("i8"), col[inside].astype("i8"), 0] / 255 * 100
    return percent


def _compute_reflected_percent(
    records: Array, sensor: ColorSensorSpec, evidence: Evidence
) -> Array:
    """Return what a colour sensor's `reflected_light_intensity_pc` would be without noise at every tick, shape (n,)."""
    from tuisim.engine.runs.sensor_arrays import measure_quiet_color

    red, *_ = measure_quiet_color(records, sensor, evidence.spec, evidence.mat).values()
    percent: Array = red.astype("i8") / 255 * 100
    return percent


def _is_line(condition: FollowCondition, percent: Array) -> Array:
    import numpy as np

    on_line = np.ones(len(percent), np.bool_)
    if condition.darker_than is not None:
        on_line &= percent < condition.darker_than
    if condition.brighter_than is not None:
        on_line &= percent > condition.brighter_than
    return on_line


def _find_longest_gap(on_line: Array) -> int:
    """Return the index at which the longest stretch of ticks off the line begins; 0 if there is none.

    Args:
        on_line: Whether the robot is on the line, at each tick, shape (n,).
    """
    import numpy as np

    edges = np.flatnonzero(np.diff(np.concatenate(([True], on_line, [True])).astype("i1")))
    begins = edges[::2]
    ends = edges[1::2]
    return int(begins[np.argmax(ends - begins)]) if len(begins) else 0
