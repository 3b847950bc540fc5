"""Conditions on where the robot is, goes and collides."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tuisim.engine.core.collision import Solids
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import Obstacle, RobotSpec, WorldSpec
from tuisim.tasks.goals.evidence import (
    Evidence,
    EvidencePoint,
    EvidenceSpan,
    Finding,
    find_motion_line,
    format_distance,
)
from tuisim.tasks.goals.spec import (
    AreaCondition,
    BodyPart,
    InsideCondition,
    OutsideCondition,
    PassCondition,
    ReachCondition,
    TouchNothingCondition,
)

if TYPE_CHECKING:
    import numpy as np

    Array = np.ndarray[Any, Any]

CONTACT_MM = 0.01
"""A smaller gap in mm counts as contact: a robot that an obstacle stops is nearer to it than this."""

_WALLS = ("the left wall", "the right wall", "the lower wall", "the upper wall")


def find_reach(condition: ReachCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the robot was at a condition's place and heading, or else on how near it came."""
    import numpy as np

    records = evidence.records[span.ticks]
    first = span.first_tick
    if condition.at_end and span.over and not len(records):
        # If the goal before was met only in the last tick, the span is empty, and the last record shows the end.
        records = evidence.records[-1:]
    if not len(records):
        return Finding(None, "The robot was not simulated at that time.")
    away_mm = _find_away_mm(condition, records)
    turned_deg = _find_turned_deg(condition, records)
    there = (away_mm <= condition.within_mm) & (turned_deg <= condition.within_deg)
    if condition.at_end:
        if span.over and there[-1]:
            return Finding(evidence.last)
        words = _describe_miss(condition, records[-1], away_mm[-1], turned_deg[-1])
        text = f"At the end the robot was {words}." if span.over else f"The robot is {words}."
        return Finding(None, "" if there[-1] else text, find_motion_line(records, len(records) - 1))
    if not there.any():
        nearest = int(np.argmin(away_mm / condition.within_mm + turned_deg / condition.within_deg))
        words = _describe_miss(condition, records[nearest], away_mm[nearest], turned_deg[nearest])
        text = f"At its nearest, at {evidence.time_words(first + nearest)}, the robot was {words}."
        return Finding(None, text, find_motion_line(records, nearest))
    times_s = evidence.times_s[span.ticks]
    came = _find_arrivals(there)
    stayed_s = np.where(there, times_s - times_s[came], -1.0)
    enough = np.flatnonzero(stayed_s >= condition.for_s - 1e-9)
    if len(enough):
        return Finding(EvidencePoint(first + int(enough[0])))
    longest = int(np.argmax(stayed_s))
    text = f"The robot stayed there for at most {stayed_s[longest]:.2f} s, {condition.for_s:g} s are needed."
    # The finding names the line that moved the robot away, else the one that brought it there.
    return Finding(None, text, find_motion_line(records, longest + 1))


def _find_arrivals(there: Array) -> Array:
    """Return the tick of arrival at a place, for each tick at which the robot is there, shape (n,).

    The value is 0 if the robot was at the place from the start. At ticks at which the robot is elsewhere, the value has
    no meaning.

    Args:
        there: Whether the robot is at the place, at each tick, shape (n,).
    """
    import numpy as np

    begins = there & ~np.concatenate(([False], there[:-1]))
    since: Array = np.maximum.accumulate(np.where(begins, np.arange(len(there)), 0))
    return since


def _find_away_mm(condition: ReachCondition, records: Array) -> Array:
    import numpy as np

    x_mm = 0.0 if condition.x_mm is None else records["x_mm"] - condition.x_mm
    y_mm = 0.0 if condition.y_mm is None else records["y_mm"] - condition.y_mm
    away: Array = np.broadcast_to(np.hypot(x_mm, y_mm), len(records))
    return away


def _find_turned_deg(condition: ReachCondition, records: Array) -> Array:
    import numpy as np

    if condition.heading_deg is None:
        return np.zeros(len(records))
    turned: Array = np.abs((records["heading_deg"] - condition.heading_deg + 180.0) % 360.0 - 180.0)
    return turned


def _describe_miss(
    condition: ReachCondition, record: Any, away_mm: float, turned_deg: float
) -> str:
    words = []
    if condition.x_mm is not None or condition.y_mm is not None:
        words.append(
            f"{format_distance(away_mm)} {_describe_side(condition, record)} {_place_words(condition)}"
        )
    if condition.heading_deg is not None:
        words.append(f"turned {turned_deg:.1f}° away from {condition.heading_deg:g}°")
    return " and ".join(words)


