"""Obstacles and the mouse: hit test, moving and drawing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle

GRID_MM = 5.0
"""Positions and sizes set with the mouse are multiples of this."""
LEAST_MM = 20.0
"""A drag smaller than this is a click."""


def _to_grid(value_mm: float) -> float:
    return round(value_mm / GRID_MM) * GRID_MM


def box_at(boxes: Sequence[Obstacle], x_mm: float, y_mm: float, slack_mm: float) -> int | None:
    """Return the index of the topmost box at a point, None for none.

    Args:
        boxes: Later ones are on top.
        x_mm: World x.
        y_mm: World y.
        slack_mm: Tolerance around a box, which may be thinner than a cell.
    """
    for index in reversed(range(len(boxes))):
        box = boxes[index]
        right, upper = box.x_mm + box.width_mm, box.y_mm + box.height_mm
        if box.x_mm - slack_mm <= x_mm <= right + slack_mm and box.y_mm - slack_mm <= y_mm <= upper + slack_mm:
            return index
    return None


@dataclass(frozen=True, slots=True)
class BoxGrip:
    """A drag in progress, which moves a box or draws a new one."""

    boxes: tuple[Obstacle, ...]
    """The boxes at the start of the drag."""
    index: int | None
    """The box that is dragged; None draws a new one."""
    x_mm: float
    y_mm: float

    def dragged_to(self, x_mm: float, y_mm: float) -> tuple[tuple[Obstacle, ...], int] | None:
        """Return the boxes with the mouse at a point, and the index of the dragged one; None if nothing has changed."""
        if self.index is None:
            box = self._drawn(x_mm, y_mm)
            return None if box is None else ((*self.boxes, box), len(self.boxes))
        box = self.boxes[self.index]
        x = min(max(_to_grid(box.x_mm + x_mm - self.x_mm), -box.width_mm / 2), FIELD_WIDTH_MM - box.width_mm / 2)
        y = min(max(_to_grid(box.y_mm + y_mm - self.y_mm), -box.height_mm / 2), FIELD_HEIGHT_MM - box.height_mm / 2)
        moved = replace(box, x_mm=x, y_mm=y)
        return (*self.boxes[: self.index], moved, *self.boxes[self.index + 1 :]), self.index

    def _drawn(self, x_mm: float, y_mm: float) -> Obstacle | None:
        left, right = sorted(_to_grid(min(max(x, 0.0), FIELD_WIDTH_MM)) for x in (self.x_mm, x_mm))
        lower, upper = sorted(_to_grid(min(max(y, 0.0), FIELD_HEIGHT_MM)) for y in (self.y_mm, y_mm))
        if right - left < LEAST_MM or upper - lower < LEAST_MM:
            return None
        return Obstacle(left, lower, right - left, upper - lower)
