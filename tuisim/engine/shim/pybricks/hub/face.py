"""What the hub shows: its status light and the 5×5 matrix, as LEDs that are recorded."""

from __future__ import annotations

from tuisim.engine.runs.brick_state import HUB_LIGHT_NAMES, PIXEL_NAMES, SIDE_PIXELS, build_led_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.leds import MAX_BRIGHTNESS
from tuisim.engine.shim.pybricks.brick import Connected
from tuisim.engine.shim.pybricks.brick_4 import AnimatedLight

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


class Light(AnimatedLight):
    """The status light."""

    def __init__(self, face: Face) -> None:
        super().__init__(lambda color: face.shine(*((0, 0, 0) if color is None else color.rgb)))
