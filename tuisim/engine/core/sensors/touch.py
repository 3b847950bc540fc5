"""Touch sensor: pressed while its bumper touches an obstacle or a wall, by a motor at its end stop, or by hand."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from tuisim.engine.core.columns import Column
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.hub_spec import HUB_PORTS
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    INPUT_PORTS,
    TOUCH,
    RunSpec,
    TouchSpec,
    WorldSpec,
)
from tuisim.engine.core.state import end_flag
from tuisim.engine.core.tick_record import FLAG_FIRST_HAND

if TYPE_CHECKING:
    from tuisim.engine.core.field import Field
    from tuisim.engine.core.state import Instant

_PORTS_OF_FLAG = tuple(
    frozenset((port, *HUB_PORTS[number :: len(INPUT_PORTS)]))
    for number, port in enumerate(INPUT_PORTS)
)
"""The ports of each flag: of a hub's six ports, A and E share one, and so do B and F."""
REACH_MM = 2.0
"""Distance of an obstacle at which a bumper reacts: the bumper yields before the obstacle stops the robot."""


def pressed(pose: Pose, spec: TouchSpec, world: WorldSpec) -> bool:
    """Return whether either end or the centre of a bumper touches a wall or an obstacle."""
    half = spec.width_mm / 2
    return any(
        _is_pressed(*world_point(pose, spec.x_mm + aside, spec.y_mm), world)
        for aside in (-half, 0.0, half)
    )


def _is_pressed(x_mm: float, y_mm: float, world: WorldSpec) -> bool:
    near = REACH_MM
    if world.walls and not (
        near < x_mm < FIELD_WIDTH_MM - near and near < y_mm < FIELD_HEIGHT_MM - near
    ):
        return True
    return any(
        box.x_mm - near <= x_mm <= box.x_mm + box.width_mm + near
        and box.y_mm - near <= y_mm <= box.y_mm + box.height_mm + near
        for box in world.obstacles
    )


def find_hand_flags(pressed: Collection[str]) -> int:
    """Return the flags of a tick record for the touch sensors that are pressed by hand.

    Args:
        pressed: Names of `PRESSABLE`; `TOUCH` presses the sensors on all ports.
    """
    return sum(
        FLAG_FIRST_HAND << number
        for number in range(len(INPUT_PORTS))
        if TOUCH in pressed or not _PORTS_OF_FLAG[number].isdisjoint(pressed)
    )


def columns(spec: TouchSpec) -> tuple[Column, ...]:
    """Return the only telemetry column of a touch sensor: whether it is pressed."""
    return (Column(f"{spec.name}_pressed", is_traced=True),)


def measure(spec: TouchSpec, instant: Instant, run: RunSpec, field: Field) -> tuple[float, ...]:
    """Return the value of a touch sensor's column at an instant: 1 if it is pressed, 0 if not."""
    if instant.press_flags & find_hand_flags((spec.port,)):
        return (1.0,)
    if spec.pressed_by:
        return (
            float(instant.press_flags & end_flag(run.robot, spec.pressed_by, spec.pressed_at) != 0),
        )
    return (float(pressed(instant.pose, spec, run.world)),)
