"""A hub as lines of text: its matrix, its status light and its buttons, and those of what is connected to it."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from rich.color import Color
from rich.style import Style

from tuisim.app.render.brick import BrickPicture, ButtonBox, draw_bumpers, draw_keys, draw_sound
from tuisim.base import palette
from tuisim.engine.core.hub_spec import CONTROLLERS
from tuisim.engine.runs.brick_state import BrickState
from tuisim.terminal.text_runs import Run

_PLAIN = Style()
_CAPTION = Style(color=palette.LABEL)
_SYMBOLS: Final = {"left": "◀", "enter": "●", "right": "▶", "up": "B"}
"""The buttons by their names in the session, from the left; the last one is that of Bluetooth."""
_SIDES: Final = {"left": "L", "right": "R", "dpad": "D", "center": "●"}
_WAYS: Final = {
    "up": "▲",
    "down": "▼",
    "left": "◀",
    "right": "▶",
    "plus": "+",
    "minus": "-",
    "": "",
}
"""Parts of the names of their keys on the panel."""
_DARK = 60
_LIT = 255


def draw_hub(
    face: BrickState,
    pressed: Collection[str],
    width: int,
    height: int,
    bumpers: Sequence[str] = (),
    *,
    has_matrix: bool = True,
) -> BrickPicture:
    """Return the picture of a hub for a panel.

    Args:
        face: What the hub shows.
        pressed: Buttons that are held down.
        width, height: Columns and rows inside the border, at least 1. With few rows, the buttons are drawn first, then
            those of a connected remote control or game controller, the matrix, bumpers and sound as far as they fit.
        bumpers: Ports of the force sensors.
        has_matrix: Whether the hub has a matrix, and more than one button.
    """
    keys = [*_draw_controllers(face, pressed, width)][: height - 1]
    matrix = face.matrix if has_matrix else []
    lines = [_draw_pixels(row, width) for row in matrix if height > len(matrix) + len(keys)]
    names = [*_SYMBOLS] if has_matrix else ["enter"]
    line, boxes = _draw_buttons(face, pressed, names, width, len(lines))
    lines.append(line)
    for key_line, key_boxes in keys:
        boxes += tuple(replace(box, row=len(lines)) for box in key_boxes)
        lines.append(key_line)
    lamps: list[Run] = [
        (f" {port} light {round(level / 2.55)} % ", _CAPTION)
        for port, level in face.port_lights.items()
    ]
    if lamps and height > len(lines):
        lines.append(lamps)
    if bumpers and height > len(lines):
        bumper_line, more = draw_bumpers(bumpers, pressed, width, len(lines))
        lines.append(bumper_line)
        boxes += more
    if face.sound and height > len(lines):
        lines.append(draw_sound(face, width))
    return BrickPicture(lines, boxes)


def _draw_pixels(levels: Sequence[int], width: int) -> list[Run]:
    """Return one row of the hub's matrix, centred; lit pixels have another shape, too, for users without colour.

    Args:
        levels: The brightness of each pixel, from 0 to 255.
        width: Columns of the panel.
    """
    line: list[Run] = [(" " * max(0, (width - 3 * len(levels)) // 2), _PLAIN)]
    for level in levels:
        shade = round(_DARK + (_LIT - _DARK) * level / 255)
        color = Color.from_rgb(shade, shade, shade if level < 1 else round(0.85 * shade))
        line.append((" ■ " if level else " · ", Style(color=color)))
    return line


def _draw_buttons(
    face: BrickState, pressed: Collection[str], names: Sequence[str], width: int, row: int
) -> tuple[list[Run], tuple[ButtonBox, ...]]:
    """Return a row with the hub's buttons between two pieces of its status light, and the cells of each button."""
    light = "   ", _build_light(face.find_light())
    first = max(0, (width - 4 * len(names) - 7) // 2)
    labels = {name: f" {_SYMBOLS[name]} " for name in names}
    keys, boxes = draw_keys(labels, pressed, first + 4, row)
    gap = " ", _PLAIN
    return [(" " * first, _PLAIN), light, gap, *keys, gap, light], boxes


def _build_light(levels: Iterable[int]) -> Style:
    """Return the style of a light, given its red, green and blue levels, each from 0 to 255."""
    return Style(bgcolor=Color.from_rgb(*(max(_DARK // 2, level) for level in levels)))


def _draw_controllers(
    face: BrickState, pressed: Collection[str], width: int
) -> Iterator[tuple[list[Run], tuple[ButtonBox, ...]]]:
    """Yield the rows of the connected controllers: the light and the keys of each, and the cells of the keys."""
    for port, port_keys in CONTROLLERS.items():
        levels = face.find_light(port)
        if not levels:
            continue
        rows = [dict[str, str]()]
        for key in port_keys:
            side, _, way = key.removeprefix(f"{port}.").removeprefix("joystick_").partition("_")
            label = f" {_SIDES.get(side, side.upper())}{_WAYS[way]} "
            if rows[-1] and len(" ".join((" ", *rows[-1].values(), label))) > width:
                rows.append({})
            rows[-1][key] = label
        for labels in rows:
            keys, boxes = draw_keys(labels, pressed, 2, 0)
            yield [(" ", _build_light(levels)), (" ", _PLAIN), *keys], boxes
