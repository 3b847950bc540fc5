"""The hubs that a robot can have in place of the EV3: their ports and their motors."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from tuisim.base.errors import RobotError


class HubKind(NamedTuple):
    """The ports of one kind of hub, and its usual motor."""

    ports: str
    """The hub's ports, for motors and sensors alike."""
    motor: str
    """The kind of motor that is usual with this hub, one of `HUB_MOTORS`."""


HUB_PORTS = tuple("ABCDEF")
HUB_MOTORS = ("large-angular", "medium-angular", "small-angular", "interactive", "technic")
HUBS: Mapping[str, HubKind] = {
    "PrimeHub": HubKind("ABCDEF", "medium-angular"),
    "InventorHub": HubKind("ABCDEF", "medium-angular"),
    "EssentialHub": HubKind("AB", "small-angular"),
    "TechnicHub": HubKind("ABCD", "technic"),
    "CityHub": HubKind("AB", "technic"),
    "MoveHub": HubKind("ABCD", "interactive"),
}
"""All hubs, by the names of their classes in `pybricks.hubs`."""
HUBS_WITH_MATRIX = frozenset({"PrimeHub", "InventorHub"})
"""Hubs with a matrix of lights, a speaker, and more than one button."""
HUB_BUTTONS = ("enter", "left", "right", "up")
"""What can be pressed by hand on a hub: the centre button, and where there is a matrix three more."""
WAYS = ("up", "down", "left", "right")
CONTROLLERS: Mapping[str, tuple[str, ...]] = {
    "remote": (
        *("remote.left_plus", "remote.left", "remote.left_minus", "remote.center"),
        *("remote.right_plus", "remote.right", "remote.right_minus"),
    ),
    "xbox": tuple(
        f"xbox.{name}"
        for name in (
            *(f"joystick_left_{way}" for way in WAYS),
            *("a", "b", "x", "y", "lb", "rb", "lt", "rt"),
            *(f"joystick_right_{way}" for way in WAYS),
            *(f"dpad_{way}" for way in WAYS),
            *("view", "menu", "guide", "upload", "lj", "rj", "p1", "p2", "p3", "p4"),
        )
    ),
}
"""What can be pressed by hand on a remote control and on a game controller, by what stands for their port."""
EV3_MOTORS = ("large", "medium")
INSIDE = "inside"
"""Stands for the port of a gyro that is inside the hub."""


def check_motor_kinds(hub: str, kinds: Mapping[str, str]) -> None:
    """Check that a hub can have motors of these kinds.

    Args:
        hub: One of `HUBS`; empty for the EV3.
        kinds: The kind of each motor, by the key in the robot file that gives it; errors name this key.

    Raises:
        RobotError: the hub has no such kind of motor.
    """
    for key, kind in kinds.items():
        require_one_of(kind, "kind of motor", HUB_MOTORS if hub else EV3_MOTORS, key)


def find_touch_keys(ports: Sequence[str]) -> dict[str, str]:
    """Return the port of each touch sensor by the digit key that presses the sensor.

    The digit of `in1` is 1. Ports that are letters get 1, 2, 3 … in the given order.
    """
    return {port[2:] or str(number): port for number, port in enumerate(ports, 1)}


def require_one_of(value: object, what: str, allowed: Iterable[object], key: str) -> None:
    """Check that a value is one of `allowed`.

    Args:
        value: Value to check; a bool is not a number.
        what: What the value is, such as `port`.
        allowed: All allowed values.
        key: Name of the value in the error.

    Raises:
        RobotError: the check failed.
    """
    allowed = tuple(allowed)
    if value not in allowed or isinstance(value, bool):
        raise RobotError(
            f"no such {what} {reprlib.repr(value)}",
            f"one of {', '.join(map(str, allowed))}",
            key=key,
        )
