"""Collisions: how far the robot's outline can move before it meets a wall or an obstacle.

The motion of a tick is checked in steps so short that no obstacle can be skipped, and the point of contact is found by
bisection, so the outline never enters an obstacle by more than `TOUCH_MM`.

A robot may be placed where it overlaps an obstacle. From there it never gets deeper into it: on a straight way it can
only drive away from it, and a turn pushes it aside by as much as the turn would lead it deeper. A turn on the spot or
around one wheel also pushes aside a robot that meets an obstacle during the turn, because its corner slides along the
obstacle.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RobotSpec, WorldSpec

TOUCH_MM = 1e-4
"""Overlap that still counts as touching."""

ROUNDING_MM = 1e-9
"""Largest overlap that rounding causes while a robot drives along an obstacle."""

BACK_OFF_MM = 1e-6
"""The robot stops this far before the contact, so that rounding cannot put it past it."""

STEP_MM = 1.0
"""Largest distance a corner moves between two checks; on an arc this misses less than 0.001 mm."""

NEAR_MM = 150.0
"""Obstacles farther from the robot's reach than this are checked again only after it has moved this far."""

_HALVINGS = 22

Box = tuple[float, float, float, float]
"""Left, lower, right and upper edge, in mm."""

PoseTuple = tuple[float, float, float]
"""x and y in mm, heading in degrees."""

Body = tuple[float, float, float, float, float, float, float, float]
"""Centre, forward direction, half length and half width of a body, and half the size of its bounding box."""


class Clearance(NamedTuple):
    """How far the body can move from a pose without a collision, in mm."""

    pose: PoseTuple
    any_mm: float
    """How far the body's fastest point may move in any direction."""
    straight: int
    """1 if the way straight ahead was checked, -1 for straight back, 0 for neither."""
    straight_mm: float
    """How far the body may move straight in that direction."""


class Leeway(NamedTuple):
    """The part of a tick's motion that obstacles allow, and how they push the robot aside."""

    part: float
    """Fraction of the motion that is possible, 0 … 1."""
    aside_mm: tuple[float, float]
    """Displacement by which the robot is pushed aside in addition, along x and y."""


UNHINDERED = Leeway(1.0, (0.0, 0.0))


