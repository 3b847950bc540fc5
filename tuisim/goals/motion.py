"""Whether the robot of a recording moved as its wheels can move it.

A program that reaches into the simulation can put the robot somewhere else. It then moves without its wheels: in each
tick, the recorded speeds of the motors limit how far the robot can have come and turned. The limits are so wide that
noise, drift and obstacles that push the robot aside stay within them.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from tuisim.core.drift import MOST_TIMES
from tuisim.core.drive import mm_per_degree
from tuisim.core.motors import top_speed_dps
from tuisim.core.outline import outline_of
from tuisim.core.spec import RunSpec
from tuisim.protocol import SetPose, UserAction

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

_FASTER = 3.0
"""No motor turns so many times as fast as without load, whatever the noise."""
_PUSHES = 8.0
"""Obstacles push the robot aside by at most so many times the way of its fastest point."""
_ROUNDING_MM, _ROUNDING_DEG = 1e-3, 1e-3
"""The recorded speeds are in single precision."""


def impossible_motion(records: Array, spec: RunSpec, actions: Iterable[UserAction]) -> str:
    """Return when the robot moved as no wheels can move it, as a sentence without its end; empty if it never did.

    Args:
        records: The ticks of the run.
        spec: The run.
        actions: Those of the user, who may put the robot anywhere: nothing is found then.
    """
    import numpy as np

    if not len(records) or any(isinstance(action.command, SetPose) for action in actions):
        return ""
    start = spec.world.start
    poses = zip(
        ("x_mm", "y_mm", "heading_deg"), (start.x_mm, start.y_mm, start.heading_deg), strict=True
    )
    x_mm, y_mm, heading_deg = (np.diff(records[name], prepend=at_start) for name, at_start in poses)
    wheels = np.abs(
        np.stack([records[f"{side}_speed_dps"] for side in ("left", "right")]).astype(np.float64)
    )
    way_mm = wheels.sum(axis=0) / spec.profile.tick_hz * max(map(abs, mm_per_degree(spec.robot)))
    if not spec.world.drift.is_none:
        # Of each wheel, by the faster one.
        way_mm = way_mm * 2 * MOST_TIMES
    turn_rad = way_mm / spec.robot.wheel_spacing_mm
    most_mm = way_mm / 2
    if spec.world.solid:
        most_mm = most_mm + _PUSHES * (way_mm / 2 + turn_rad * outline_of(spec.robot).reach_mm)
    # A heading of the browser simulator begins again after a whole turn.
    turned_deg = np.abs((heading_deg + 180) % 360 - 180)
    # What is no number is no motion of a robot, either.
    possible = np.hypot(x_mm, y_mm) <= most_mm + _ROUNDING_MM
    possible &= turned_deg <= np.degrees(turn_rad) + _ROUNDING_DEG
    for speed_dps, motor in zip(wheels, spec.robot.wheel_motors, strict=True):
        possible &= speed_dps <= _FASTER * top_speed_dps(motor.kind, spec.profile)
    # A record with another number is damaged, on the disk of whoever judges it: it is no motion.
    damaged = records["tick"] != np.arange(len(records))
    possible |= damaged
    possible[1:] |= damaged[:-1]
    at = int(np.argmin(possible))
    if possible[at]:
        return ""
    return f"the robot moved as no wheels can move it, at {at / spec.profile.tick_hz:.2f} s"
