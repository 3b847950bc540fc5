"""Finds where a wall or an obstacle pushed a turning robot aside, from the recording alone.

A robot that turns on the spot or around one wheel slides along an obstacle that its corner meets: its wheels turn
freely, and it moves further than they explain.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.core.drive import compute_mm_per_degree
from tuisim.engine.core.profile import NS_PER_S, compute_due_ns
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec
from tuisim.engine.runs.standstill import describe_touched
from tuisim.engine.runs.views import TelemetryView

if TYPE_CHECKING:
    from numpy.typing import NDArray

_MIN_TICK_MM = 1e-3
"""Smallest additional motion in a tick that counts as a push."""
_MIN_PUSH_MM = 1.0
"""Smallest push that is reported: nobody sees the effect of a smaller one."""


@dataclass(frozen=True, slots=True)
class Push:
    """A summary of how often and how far walls or obstacles pushed a turning robot aside in a run."""

    at: str
    """What pushed the robot first: `the wall` or `an obstacle`."""
    times: int
    since_s: float
    """Time in s at which the robot was pushed for the first time."""
    until_s: float
    """Time in s at which the last push ended."""
    aside_mm: float
    """How far the robot was pushed in all, in mm."""

    @property
    def words(self) -> str:
        """A sentence for users without its subject, the robot, such as `was pushed 12 mm aside by the wall …`."""
        aside = f"was pushed {self.aside_mm:.0f} mm aside by {self.at} while it turned"
        if self.times > 1:
            return f"{aside}, {counted(self.times, 'time')}, first at {self.since_s:.2f} s"
        return f"{aside}, from {self.since_s:.2f} s to {self.until_s:.2f} s"


def find_push(telemetry: TelemetryView, spec: RunSpec) -> Push | None:
    """Return a summary of how walls or obstacles pushed the turning robot of a run aside; None if that never happened.

    Raises:
        LogError: the recording is damaged.
    """
    if not spec.world.solid or telemetry.count < 2:
        return None
    # Imported on demand: in most worlds nothing is solid.
    import numpy as np

    from tuisim.engine.core.collision import Solids
    from tuisim.engine.runs.arrays import find_spans

    records = telemetry.array()
    solids = Solids(spec.world, spec.robot)
    aside_mm = _measure_aside_mm(records, spec, solids.reach_mm)
    is_pushed = np.zeros(len(records), np.bool_)
    for tick in np.flatnonzero(np.hypot(*aside_mm) > _MIN_TICK_MM):
        is_pushed[tick] = bool(describe_touched(solids, records, int(tick), spec))
    pushes = [
        (start, end, float(np.hypot(*aside_mm[:, start:end].sum(axis=1))))
        for start, end in find_spans(is_pushed).tolist()
    ]
    pushes = [push for push in pushes if push[2] >= _MIN_PUSH_MM]
    if not pushes:
        return None
    start, end, _ = pushes[0]

    def time_s(tick: int) -> float:
        return compute_due_ns(tick, spec.profile.tick_hz) / NS_PER_S

    return Push(
        describe_touched(solids, records, start, spec),
        len(pushes),
        time_s(start - 1),
        time_s(end - 1),
        sum(push[2] for push in pushes),
    )


def _measure_aside_mm(records: NDArray[Any], spec: RunSpec, reach_mm: float) -> NDArray[Any]:
    """Return how far the robot moved in each tick beyond the motion of its wheels, along x and y, shape (2, n).

    It is 0 in ticks in which both wheels rolled in the same direction, or nothing solid was near the robot. It is also
    0 where the robot moved so far that a user must have moved it.
    """
    import numpy as np

    x_mm, y_mm = records["x_mm"], records["y_mm"]
    heading = np.radians(records["heading_deg"])
    left_mm, right_mm = (
        records[name] * mm_per_deg / spec.profile.tick_hz
        for name, mm_per_deg in zip(
            ("left_speed_dps", "right_speed_dps"), compute_mm_per_degree(spec.robot), strict=True
        )
    )
    forward_mm = (left_mm + right_mm) / 2
    middle = heading - np.diff(heading, prepend=heading[:1]) / 2
    aside_mm = np.stack(
        [
            np.diff(x_mm, prepend=x_mm[:1]) - forward_mm * np.cos(middle),
            np.diff(y_mm, prepend=y_mm[:1]) - forward_mm * np.sin(middle),
        ]
    )
    way_mm = (
        np.abs(forward_mm) + np.abs(right_mm - left_mm) * reach_mm / spec.robot.wheel_spacing_mm
    )
    counts = (left_mm * right_mm <= 0) & (np.hypot(*aside_mm) <= 2 * way_mm)
    counts &= _are_near(x_mm, y_mm, spec, reach_mm + 2 * way_mm)
    counts[0] = False
    aside_mm[:, ~counts] = 0
    return aside_mm


def _are_near(
    x_mm: NDArray[Any], y_mm: NDArray[Any], spec: RunSpec, reach_mm: NDArray[Any]
) -> NDArray[Any]:
    """Return for each point whether a wall or an obstacle is closer to it than its value in `reach_mm`.

    Args:
        x_mm, y_mm: The points, each of shape (n,).
        spec: The run, with the walls and obstacles.
        reach_mm: A distance for each point, shape (n,).
    """
    import numpy as np

    is_near = np.zeros(len(x_mm), np.bool_)
    if spec.world.walls:
        is_near |= (x_mm < reach_mm) | (x_mm > FIELD_WIDTH_MM - reach_mm)
        is_near |= (y_mm < reach_mm) | (y_mm > FIELD_HEIGHT_MM - reach_mm)
    for box in spec.world.obstacles:
        is_near |= (
            (x_mm > box.x_mm - reach_mm)
            & (x_mm < box.x_mm + box.width_mm + reach_mm)
            & (y_mm > box.y_mm - reach_mm)
            & (y_mm < box.y_mm + box.height_mm + reach_mm)
        )
    return is_near
