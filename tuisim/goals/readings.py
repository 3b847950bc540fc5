"""Conditions on what the sensors see."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tuisim.core.sensors.color import columns
from tuisim.core.spec import ColorSensorSpec
from tuisim.goals.evidence import Evidence, Moment, Span
from tuisim.goals.found import Found, share_words
from tuisim.goals.spec import Follow
from tuisim.runs.frames import quiet_color_columns

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]


def find_off_line(condition: Follow, evidence: Evidence, span: Span) -> Found:
    """Find out at the end of a span whether a sensor was on a line for too small a share of the time."""
    import numpy as np

    named = {sensor.name: sensor for sensor in evidence.spec.robot.color_sensors}
    unknown = [name for name in condition.sensors if name not in named]
    if unknown:
        known = ", ".join(named) or "none"
        return Found(Moment(max(0, span.first_tick)), f"The robot has no colour sensor {unknown[0]}; it has: {known}.")
    records = evidence.records[span.ticks]
    if not len(records):
        return Found()
    on_line = np.zeros(len(records), np.bool_)
    for name in condition.sensors:
        on_line |= _on_line(condition, _reflected_percent(records, named[name], evidence))
    share = float(on_line.mean())
    sensors = " or ".join(condition.sensors)
    text = (
        f"The sensor {sensors} was on the line for {share_words(share)} of the time, "
        f"{share_words(condition.share)} are needed"
    )
    if share >= condition.share:
        return Found()
    lost = span.first_tick + _longest_gap(on_line)
    text = f"{text}; it was off for longest from {evidence.time_words(lost)}."
    decided = span.stop or (evidence.last if span.over else None)
    return Found(decided, text, evidence.line(Moment(lost)))


def _reflected_percent(records: Array, sensor: ColorSensorSpec, evidence: Evidence) -> Array:
    """Return what `reflected_light_intensity_pc` would be without noise, at every tick."""
    red = quiet_color_columns(records, sensor, evidence.mat)[columns(sensor)[0]]
    percent: Array = red.astype("i8") / 255 * 100
    return percent


def _on_line(condition: Follow, percent: Array) -> Array:
    import numpy as np

    on_line = np.ones(len(percent), np.bool_)
    if condition.darker_than is not None:
        on_line &= percent < condition.darker_than
    if condition.brighter_than is not None:
        on_line &= percent > condition.brighter_than
    return on_line


def _longest_gap(on_line: Array) -> int:
    """Return the index at which the longest time off the line begins."""
    import numpy as np

    edges = np.flatnonzero(np.diff(np.concatenate(([True], on_line, [True])).astype("i1")))
    begins, ends = edges[::2], edges[1::2]
    return int(begins[np.argmax(ends - begins)]) if len(begins) else 0