def _describe_side(condition: ReachCondition, record: Any) -> str:
    """Return on which side of a condition's line the robot is in a record of telemetry, such as `left of`.

    The result is `from` if the condition has a point instead of a line.
    """
    if condition.x_mm is None:
        return "below" if record["y_mm"] < condition.y_mm else "above"
    if condition.y_mm is None:
        return "left of" if record["x_mm"] < condition.x_mm else "right of"
    return "from"


def _place_words(condition: ReachCondition) -> str:
    if condition.y_mm is None:
        return f"x = {condition.x_mm:g} mm"
    if condition.x_mm is None:
        return f"y = {condition.y_mm:g} mm"
    return f"({condition.x_mm:g}, {condition.y_mm:g})"


def find_pass(condition: PassCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the robot had passed all places of a condition, or else on the place that it missed."""
    records = evidence.records[span.ticks]
    first = span.first_tick
    if not len(records):
        return Finding(None, "The robot was not simulated at that time.")
    passed = last = 0
    for count, (x_mm, y_mm) in enumerate(condition.places_mm):
        away_mm = _measure_way_away_mm(records, x_mm, y_mm)
        start = passed if condition.in_order else 0
        near = away_mm[start:] <= condition.within_mm
        if not near.any():
            nearest = start + int(away_mm[start:].argmin())
            after = f" after place {count}" if count and condition.in_order else ""
            which = (
                f"{count + 1} of {len(condition.places_mm)} "
                if len(condition.places_mm) > 1
                else ""
            )
            text = (
                f"The robot came no nearer than {format_distance(away_mm[nearest])} to place {which}"
                f"({x_mm:g}, {y_mm:g}){after}, at {evidence.time_words(first + nearest)}."
            )
            return Finding(None, text, find_motion_line(records, nearest))
        passed = start + int(near.argmax())
        last = max(last, passed)
    return Finding(EvidencePoint(first + last))


def _measure_way_away_mm(records: Array, x_mm: float, y_mm: float) -> Array:
    """Return the least distance in mm between the robot and a point during each tick, shape (n,)."""
    import numpy as np

    x, y = records["x_mm"] - x_mm, records["y_mm"] - y_mm
    away_mm = np.hypot(x, y)
    dx, dy = np.diff(x), np.diff(y)
    squared = dx * dx + dy * dy
    # A robot that was moved by hand does not pass the places between its old and its new place.
    driven = (np.diff(records["actions"].astype("i4")) == 0) & (squared > 0)
    part = np.clip(-(x[:-1] * dx + y[:-1] * dy) / np.where(driven, squared, 1.0), 0.0, 1.0)
    between = np.hypot(x[:-1] + part * dx, y[:-1] + part * dy)
    away_mm[1:] = np.where(driven, np.minimum(between, away_mm[1:]), away_mm[1:])
    return away_mm


def find_left(condition: InsideCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the robot left an area in which it must stay; `Finding()` if it never left the area."""
    import numpy as np

    records = evidence.records[span.ticks]
    inside = np.ones(len(records), np.bool_)
    for x_mm, y_mm in _compute_points(condition.part, records, evidence.spec.robot):
        inside &= _find_inside(condition, x_mm, y_mm)
    return _find_first_wrong(
        ~inside, "left the area", "was not in the area from the start", evidence, span
    )


def find_entered(condition: OutsideCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the robot entered an area that it must avoid; `Finding()` if it never entered it."""
    import numpy as np

    records = evidence.records[span.ticks]
    if condition.part is BodyPart.CENTRE:
        within = _find_inside(condition, records["x_mm"], records["y_mm"])
    elif condition.radius_mm is not None:
        within = (
            _measure_circle_gap_mm(condition, records, evidence.spec.robot) < condition.radius_mm
        )
    else:
        left, lower, right, upper = condition.box_mm
        world = WorldSpec(
            walls=False, obstacles=(Obstacle(left, lower, right - left, upper - lower),)
        )
        contact = _find_first_contact(
            records, Solids(world, evidence.spec.robot), 0.0, forgiven=False
        )
        within = np.zeros(len(records), np.bool_)
        if contact is not None:
            within[contact[0]] = True
    return _find_first_wrong(
        within, "entered the area", "was in the area from the start", evidence, span
    )


def _find_first_wrong(
    wrong: Array, text: str, at_start: str, evidence: Evidence, span: EvidenceSpan
) -> Finding:
    if not wrong.any():
        return Finding()
    tick = span.first_tick + int(wrong.argmax())
    x_mm, y_mm = evidence.place_mm(tick)
    what = f"{text} at {evidence.time_words(tick)}" if tick else at_start
    # At the start no line of the program has moved the robot.
    return Finding(
        EvidencePoint(tick),
        f"The robot {what}, at x {x_mm:.0f} mm, y {y_mm:.0f} mm.",
        None if tick else 0,
    )


def _compute_points(part: BodyPart, records: Array, robot: RobotSpec) -> list[tuple[Array, Array]]:
    """Return the points that must be in or out of an area, each as x and y in mm at every tick.

    They are the robot's centre, or the corners of its body, as `part` says.
    """
    import numpy as np

    x_mm, y_mm = records["x_mm"], records["y_mm"]
    if part is BodyPart.CENTRE:
        return [(x_mm, y_mm)]
    turn = np.radians(records["heading_deg"])
    cos, sin = np.cos(turn), np.sin(turn)
    corners = build_outline(robot).corners_mm
    return [
        (x_mm + ahead * cos + aside * sin, y_mm + ahead * sin - aside * cos)
        for aside, ahead in corners
    ]


def _find_inside(area: AreaCondition, x_mm: Array, y_mm: Array) -> Array:
    import numpy as np

    if area.radius_mm is not None:
        round_in: Array = np.hypot(x_mm - area.x_mm, y_mm - area.y_mm) <= area.radius_mm
        return round_in
    left, lower, right, upper = area.box_mm
    in_box: Array = (left <= x_mm) & (x_mm <= right) & (lower <= y_mm) & (y_mm <= upper)
    return in_box


def _measure_circle_gap_mm(area: AreaCondition, records: Array, robot: RobotSpec) -> Array:
    """Return the distance in mm of the robot's body from the centre of a circle at every tick, shape (n,)."""
    import numpy as np

    outline = build_outline(robot)
    turn = np.radians(records["heading_deg"])
    dx, dy = area.x_mm - records["x_mm"], area.y_mm - records["y_mm"]
    ahead = dx * np.cos(turn) + dy * np.sin(turn)
    aside = dx * np.sin(turn) - dy * np.cos(turn)
    along = ahead - np.clip(ahead, outline.back_mm, outline.front_mm)
    across = aside - np.clip(aside, -outline.half_width_mm, outline.half_width_mm)
    gap: Array = np.hypot(along, across)
    return gap


def find_touch(condition: TouchNothingCondition, evidence: Evidence, span: EvidenceSpan) -> Finding:
    """Return a finding on when the robot touched an obstacle or wall, or came too near; `Finding()` if it never did."""
    world = evidence.spec.world
    robot = evidence.spec.robot
    walls = world.walls and condition.walls
    obstacles = world.obstacles if condition.obstacles else ()
    solids = Solids(WorldSpec(walls=walls, obstacles=obstacles), robot)
    contact = _find_first_contact(
        evidence.records[span.ticks], solids, max(condition.gap_mm, CONTACT_MM), forgiven=True
    )
    if contact is None:
        return Finding()
    index, number = contact
    tick = span.first_tick + index
    names = [
        *(_WALLS if walls else ()),
        *(f"the obstacle at x {o.x_mm:g}, y {o.y_mm:g}" for o in obstacles),
    ]
    did = "came too near to" if condition.gap_mm > CONTACT_MM else "touched"
    x_mm, y_mm = evidence.place_mm(tick)
    place = f"at x {x_mm:.0f} mm, y {y_mm:.0f} mm"
    return Finding(
        EvidencePoint(tick),
        f"The robot {did} {names[number]} at {evidence.time_words(tick)}, {place}.",
    )


def _find_first_contact(
    records: Array, solids: Solids, gap_mm: float, *, forgiven: bool
) -> tuple[int, int] | None:
    """Return the first tick at which the robot is too near to a solid object, and the index of the object.

    The result is None if the robot is never too near. Ticks are skipped if the robot cannot have come so near in them.

    Args:
        records: Telemetry.
        solids: Obstacles and walls.
        gap_mm: A smaller distance is too near.
        forgiven: Whether an object that is too near at the start counts only after the robot has been farther away.
    """
    import numpy as np

    if not len(records):
        return None
    turned = np.abs(np.diff(np.radians(records["heading_deg"])))
    steps_mm = (
        np.hypot(np.diff(records["x_mm"]), np.diff(records["y_mm"])) + turned * solids.reach_mm
    )
    way_mm = np.concatenate(([0.0], np.cumsum(steps_mm)))
    index = 0
    near_from_start = None
    while index < len(records):
        x_mm, y_mm, heading_deg = (
            float(records[name][index]) for name in ("x_mm", "y_mm", "heading_deg")
        )
        gaps = solids.measure_gaps_mm((x_mm, y_mm, heading_deg))
        near = {number for number, gap in enumerate(gaps) if gap < gap_mm}
        if near_from_start is None:
            near_from_start = near if forgiven else set()
        near_from_start &= near
        if near - near_from_start:
            return index, min(near - near_from_start)
        free_mm = min((abs(gap - gap_mm) for gap in gaps), default=np.inf)
        index = max(index + 1, int(np.searchsorted(way_mm, way_mm[index] + free_mm - 1e-6)))
    return None
