"""The names of `pybricks.parameters` that differ between a hub and the EV3."""

from __future__ import annotations

from tuisim.engine.shim.pybricks.parameters import AnyPort, NamedEnum


class Port(AnyPort):
    """The ports of the hub, for motors and sensors alike."""

    A, B, C, D, E, F = map(ord, "ABCDEF")


class Button(NamedEnum):
    """Buttons of the hub, of the remote control and of a game controller."""

    (LEFT, RIGHT, CENTER, BLUETOOTH, LEFT_PLUS, LEFT_MINUS, RIGHT_PLUS, RIGHT_MINUS) = range(1, 9)
    (UP, DOWN, LEFT_UP, LEFT_DOWN, RIGHT_UP, RIGHT_DOWN, BEACON) = range(9, 16)
    (A, B, X, Y, LB, RB, VIEW, MENU, GUIDE, LJ, RJ, UPLOAD, P1, P2, P3, P4) = range(16, 32)
