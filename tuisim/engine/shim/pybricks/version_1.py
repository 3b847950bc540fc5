"""Modules of version 1.0 that version 2.0 still has: `pybricks.ev3brick`, `pybricks.speaker`, `pybricks.display`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tuisim.engine.shim.pybricks import hubs
from tuisim.engine.shim.pybricks.brick import whole
from tuisim.engine.shim.pybricks.image import Image
from tuisim.engine.shim.pybricks.parameters import Align, Button, Color
from tuisim.engine.shim.pybricks.speaker import START_VOLUMES
from tuisim.engine.shim.pybricks.tools import wait

BEEPS_PAUSE_MS = 100
"""Silence in ms after each tone of `beeps`."""

_brick = hubs.EV3Brick()
battery = _brick.battery


class _OfBrick:
    def __init__(self, device_type: str) -> None:
        assert device_type == "EV3", "only the EV3 has it"


class Speaker(_OfBrick):
    """The speaker in version 1.0 of Pybricks. Each call gives the volume, in percent."""

    def beep(
        self, frequency: float = 500, duration: float = 100, volume: float = START_VOLUMES["Beep"]
    ) -> None:
        """Play a tone of a frequency in Hz for a duration in ms, at a volume in percent, and wait for its end."""
        _brick.speaker.set_volume(volume, "Beep")
        _brick.speaker.beep(frequency, duration)

    def beeps(self, number: float) -> None:
        """Play `number` short tones."""
        for _ in range(whole(number)):
            self.beep()
            wait(BEEPS_PAUSE_MS)

    def tune(
        self,
        frequencies_and_durations: Iterable[tuple[float, float]],
        volume: float = START_VOLUMES["Beep"],
    ) -> None:
        """Play tones, each given by a frequency in Hz and a duration in ms, at a volume in percent."""
        for frequency, duration in frequencies_and_durations:
            self.beep(frequency, duration, volume)

    def file(self, file_name: str, volume: float = START_VOLUMES["Beep"]) -> None:
        """Play a sound file, and wait for its end.

        Args:
            file_name: The path of the file, or a constant of `SoundFile`.
            volume: The volume in percent.
        """
        _brick.speaker.set_volume(volume, "PCM")
        _brick.speaker.play_file(file_name)

    def speech(self, text: str, volume: float = START_VOLUMES["Beep"]) -> None:
        """Speak a text at a volume in percent, and wait for its end."""
        _brick.speaker.set_volume(volume, "PCM")
        _brick.speaker.say(text)


class Display(_OfBrick):
    """The screen in version 1.0 of Pybricks."""

    def clear(self) -> None:
        """Make the screen white."""
        _brick.screen.clear()

    def text(self, text: Any, location: tuple[float, float] | None = None) -> None:
        """Show a line of text at a point; without a point, below the last line."""
        if location is None:
            _brick.screen.print(text)
        else:
            _brick.screen.draw_text(*location, text)

    def image(
        self,
        file_name: str,
        location_or_alignment: tuple[float, float] | Align = Align.CENTER,
        clear: bool = True,
    ) -> None:
        """Show an image at a point or an alignment; if `clear` is True, clear the screen first."""
        screen = _brick.screen
        source = Image(file_name)
        place = location_or_alignment
        if isinstance(place, Align):
            # The alignments are numbered like the keys of a number pad, from the bottom row up.
            row, column = divmod(place.value - 1, 3)
            place = (
                (screen.width - source.width) * column // 2,
                (screen.height - source.height) * (2 - row) // 2,
            )
        if clear:
            screen.clear()
        x, y = place
        screen.draw_image(x, y, source)


sound, display = Speaker("EV3"), Display("EV3")


def light(color: Color | None) -> None:
    """Turn the brick's light on in a colour; None turns it off."""
    _brick.light.on(color)


def buttons() -> list[Button]:
    """Return the brick's pressed buttons; an empty list if none is pressed."""
    return [*_brick.buttons.pressed()]
