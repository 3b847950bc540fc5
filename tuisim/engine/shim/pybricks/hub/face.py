"""What the hub shows: its status light and the 5×5 matrix, as LEDs that are recorded."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tuisim.engine.runs.brick_state import HUB_LIGHT_NAMES, PIXEL_NAMES, SIDE_PIXELS, build_led_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.leds import MAX_BRIGHTNESS
from tuisim.engine.shim.pybricks.brick import Connected

Pixels = tuple[int, ...]
"""Brightness of the 25 pixels in percent, row by row from the top."""
DARK: Pixels = (0,) * SIDE_PIXELS**2


class Face(Connected):
    """The LEDs of the hub and of the controllers that are connected to it."""

    def shine(self, color: Any, names: Sequence[str] = HUB_LIGHT_NAMES) -> None:
        """Show a colour, or darkness for None.

        Args:
            color: The colour.
            names: The LEDs: by default those of the status light.
        """
        self._show(dict(zip(names, (0, 0, 0) if color is None else color.rgb, strict=True)))

    def draw(self, pixels: Pixels) -> None:
        """Show a picture on the matrix of lights."""
        levels = (max(0, min(100, value)) * MAX_BRIGHTNESS // 100 for value in pixels)
        self._show(dict(zip(PIXEL_NAMES, levels, strict=True)))

    def _show(self, levels: dict[str, int]) -> None:
        self.brick.session.command()
        before = self.brick.led_levels or dict.fromkeys((*HUB_LIGHT_NAMES, *PIXEL_NAMES), 0)
        levels = {**before, **levels}
        if levels != before:
            self.brick.led_levels = levels
            self.brick.session.show(build_led_row(levels), Stream.LED)
