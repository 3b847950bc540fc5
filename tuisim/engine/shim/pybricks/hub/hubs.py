"""The hubs of `pybricks.hubs`: their lights, buttons, speaker, battery and settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

from tuisim.engine.runs.readings import HUB_BUTTONS_PORT
from tuisim.engine.shim.pybricks.brick import Connected
from tuisim.engine.shim.pybricks.brick_4 import AnimatedLight, Battery, Buttons, Speaker, System
from tuisim.engine.shim.pybricks.hub.display import Display
from tuisim.engine.shim.pybricks.hub.face import shine
from tuisim.engine.shim.pybricks.hub.imu import IMU, Accelerometer
from tuisim.engine.shim.pybricks.hub.parameters import Button
from tuisim.engine.shim.pybricks.matrix import Axis
from tuisim.engine.shim.unsupported.modules import Hardware, refused_part

RADIO = Hardware("messages between hubs", "leave them out: there is one hub")
BUTTON_NAMES: Mapping[str, Button] = {
    "left": Button.LEFT,
    "right": Button.RIGHT,
    "enter": Button.CENTER,
    "up": Button.BLUETOOTH,
}
"""The buttons of hubs as Pybricks' `Button`, by their names in `DeviceSession.pressed`."""


class Charger(Connected):
    """The charger, which is never connected: its connection, its state and its current in mA are 0."""

    def connected(self) -> int:
        """Return 0: the charger is not connected."""
        return 0

    status = current = connected


class Hub(Connected):
    """Base class of Pybricks' hubs, with what all hubs have: a light, a battery, buttons and a system."""

    BUTTONS: tuple[str, ...] = ("enter",)
    SENSES: ClassVar[type[Accelerometer] | None] = IMU
    ble = refused_part("PrimeHub", "ble", RADIO)

    def __init__(
        self,
        top_side: Any = None,
        front_side: Any = None,
        broadcast_channel: int | None = None,
        observe_channels: Iterable[int] = (),
    ) -> None:
        self.brick.command()
        if self.SENSES is not None:
            self.imu = self.SENSES(top_side or Axis.Z, front_side or Axis.X)
        self.brick.session.stop_buttons = frozenset({"enter"})
        self.light = AnimatedLight(shine)
        self.battery, self.system = Battery(), System(type(self).__name__, BUTTON_NAMES)
        buttons = {name: BUTTON_NAMES[name] for name in self.BUTTONS}
        self.buttons = Buttons(buttons, HUB_BUTTONS_PORT)
        if len(buttons) == 1:
            self.button = self.buttons


class PrimeHub(Hub):
    """The hub of SPIKE Prime and of the Robot Inventor; it also has a speaker, a display and a charger."""

    BUTTONS = tuple(BUTTON_NAMES)
    charger = Charger()

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self.speaker = Speaker()
        self.display = Display()


class EssentialHub(Hub):
    """The hub of SPIKE Essential; it also has a charger."""

    charger = Charger()


class TechnicHub(Hub):
    """The hub of Technic sets."""


class CityHub(Hub):
    """The hub of trains, which has no gyro."""

    SENSES = None


class MoveHub(Hub):
    """The hub of BOOST, which has no gyro."""

    SENSES = Accelerometer
