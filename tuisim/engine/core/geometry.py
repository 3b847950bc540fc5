"""Poses and points: millimetres, y up, degrees counter-clockwise from +x."""

from __future__ import annotations

import math

from tuisim.base.data_class import dataclass


@dataclass(frozen=True, slots=True)
class Pose:
    """The robot's position in mm and its heading in degrees, in the coordinates of the world."""

    x_mm: float
    y_mm: float
    heading_deg: float
    """Counter-clockwise from +x, not wrapped: -90 stays -90, two turns are 720."""

    def describe(self) -> str:
        """Return a pose as text, such as `x 1.00 mm, y 2.00 mm, heading 90.00°`."""
        return f"x {self.x_mm:.2f} mm, y {self.y_mm:.2f} mm, heading {shown_heading_deg(self.heading_deg):.2f}°"


def shown_heading_deg(heading_deg: float) -> float:
    """Return a heading wrapped to -180 … 180 for display; recorded headings are not wrapped."""
    if -180.0 <= heading_deg <= 180.0:
        return heading_deg
    return 180.0 - (180.0 - heading_deg) % 360.0


def world_point(pose: Pose, x_mm: float, y_mm: float) -> tuple[float, float]:
    """Return the world position of a point given in robot coordinates.

    Args:
        pose: The robot's pose; its position is the midpoint between the wheels.
        x_mm: To the right of the robot.
        y_mm: Forward of the robot.

    Returns:
        x and y in mm in the world.
    """
    # The robot's frame has y forward, so it is rotated by heading - 90 degrees.
    turn = math.radians(pose.heading_deg - 90.0)
    cos, sin = math.cos(turn), math.sin(turn)
    return pose.x_mm + cos * x_mm - sin * y_mm, pose.y_mm + sin * x_mm + cos * y_mm