class Solids:
    """The obstacles and walls of a world, for one robot.

    Most of the time nothing is near. The distance that every point of the body may move is therefore computed once, and
    reduced by the motion of each tick. The obstacles are checked again only when this distance is used up.

    Args:
        world: Walls and obstacles.
        robot: The robot; its outline is used.
        early: The heading along which the robot drives in a tick in which it turns: 0 is the heading before the turn, 1
            the heading after the turn, and 0.5 the heading halfway between them.
    """

    def __init__(self, world: WorldSpec, robot: RobotSpec, early: float = 0.0) -> None:
        self._early = early
        self._walls = world.walls
        self._boxes: list[Box] = [
            (o.x_mm, o.y_mm, o.x_mm + o.width_mm, o.y_mm + o.height_mm) for o in world.obstacles
        ]
        outline = build_outline(robot)
        self._half_width = outline.half_width_mm
        front = outline.front_mm
        back = outline.back_mm
        self._middle = (front + back) / 2
        self._half_length = (front - back) / 2
        self._turns_mm = robot.wheel_spacing_mm / 2 * (1.0 + 1e-9)
        """Distance per radian up to which a motion counts as a turn, in which the wheels push in opposite
        directions."""
        self.reach_mm = outline.reach_mm
        """Largest distance of the body from the centre of the axle."""
        self._near: list[Box] = []
        self._near_at = (math.inf, math.inf)
        self._free = Clearance((math.inf, math.inf, 0.0), 0.0, 0, 0.0)
        self._last_motion: tuple[float, ...] = ()
        self._last_leeway = UNHINDERED

    def find_free_way_mm(self, pose: PoseTuple, wanted_mm: float, straight: int = 0) -> float:
        """Return a lower bound of how far every point of the body can move without a collision.

        Args:
            pose: x and y in mm, heading in degrees.
            wanted_mm: If at least this distance is known to be free, nothing is checked again.
            straight: 1 or -1 for a robot that only moves forwards or backwards, 0 for any motion.
        """
        left = self.remaining_mm(pose)
        if left >= wanted_mm:
            return left
        if self._free.pose != pose or self._free.straight != straight:
            self._free = self._compute_clearance(pose, straight)
        return max(self._free.any_mm, self._free.straight_mm)

    def remaining_mm(self, pose: PoseTuple) -> float:
        """Return the free distance in mm that the last check found, less the distance moved since."""
        x, y, heading = self._free.pose
        turned = math.radians(abs(pose[2] - heading)) * self.reach_mm
        return self._free.any_mm - math.hypot(pose[0] - x, pose[1] - y) - turned

    def find_leeway(self, pose: PoseTuple, forward_mm: float, turn_deg: float) -> Leeway:
        """Return the part of a tick's motion that obstacles allow, and how they push the robot aside.

        Args:
            pose: x and y in mm, heading in degrees, before the motion.
            forward_mm: The motion along the heading.
            turn_deg: The turn, positive counter-clockwise.
        """
        way = abs(forward_mm) + abs(math.radians(turn_deg)) * self.reach_mm
        if self.remaining_mm(pose) >= way:
            return UNHINDERED
        motion = (*pose, forward_mm, turn_deg)
        # A robot that pushes against an obstacle has the same pose and motion in every tick.
        if motion != self._last_motion:
            self._last_motion, self._last_leeway = (
                motion,
                self._compute_leeway(pose, forward_mm, turn_deg, way),
            )
        return self._last_leeway

    def _compute_leeway(
        self, pose: PoseTuple, forward_mm: float, turn_deg: float, way_mm: float
    ) -> Leeway:
        if self._free.pose != pose:
            self._free = self._compute_clearance(pose, 0)
        if self._free.any_mm >= way_mm:
            return UNHINDERED
        body = self._place_body(*pose)
        # A robot that is pushed aside moves up to twice the distance.
        boxes = [
            box for box in self._find_near_boxes(pose) if _measure_box_gap(body, box) <= 2 * way_mm
        ]
        gaps = list(self._measure_gaps(body, boxes))
        x_mm, y_mm, heading_deg = pose
        early_deg = turn_deg * self._early

        def move_body(part: float) -> Body:
            heading = math.radians(heading_deg + early_deg * part)
            way = forward_mm * part
            x, y = x_mm + way * math.cos(heading), y_mm + way * math.sin(heading)
            return self._place_body(x, y, heading_deg + turn_deg * part)

        floors = [-TOUCH_MM if gap >= -TOUCH_MM else gap - ROUNDING_MM for gap in gaps]
        if turn_deg and min(gaps, default=0.0) < -TOUCH_MM:
            return self._push_aside(move_body(1.0), boxes, floors)

        def is_blocked(part: float) -> bool:
            return any(
                gap < floor
                for gap, floor in zip(
                    self._measure_gaps(move_body(part), boxes), floors, strict=True
                )
            )

        part = _find_free_part(is_blocked, way_mm)
        if part < 1.0 and abs(forward_mm) <= abs(math.radians(turn_deg)) * self._turns_mm:
            pushed = self._push_aside(move_body(1.0), boxes, floors)
            if pushed.part:
                return pushed
        return Leeway(part, (0.0, 0.0))

    def _push_aside(self, body: Body, boxes: list[Box], floors: list[float]) -> Leeway:
        """Compute how far to push the robot's body aside, so that it keeps a minimum distance from walls and obstacles.

        Args:
            body: The robot's body after the whole motion of a tick.
            boxes: The obstacles near the body.
            floors: The minimum distance to each wall and obstacle, in mm, in the order of `_measure_gaps`.

        Returns:
            A `Leeway` with the push, which allows the whole motion; if no such push is found, one that allows no
            motion.
        """
        x_mm = y_mm = 0.0
        there = body
        for number, floor in enumerate(floors):
            gap = list(self._measure_gaps(there, boxes))[number]
            if gap < floor:
                out_x, out_y = self._find_way_out(there, number, boxes)
                deeper = floor + ROUNDING_MM - gap
                x_mm, y_mm = x_mm + deeper * out_x, y_mm + deeper * out_y
                there = (body[0] + x_mm, body[1] + y_mm, *body[2:])
        if any(
            gap < floor for gap, floor in zip(self._measure_gaps(there, boxes), floors, strict=True)
        ):
            return Leeway(0.0, (0.0, 0.0))
        return Leeway(1.0, (x_mm, y_mm))

    # Gaps

    def measure_gaps_mm(self, pose: PoseTuple) -> tuple[float, ...]:
        """Return the gaps in mm between the body and every wall and obstacle, negative where they overlap.

        The left, right, lower and upper wall come first, if there are walls, then the obstacles in their order. When
        the body moves, no gap changes by more than the distance that the fastest point of the body moves.
        """
        return tuple(self._measure_gaps(self._place_body(*pose), self._boxes))

    def _measure_gaps(self, body: Body, boxes: list[Box]) -> Iterator[float]:
        """Yield the gap in mm between the body and each wall and box, negative if they overlap."""
        if self._walls:
            yield from _measure_wall_gaps(body)
        for box in boxes:
            yield _measure_box_gap(body, box)

    def _find_way_out(self, body: Body, number: int, boxes: list[Box]) -> tuple[float, float]:
        """Return the direction, as x and y, in which a body leaves an overlap by the shortest way.

        `number` is the index of the overlapped wall or box among the results of `_measure_gaps`.
        """
        if self._walls:
            if number < len(_AWAY_FROM_WALLS):
                return _AWAY_FROM_WALLS[number]
            number -= len(_AWAY_FROM_WALLS)
        return _find_way_out_of_box(body, boxes[number])

    def _compute_clearance(self, pose: PoseTuple, straight: int) -> Clearance:
        body = self._place_body(*pose)
        # Boxes that are not in this list are at least `beyond` away from the body.
        boxes = self._find_near_boxes(pose)
        any_mm = beyond = NEAR_MM - math.dist(pose[:2], self._near_at) if self._boxes else math.inf
        on_mm = beyond if straight else 0.0
        if self._walls:
            any_mm = min(any_mm, *_measure_wall_gaps(body))
            on_mm = min(on_mm, _measure_way_to_wall(body, straight)) if straight else 0.0
        cx, cy, _, _, _, _, wide, high = body
        for box in boxes:
            left, lower, right, upper = box
            # The gaps along the box's own axes are computed first: that is fast, and mostly sufficient.
            apart = max(left - cx - wide, cx - right - wide, lower - cy - high, cy - upper - high)
            if apart >= any_mm and not straight:
                continue
            gap = _measure_box_gap(body, box)
            any_mm = min(any_mm, gap)
            if gap < -TOUCH_MM:
                on_mm = 0.0
            elif straight:
                along, aside, before = _locate_box(body, box)
                if aside < 0.0 and along < 0.0:
                    # The box is only diagonally beside the body: a straight motion may meet it even if its centre is
                    # behind.
                    on_mm = min(on_mm, gap)
                elif aside < 0.0 and before == (straight > 0):
                    on_mm = min(on_mm, along)
        return Clearance(pose, max(0.0, any_mm), straight, max(0.0, on_mm))

    def _find_near_boxes(self, pose: PoseTuple) -> list[Box]:
        x_mm, y_mm = pose[:2]
        if self._boxes and math.dist((x_mm, y_mm), self._near_at) > NEAR_MM / 2:
            self._near_at = (x_mm, y_mm)
            reach = self.reach_mm + NEAR_MM
            self._near = [
                box
                for box in self._boxes
                if box[0] - reach < x_mm < box[2] + reach and box[1] - reach < y_mm < box[3] + reach
            ]
        return self._near

    def _place_body(self, x_mm: float, y_mm: float, heading_deg: float) -> Body:
        turn = math.radians(heading_deg)
        fx = math.cos(turn)
        fy = math.sin(turn)
        length = self._half_length
        width = self._half_width
        return (
            x_mm + fx * self._middle,
            y_mm + fy * self._middle,
            fx,
            fy,
            length,
            width,
            abs(fx) * length + abs(fy) * width,
            abs(fy) * length + abs(fx) * width,
        )


