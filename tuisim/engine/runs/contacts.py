"""Finds where something solid stopped the robot or pushed it aside, and whether it left a field without walls.

It is found from the recording alone. A robot stands if a motor runs, no wheel turns, and the robot touches a wall or an
obstacle. A robot that turns on the spot or around one wheel slides along an obstacle that its corner meets: its wheels
turn freely, and it moves further than they explain.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import counted
from tuisim.engine.core.drive import compute_mm_per_degree
from tuisim.engine.core.profile import NS_PER_S, compute_due_ns
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec
from tuisim.engine.core.tick_record import RUNNING_FLAGS
from tuisim.engine.runs.views import TelemetryView

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tuisim.engine.core.collision import PoseTuple, Solids

_MIN_TICK_MM = 1e-3
"""Smallest additional motion in a tick that counts as a push."""
_MIN_PUSH_MM = 1.0
"""Smallest push that is reported: nobody sees the effect of a smaller one."""

_CONTACT_MM = 0.01
"""Distance below which a robot touches something; collisions end within a small part of it."""

_STILL = 1e-3
"""Motion in mm or degrees below which a robot stands: wheels that push again move it by a fraction of that."""

WALL = "the wall"
LEFT_FIELD = "left the field, which has no walls (--walls on)"
_WALLS = 4
"""Number of walls, whose gaps come first in the result of `Solids.measure_gaps_mm`."""

_POSE = ["x_mm", "y_mm", "heading_deg"]


@dataclass(frozen=True, slots=True)
class Standstill:
    """A summary of all times that walls or obstacles stopped the robot in a run."""

    at: str
    """What stopped the robot: `the wall`, `an obstacle`, or both."""
    times: int
    """How often the robot was stopped; until it moves again, this counts as once, whatever its motors do."""
    since_s: float
    """Time in s at which the robot was stopped for the first time."""
    until_s: float | None
    """Time in s at which the robot moved on for the last time; None if it did not move on."""
    pushed_s: float
    """How long the robot's wheels pushed in all, in s."""
    on_floor: bool = False
    """Whether there would be a floor behind the wall, with `--walls off`."""

    @property
    def words(self) -> str:
        """A sentence for users, whose subject is the robot, such as `stood at the wall from 1.50 s to 2.30 s, …`."""
        if self.on_floor and WALL in self.at:
            return f"stood at {self.at} for {self.pushed_s:.1f} s; --walls off takes the walls away"
        pushed = f"its wheels pushed for {self.pushed_s:.1f} s"
        if self.times > 1:
            return f"stood at {self.at} {counted(self.times, 'time')}, first at {self.since_s:.2f} s, {pushed} in all"
        how_long = "on" if self.until_s is None else f"to {self.until_s:.2f} s"
        return f"stood at {self.at} from {self.since_s:.2f} s {how_long}, {pushed}"


@dataclass(frozen=True, slots=True)
class _Stretch:
    """A stretch of ticks in which the wheels pushed the robot against something."""

    start: int
    end: int
    """The tick after the last one of the stretch."""
    at: str


def find_standstill(telemetry: TelemetryView, spec: RunSpec) -> Standstill | None:
    """Return a summary of how walls or obstacles stopped the robot of a run; None if that never happened.

    Raises:
        LogError: the recording is damaged.
    """
    if not spec.world.solid:
        return None
    records = telemetry.array()
    stretches = list(_find_stretches(records, spec))
    if not stretches:
        return None
    moved = [
        _find_next_move(records, stretch_before.end - 1, other.start)
        for stretch_before, other in pairwise(stretches)
    ]
    last = stretches[-1].end - 1
    until = _find_next_move(records, last, len(records) - 1)
    kinds = sorted({stretch.at for stretch in stretches}, reverse=True)

    return Standstill(
        " and ".join(kinds),
        1 + sum(tick is not None for tick in moved),
        # The robot already stood at the end of the tick before the stretch.
        _find_time_s(stretches[0].start - 1, spec),
        None if until is None else _find_time_s(until - 1, spec),
        _find_time_s(sum(stretch.end - stretch.start for stretch in stretches), spec),
        spec.world.floor,
    )


