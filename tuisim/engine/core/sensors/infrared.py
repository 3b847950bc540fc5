"""Infrared sensor: proximity, direction and distance of a beacon, buttons of a remote control."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import TYPE_CHECKING

from tuisim.engine.core.columns import Column
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.remote_spec import REMOTE_BY_HAND, REMOTE_CODES
from tuisim.engine.core.sensors.ultrasonic import find_first_hit_mm, find_surfaces
from tuisim.engine.core.spec import InfraredSpec, RunSpec, WorldSpec

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.state import Instant

PROXIMITY_RANGE_MM = 700.0
"""Distance that is 100 % proximity."""
RAY_ANGLES_DEG = (-10.0, -5.0, 0.0, 5.0, 10.0)
"""Rays of the narrow cone in which light is emitted and received."""
SEEK_RANGE_MM = 2000.0
"""Distance of a beacon that reads 100 %; farther beacons are not found."""
SEEK_ANGLE_DEG = 100.0
"""Largest angle to the sensor's direction, to either side, at which the sensor finds a beacon."""
SEEK_STEPS = 25
"""The value of the heading that the sensor reads for a beacon at `SEEK_ANGLE_DEG`."""
NOT_FOUND = (0, -128)
"""The values of heading and distance that the sensor reads if it finds no beacon."""

_REM_A_NONE = 262
_REM_A_BUTTONS = {"top_left": 16, "bottom_left": 32, "top_right": 64, "bottom_right": 128}


def _measure_way_mm(
    place: tuple[float, float], angle_deg: float, world: WorldSpec, most_mm: float
) -> float:
    """Return how far infrared light travels before it meets a surface, at most `most_mm`.

    Args:
        place: Where the light begins: x and y in mm.
        angle_deg: The direction of the light in the world.
        world: The walls and obstacles.
        most_mm: The limit.
    """
    edges = find_surfaces(world)
    angle = math.radians(angle_deg)
    (x_mm, y_mm), cos, sin = place, math.cos(angle), math.sin(angle)
    way = find_first_hit_mm(edges.upright, edges.upright_at, (x_mm, y_mm), (cos, sin), most_mm)
    return find_first_hit_mm(edges.level, edges.level_at, (y_mm, x_mm), (sin, cos), way)


def proximity(pose: Pose, spec: InfraredSpec, world: WorldSpec) -> int:
    """Return the distance of an infrared sensor to the nearest surface ahead, 0 … 100 % of `PROXIMITY_RANGE_MM`."""
    place = world_point(pose, spec.x_mm, spec.y_mm)
    facing = pose.heading_deg + spec.angle_deg
    nearest = min(
        _measure_way_mm(place, facing + ray_deg, world, PROXIMITY_RANGE_MM)
        for ray_deg in RAY_ANGLES_DEG
    )
    return round(100 * nearest / PROXIMITY_RANGE_MM)


def seek(pose: Pose, spec: InfraredSpec, world: WorldSpec) -> tuple[int, ...]:
    """Return what an infrared sensor reads of the beacon: a heading and a distance for each of the channels 1 to 4.

    The heading is from -25 to 25, positive to the right. The distance is from 0 to 100, or -128 if there is no beacon.
    """
    beacon = world.beacon
    if beacon is None:
        return NOT_FOUND * 4
    x_mm, y_mm = world_point(pose, spec.x_mm, spec.y_mm)
    way_mm = math.hypot(beacon.x_mm - x_mm, beacon.y_mm - y_mm)
    bearing_deg = math.degrees(math.atan2(beacon.y_mm - y_mm, beacon.x_mm - x_mm))
    aside_deg = (pose.heading_deg + spec.angle_deg - bearing_deg + 180.0) % 360.0 - 180.0
    seen = NOT_FOUND
    if (
        way_mm <= SEEK_RANGE_MM
        and abs(aside_deg) <= SEEK_ANGLE_DEG
        and _measure_way_mm((x_mm, y_mm), bearing_deg, world, way_mm) >= way_mm - 1e-9
    ):
        seen = (round(SEEK_STEPS * aside_deg / SEEK_ANGLE_DEG), round(100 * way_mm / SEEK_RANGE_MM))
    return NOT_FOUND * (beacon.channel - 1) + seen + NOT_FOUND * (4 - beacon.channel)


def _find_pressed(
    channel: int, time_s: float, world: WorldSpec, by_hand: Collection[str]
) -> frozenset[str]:
    """Return the names of the buttons that are pressed on a channel of the remote control; empty if none is.

    If a user presses buttons by hand, exactly these are pressed, on every channel. Otherwise the presses in
    `world.remote` apply; if several overlap, the last one in the list.
    """
    if held := [button for name, button in REMOTE_BY_HAND.items() if name in by_hand]:
        return frozenset(held)
    for press in reversed(world.remote):
        if press.channel == channel and press.from_s <= time_s < press.until_s:
            return frozenset(press.buttons)
    return frozenset()


def remote(
    time_s: float, world: WorldSpec, by_hand: Collection[str] = ()
) -> tuple[int, int, int, int]:
    """Return the code of the pressed buttons of the remote control for channels 1 to 4; 0 if none is pressed.

    Args:
        time_s: Simulated time, which selects the presses that are part of the world.
        world: The world.
        by_hand: Names of `REMOTE_BY_HAND` that a user presses. If there are any, they are pressed on every channel, and
            the presses of the world are ignored.
    """
    button_1, two, three, four = (
        REMOTE_CODES.get(_find_pressed(channel, time_s, world, by_hand), 0)
        for channel in range(1, 5)
    )
    return button_1, two, three, four


def compute_remote_bits(time_s: float, world: WorldSpec, by_hand: Collection[str] = ()) -> int:
    """Return the remote control's buttons that are pressed on channel 1, as bits of the sensor's mode `IR-REM-A`.

    Args:
        time_s: Simulated time, which selects the presses that are part of the world.
        world: The world.
        by_hand: Names of buttons that a user presses; if there are any, the presses of the world are ignored.
    """
    pressed = _find_pressed(1, time_s, world, by_hand)
    return _REM_A_NONE + sum(_REM_A_BUTTONS.get(button, 0) for button in pressed)


def columns(spec: InfraredSpec) -> tuple[Column, ...]:
    """Return the only telemetry column of an infrared sensor: its proximity."""
    return (Column(f"{spec.name}_proximity", is_traced=True),)


def measure(spec: InfraredSpec, instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return the value of an infrared sensor's column at an instant: the proximity, 0 … 100."""
    return (float(proximity(instant.pose, spec, run.world)),)
