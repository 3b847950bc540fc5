"""Ultrasonic sensor: distance to the nearest surface that returns an echo."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from dataclasses import replace
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine.core.columns import Column
from tuisim.engine.core.drift import compute_lost_echoes, draw_echo_bias_mm
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.noise import draw_numbers, generate_bytes
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    RunSpec,
    UltrasonicSpec,
    WorldSpec,
)

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.state import Instant

MIN_ECHO_DEG, MAX_ECHO_DEG = 40.0, 140.0
"""A surface at an angle to the heading outside these limits reflects the pulse away."""

Edge = tuple[float, float, float]
"""An edge parallel to one axis: its coordinate on the other axis, its start and its end, in mm."""


@dataclass(frozen=True, slots=True)
class Surfaces:
    """All edges that can echo, sorted by coordinate, so that a ray meets them in their order."""

    upright: tuple[Edge, ...]
    """Edges parallel to the y axis: x, lower y, upper y."""
    upright_at: tuple[float, ...]
    level: tuple[Edge, ...]
    """Edges parallel to the x axis: y, left x, right x."""
    level_at: tuple[float, ...]


def find_surfaces(world: WorldSpec) -> Surfaces:
    """Return every edge that can echo: the four walls and the sides of the obstacles."""
    # Cached by identity: hashing a world with many obstacles would cost more than the rays.
    global _last_asked
    if _last_asked is None or _last_asked[0] is not world:
        _last_asked = (world, _sort_surfaces(world))
    return _last_asked[1]


_last_asked: tuple[WorldSpec, Surfaces] | None = None


def _sort_surfaces(world: WorldSpec) -> Surfaces:
    boxes = [(o.x_mm, o.y_mm, o.x_mm + o.width_mm, o.y_mm + o.height_mm) for o in world.obstacles]
    if world.walls:
        boxes.append((0.0, 0.0, float(FIELD_WIDTH_MM), float(FIELD_HEIGHT_MM)))
    upright = sorted(
        (x, lower, upper) for left, lower, right, upper in boxes for x in (left, right)
    )
    level = sorted((y, left, right) for left, lower, right, upper in boxes for y in (lower, upper))
    return Surfaces(
        tuple(upright), tuple(x for x, *_ in upright), tuple(level), tuple(y for y, *_ in level)
    )


def _is_echoing(edge_deg: float, heading_deg: float) -> bool:
    """Return whether an edge sends the pulse back: its angle to the heading is above 40 and below 140 degrees."""
    return MIN_ECHO_DEG < abs(edge_deg - heading_deg) % 180.0 < MAX_ECHO_DEG


def find_first_hit_mm(
    edges: tuple[Edge, ...],
    places: tuple[float, ...],
    start: tuple[float, float],
    step: tuple[float, float],
    most: float,
) -> float:
    """Return the distance in mm at which a ray meets one of some parallel edges; `most` if it meets none before.

    Positions have two coordinates: one across the edges, which is constant for each edge, and one along them.

    Args:
        edges: The edges, sorted by their coordinate across.
        places: The coordinate across of each edge, in the same order.
        start: Where the ray begins: across and along.
        step: How much each of the two coordinates changes per mm of the ray.
        most: Length of the ray in mm.
    """
    across, along = start
    across_step, along_step = step
    if abs(across_step) < 1e-12:
        return most
    if across_step > 0:
        passing = range(bisect_left(places, across), len(edges))
    else:
        passing = range(bisect_right(places, across) - 1, -1, -1)
    for index in passing:
        place, low, high = edges[index]
        way = (place - across) / across_step
        if way >= most:
            return most
        if low - 1e-9 <= along + way * along_step <= high + 1e-9:
            return way
    return most


def measure_rays_mm(
    pose: Pose, spec: UltrasonicSpec, world: WorldSpec
) -> list[tuple[float, float]]:
    """Return for each ray of the sensor its direction in the world in degrees and its length in mm."""
    start = world_point(pose, spec.x_mm, spec.y_mm)
    facing = pose.heading_deg + spec.angle_deg
    angles = [facing + ray_deg for ray_deg in spec.ray_angles_deg]
    return [
        (angle, _measure_ray_mm(start, angle, facing, find_surfaces(world), spec.max_range_mm))
        for angle in angles
    ]


def _measure_ray_mm(
    start: tuple[float, float],
    angle_deg: float,
    facing_deg: float,
    surfaces: Surfaces,
    max_mm: float,
) -> float:
    """Return the distance at which one ray meets a surface that echoes; `max_mm` if it meets none before.

    Args:
        start: Where the ray begins: x and y in mm.
        angle_deg: The direction of the ray in the world.
        facing_deg: The direction of the sensor, which decides which surfaces echo.
        surfaces: The surfaces.
        max_mm: Length of the ray.
    """
    x_mm, y_mm = start
    angle = math.radians(angle_deg)
    cos, sin = math.cos(angle), math.sin(angle)
    if _is_echoing(90.0, facing_deg):
        max_mm = find_first_hit_mm(
            surfaces.upright, surfaces.upright_at, (x_mm, y_mm), (cos, sin), max_mm
        )
    if _is_echoing(0.0, facing_deg):
        max_mm = find_first_hit_mm(
            surfaces.level, surfaces.level_at, (y_mm, x_mm), (sin, cos), max_mm
        )
    return max_mm


def measure_distance_mm(
    pose: Pose, spec: UltrasonicSpec, world: WorldSpec, heard: Surfaces | None = None
) -> int:
    """Return the distance to the nearest echo in whole mm, `max_range_mm` if there is none, without noise.

    Args:
        pose: The robot's pose.
        spec: The sensor.
        world: The walls and obstacles.
        heard: The surfaces that send this pulse back; None for all.
    """
    start = world_point(pose, spec.x_mm, spec.y_mm)
    facing = pose.heading_deg + spec.angle_deg
    surfaces = heard or find_surfaces(world)
    nearest = spec.max_range_mm
    for ray_deg in spec.ray_angles_deg:
        # A ray need not be followed beyond the nearest echo so far.
        nearest = _measure_ray_mm(start, facing + ray_deg, facing, surfaces, nearest)
    return round(nearest)


def _find_echoing_surfaces(
    spec: UltrasonicSpec, instant: Instant, world: WorldSpec
) -> Surfaces | None:
    """Return the surfaces that send back the sensor's pulse at an instant.

    Return None, which stands for all surfaces, if no pulse of the run can get lost.
    """
    drift = instant.drift
    if not drift.echo_loss_pc:
        return None
    echoing = find_surfaces(world)
    by_upright, by_level = draw_numbers(instant.seed, instant.tick, f"{spec.name}/echo", 2)
    # The angle between the pulse and the normal of the upright surfaces, which points along x: 0 to 90 degrees.
    flat = abs((instant.pose.heading_deg + spec.angle_deg + 90.0) % 180.0 - 90.0)
    if by_upright < compute_lost_echoes(flat, drift):
        echoing = replace(echoing, upright=(), upright_at=())
    if by_level < compute_lost_echoes(90.0 - flat, drift):
        echoing = replace(echoing, level=(), level_at=())
    return echoing


def measure_noisy_mm(spec: UltrasonicSpec, instant: Instant, world: WorldSpec) -> int:
    """Return the distance in whole mm including the sensor's errors and noise, 0 … `max_range_mm`.

    It is `max_range_mm` without an echo, and for a surface closer than the sensor can measure.
    """
    distance = measure_distance_mm(
        instant.pose, spec, world, _find_echoing_surfaces(spec, instant, world)
    )
    farthest = round(spec.max_range_mm)
    if distance < instant.profile.min_echo_mm:
        distance = farthest
    elif instant.drift.echo_bias_mm and distance < farthest:
        bias_mm = draw_echo_bias_mm(spec.port, instant.drift, instant.seed)
        distance = max(0, min(farthest, distance + bias_mm))
    if not spec.noise_mm:
        return distance
    share = (
        int.from_bytes(generate_bytes(instant.seed, instant.tick, spec.name, 4), "little")
        / 2147483647.5
        - 1
    )
    return max(0, min(farthest, round(distance + spec.noise_mm * share)))


def columns(spec: UltrasonicSpec) -> tuple[Column, ...]:
    """Return the only telemetry column of an ultrasonic sensor: its distance."""
    return (Column(f"{spec.name}_mm", is_traced=True, also=(spec.name,)),)


def measure(
    spec: UltrasonicSpec, instant: Instant, run: RunSpec, field: Field
) -> tuple[float, ...]:
    """Return the value of an ultrasonic sensor's column at an instant: the distance in mm."""
    return (float(measure_noisy_mm(spec, instant, run.world)),)
