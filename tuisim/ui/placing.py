"""A random place for the robot: on the field, and clear of what is solid."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence

from tuisim.core.geometry import Pose, world_point
from tuisim.core.solid import outline
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec

MOST_TRIES = 2000

Corners = Sequence[tuple[float, float]]


def random_pose(spec: RunSpec, chance: random.Random) -> Pose | None:
    """Return a pose at whole mm and degrees at which the robot's outline lies on the field.

    Args:
        spec: Robot and world; where things are solid, the outline is clear of every obstacle.
        chance: Where the numbers come from.

    Returns:
        None if no free place was found.
    """
    for _ in range(MOST_TRIES):
        x_mm, y_mm = chance.randint(0, FIELD_WIDTH_MM), chance.randint(0, FIELD_HEIGHT_MM)
        pose = Pose(float(x_mm), float(y_mm), float(chance.randint(-179, 180)))
        if fits(spec, pose):
            return pose
    return None


def fits(spec: RunSpec, pose: Pose) -> bool:
    """Return whether the outline of the robot lies on the field, and clear of obstacles where those are solid."""
    corners = [world_point(pose, x, y) for x, y in outline(spec.robot)]
    if not all(0 <= x <= FIELD_WIDTH_MM and 0 <= y <= FIELD_HEIGHT_MM for x, y in corners):
        return False
    if not spec.world.solid:
        return True
    boxes = (
        ((o.x_mm, o.y_mm), (o.x_mm + o.width_mm, o.y_mm), (o.x_mm, o.y_mm + o.height_mm),
         (o.x_mm + o.width_mm, o.y_mm + o.height_mm))
        for o in spec.world.obstacles
    )  # fmt: skip
    return not any(_overlap(corners, box, pose.heading_deg) for box in boxes)


def _overlap(one: Corners, other: Corners, heading_deg: float) -> bool:
    """Whether two rectangles overlap: no side of either parts them."""
    heading = math.radians(heading_deg)
    axes = ((1.0, 0.0), (0.0, 1.0), (math.cos(heading), math.sin(heading)), (-math.sin(heading), math.cos(heading)))
    for across, up in axes:
        ours, theirs = ([x * across + y * up for x, y in corners] for corners in (one, other))
        if max(ours) <= min(theirs) or max(theirs) <= min(ours):
            return False
    return True