def _find_time_s(tick: int, spec: RunSpec) -> float:
    return compute_due_ns(tick, spec.profile.tick_hz) / NS_PER_S


def touches_solid(pose: PoseTuple, spec: RunSpec) -> bool:
    """Return whether the robot of a run touches a wall or an obstacle at a pose."""
    from tuisim.engine.core.collision import Solids

    gaps = Solids(spec.world, spec.robot).measure_gaps_mm(pose) if spec.world.solid else ()
    return any(gap < _CONTACT_MM for gap in gaps)


def _find_stretches(records: NDArray[Any], spec: RunSpec) -> Iterator[_Stretch]:
    """Yield the stretches of ticks in which the wheels pushed the robot against something until they stalled.

    With noise, the wheels may turn a little during a push. So two stretches are joined if they are close together, and
    the motors ran on between them.
    """
    # Imported on demand: in most worlds nothing is solid.
    import numpy as np

    from tuisim.engine.core.collision import Solids
    from tuisim.engine.core.motion import compute_stall_ticks
    from tuisim.engine.core.motors import STANDSTILL_DEG
    from tuisim.engine.runs.arrays import find_spans

    runs = (records["flags"] & RUNNING_FLAGS) != 0
    # The first record is that of the start, before any motion: it is not a push.
    runs[:1] = False
    pushes = runs.copy()
    for name in ("left_speed_dps", "right_speed_dps"):
        pushes &= np.abs(records[name]) < STANDSTILL_DEG * spec.profile.tick_hz
    solids = Solids(spec.world, spec.robot)
    shortest = compute_stall_ticks(spec.profile.tick_hz)
    now: _Stretch | None = None
    for start, end in find_spans(pushes).tolist():
        if at := describe_touched(solids, records, start, spec):
            goes_on = now is not None and start - now.end < shortest and runs[now.end : start].all()
            if now is not None and not goes_on and now.end - now.start >= shortest:
                yield now
            now = replace(now, end=end) if now is not None and goes_on else _Stretch(start, end, at)
    if now is not None and now.end - now.start >= shortest:
        yield now


def describe_touched(solids: Solids, records: NDArray[Any], tick: int, spec: RunSpec) -> str:
    """Return what the robot touches at a tick, such as `the wall`; empty if it touches nothing.

    Args:
        solids: The walls and obstacles, for this robot.
        records: Telemetry, structured as `TICK_FIELDS`.
        tick: The index of a record.
        spec: The run.
    """
    gaps = solids.measure_gaps_mm(records[_POSE][tick].item())
    number = next((number for number, gap in enumerate(gaps) if gap < _CONTACT_MM), None)
    if number is None:
        return ""
    return WALL if spec.world.walls and number < _WALLS else "an obstacle"


def _find_next_move(records: NDArray[Any], start: int, end: int) -> int | None:
    """Return the first tick after `start`, up to `end`, at which the robot's pose differs from that at `start`.

    Return None if there is no such tick.
    """
    import numpy as np

    moved = np.zeros(max(0, end - start), np.bool_)
    for name in _POSE:
        moved |= np.abs(records[name][start + 1 : end + 1] - records[name][start]) > _STILL
    ticks = np.flatnonzero(moved)
    return start + 1 + int(ticks[0]) if len(ticks) else None


def is_off_field(x_mm: Any, y_mm: Any) -> Any:
    """Return whether a place is off the field; for arrays of coordinates, an array of answers."""
    return (x_mm < 0) | (x_mm > FIELD_WIDTH_MM) | (y_mm < 0) | (y_mm > FIELD_HEIGHT_MM)


def has_left_field(telemetry: TelemetryView, spec: RunSpec) -> bool:
    """Return whether a robot on an open floor has been off the field.

    Raises:
        LogError: the recording is damaged.
    """
    if not spec.world.is_open:
        return False
    records = telemetry.array()
    return bool(is_off_field(records["x_mm"], records["y_mm"]).any())


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
        """A sentence for users, whose subject is the robot, such as `was pushed 12 mm aside by the wall …`."""
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

    return Push(
        describe_touched(solids, records, start, spec),
        len(pushes),
        _find_time_s(start - 1, spec),
        _find_time_s(end - 1, spec),
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
