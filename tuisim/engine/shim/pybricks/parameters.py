"""The enumerations of `pybricks.parameters`."""

from __future__ import annotations

from enum import Enum
from typing import Any, TypeVar

Members = TypeVar("Members", bound=type[Enum])


def shown_by_name(members: Members) -> Members:
    """Let members of an enumeration be printed as the firmware does, such as `Port.A`; return the enumeration."""

    def shown(self: Enum) -> str:
        return f"{type(self).__name__}.{self.name}"

    members.__repr__ = members.__str__ = shown  # type: ignore[assignment, method-assign]
    return members


class AnyPort(Enum):
    """The ports of a brick or a hub."""

    @property
    def device_port(self) -> str:
        """The name of the port in a robot."""
        return self.name


def find_port(port: Any) -> str:
    """Return the name of a port in a robot.

    Raises:
        TypeError: it is no port.
    """
    if not isinstance(port, AnyPort):
        raise TypeError(f"a Port is needed, not {type(port).__name__}")
    return port.device_port


@shown_by_name
class Port(AnyPort):
    """The ports of the brick."""

    A, B, C, D = map(ord, "ABCD")
    S1, S2, S3, S4 = map(ord, "1234")

    @property
    def device_port(self) -> str:
        """The kernel's short name of the port, such as `outA`."""
        return f"in{self.name[1]}" if self.name.startswith("S") else f"out{self.name}"


@shown_by_name
class Stop(Enum):
    """What a motor does after a move."""

    COAST, BRAKE, HOLD = range(3)


@shown_by_name
class Direction(Enum):
    """The direction that counts as positive."""

    CLOCKWISE, COUNTERCLOCKWISE = range(2)

    @property
    def sign(self) -> int:
        """1 or -1."""
        return 1 if self is Direction.CLOCKWISE else -1


@shown_by_name
class Button(Enum):
    """Buttons of the brick and of the infrared remote."""

    LEFT_DOWN, DOWN, RIGHT_DOWN, LEFT, CENTER, RIGHT, LEFT_UP, UP, RIGHT_UP = range(1, 10)
    BEACON = 8


@shown_by_name
class Color(Enum):
    """Colours of the sensor, the light and the screen."""

    BLACK, BLUE, GREEN, YELLOW, RED, WHITE, BROWN, ORANGE, PURPLE = range(1, 10)


@shown_by_name
class Align(Enum):
    """Where version 1.0 shows an image."""

    BOTTOM_LEFT, BOTTOM, BOTTOM_RIGHT, LEFT, CENTER, RIGHT, TOP_LEFT, TOP, TOP_RIGHT = range(1, 10)
