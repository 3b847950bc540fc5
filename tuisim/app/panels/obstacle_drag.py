"""Obstacles under the mouse: where one is taken hold of, moved, or drawn anew."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, Obstacle

GRID_MM = 5.0
"""Places and sizes drawn with the mouse are multiples of this."""
LEAST_MM = 20.0
"""What is drawn smaller was a click."""


def _to_grid(value_mm: float) -> float:
    return round(value_mm / GRID_MM) * GRID_MM


def box_at(boxes: Sequence[Obstacle], x_mm: float, y_mm: float, slack_mm: float) -> int | None:
    """Return the index of the topmost box at a point, None for none.

    Args:
        boxes: The later ones lie on top.
        x_mm: World x.
        y_mm: World y.
        slack_mm: So far beside a box still counts: one may be thinner than a cell.
    """
    for index in reversed(range(len(boxes))):
        box = boxes[index]
        right, upper = box.x_mm + box.width_mm, box.y_mm + box.height_mm
        if box.x_mm - slack_mm <= x_mm <= right + slack_mm and box.y_mm - slack_mm <= y_mm <= upper + slack_mm:
            return index
    return None


@dataclass(frozen=True, slots=True)
class BoxGrip:
    """A drag under way: of a box, or one that draws a new box."""

    boxes: tuple[Obstacle, ...]
    """As they were when the drag began."""
    index: int | None
    """The box that is held; None draws a new one."""
    x_mm: float
    y_mm: float

    def dragged_to(self, x_mm: float, y_mm: float) -> tuple[tuple[Obstacle, ...], int] | None:
        """Return the boxes with the mouse at a point, and the index of the one at hand; None if nothing is changed."""
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
