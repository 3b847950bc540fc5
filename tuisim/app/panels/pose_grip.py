"""A drag that moves or turns the robot."""

from __future__ import annotations

import math
from dataclasses import replace

from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, START_VALUES

_ON_FIELD = (0, FIELD_WIDTH_MM), (0, FIELD_HEIGHT_MM)
_ON_FLOOR = tuple((START_VALUES[key].low, START_VALUES[key].high) for key in ("x_mm", "y_mm"))


@dataclass(frozen=True, slots=True)
class PoseGrip:
    """A drag of the mouse that moves or turns the robot, with the pose at which it began."""

    pose: Pose
    x_mm: float
    y_mm: float
    turns: bool
    on_floor: bool
    """Whether the drag may move the robot off the field, onto the floor around it."""

    def drag_pose(self, x_mm: float, y_mm: float) -> Pose:
        """Return the pose of the robot after a drag to a point of the field, in whole mm and degrees.

        Args:
            x_mm: World x of the point.
            y_mm: World y of the point.
        """
        start = self.pose
        if self.turns:
            before = math.atan2(self.y_mm - start.y_mm, self.x_mm - start.x_mm)
            now = math.atan2(y_mm - start.y_mm, x_mm - start.x_mm)
            turn = math.remainder(math.degrees(now - before), 360.0)
            return replace(start, heading_deg=float(round(start.heading_deg + turn)))
        at_mm = start.x_mm + x_mm - self.x_mm, start.y_mm + y_mm - self.y_mm
        sides = _ON_FLOOR if self.on_floor else _ON_FIELD
        x_mm, y_mm = (
            float(round(min(max(place, low), high)))
            for place, (low, high) in zip(at_mm, sides, strict=True)
        )
        return Pose(x_mm, y_mm, start.heading_deg)