_AWAY_FROM_WALLS = ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0))
"""Directions from the walls into the field, in the order of `_measure_wall_gaps`."""


def _measure_wall_gaps(body: Body) -> tuple[float, float, float, float]:
    """Return the gaps in mm to the left, right, lower and upper wall, negative if the body is in the wall."""
    cx, cy, _, _, _, _, wide, high = body
    return cx - wide, FIELD_WIDTH_MM - wide - cx, cy - high, FIELD_HEIGHT_MM - high - cy


def _measure_way_to_wall(body: Body, direction: int) -> float:
    """Return how many mm the body can move along its heading (direction 1) or against it (-1) up to a wall."""
    cx, cy, fx, fy, _, _, wide, high = body
    way = math.inf
    for centre, half, end, step in (
        (cx, wide, FIELD_WIDTH_MM, fx),
        (cy, high, FIELD_HEIGHT_MM, fy),
    ):
        step *= direction
        if abs(step) > 1e-12:
            way = min(way, ((end - half - centre) if step > 0 else (centre - half)) / abs(step))
    return way


def _measure_box_gap(body: Body, box: Box) -> float:
    """Return the largest gap in mm between body and box along one of four directions; negative if they overlap.

    The directions are those of the sides of the box and of the body.
    """
    cx, cy, _, _, _, _, wide, high = body
    left, lower, right, upper = box
    upright = max(left - cx, cx - right) - wide
    level = max(lower - cy, cy - upper) - high
    along, aside, _ = _locate_box(body, box)
    return max(upright, level, along, aside)


