"""Ultrasonic sensor: distance to the nearest surface that echoes."""

from __future__ import annotations

import math
from functools import lru_cache

from tuisim.core.field import Field
from tuisim.core.geometry import Pose, world_point
from tuisim.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM, RunSpec, UltrasonicSpec, WorldSpec
from tuisim.core.state import Instant

MIN_ECHO_DEG, MAX_ECHO_DEG = 40.0, 140.0
"""A surface met at a flatter angle to the heading throws the pulse away."""

Segment = tuple[float, float, float, float]
"""End points x1, y1, x2, y2 in mm."""


@lru_cache(maxsize=8)
def surfaces(world: WorldSpec) -> tuple[Segment, ...]:
    """Return every edge that can echo: the four walls and the sides of the obstacles."""
    boxes = [(o.x_mm, o.y_mm, o.x_mm + o.width_mm, o.y_mm + o.height_mm) for o in world.obstacles]
    if world.walls:
        boxes.append((0.0, 0.0, float(FIELD_WIDTH_MM), float(FIELD_HEIGHT_MM)))
    edges: list[Segment] = []
    for x0, y0, x1, y1 in boxes:
        edges += [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]
    return tuple(edges)


def _echoes(edge: Segment, heading_deg: float) -> bool:
    """Whether the angle between edge and heading is above 40 and below 140 degrees."""
    x1, y1, x2, y2 = edge
    angle = abs(math.degrees(math.atan2(y2 - y1, x2 - x1)) - heading_deg) % 180.0
    return MIN_ECHO_DEG < angle < MAX_ECHO_DEG


def _hit_mm(x_mm: float, y_mm: float, cos: float, sin: float, edge: Segment) -> float:
    """Distance along a ray to an edge, infinite if it passes by."""
    x1, y1, x2, y2 = edge
    ex, ey = x2 - x1, y2 - y1
    cross = cos * ey - sin * ex
    if abs(cross) < 1e-12:
        return math.inf
    along_ray = ((x1 - x_mm) * ey - (y1 - y_mm) * ex) / cross
    along_edge = ((x1 - x_mm) * sin - (y1 - y_mm) * cos) / cross
    return along_ray if along_ray >= 0 and -1e-9 <= along_edge <= 1 + 1e-9 else math.inf


def rays_mm(pose: Pose, spec: UltrasonicSpec, world: WorldSpec) -> list[tuple[float, float]]:
    """Return each ray as (world angle in degrees, length in mm); the length is at most the range."""
    x_mm, y_mm = world_point(pose, spec.x_mm, spec.y_mm)
    facing = pose.heading_deg + spec.angle_deg
    edges = [edge for edge in surfaces(world) if _echoes(edge, facing)]
    rays = []
    for ray_deg in spec.ray_angles_deg:
        angle = math.radians(facing + ray_deg)
        cos, sin = math.cos(angle), math.sin(angle)
        nearest = min((_hit_mm(x_mm, y_mm, cos, sin, edge) for edge in edges), default=math.inf)
        rays.append((facing + ray_deg, min(nearest, spec.max_range_mm)))
    return rays


def distance_mm(pose: Pose, spec: UltrasonicSpec, world: WorldSpec) -> int:
    """Return the distance to the nearest echo in whole mm, `max_range_mm` if there is none."""
    return round(min(length for _, length in rays_mm(pose, spec, world)))


def columns(spec: UltrasonicSpec) -> tuple[str, ...]:
    """Return the telemetry columns of an ultrasonic sensor."""
    return (f"{spec.name}_mm",)


def measure(spec: UltrasonicSpec, instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return the value of `columns`."""
    return (float(distance_mm(instant.pose, spec, run.world)),)
