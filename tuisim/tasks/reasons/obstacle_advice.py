"""Which obstacles stand where a sensor of a run would see them."""

from __future__ import annotations

import math
from dataclasses import replace

from tuisim.engine.core.collision import TOUCH_MM, Solids
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.sensors.infrared import PROXIMITY_RANGE_MM, proximity
from tuisim.engine.core.sensors.ultrasonic import measure_distance_mm
from tuisim.engine.core.spec import InfraredSpec, RunSpec, UltrasonicSpec, WorldSpec
from tuisim.engine.obstacles import OBSTACLES

_SHARE = 0.7
"""Distance of the proposed obstacle, as a share of the one that the program asks for."""
_NEAREST_MM = 40.0
"""Ultrasonic sensors measure nothing that is nearer than 30 mm."""


def find_nearest(sensor: UltrasonicSpec, spec: RunSpec) -> float:
    """Return the least distance in mm that an ultrasonic sensor can read of a wall: that with the robot at the wall."""
    front_mm = build_outline(spec.robot).front_mm if spec.profile.solid or spec.world.solid else 0.0
    return max(float(spec.profile.min_echo_mm), front_mm - sensor.y_mm)


def find_obstacle(
    sensor: UltrasonicSpec | InfraredSpec, spec: RunSpec, pose: Pose, limit: float | None
) -> str:
    """Return options that put an obstacle of `OBSTACLES` before a sensor; empty if none of them does.

    Args:
        sensor: The sensor.
        spec: The run.
        pose: Where the robot looks for the obstacle.
        limit: How near it has to be, in mm or in % for an infrared sensor; None for anywhere.
    """
    sets = {name: replace(spec.world, obstacles=boxes) for name, boxes in OBSTACLES.items()}
    distances = {name: _measure(sensor, spec, world, pose) for name, world in sets.items()}
    nearest = min(distances, key=distances.__getitem__)
    if distances[nearest] < (math.inf if limit is None else limit):
        return f"-o {nearest}"
    start = spec.world.start
    if limit is None or (pose.x_mm, pose.y_mm) != (start.x_mm, start.y_mm):
        return ""
    per_unit = 1.0 if isinstance(sensor, UltrasonicSpec) else PROXIMITY_RANGE_MM / 100
    way_mm = max(_NEAREST_MM, limit * per_unit * _SHARE, build_outline(spec.robot).front_mm + 1.0)
    for name, world in sets.items():
        for box in world.obstacles:
            x_mm = math.floor(box.x_mm - sensor.y_mm - way_mm)
            if _measure(sensor, spec, world, replace(pose, x_mm=float(x_mm))) < limit:
                return f"-o {name} -x {x_mm}"
    return ""


def _measure(
    sensor: UltrasonicSpec | InfraredSpec, spec: RunSpec, world: WorldSpec, pose: Pose
) -> float:
    """Return how far a sensor sees an obstacle of a world; infinite if it sees none or the robot would touch one."""
    bare = replace(world, obstacles=())
    if isinstance(sensor, UltrasonicSpec):
        distance = measure_distance_mm(pose, sensor, world)
        free = measure_distance_mm(pose, sensor, bare)
        is_seen = spec.profile.min_echo_mm <= distance < free
    else:
        distance = proximity(pose, sensor, world)
        is_seen = distance < proximity(pose, sensor, bare)
    gaps = Solids(world, spec.robot).measure_gaps_mm((pose.x_mm, pose.y_mm, pose.heading_deg))
    return distance if is_seen and min(gaps, default=0.0) >= -TOUCH_MM else math.inf