def _find_way_out_of_box(body: Body, box: Box) -> tuple[float, float]:
    """Return the direction, as x and y, in which a body that overlaps a box leaves it by the shortest way."""
    cx, cy, fx, fy, _, _, wide, high = body
    left, lower, right, upper = box
    along, aside, in_front = _locate_box(body, box)
    middle_x, middle_y = (left + right) / 2, (lower + upper) / 2
    on_the_left = (middle_y - cy) * fx - (middle_x - cx) * fy > 0
    ways = (
        (max(left - cx, cx - right) - wide, (-1.0, 0.0) if cx < middle_x else (1.0, 0.0)),
        (max(lower - cy, cy - upper) - high, (0.0, -1.0) if cy < middle_y else (0.0, 1.0)),
        (along, (-fx, -fy) if in_front else (fx, fy)),
        (aside, (fy, -fx) if on_the_left else (-fy, fx)),
    )
    return max(ways)[1]


def _locate_box(body: Body, box: Box) -> tuple[float, float, bool]:
    """Return the gaps in mm to a box along the heading and across it, and whether the box is in front."""
    cx, cy, fx, fy, length, width, _, _ = body
    left, lower, right, upper = box
    dx, dy = (left + right) / 2 - cx, (lower + upper) / 2 - cy
    half_x, half_y = (right - left) / 2, (upper - lower) / 2
    forward, sideways = dx * fx + dy * fy, dy * fx - dx * fy
    along = abs(forward) - length - half_x * abs(fx) - half_y * abs(fy)
    aside = abs(sideways) - width - half_x * abs(fy) - half_y * abs(fx)
    return along, aside, forward > 0


def _find_free_part(is_blocked: Callable[[float], bool], way_mm: float) -> float:
    """Return the largest fraction, 0 … 1, of a motion of `way_mm` that brings no contact.

    `is_blocked` returns whether there is contact after a fraction of the motion.
    """
    steps = max(1, math.ceil(way_mm / STEP_MM))
    for step in range(1, steps + 1):
        if is_blocked(step / steps):
            return max(
                0.0,
                _bisect_free_part(is_blocked, (step - 1) / steps, step / steps)
                - BACK_OFF_MM / way_mm,
            )
    return 1.0


def _bisect_free_part(is_blocked: Callable[[float], bool], clear: float, met: float) -> float:
    for _ in range(_HALVINGS):
        part = (clear + met) / 2
        if is_blocked(part):
            met = part
        else:
            clear = part
    return clear
