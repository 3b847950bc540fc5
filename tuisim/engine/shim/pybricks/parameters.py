"""The enumerations of `pybricks.parameters`."""

from __future__ import annotations

from enum import Enum
from typing import Any


class NamedEnum(Enum):
    """An enumeration whose members are printed as on the brick, such as `Port.A`."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}.{self.name}"

    __str__ = __repr__


class AnyPort(NamedEnum):
    """The ports of a brick or a hub."""

    @property
    def device_port(self) -> str:
        """The name of the port in the simulated robot."""
        return self.name


def find_port(port: Any) -> str:
    """Return the name that a port has in the simulated robot.

    Raises:
        TypeError: it is not a port.
    """
    if not isinstance(port, AnyPort):
        raise TypeError(f"a Port is needed, not {type(port).__name__}")
    return port.device_port


class Port(AnyPort):
    """The ports of the brick."""

    A, B, C, D = map(ord, "ABCD")
    S1, S2, S3, S4 = map(ord, "1234")

    @property
    def device_port(self) -> str:
        """The kernel's short name of the port, such as `outA`."""
        return f"in{self.name[1]}" if self.name.startswith("S") else f"out{self.name}"


class Stop(NamedEnum):
    """What a motor does after a move."""

    COAST, BRAKE, HOLD = range(3)


class Direction(NamedEnum):
    """The direction of a motor in which its angle increases."""

    CLOCKWISE, COUNTERCLOCKWISE = range(2)

    @property
    def sign(self) -> int:
        """1 if the motor's angle increases clockwise, -1 if it increases counter-clockwise."""
        return 1 if self is Direction.CLOCKWISE else -1


class Button(NamedEnum):
    """Buttons of the brick and of the infrared remote."""

    LEFT_DOWN, DOWN, RIGHT_DOWN, LEFT, CENTER, RIGHT, LEFT_UP, UP, RIGHT_UP = range(1, 10)
    BEACON = 8


class Color(NamedEnum):
    """Colours of the colour sensor, the brick's light and the screen."""

    BLACK, BLUE, GREEN, YELLOW, RED, WHITE, BROWN, ORANGE, PURPLE = range(1, 10)


class Align(NamedEnum):
    """Places on the screen at which version 1.0 shows an image."""

    BOTTOM_LEFT, BOTTOM, BOTTOM_RIGHT, LEFT, CENTER, RIGHT, TOP_LEFT, TOP, TOP_RIGHT = range(1, 10)
