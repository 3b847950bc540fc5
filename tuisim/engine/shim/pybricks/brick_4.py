"""`EV3Brick` of version 4: a light that blinks, a speaker with a volume, and the settings of a hub."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from tuisim.engine.shim.pybricks import hubs
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.hub import hubs as other_hubs
from tuisim.engine.shim.pybricks.hub.face import Animation
from tuisim.engine.shim.pybricks.parameters import Button

DARK = (0, 0)
HUES: Mapping[int, str] = {15: "RED", 45: "ORANGE", 90: "YELLOW", 180: "GREEN", 330: "", 360: "RED"}
"""The colour of the light for a hue, by the highest of its hues; others leave it dark."""


class Buttons(hubs.Buttons):
    """The buttons of the brick."""

    def pressed(self) -> set[Button]:  # type: ignore[override]
        """Return the pressed buttons."""
        return set(super().pressed())


class Light(hubs.Light):
    """The light around the buttons, which has four colours."""

    def __init__(self) -> None:
        self._animation = Animation()

    def on(self, color: Any) -> None:  # type: ignore[override]
        """Turn it on in the colour that is nearest."""
        self._animation.stop()
        self._show(color)

    def off(self) -> None:
        """Turn it off."""
        self._animation.stop()
        self._show(None)

    def blink(self, color: Any, durations: Sequence[int]) -> None:
        """Blink in a colour: durations in ms, on and off in turn."""
        shown = [color if at % 2 == 0 else None for at in range(len(durations))]
        self._animation.play(self._show, [*zip(shown, durations, strict=True)])

    def animate(self, colors: Sequence[Any], interval: int) -> None:
        """Show colours one after another, each for a time in ms."""
        self._animation.play(self._show, [(color, interval) for color in colors])

    def _show(self, color: Color | None) -> None:
        if color is None or color.v <= 0 or not color.s:
            self._shine(*DARK)
            return
        name = next(name for hue, name in HUES.items() if color.h <= hue)
        self._shine(*hubs.LIGHTS.get(name, DARK))


class System(other_hubs.System):
    """The settings of the brick."""

    def set_stop_button(self, button: Any) -> None:
        """Let a button, or several at once, stop the program; None: none does."""
        buttons = [] if button is None else [button] if isinstance(button, Button) else [*button]
        names = {known: name for name, known in hubs.BUTTON_NAMES.items()}
        self.brick.stop_buttons = frozenset(names[one] for one in buttons)


class EV3Brick(hubs.EV3Brick):
    """The brick."""

    buttons = Buttons()
    light = Light()
    speaker = other_hubs.Speaker()  # type: ignore[assignment]
    system = System("EV3")
