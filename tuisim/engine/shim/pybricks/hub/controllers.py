"""`Remote` and `XboxController`: they are always in reach, and have the buttons that a user presses by hand."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from math import atan2, degrees
from typing import Any, ClassVar

from tuisim.engine.core.hub_spec import CONTROLLERS, WAYS
from tuisim.engine.shim.pybricks.brick import Connected, FirmwareError, Waiting, text_of
from tuisim.engine.shim.pybricks.brick_4 import Buttons
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.hub.face import shine
from tuisim.engine.shim.pybricks.hub.parameters import Button
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.unsupported.modules import Hardware, refused_part

RAW = Hardware("the raw report of a game controller", "use its joysticks, triggers and buttons")
FULL = 100
"""How far, in percent, a pressed stick or trigger is moved: a key press of the user moves it all the way."""


class Controller(Connected):
    """A remote control or game controller that is connected to the hub by radio."""

    PORT: ClassVar[str]

    _is_connected = False

    def __init__(self, name: str | None, connect: bool) -> None:
        self.brick.require_no_task()
        self._name = name or type(self).__name__
        self.buttons = Keys(self)
        if connect:
            self._set_connected(True)

    def _set_connected(self, is_connected: bool) -> None:
        self._is_connected = is_connected
        shine(Color.WHITE if is_connected else None, self.PORT)
        return wait(0)

    def check(self) -> None:
        """Check that the controller is connected.

        Raises:
            OSError: the controller is not connected.
        """
        if not self._is_connected:
            raise FirmwareError(
                errno.ENODEV, f"ENODEV:\n\nThe {type(self).__name__} is disconnected."
            )

    def connect(self) -> None:
        """Connect the controller to the hub."""
        return self._set_connected(True)

    def disconnect(self) -> None:
        """Disconnect the controller."""
        return self._set_connected(False)


class Keys(Buttons):
    """The buttons of a remote control or game controller."""

    def __init__(self, controller: Controller) -> None:
        port = controller.PORT
        known = Button.__members__
        names = {key: key.removeprefix(f"{port}.").upper() for key in CONTROLLERS[port]}
        super().__init__({key: known[name] for key, name in names.items() if name in known}, port)
        self._controller = controller

    def pressed(self) -> Any:
        """Return the pressed buttons of the controller, as members of `Button`; empty for none.

        Raises:
            OSError: the controller is not connected.
        """
        self._controller.check()
        return super().pressed()


class RemoteLight:
    """The light of a remote control."""

    def __init__(self, remote: Controller) -> None:
        self._remote = remote

    def on(self, color: Any) -> None:
        """Turn the light of the remote control on in a colour."""
        self._remote.check()
        shine(color, self._remote.PORT)

    def off(self) -> None:
        """Turn the light of the remote control off."""
        self.on(None)


class Remote(Controller):
    """The remote control of LEGO Powered Up."""

    PORT = "remote"

    def __init__(
        self, name: str | None = None, timeout: int | None = 10_000, connect: bool = True
    ) -> None:
        super().__init__(name, connect)
        self.light = RemoteLight(self)

    def name(self, name: str | None = None) -> str | None:
        """Set the name of the remote control; without an argument, return it."""
        return self.brick.finish(self._rename(name))

    def _rename(self, name: str | None) -> Waiting[str | None]:
        self.check()
        yield self.brick.command()
        if name is None:
            return self._name
        self._name = text_of(name)
        return None


class XboxController(Controller):
    """The game controller of an Xbox."""

    PORT = "xbox"
    state = refused_part("XboxController", "state", RAW)

    def __init__(
        self,
        joystick_deadzone: int = 10,
        name: str | None = None,
        timeout: int | None = 10_000,
        connect: bool = True,
        stay_connected: bool = False,
    ) -> None:
        super().__init__(name, connect)

    def _read(self, *names: str) -> list[int]:
        """Return for each key of the controller 1 if it is pressed, else 0."""
        self.check()
        self.brick.read("pressed", self.PORT)
        return [f"{self.PORT}.{name}" in self.brick.session.pressed for name in names]

    def _find_direction(self, part: str) -> tuple[int, int]:
        """Return how far a stick or the pad is pressed to the right, and up: -100, 0 or 100 percent each."""
        up, down, left, right = self._read(*(f"{part}_{way}" for way in WAYS))
        return FULL * (right - left), FULL * (up - down)

    def joystick_left(self) -> tuple[int, int]:
        """Return how far the left stick is to the right, and up, each from -100 to 100 percent."""
        return self._find_direction("joystick_left")

    def joystick_right(self) -> tuple[int, int]:
        """Return how far the right stick is to the right, and up, each from -100 to 100 percent."""
        return self._find_direction("joystick_right")

    def triggers(self) -> tuple[int, int]:
        """Return how far the left and the right trigger are pressed, in percent."""
        left, right = self._read("lt", "rt")
        return FULL * left, FULL * right

    def dpad(self) -> int:
        """Return the direction in which the pad is pressed: 0 for none, then 1 to 8 clockwise from the top."""
        right, up = self._find_direction("dpad")
        return round(degrees(atan2(right, up)) / 45) % 8 + 1 if right or up else 0

    def profile(self) -> int:
        """Return the chosen profile of buttons: always 0, as a controller without profiles does."""
        self.check()
        return 0

    def name(self) -> str:
        """Return the name of the controller."""
        return self._name

    def rumble(
        self,
        power: int | Sequence[int] = 100,
        duration: int = 200,
        count: int = 1,
        delay: int = 100,
    ) -> None:
        """Do nothing: the vibrations of the controller are not shown."""
        self.check()
        self.brick.command()
