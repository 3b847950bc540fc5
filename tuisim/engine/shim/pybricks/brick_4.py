"""The parts that each hub of version 4 has, such as a light, a speaker and settings, and `EV3Brick` of that version."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from enum import Enum
from typing import Any

from tuisim.engine.core.profile import MS
from tuisim.engine.shim.pybricks import hubs
from tuisim.engine.shim.pybricks.animation import Animation
from tuisim.engine.shim.pybricks.brick import Connected, whole
from tuisim.engine.shim.pybricks.hsv_color import Color
from tuisim.engine.shim.pybricks.speaker import TonePlayer
from tuisim.engine.shim.pybricks.tools import wait
from tuisim.engine.shim.sound import Loudspeaker
from tuisim.engine.shim.tones import Heard, Tone
from tuisim.engine.shim.unsupported.modules import Hardware, refused_part

HUES: Mapping[int, str] = {15: "RED", 45: "ORANGE", 90: "YELLOW", 180: "GREEN", 330: "", 360: "RED"}
"""The colour that the brick's light shows for a range of hues, by the range's highest hue in degrees; empty where the
light stays dark.
"""


class AnimatedLight:
    """A light that can blink and change its colour in the background.

    Args:
        show: Shows the light in a colour; for None, it turns the light off.
    """

    def __init__(self, show: Callable[[Any], None]) -> None:
        self._show, self._animation = show, Animation()

    def on(self, color: Any) -> None:
        """Turn the light on in a colour, or in the nearest one that the light has."""
        self._animation.stop()
        self._show(color)

    def off(self) -> None:
        """Turn the light off."""
        self.on(None)

    def blink(self, color: Any, durations: Sequence[int]) -> None:
        """Let the light blink in a colour, in the background.

        Args:
            color: The colour.
            durations: Times in ms for which the light is on and off, in turn; they are repeated.
        """
        frames = [(None if number % 2 else color, time) for number, time in enumerate(durations)]
        self._animation.play(self._show, frames)

    def animate(self, colors: Sequence[Any], interval: int) -> None:
        """Show colours one after another, each for `interval` ms, again and again in the background."""
        self._animation.play(self._show, [(color, interval) for color in colors])


class Speaker(TonePlayer):
    """The speaker of a brick or hub under version 4 of Pybricks, whose `volume` a program can set and read."""

    _volume = 100

    def volume(self, volume: int | None = None) -> int | None:
        """Set the volume in percent, and return None; without an argument, return the volume."""
        if volume is None:
            return self._volume
        self.brick.command()
        self._volume = max(0, min(100, whole(volume)))
        return None

    def _play(self, heard: Heard) -> Any:
        play = Loudspeaker(self.brick.session).play
        play(heard, 0)
        sounding: Any = wait(heard.length_ns // MS)
        if sounding is not None:
            sounding.stop = lambda: play(Heard("[silence]", 0, (Tone(0.0, 0.0),)), 0)
        return sounding


class System(Connected):
    """The settings of the hub itself: its name, its stop buttons and its storage.

    Args:
        name: The name of the hub.
        buttons: The buttons of the hub by their names in the session.
    """

    umm_info = refused_part(
        "System", "umm_info", Hardware("the hub's memory", "gc.mem_free() tells")
    )

    def __init__(self, name: str, buttons: Mapping[str, Enum]) -> None:
        self._name, self._stored = name, bytearray(512)
        self._session_names = {button: name for name, button in buttons.items()}

    def set_stop_button(self, button: Any) -> None:
        """Choose the button, or buttons pressed together, that stop the program; None for no button."""
        buttons = [button] if isinstance(button, Enum) else button or ()
        names = frozenset(self._session_names[pressed] for pressed in buttons)
        self.brick.session.stop_buttons = names

    def name(self) -> str:
        """Return the name of the hub."""
        return self._name

    def info(self) -> dict[str, Any]:
        """Return what the firmware reports of the hub: its name, causes of reset and start, and who is connected."""
        return {
            "name": self._name,
            "reset_reason": 0,
            "host_connected_ble": False,
            "host_connected_usb": False,
            "program_id": 0,
            "program_start_type": 1,
        }

    def storage(
        self, offset: int, *, read: int | None = None, write: bytes | None = None
    ) -> bytes | None:
        """Return `read` bytes of the storage from `offset` on; or write the bytes `write` there, and return None.

        The bytes stay when the program ends.

        Raises:
            TypeError: the program gives both `read` and `write`, or neither.
        """
        if read is None and write is not None:
            self._stored[offset : offset + len(write)] = write
            return None
        if write is not None:
            raise TypeError("read or write, not both")
        return bytes(self._stored[offset : offset + whole(read)])

    def reset_storage(self) -> None:
        """Set all bytes of the storage to 0."""
        self._stored = bytearray(len(self._stored))

    def shutdown(self) -> None:
        """Turn the hub off, which ends the program."""
        raise SystemExit

    def reset_reason(self) -> int:
        """Return the reason why the hub was last turned off: always 0, the usual one."""
        return 0


class Buttons(hubs.Buttons):
    """The buttons of a hub or a controller under version 4 of Pybricks, which returns pressed buttons as a set."""

    COLLECT = set


class Battery(hubs.Battery):
    """The rechargeable battery of a brick under version 4 of Pybricks, which also tells its type."""

    temperature = refused_part(
        "Battery", "temperature", Hardware("the temperature of the battery", "it stays as it is")
    )

    def type(self) -> str:
        """Return the type of the battery: always `Li-ion`."""
        return "Li-ion"


class Light(AnimatedLight, hubs.Light):  # type: ignore[misc]
    """The light around the buttons, which has four colours."""

    def __init__(self) -> None:
        super().__init__(self._show_nearest)

    def _show_nearest(self, color: Color | None) -> None:
        if color is None or color.v <= 0 or not color.s:
            self._shine(0, 0)
            return
        name = next(name for hue, name in HUES.items() if color.h <= hue)
        self._shine(*hubs.LIGHTS.get(name, (0, 0)))


class EV3Brick(hubs.EV3Brick):
    """The EV3 brick under version 4 of Pybricks: its parts have the methods of that version, and it has a `system`."""

    buttons = Buttons()
    battery = Battery()
    light = Light()
    speaker = Speaker()  # type: ignore[assignment]
    system = System("EV3", hubs.BUTTON_NAMES)
