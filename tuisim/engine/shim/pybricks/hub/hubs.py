"""The hubs of `pybricks.hubs`: what they have of lights, buttons, speaker, battery and system."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, ClassVar

from tuisim.engine.runs.readings import HUB_BUTTONS_PORT
from tuisim.engine.shim.pybricks import hubs
from tuisim.engine.shim.pybricks.brick import Connected
from tuisim.engine.shim.pybricks.brick_4 import AnimatedLight, Speaker, System
from tuisim.engine.shim.pybricks.hub.display import Display, Menu
from tuisim.engine.shim.pybricks.hub.face import Face
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
"""By the name of the button in the session."""
FULL_MV = 8190
"""From this voltage on a charged battery is shown as full."""


class Buttons(Connected):
    """Buttons that a hand presses.

    Args:
        buttons: They, by their names in the session.
        port: Where they are, one of `READING_PORTS`.
    """

    def __init__(self, buttons: Mapping[str, Button], port: str = HUB_BUTTONS_PORT) -> None:
        self._buttons = buttons
        self._place = port

    def pressed(self) -> set[Button]:
        """Return the pressed buttons."""
        self.brick.read("pressed", self._place)
        names = self.brick.session.pressed & self._buttons.keys()
        return {self._buttons[name] for name in names}


class Battery(hubs.Battery):
    """The battery, which can be charged."""

    temperature = refused_part(
        "Battery", "temperature", Hardware("the temperature of the battery", "it stays as it is")
    )

    def type(self) -> str:
        """Return its type."""
        return "Li-ion"


class Charger(Connected):
    """The charger, which is not connected."""

    def connected(self) -> bool:
        """Return whether it is connected."""
        return False

    def status(self) -> int:
        """Return its state: it does not charge."""
        return 0

    def current(self) -> int:
        """Return its current in mA."""
        return 0


class Hub(Connected):
    """Any hub."""

    BUTTONS: tuple[str, ...] = ("enter",)
    SENSES: ClassVar[type[Accelerometer]] = IMU
    ble = refused_part("PrimeHub", "ble", RADIO)

    def __init__(
        self,
        top_side: Any = None,
        front_side: Any = None,
        broadcast_channel: int | None = None,
        observe_channels: Iterable[int] = (),
    ) -> None:
        self.brick.command()
        self.imu = self.SENSES(
            Axis.Z if top_side is None else top_side, Axis.X if front_side is None else front_side
        )
        self._face = Face()
        self.brick.stop_buttons = frozenset({"enter"})
        self.light = AnimatedLight(self._face.shine)
        self.battery, self.system = Battery(), System(type(self).__name__, BUTTON_NAMES)
        self.buttons = self.button = Buttons({name: BUTTON_NAMES[name] for name in self.BUTTONS})


class PrimeHub(Hub):
    """The hub of SPIKE Prime, and of the Robot Inventor."""

    BUTTONS = tuple(BUTTON_NAMES)

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        # Only a hub with a single button has it by this name, too.
        del self.button
        self.speaker, self.charger = Speaker(), Charger()
        self.display = Display(self._face)
        Menu(self.display)


class EssentialHub(Hub):
    """The hub of SPIKE Essential."""

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        self.charger = Charger()


class TechnicHub(Hub):
    """The hub of Technic sets."""


class CityHub(Hub):
    """The hub of trains, which has no gyro."""

    def __init__(self, *given: Any, **named: Any) -> None:
        super().__init__(*given, **named)
        del self.imu


class MoveHub(Hub):
    """The hub of BOOST, which has no gyro."""

    SENSES = Accelerometer


CLASSES: Mapping[str, type[Hub]] = {
    "PrimeHub": PrimeHub,
    "InventorHub": PrimeHub,
    "EssentialHub": EssentialHub,
    "TechnicHub": TechnicHub,
    "CityHub": CityHub,
    "MoveHub": MoveHub,
}
"""By the name of `RobotSpec.hub`."""
