"""Optional parts of a robot or a world: extra motors, touch, infrared, remote control.

Lengths are in mm in the robot's own frame (x right, y forward) unless stated otherwise, times in
simulated seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

from tuisim.errors import ObstacleError, require, require_one_of

MOTOR_KINDS = ("large", "medium")
"""Kinds of motors, for `MotorSpec.kind` and the wheel motors."""

REMOTE_BUTTONS = ("top_left", "bottom_left", "top_right", "bottom_right", "beacon")
"""Buttons of the remote control, by their names in ev3dev2."""

REMOTE_CHANNELS = (1, 2, 3, 4)
"""Channels of a remote control or beacon."""


@dataclass(frozen=True, slots=True)
class MotorSpec:
    """A motor on a port."""

    port: str
    kind: str = "medium"
    """One of `MOTOR_KINDS`."""

    def __post_init__(self) -> None:
        require_one_of(self.kind, "kind of motor", MOTOR_KINDS, "motors")


@dataclass(frozen=True, slots=True)
class TouchSpec:
    """A touch sensor: pressed while its bumper touches an obstacle or a wall."""

    name: str = "touch"
    port: str = "in1"
    x_mm: float = 0.0
    y_mm: float = 45.0
    width_mm: float = 20.0
    """Width of the bumper, across the robot."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        require(self.width_mm, 1, 500, f"{self.name}.width_mm")


@dataclass(frozen=True, slots=True)
class InfraredSpec:
    """The infrared sensor: proximity, direction and distance of a beacon, buttons of a remote control."""

    name: str = "infrared"
    port: str = "in4"
    x_mm: float = 0.0
    y_mm: float = 20.0
    angle_deg: float = 0.0
    """Direction, counter-clockwise from straight ahead."""

    def __post_init__(self) -> None:
        require(self.x_mm, -500, 500, f"{self.name}.x_mm")
        require(self.y_mm, -500, 500, f"{self.name}.y_mm")
        require(self.angle_deg, -360, 360, f"{self.name}.angle_deg")


@dataclass(frozen=True, slots=True)
class BeaconSpec:
    """An infrared beacon on the field, in world coordinates."""

    x_mm: float
    y_mm: float
    channel: int = 1

    def __post_init__(self) -> None:
        require(self.x_mm, -10_000, 10_000, "beacon.x_mm", ObstacleError)
        require(self.y_mm, -10_000, 10_000, "beacon.y_mm", ObstacleError)
        require_one_of(self.channel, "channel", REMOTE_CHANNELS, "beacon.channel", ObstacleError)


@dataclass(frozen=True, slots=True)
class RemotePress:
    """Buttons of the remote control that are pressed for some time."""

    buttons: tuple[str, ...]
    """One or two of `REMOTE_BUTTONS`; `beacon` only alone, since the sensor cannot distinguish other combinations."""
    from_s: float = 0.0
    until_s: float = 1e9
    channel: int = 1

    def __post_init__(self) -> None:
        if frozenset(self.buttons) not in REMOTE_CODES:
            raise ObstacleError(
                f"the sensor cannot tell {', '.join(self.buttons) or 'no button'}",
                f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
                key="remote.buttons",
            )
        if not self.from_s <= self.until_s:
            raise ObstacleError("ends before it begins", key="remote.until_s")
        require_one_of(self.channel, "channel", REMOTE_CHANNELS, "remote.channel", ObstacleError)


REMOTE_CODES = {
    frozenset(buttons): code
    for code, buttons in enumerate(
        (
            (),
            ("top_left",),
            ("bottom_left",),
            ("top_right",),
            ("bottom_right",),
            ("top_left", "top_right"),
            ("top_left", "bottom_right"),
            ("bottom_left", "top_right"),
            ("bottom_left", "bottom_right"),
            ("beacon",),
            ("top_left", "bottom_left"),
            ("top_right", "bottom_right"),
        )
    )
    if buttons
}
"""Value of the sensor for each set of buttons; 0 is none."""
