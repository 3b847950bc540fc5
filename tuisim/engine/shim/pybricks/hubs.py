"""`EV3Brick` of `pybricks.hubs`: buttons, light, battery, speaker and screen."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any, ClassVar

from tuisim.engine.runs.readings import BUTTONS_PORT
from tuisim.engine.shim.leds import MAX_BRIGHTNESS
from tuisim.engine.shim.pybricks.brick import Connected, refused
from tuisim.engine.shim.pybricks.image import THE_SCREEN, Image
from tuisim.engine.shim.pybricks.parameters import Button
from tuisim.engine.shim.pybricks.speaker import Speaker

BUTTON_NAMES: Mapping[str, Button] = {
    "enter": Button.CENTER,
    "left": Button.LEFT,
    "right": Button.RIGHT,
    "up": Button.UP,
    "down": Button.DOWN,
    "backspace": Button.LEFT_UP,
}
"""The brick's buttons, by their names in `DeviceSession.pressed`, in the order in which `pressed` lists them."""
LIGHTS: Mapping[str, tuple[int, int]] = {
    "RED": (MAX_BRIGHTNESS, 0),
    "ORANGE": (MAX_BRIGHTNESS, MAX_BRIGHTNESS),
    "YELLOW": (30, MAX_BRIGHTNESS),
    "GREEN": (0, MAX_BRIGHTNESS),
}
"""Brightness, 0 to 255, of the red and the green LED for each colour by name; any other colour turns the light off."""


class Buttons(Connected):
    """Buttons of the brick or of another device that the user presses.

    Args:
        buttons: The buttons by their names in the session.
        place: Where they are, one of `READING_PORTS`.
    """

    def __init__(
        self, buttons: Mapping[str, Enum] = BUTTON_NAMES, place: str = BUTTONS_PORT
    ) -> None:
        self._buttons, self._place = buttons, place

    COLLECT: ClassVar[type[Any]] = list
    """The type of the collection in which `pressed` returns buttons: a list, or a set under version 4."""

    def pressed(self) -> Any:
        """Return the buttons that are pressed now, as members of `Button`; empty for none."""
        self.brick.read("pressed", self._place)
        pressed = self.brick.session.pressed
        return self.COLLECT(button for name, button in self._buttons.items() if name in pressed)


class Light(Connected):
    """The light around the brick's buttons."""

    def on(self, color: Enum | None, brightness: int = 100) -> None:
        """Turn the light around the brick's buttons on in a colour; None turns it off."""
        if brightness != 100:
            raise refused("the light of the EV3 has one brightness")
        self._shine(*LIGHTS.get(color.name, (0, 0)) if color is not None else (0, 0))

    def off(self) -> None:
        """Turn the light around the brick's buttons off."""
        self._shine(0, 0)

    def _shine(self, red: int, green: int) -> None:
        self.brick.command()
        lights = self.brick.built.lights
        lights.shine({name: red if name.endswith("red") else green for name in lights.lights})


class Battery(Connected):
    """The battery of the brick, whose voltage and current a program can read."""

    def voltage(self) -> int:
        """Return the voltage of the brick's battery in mV."""
        self.brick.read()
        return round(1000 * self.brick.built.battery.voltage_v())

    def current(self) -> int:
        """Return the current that the brick's battery supplies, in mA."""
        self.brick.read()
        return round(1000 * self.brick.built.battery.current_a())


class EV3Brick(Connected):
    """Pybricks' EV3 brick, with its buttons, light, battery, speaker and screen."""

    buttons = Buttons()
    light = Light()
    battery = Battery()
    speaker = Speaker()
    screen = Image(THE_SCREEN)
