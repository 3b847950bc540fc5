"""Light that a program compares again and again, and that came and went while a long line kept it from looking."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tuisim.engine.core.columns import COLOR_NAMES
from tuisim.engine.core.conditions import COMPARE
from tuisim.engine.core.sensors.color import WHITE, LightRead, find_color_code
from tuisim.programs.facts import ProgramThreshold
from tuisim.programs.moves import WheelTurn
from tuisim.tasks.reasons.lost_line import MIN_READINGS
from tuisim.tasks.reasons.run_data import RunData, compute_turns_deg, is_on_mat, list_distinct
from tuisim.tasks.reasons.unmet import Unmet

if TYPE_CHECKING:
    from tuisim.engine.core.spec import ColorSensorSpec

    Array = NDArray[Any]

_MIN_SHARE = 0.95
"""Wheels that turned by less than this share of what was asked were stopped by something else."""
_ROUND_DEG = 45.0
"""Turns of robots are usually multiples of this angle."""
_NEAR_DEG = 3.0
"""A turn is intended if it differs by at most this much from a multiple of `_ROUND_DEG`."""


def list_mistaken_turns(data: RunData) -> Iterator[Unmet]:
    """Yield the turns on the spot whose angle was probably meant for the robot, but turned the wheels, in order."""
    turns = [_measure_turns(data, turn) for turn in data.facts.list_wheel_turns()]
    yield from sorted((turn for turn in turns if turn), key=lambda turn: turn.time_s)


def _measure_turns(data: RunData, turn: WheelTurn) -> Unmet | None:
    """Return a fault if a call turned the wheels by an angle that was meant for the robot, when it first ran.

    The result is None if the call never ran or did not turn the robot on the spot, or if the robot's angle seems
    intended.
    """
    spans = data.find_stays(turn.first_line, turn.last_line)
    if not spans:
        return None
    first, end = spans[0]
    span = data.records[max(0, first - 1) : end]
    wheels = [span[f"{side}_position_deg"] for side in ("left", "right")]
    left_deg, right_deg = (float(positions[-1] - positions[0]) for positions in wheels)
    wheel_deg = abs(left_deg - right_deg) / 2
    # The numbers of a call may mean speeds or steering, so the wheels' own turns show whether it is on the spot.
    is_on_the_spot = abs(left_deg + right_deg) <= 2 * (1 - _MIN_SHARE) * wheel_deg
    if not is_on_the_spot or wheel_deg < turn.angle_deg * _MIN_SHARE:
        return None
    # The line may have run several times in a row, so the robot's turn is scaled to one call.
    robot_deg = abs(float(compute_turns_deg(span).sum())) / wheel_deg * turn.angle_deg
    off_deg = abs(robot_deg - round(robot_deg / _ROUND_DEG) * _ROUND_DEG)
    if robot_deg < 1 or (robot_deg > _ROUND_DEG / 2 and off_deg <= _NEAR_DEG):
        return None
    needed_deg = turn.angle_deg**2 / robot_deg
    counted = "rotations" if turn.method.endswith("rotations") else "degrees"
    needed = f"{needed_deg / 360:.2f}" if counted == "rotations" else f"{needed_deg:.0f}"
    text = (
        f"this line turned the robot by {robot_deg:.0f}°: {turn.method} counts {counted} of the "
        f"wheels; {needed} turn the robot by {turn.angle_deg:.0f}°"
    )
    return Unmet(first / data.hz, turn.first_line, text)


_MIN_PAUSE_S = 0.1
"""A program that reads again sooner looks often enough."""
_MIN_SEEN_S = 0.03
"""What a sensor sees for less time is the edge of something."""
_WHOLE = frozenset({LightRead.REFLECTED, LightRead.REFLECTION})
"""What programs read as whole numbers, cut off."""


def list_unwatched(data: RunData) -> Iterator[Unmet]:
    """Yield a fault for light that a sensor saw only between two readings, so that the program missed it.

    A reading in between would have changed the result of a comparison. For each comparison, only the first such light
    is yielded. The earliest fault is first.
    """
    thresholds = data.facts.find_thresholds(data.run.spec.robot)
    passes = [
        unwatched
        for sensor in data.run.spec.robot.color_sensors
        if len(ticks := list_distinct(data.light_ticks[sensor.name])) >= MIN_READINGS
        for threshold in thresholds.get(sensor.name, ())
        if not threshold.is_aim
        for unwatched in _list_passes(data, sensor, threshold, ticks)
    ]
    yield from sorted(passes, key=lambda unwatched: unwatched.time_s)


def _list_passes(
    data: RunData, sensor: ColorSensorSpec, threshold: ProgramThreshold, ticks: Array
) -> Iterator[Unmet]:
    """Yield a fault if the result of a comparison changed and changed back between two readings.

    The program then did not see the change. Only the first such time is yielded.

    Args:
        data: The run.
        sensor: The light sensor.
        threshold: The comparison of the sensor's light with a value.
        ticks: The ticks at which the program read the sensor.
    """
    hz, records = data.hz, data.records
    long = np.flatnonzero(np.diff(ticks) >= _MIN_PAUSE_S * hz)
    if not len(long):
        return
    values = _measure(data, sensor, threshold.read)
    holds = COMPARE[threshold.sign](values, threshold.value)
    is_on = is_on_mat(records, sensor)
    for start, end in zip(ticks[long], ticks[long + 1], strict=True):
        between = slice(start + 1, end)
        differs = (holds[between] != holds[start]) & is_on[between]
        if holds[start] == holds[end] and differs.sum() >= _MIN_SEEN_S * hz:
            tick = int(start + 1 + differs.argmax())
            lines, counts = np.unique(records["line"][between], return_counts=True)
            value = values[start + 1 : end][differs][int(differs.sum()) // 2]
            text = (
                f"{data.name_eye(sensor.name)} saw {_name_value(threshold.read, value)} here, but the program read it "
                f"only at {start / hz:.2f} s and {end / hz:.2f} s: line {lines[counts.argmax()]} takes too long"
            )
            yield Unmet(tick / hz, int(records["line"][tick]), text)
            return


def _measure(data: RunData, sensor: ColorSensorSpec, read: LightRead) -> Array:
    """Return what a program would have read from a colour sensor at each tick without noise, shape (n,)."""
    spec = data.run.spec
    red, green, blue = channels = data.measure_channels(sensor, data.records)
    if read.is_color:
        colors, places = np.unique(channels.astype(int), axis=1, return_inverse=True)
        return np.array([find_color_code(*color) for color in colors.T.tolist()])[places]
    light = (red + green + blue) / 3 if read is LightRead.MEAN else red
    value: Array = light * read.find_white(spec.profile.reflected_max) / WHITE
    return np.floor(value) if read in _WHOLE else value


def _name_value(read: LightRead, value: float) -> str:
    return COLOR_NAMES[int(value)].lower() if read.is_color else f"light of {value:.0f}"
