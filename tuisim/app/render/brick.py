"""The brick as lines of text: display, text screen, lights and buttons."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from numpy.typing import NDArray
from rich.color import Color
from rich.style import Style

from tuisim.app import design
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.engine.core.css_colors import Rgb
from tuisim.engine.core.spec import TOUCH
from tuisim.engine.runs.brick_state import (
    BrickState,
    TextScreen,
    unpack_display,
)
from tuisim.terminal.text_runs import Run

_PAPER_RGB, _INK_RGB = (172, 186, 158), (22, 28, 20)
_PAPER = Style(color=Color.from_rgb(*_INK_RGB), bgcolor=Color.from_rgb(*_PAPER_RGB))
_INVERSE = Style(color=Color.from_rgb(*_PAPER_RGB), bgcolor=Color.from_rgb(*_INK_RGB))
_PLAIN = Style()
_CAPTION = Style(color=palette.LABEL)
_BUTTON = Style(color=design.LIGHT, bgcolor=design.BUTTON, bold=True)
_PRESSED = Style(color=palette.BLACK, bgcolor=design.PRESSED, bold=True)
_DARK_LED_RGB = (48, 48, 48)

HALF_BLOCK_SCALE = 0.7
"""From this scale on, the display is drawn in half blocks; below it in dots, which keep twice the detail."""

_SHADES = 5
"""Shades between paper and ink for half blocks: more would only cost bytes."""

_DOT_SHARE = 0.25
_LINE_PX = 0.5
"""A dot is dark if at least this share of its area is dark, or as much as a line of this width darkens, which is what
the greater part of a thin line leaves in one of two dots."""

_SYMBOLS = {"backspace": "⌫", "up": "▲", "left": "◀", "enter": "●", "right": "▶", "down": "▼"}
"""Signs of the buttons, in the order of the single-row layout."""

_BUMPER = "□"

_PAD_ROWS, _PAD_COLUMNS = 3, 23
_PLACES = {
    "backspace": (0, 0),
    "up": (0, 10),
    "left": (1, 5),
    "enter": (1, 10),
    "right": (1, 15),
    "down": (2, 10),
}
"""Row and column of each button on the pad."""
_BUTTON_COLUMNS = 3
_LED_COLUMNS = 8

_DOT_BITS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]], np.uint8)


@dataclass(frozen=True, slots=True)
class ButtonBox:
    """The cells of a button in a picture: its row, its first column, and the column after its last one."""

    row: int
    first: int
    end: int
    name: str


@dataclass(frozen=True, slots=True)
class BrickPicture:
    """The picture of a brick as lines of text, with the cells of its buttons."""

    lines: list[list[Run]]
    buttons: tuple[ButtonBox, ...]


def draw_brick(
    face: BrickState,
    pressed: Collection[str],
    width: int,
    height: int,
    bumpers: Sequence[str] = (),
) -> BrickPicture:
    """Return the picture of the EV3 for a panel.

    Args:
        face: State of the brick.
        pressed: Buttons that are held down.
        width: Columns inside the border, at least 1.
        height: Rows inside the border, at least 1. With few rows, the buttons are drawn first, then bumpers, display
            and sound as far as they fit.
        bumpers: Ports of the touch sensors.
    """
    pad_rows = _PAD_ROWS if height >= 9 and width >= _PAD_COLUMNS + 2 * _LED_COLUMNS else 1
    bumper_rows = 1 if bumpers and height > pad_rows else 0
    sound_rows = 1 if height >= pad_rows + bumper_rows + 3 else 0
    rows = max(0, height - pad_rows - bumper_rows - sound_rows)
    screen = _draw_screen(face, width, rows) if rows else []
    pad, buttons = _pad(face, pressed, width, pad_rows, len(screen))
    lines = [*screen, *pad]
    if bumper_rows:
        line, boxes = draw_bumpers(bumpers, pressed, width, len(lines))
        lines.append(line)
        buttons += boxes
    return BrickPicture([*lines, *([draw_sound(face, width)] if sound_rows else [])], buttons)


def draw_sound(face: BrickState, width: int) -> list[Run]:
    """Return the row with the sound that the brick plays, or the text that it says."""
    sound = face.sound
    if sound.startswith("["):
        sound = sound.removeprefix("[").removeprefix("♪ ").removesuffix("]")
    return [(f"♪ {sound}"[:width] if sound else "", _CAPTION)]


# The display


def _draw_screen(face: BrickState, width: int, rows: int) -> list[list[Run]]:
    if face.shows_text and face.text is not None:
        return _draw_text_screen(face.text, width, rows)
    return _display(face.picture, width, rows)


def _draw_text_screen(screen: TextScreen, width: int, rows: int) -> list[list[Run]]:
    """Return the brick's text screen as rows of the terminal, cut to a size in cells."""
    columns = min(width, screen.columns)
    left = (width - columns) // 2
    top = max(0, (rows - screen.rows) // 2)
    lines: list[list[Run]] = [[] for _ in range(top)]
    for row, text in enumerate(screen.lines[: rows - top]):
        spans = [(start, end) for line, start, end in screen.inverse if line == row]
        cells = text.ljust(screen.columns)[:columns]
        line: list[Run] = [(" " * left, _PLAIN)]
        for column, char in enumerate(cells):
            style = _INVERSE if any(start <= column < end for start, end in spans) else _PAPER
            if line[-1][1] is style:
                line[-1] = (line[-1][0] + char, style)
            else:
                line.append((char, style))
        lines.append(line)
    return (lines + [[] for _ in range(rows)])[:rows]


@lru_cache(maxsize=8)
def _display(picture: bytes, width: int, rows: int) -> list[list[Run]]:
    ink = unpack_display(picture)
    display_rows, display_columns = ink.shape
    scale = min(width / display_columns, 2 * rows / display_rows, 1.0)
    dots = scale < HALF_BLOCK_SCALE
    # A dot is half as wide and half as high as a half block.
    fine = min(2 * scale, 1.0) if dots else scale
    per_row = 4 if dots else 2
    high = max(per_row, round(fine * display_rows) // per_row * per_row)
    across = max(2, round(fine * display_columns) // 2 * 2)
    shares = shrink_pixels(ink, min(high, display_rows), min(across, display_columns))
    drawn = (
        _draw_dots(shares, min(_DOT_SHARE, _LINE_PX * fine)) if dots else _draw_half_blocks(shares)
    )
    left = (width - sum(len(text) for text, _ in drawn[0])) // 2
    lines: list[list[Run]] = [[(" " * left, _PLAIN), *line] for line in drawn]
    top = max(0, (rows - len(lines)) // 2)
    return ([[] for _ in range(top)] + lines + [[] for _ in range(rows)])[:rows]


def _draw_dots(shares: NDArray[np.float64], min_share: float) -> list[list[Run]]:
    dark = shares >= min_share
    rows, columns = dark.shape[0] // 4, dark.shape[1] // 2
    fields = dark[: rows * 4, : columns * 2].reshape(rows, 4, columns, 2)
    codes = (fields * _DOT_BITS[None, :, None, :]).sum(axis=(1, 3))
    return [[("".join(chr(0x2800 + code) for code in row), _PAPER)] for row in codes.tolist()]


def _draw_half_blocks(shares: NDArray[np.float64]) -> list[list[Run]]:
    shades = np.rint(shares * (_SHADES - 1)).astype(int)
    lines = []
    for upper, lower in zip(shades[::2].tolist(), shades[1::2].tolist(), strict=True):
        line: list[Run] = []
        for pair in zip(upper, lower, strict=True):
            style = _find_pair_style(*pair)
            char = " " if pair[0] == pair[1] else "▀"
            if line and line[-1][1] is style and line[-1][0][-1] == char:
                line[-1] = (line[-1][0] + char, style)
            else:
                line.append((char, style))
        lines.append(line)
    return lines


@lru_cache(maxsize=_SHADES * _SHADES)
def _find_pair_style(upper: int, lower: int) -> Style:
    return Style(color=_find_shade(upper), bgcolor=_find_shade(lower))


def _find_shade(step: int) -> Color:
    part = step / (_SHADES - 1)
    return Color.from_rgb(
        *(round(p + (i - p) * part) for p, i in zip(_PAPER_RGB, _INK_RGB, strict=True))
    )


# The following functions draw lights and buttons.


def mix_led_rgb(red: int, green: int) -> Rgb:
    """Return the mixed colour of a red and a green light, whose brightness is 0 to 255; both together are amber."""
    if not red and not green:
        return _DARK_LED_RGB
    # A lamp that is on at all must be visible; the green ones are brighter.
    levels = [
        round(48 + 207 * level / 255) if level else 30 for level in (red, round(0.75 * green))
    ]
    return levels[0], levels[1], 20


def name_led(red: int, green: int) -> str:
    """Return the name of the mixed colour of a red and a green light with brightness 0 to 255, such as `amber`."""
    if not red and not green:
        return "off"
    if not green:
        return "red"
    share = red / green
    if not red:
        return "green"
    if share < 0.5:
        return "yellow"
    if share < 1.5:
        return "amber"
    return "orange"


def _list_lamps(face: BrickState) -> list[tuple[int, int]]:
    if not face.leds:
        return [(0, 255), (0, 255)]
    return [
        (face.leds.get(f"{side} red", 0), face.leds.get(f"{side} green", 0))
        for side in ("left", "right")
    ]


def _build_lamp(lamp: tuple[int, int], named: bool, columns: int) -> Run:
    """Return a row that is filled with the mixed colour of a red and a green light.

    Args:
        lamp: Brightness of red and green, 0 to 255.
        named: Whether to write the name of the colour in it, for terminals and users without colour.
        columns: Width of the row.
    """
    red, green, blue = mix_led_rgb(*lamp)
    ink = palette.BLACK if 3 * red + 6 * green > 1000 else palette.INK
    style = Style(color=ink, bgcolor=Color.from_rgb(red, green, blue))
    name = name_led(*lamp) if named else ""
    if len(name) > columns:
        name = f"{name[: columns - 1]}…" if columns > 1 else ""
    return name.center(columns), style


def _pad(
    face: BrickState, pressed: Collection[str], width: int, rows: int, top: int
) -> tuple[list[list[Run]], tuple[ButtonBox, ...]]:
    places = _PLACES if rows > 1 else {name: (0, 4 * at) for at, name in enumerate(_SYMBOLS)}
    columns = _PAD_COLUMNS if rows > 1 else 4 * len(_SYMBOLS) - 1
    led_columns = max(0, min(_LED_COLUMNS, (width - columns) // 2 - 1))
    left = max(0, (width - columns - 2 * led_columns - 2) // 2) + led_columns + 1
    lamps = _list_lamps(face)
    lines: list[list[Run]] = []
    boxes = []
    for row in range(rows):
        named = row == rows // 2
        indent = (" " * max(0, left - led_columns - 1), _PLAIN)
        line: list[Run] = [indent, _build_lamp(lamps[0], named, led_columns), (" ", _PLAIN)]
        at = 0
        for name, (button_row, column) in sorted(places.items(), key=lambda place: place[1]):
            if button_row == row:
                style = _PRESSED if name in pressed else _BUTTON
                line += [(" " * (column - at), _PLAIN), (f" {_SYMBOLS[name]} ", style)]
                at = column + _BUTTON_COLUMNS
                boxes.append(ButtonBox(top + row, left + column, left + at, name))
        line += [(" " * (columns - at + 1), _PLAIN), _build_lamp(lamps[1], named, led_columns)]
        lines.append(line)
    return lines, tuple(boxes)


def draw_bumpers(
    ports: Sequence[str], pressed: Collection[str], width: int, row: int
) -> tuple[list[Run], tuple[ButtonBox, ...]]:
    """Return the row with the bumpers of the touch sensors, as many as fit, and the cells of each."""
    labels = {port: f" {port} {_BUMPER} " for port in ports}
    while len(labels) > 1 and len(" ".join(labels.values())) > width:
        labels.popitem()
    first = max(0, (width - len(" ".join(labels.values()))) // 2)
    line, boxes = draw_keys(labels, ports if TOUCH in pressed else pressed, first, row)
    return [(" " * first, _PLAIN), *line], boxes


def draw_keys(
    labels: Mapping[str, str], pressed: Collection[str], first: int, row: int
) -> tuple[list[Run], tuple[ButtonBox, ...]]:
    """Return a row of keys side by side, with a blank between two, and the cells of each.

    Args:
        labels: The words on the keys, by their names.
        pressed: The keys that are held down.
        first, row: The column and the row of the first key.
    """
    line: list[Run] = []
    boxes = []
    for name, label in labels.items():
        line += [(label, _PRESSED if name in pressed else _BUTTON), (" ", _PLAIN)]
        boxes.append(ButtonBox(row, first, first + len(label), name))
        first += len(label) + 1
    return line[:-1], tuple(boxes)


def shrink_pixels(
    pixels: npt.NDArray[np.uint8], rows: int, columns: int
) -> npt.NDArray[np.float64]:
    """Return the pixels of a picture as means over a coarser grid.

    Args:
        pixels: Shape (h, w).
        rows: Rows of the coarser grid, at most h.
        columns: Columns of the coarser grid, at most w.

    Returns:
        Shape (rows, columns).
    """
    down = np.arange(rows + 1) * pixels.shape[0] // rows
    across = np.arange(columns + 1) * pixels.shape[1] // columns
    sums = np.add.reduceat(
        np.add.reduceat(pixels, down[:-1], axis=0, dtype=np.float64), across[:-1], axis=1
    )
    means: npt.NDArray[np.float64] = sums / (np.diff(down)[:, None] * np.diff(across)[None, :])
    return means
