"""A program that looked for something on the mat, and saw one colour all the time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.sensors.color import WHITE_CODE, find_color_code, find_response
from tuisim.programs.facts import LoopEnd
from tuisim.tasks.reasons.run_data import RunData, is_on_mat

if TYPE_CHECKING:
    from tuisim.engine.core.spec import ColorSensorSpec, RunSpec

    Array = NDArray[Any]

_MIN_READINGS = 20
"""A program that reads less often while the robot drives does not look for anything."""
_MIN_WAY_MM = 200.0
"""The least distance that the robot must drive: before, it may not have come to another colour."""
_SAME_LIGHT = 25
"""A sensor sees the same colour as long as each channel, from 0 to 255, changes by less than this."""
_MIN_WHITE_SHARE = 0.9
"""Darker than this share of white, light without a hue is grey."""


@dataclass(frozen=True, slots=True)
class OneColor:
    """The only colour that light sensors saw in a run, with the sensor that the program read first."""

    tick: int
    """When the program read the first of these sensors."""
    sensor: str
    """The name of that sensor."""
    color: str
    left_tick: int | None = None
    """When the program first read it off the mat for good; None if it stayed on it."""


def find_one_color(data: RunData) -> OneColor | None:
    """Return the colour that a light sensor saw all the time while the robot drove far; None if there is none.

    Only sensors that the program reads are considered. The result is also None if one of them saw several colours, or
    if the program read too seldom.
    """
    records, spec = data.records, data.run.spec
    step_mm = np.hypot(np.diff(records["x_mm"], prepend=0), np.diff(records["y_mm"], prepend=0))
    step_mm[0] = 0
    first: OneColor | None = None
    for sensor in spec.robot.color_sensors:
        all_ticks = data.light_ticks[sensor.name]
        ticks = all_ticks[is_on_mat(records, sensor)[all_ticks]]
        if not len(ticks):
            continue
        later = all_ticks[all_ticks > ticks[-1]]
        way_mm = step_mm[ticks[0] : ticks[-1] + 1]
        name = name_only_color(data.measure_channels(sensor, records[ticks]), sensor, spec)
        if not name:
            return None
        drives = (step_mm[ticks] > 0).sum() >= _MIN_READINGS and way_mm.sum() >= _MIN_WAY_MM
        if drives and (first is None or ticks[0] < first.tick):
            left_tick = int(later[0]) if len(later) else None
            first = OneColor(int(ticks[0]), sensor.name, name, left_tick)
    return first


def name_only_color(
    channels: Array, sensor: ColorSensorSpec, spec: RunSpec, *, has_grey: bool = True
) -> str:
    """Return the name of the only colour that a light sensor saw; empty if it saw several.

    Args:
        channels: Red, green and blue without noise, shape (3, n).
        sensor: The sensor.
        spec: The run.
        has_grey: Whether grey has its own name; a sensor that reads names of colours calls it white.
    """
    if np.ptp(channels, axis=1).max() > _SAME_LIGHT:
        return ""
    red, green, blue = (int(level) for level in channels.mean(axis=1))
    code = find_color_code(red, green, blue)
    white = sum(find_response(sensor, spec.profile))
    is_grey = code == WHITE_CODE and channels.min() < _MIN_WHITE_SHARE * white
    return "grey" if has_grey and is_grey else COLOR_NAMES[code].lower()


def describe_colors(loop: LoopEnd, device: str, codes: Array, has_codes: bool) -> str:
    """Return as text which colour a loop waited for and which it read instead; empty if it read the right colour.

    Args:
        loop: The loop.
        device: The sensor that was read, in words.
        codes: Codes of the colours that it read, shape (n,).
        has_codes: Whether `color` is a number in the program's library.
    """
    seen = name_seen(loop, codes, has_codes)
    color = name_limit(loop)
    if loop.operator != "==" or color in {"", *seen}:
        return ""
    text = f"{device} to see {color}: it saw only {', '.join(seen)}"
    if loop.attribute != "color" or not loop.color or not _is_text(loop):
        return text
    if not has_codes:
        return f"{text}; a text equals no colour, Color.{loop.color.upper()} does"
    code = [name.lower() for name in COLOR_NAMES].index(loop.color)
    return f"{text}; color is a number ({code} for {color}), color_name is the word"


def _is_text(loop: LoopEnd) -> bool:
    """Return whether a loop compares with a text such as `"Red"`, not with a constant such as `COLOR_RED`."""
    return isinstance(loop.limit, str) and not loop.limit.isupper()


def name_seen(loop: LoopEnd, codes: Array, has_codes: bool) -> list[str]:
    """Return the names of colours, sorted: in words or, if the loop compares with a text, as the program reads them.

    Args:
        loop: The loop.
        codes: Codes of the colours, shape (n,).
        has_codes: Whether `color` is a number in the program's library.
    """
    names = {COLOR_NAMES[int(code)]: f"{code:g}" for code in codes}
    if not _is_text(loop):
        return sorted("no colour" if name == COLOR_NAMES[0] else name.lower() for name in names)
    if loop.attribute != "color":
        return sorted(map(repr, names))
    if has_codes:
        return sorted(names.values())
    return sorted(
        "Color.NONE" if name == COLOR_NAMES[0] else f"Color.{name.upper()}" for name in names
    )


def name_limit(loop: LoopEnd) -> str:
    """Return the colour that a loop compares with, in words; a text such as `"Red"` in quotes, as in the program."""
    return repr(loop.limit) if _is_text(loop) else loop.color
