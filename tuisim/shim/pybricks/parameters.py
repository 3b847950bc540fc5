"""The enumerations of `pybricks.parameters`."""

from __future__ import annotations

from enum import Enum


class _Named(Enum):
    """Members are shown as the firmware shows them."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}.{self.name}"

    __str__ = __repr__


class Port(_Named):
    """The ports of the brick."""

    A, B, C, D = map(ord, "ABCD")
    S1, S2, S3, S4 = map(ord, "1234")

    @property
    def device_port(self) -> str:
        """The kernel's short name of the port, such as `outA`."""
        return f"in{self.name[1]}" if self.name.startswith("S") else f"out{self.name}"


class Stop(_Named):
    """What a motor does after a move."""

    COAST, BRAKE, HOLD = range(3)


class Direction(_Named):
    """The direction that counts as positive."""

    CLOCKWISE, COUNTERCLOCKWISE = range(2)

    @property
    def sign(self) -> int:
        """1 or -1."""
        return 1 if self is Direction.CLOCKWISE else -1


class Button(_Named):
    """Buttons of the brick and of the infrared remote."""

    LEFT_DOWN, DOWN, RIGHT_DOWN, LEFT, CENTER, RIGHT, LEFT_UP, UP, RIGHT_UP = range(1, 10)
    BEACON = 8


class Color(_Named):
    """Colours of the sensor, the light and the screen."""

    BLACK, BLUE, GREEN, YELLOW, RED, WHITE, BROWN, ORANGE, PURPLE = range(1, 10)


class Align(_Named):
    """Where version 1.0 shows an image."""

    BOTTOM_LEFT, BOTTOM, BOTTOM_RIGHT, LEFT, CENTER, RIGHT, TOP_LEFT, TOP, TOP_RIGHT = range(1, 10)
