"""Solid things: how far the robot's outline can go before it meets a wall or an obstacle.

The motion of a tick is followed in steps so short that nothing can be passed between
them, and the place of contact is found by halving, so the outline never enters a solid
thing by more than `TOUCH_MM`.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RobotSpec, WorldSpec

TOUCH_MM = 1e-4
"""Overlap that still counts as touching."""

INSIDE_MM = 5e-3
"""Overlap from which on the robot counts as put into a thing, not as driven against it."""

BACK_OFF_MM = 1e-6
"""The robot stops so far before the contact, so that rounding cannot put it past it."""

STEP_MM = 1.0
"""No corner moves further between two looks; on an arc that hides less than 0.001 mm."""

NEAR_MM = 150.0
"""Obstacles so much further away than the robot reaches are looked at again only after such a way."""

SENSOR_HOUSING_MM = 15.0
"""A sensor's housing reaches so far to every side of its middle."""

_HALVINGS = 30

Box = tuple[float, float, float, float]
"""Left, lower, right and upper edge in mm."""


def front_mm(robot: RobotSpec) -> float:
    """Return how far the body reaches forward of the axle: to the front of its sensors."""
    sensors = [sensor.y_mm for sensor in robot.color_sensors]
    return max([0.0, robot.wheel_diameter_mm / 2, *(y + SENSOR_HOUSING_MM for y in sensors)])


def half_width_mm(robot: RobotSpec) -> float:
    """Return how far the body reaches to either side: to the outer edge of its wheels."""
    return (robot.wheel_spacing_mm + robot.wheel_width_mm) / 2


def outline(robot: RobotSpec) -> tuple[tuple[float, float], ...]:
    """Return the four corners of the body in robot coordinates, x right and y forward, in mm."""
    side, front, back = half_width_mm(robot), front_mm(robot), robot.back_mm
    return (-side, back), (side, back), (side, front), (-side, front)


class Solids:
    """The solid things of a world, for one robot.

    Args:
        world: Walls and obstacles.
        robot: Its outline counts.
    """

    def __init__(self, world: WorldSpec, robot: RobotSpec) -> None:
        self._walls = world.walls
        self._boxes: list[Box] = [(o.x_mm, o.y_mm, o.x_mm + o.width_mm, o.y_mm + o.height_mm) for o in world.obstacles]
        self._half_width, self._front, self._back = half_width_mm(robot), front_mm(robot), robot.back_mm
        self._reach = max(math.hypot(x, y) for x, y in outline(robot))
        self._near: list[Box] = []
        self._near_at = (math.inf, math.inf)

    def clearance_mm(self, x_mm: float, y_mm: float) -> float:
        """Return how far the robot's middle can go in any direction without meeting anything, at least 0."""
        gap = math.inf
        if self._walls:
            gap = min(x_mm, y_mm, FIELD_WIDTH_MM - x_mm, FIELD_HEIGHT_MM - y_mm)
        for left, lower, right, upper in self._boxes_near(x_mm, y_mm):
            across = max(left - x_mm, 0.0, x_mm - right)
            up = max(lower - y_mm, 0.0, y_mm - upper)
            gap = min(gap, math.hypot(across, up))
        # Boxes that were left out are at least this far away.
        beyond = NEAR_MM - math.dist((x_mm, y_mm), self._near_at) if self._boxes else math.inf
        return max(0.0, min(gap - self._reach, beyond))

    def _boxes_near(self, x_mm: float, y_mm: float) -> list[Box]:
        if not self._boxes:
            return self._boxes
        if math.dist((x_mm, y_mm), self._near_at) > NEAR_MM / 2:
            self._near_at = (x_mm, y_mm)
            reach = self._reach + NEAR_MM
            self._near = [
                box
                for box in self._boxes
                if box[0] - reach < x_mm < box[2] + reach and box[1] - reach < y_mm < box[3] + reach
            ]
        return self._near

    def free_part(self, x_mm: float, y_mm: float, heading_deg: float, forward_mm: float, turn_deg: float) -> float:
        """Return which part of a tick's motion can be made, 0 … 1.

        Args:
            x_mm: Where the middle of the axle is.
            y_mm: The same.
            heading_deg: Where the robot faces.
            forward_mm: Way along the heading before the turn.
            turn_deg: Turn, counter-clockwise.
        """
        solid = self._solid_now(x_mm, y_mm, heading_deg)
        heading = math.radians(heading_deg)
        across, up = forward_mm * math.cos(heading), forward_mm * math.sin(heading)

        def meets(part: float) -> bool:
            return self._meets(x_mm + across * part, y_mm + up * part, heading_deg + turn_deg * part, solid)

        way = abs(forward_mm) + abs(math.radians(turn_deg)) * self._reach
        steps = max(1, math.ceil(way / STEP_MM))
        for step in range(1, steps + 1):
            if meets(step / steps):
                return max(0.0, _last_clear(meets, (step - 1) / steps, step / steps) - BACK_OFF_MM / way)
        return 1.0

    def _solid_now(self, x_mm: float, y_mm: float, heading_deg: float) -> tuple[bool, list[Box]]:
        """What can be met: a thing that the robot already stands in lets it leave."""
        boxes = self._boxes_near(x_mm, y_mm)
        walls = self._walls and not self._meets(x_mm, y_mm, heading_deg, (True, []), INSIDE_MM)
        return walls, [box for box in boxes if not self._meets(x_mm, y_mm, heading_deg, (False, [box]), INSIDE_MM)]

    def _meets(
        self,
        x_mm: float,
        y_mm: float,
        heading_deg: float,
        solid: tuple[bool, list[Box]],
        allowed_mm: float = TOUCH_MM,
    ) -> bool:
        walls, boxes = solid
        # The body's own axes: forward, and to the left.
        turn = math.radians(heading_deg)
        fx, fy = math.cos(turn), math.sin(turn)
        middle, half_length = (self._front + self._back) / 2, (self._front - self._back) / 2
        half_width = self._half_width
        cx, cy = x_mm + fx * middle, y_mm + fy * middle
        # Half the size of the upright box around the body.
        wide = abs(fx) * half_length + abs(fy) * half_width - allowed_mm
        high = abs(fy) * half_length + abs(fx) * half_width - allowed_mm
        if walls and not (wide <= cx <= FIELD_WIDTH_MM - wide and high <= cy <= FIELD_HEIGHT_MM - high):
            return True
        for left, lower, right, upper in boxes:
            if cx + wide <= left or cx - wide >= right or cy + high <= lower or cy - high >= upper:
                continue
            # Separating axes of the body: the box seen along them.
            dx, dy = (left + right) / 2 - cx, (lower + upper) / 2 - cy
            half_x, half_y = (right - left) / 2, (upper - lower) / 2
            along = abs(dx * fx + dy * fy) - half_length - half_x * abs(fx) - half_y * abs(fy)
            aside = abs(dy * fx - dx * fy) - half_width - half_x * abs(fy) - half_y * abs(fx)
            if along < -allowed_mm and aside < -allowed_mm:
                return True
        return False


def _last_clear(meets: Callable[[float], bool], clear: float, met: float) -> float:
    for _ in range(_HALVINGS):
        part = (clear + met) / 2
        if meets(part):
            met = part
        else:
            clear = part
    return clear
