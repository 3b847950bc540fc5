"""What the hub shows: its status light and the 5×5 matrix, as LEDs that are recorded."""

from __future__ import annotations

import _thread
from collections.abc import Callable, Sequence
from typing import Any

from tuisim.engine.core.profile import MS, NS_PER_S
from tuisim.engine.runs.brick_state import HUB_LIGHT_NAMES, PIXEL_NAMES, SIDE_PIXELS, build_led_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.leds import MAX_BRIGHTNESS
from tuisim.engine.shim.pybricks.brick import Connected, whole

Pixels = tuple[int, ...]
"""Brightness of the 25 pixels in percent, row by row from the top."""
DARK: Pixels = (0,) * SIDE_PIXELS**2


class Face(Connected):
    """The LEDs of the hub."""

    def __init__(self) -> None:
        self._levels: dict[str, int] = dict.fromkeys((*HUB_LIGHT_NAMES, *PIXEL_NAMES), 0)

    def shine(self, red: int, green: int, blue: int) -> None:
        """Show a colour on the status light; channels are 0 to 255."""
        self._show(dict(zip(HUB_LIGHT_NAMES, (red, green, blue), strict=True)))

    def draw(self, pixels: Pixels) -> None:
        """Show a picture on the matrix."""
        levels = (max(0, min(100, value)) * MAX_BRIGHTNESS // 100 for value in pixels)
        self._show(dict(zip(PIXEL_NAMES, levels, strict=True)))

    def _show(self, levels: dict[str, int]) -> None:
        self.brick.session.command()
        levels = {**self._levels, **levels}
        if levels != self._levels:
            self._levels = levels
            self.brick.session.show(build_led_row(levels), Stream.LED)


class Animation:
    """Frames that are shown one after another in the background, until the next ones."""

    def __init__(self) -> None:
        self._number = 0

    def stop(self) -> None:
        """Show no further frame."""
        self._number += 1

    def play(self, show: Callable[[Any], None], frames: Sequence[tuple[Any, int]]) -> None:
        """Show frames again and again.

        Args:
            show: Shows a frame.
            frames: Each with the time in ms that it stays.

        Raises:
            ValueError: there is no frame, or one has no time.
        """
        if not frames or any(whole(time) <= 0 for _, time in frames):
            raise ValueError("Invalid argument")
        self._number += 1
        _thread.start_new_thread(self._keep_on, (self._number, show, frames))

    def _keep_on(
        self, number: int, show: Callable[[Any], None], frames: Sequence[tuple[Any, int]]
    ) -> None:
        # A lock that is never released: waiting on it does not count as a program line that spends time.
        alarm = _thread.allocate_lock()
        alarm.acquire()
        while number == self._number:
            for frame, time in frames:
                if number != self._number:
                    return
                show(frame)
                alarm.acquire(True, whole(time) * MS / NS_PER_S)


class Light:
    """The status light."""

    def __init__(self, face: Face) -> None:
        self._face, self._animation = face, Animation()

    def on(self, color: Any) -> None:
        """Turn it on in a colour."""
        self._animation.stop()
        self._shine(color)

    def off(self) -> None:
        """Turn it off."""
        self._animation.stop()
        self._face.shine(0, 0, 0)

    def blink(self, color: Any, durations: Sequence[int]) -> None:
        """Blink in a colour: durations in ms, on and off in turn."""
        shown = [color if at % 2 == 0 else None for at in range(len(durations))]
        self._animation.play(self._shine, [*zip(shown, durations, strict=True)])

    def animate(self, colors: Sequence[Any], interval: int) -> None:
        """Show colours one after another, each for a time in ms."""
        self._animation.play(self._shine, [(color, interval) for color in colors])

    def _shine(self, color: Any) -> None:
        self._face.shine(*((0, 0, 0) if color is None else color.rgb))
