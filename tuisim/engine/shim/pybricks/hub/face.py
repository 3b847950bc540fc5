"""The LEDs of the hub, its status light and the 5×5 matrix, and those of the controllers that are connected to it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tuisim.engine.runs.brick_state import (
    LIGHT_NAMES,
    PIXEL_NAMES,
    PORT_LIGHT,
    SIDE_PIXELS,
    build_led_row,
)
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.leds import MAX_BRIGHTNESS
from tuisim.engine.shim.pybricks.brick import Connected

Pixels = tuple[int, ...]
"""Brightness of the 25 pixels in percent, row by row from the top."""
DARK: Pixels = (0,) * SIDE_PIXELS**2


def shine(color: Any, owner: str = "") -> None:
    """Show a light in a colour; None turns it off.

    Args:
        color: The colour.
        owner: Whose light shows it, one of `LIGHT_NAMES`: by default the hub's.
    """
    _show(dict(zip(LIGHT_NAMES[owner], (0, 0, 0) if color is None else color.rgb, strict=True)))


def show_pixels(pixels: Sequence[int]) -> None:
    """Show a picture on the hub's matrix of lights; `pixels` are brightness values in percent, row by row."""
    _show(dict(zip(PIXEL_NAMES, map(_convert, pixels), strict=True)))


def show_light(port: str, brightness: int) -> None:
    """Show how bright the light that is connected to a port is, in percent."""
    _show({f"{PORT_LIGHT}{port}": _convert(brightness)})


def _convert(brightness: int) -> int:
    return max(0, min(100, brightness)) * MAX_BRIGHTNESS // 100


def _show(levels: dict[str, int]) -> None:
    brick = Connected.brick
    brick.session.command()
    before = brick.led_levels or dict.fromkeys((*LIGHT_NAMES[""], *PIXEL_NAMES), 0)
    levels = {**before, **levels}
    if levels != before:
        brick.led_levels = levels
        brick.session.show(build_led_row(levels), Stream.LED)
