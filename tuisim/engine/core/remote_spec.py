"""The infrared beacon and the remote control of a world."""

from __future__ import annotations

from tuisim.base.errors import ObstacleError
from tuisim.engine.core.spec_fields import Spec, choice, number, some, spec

MAX_POSITION_MM = 10_000
"""Largest distance of a coordinate in the world from 0."""
REMOTE_BUTTONS = ("top_left", "bottom_left", "top_right", "bottom_right", "beacon")
"""Buttons of the remote control, by their names in ev3dev2."""

REMOTE_BY_HAND = {
    "remote.left_up": "top_left",
    "remote.left_down": "bottom_left",
    "remote.right_up": "top_right",
    "remote.right_down": "bottom_right",
    "remote.beacon": "beacon",
}
"""Names of the remote control's buttons for presses by hand; each of `REMOTE_BUTTONS` by its name."""

REMOTE_CHANNELS = (1, 2, 3, 4)
"""Channels of a remote control or beacon."""


@spec
class BeaconSpec(Spec):
    """An infrared beacon on the field, in world coordinates."""

    ERROR = ObstacleError
    KEY = "beacon"

    x_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")
    y_mm: float = number(-MAX_POSITION_MM, MAX_POSITION_MM, unit="mm")
    channel: int = choice(REMOTE_CHANNELS, what="channel", default=1, help="1 to 4")


@spec
class RemotePress(Spec):
    """Buttons of the remote control that are pressed for some time."""

    ERROR = ObstacleError
    KEY = "remote"

    buttons: tuple[str, ...] = some(
        REMOTE_BUTTONS,
        what="button",
        help=f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
    )
    """One or two of `REMOTE_BUTTONS`; `beacon` only alone, since the sensor cannot distinguish other combinations."""
    from_s: float = number(0, 1e9, default=0.0, unit="s", help="simulated seconds")
    until_s: float = number(0, 1e9, default=1e9, unit="s")
    channel: int = choice(REMOTE_CHANNELS, what="channel", default=1, help="1 to 4")

    def check(self) -> None:
        if frozenset(self.buttons) not in REMOTE_CODES:
            raise ObstacleError(
                f"the sensor does not report {', '.join(self.buttons) or 'no button'}",
                f"one or two of {', '.join(REMOTE_BUTTONS[:4])}, or beacon",
                key="remote.buttons",
            )
        if not self.from_s <= self.until_s:
            raise ObstacleError("ends before it begins", key="remote.until_s")


REMOTE_CODES = {
    frozenset(buttons.split("+")): code
    for code, buttons in enumerate(
        (
            "top_left",
            "bottom_left",
            "top_right",
            "bottom_right",
            "top_left+top_right",
            "top_left+bottom_right",
            "bottom_left+top_right",
            "bottom_left+bottom_right",
            "beacon",
            "top_left+bottom_left",
            "top_right+bottom_right",
        ),
        start=1,
    )
}
"""Value of the sensor for each set of buttons; 0 is none."""
