"""Block elements, box drawing and braille as shapes, so that neighbouring cells join without gaps in any font.

Sources: The Unicode Standard 16.0, code charts Box Drawing (U+2500), Block Elements (U+2580) and Braille Patterns
(U+2800). The names of box drawing characters say which arms they have and how thick these are.
"""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

from tuisim.terminal.glyphs import block_patterns


@dataclass(frozen=True, slots=True)
class GlyphArea:
    """A filled rectangle of a glyph, in pixels from the upper left corner of the cell."""

    left: float
    top: float
    right: float
    bottom: float
    opacity: float = 1.0


@dataclass(frozen=True, slots=True)
class GlyphDot:
    """A filled disc of a glyph, in pixels from the upper left corner of the cell."""

    x: float
    y: float
    radius: float


@dataclass(frozen=True, slots=True)
class Bend:
    """A line of a glyph through several points, which are in pixels from the upper left corner of the cell."""

    points: tuple[tuple[float, float], ...]
    width: float


GlyphShape: TypeAlias = GlyphArea | GlyphDot | Bend

_EIGHTHS: Mapping[str, tuple[int, int, int, int]] = {
    "▀": (0, 0, 8, 4), "▐": (4, 0, 8, 8), "▔": (0, 0, 8, 1), "▕": (7, 0, 8, 8),
    **{chr(0x2580 + rows): (0, 8 - rows, 8, 8) for rows in range(1, 9)},
    **{chr(0x2590 - columns): (0, 0, columns, 8) for columns in range(1, 8)},
}  # fmt: skip
"""Left, top, right and bottom of rectangles in eighths of the cell."""

_SHADES = {"░": 0.25, "▒": 0.5, "▓": 0.75}

_BOX, _BRAILLE = range(0x2500, 0x2580), range(0x2800, 0x2900)
_BRAILLE_PLACES = ((0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3))
"""Column and row of the dots 1 to 8."""

_ARC_POINTS = 9


@lru_cache(maxsize=4096)
def draw_character(char: str, width: int, height: int) -> tuple[GlyphShape, ...] | None:
    """Return the shapes of a block or box drawing character in a cell; None for a character that a font has to draw.

    Args:
        char: The character.
        width, height: Size of the cell in pixels.
    """
    if len(char) != 1:
        return None
    if eighths := _EIGHTHS.get(char):
        left, top, right, bottom = eighths
        return (_place_area(left / 8, top / 8, right / 8, bottom / 8, width, height),)
    if char in _SHADES:
        return (GlyphArea(0, 0, width, height, _SHADES[char]),)
    if char in block_patterns():
        rows, bits = block_patterns()[char]
        parts = [
            (position % 2, position // 2) for position in range(2 * rows) if bits >> position & 1
        ]
        return tuple(
            _place_area(x / 2, y / rows, (x + 1) / 2, (y + 1) / rows, width, height)
            for x, y in parts
        )
    if ord(char) in _BRAILLE:
        dots = [place for bit, place in enumerate(_BRAILLE_PLACES) if ord(char) >> bit & 1]
        radius = min(width / 4, height / 8) * 0.7
        return tuple(
            GlyphDot((x + 0.5) * width / 2, (y + 0.5) * height / 4, radius) for x, y in dots
        )
    if ord(char) in _BOX:
        return tuple(
            _draw_box(unicodedata.name(char).removeprefix("BOX DRAWINGS ").split(), width, height)
        )
    return None


def _place_area(
    left: float, top: float, right: float, bottom: float, width: int, height: int
) -> GlyphArea:
    """Return a rectangle of whole pixels; its edges are given as shares of the cell's width and height."""
    x = [math.floor(share * width + 0.5) for share in (left, right)]
    y = [math.floor(share * height + 0.5) for share in (top, bottom)]
    # In a small cell, an eighth may be less than a pixel: draw at least one.
    if x[0] == x[1]:
        x = [x[0], x[0] + 1] if left < 0.5 else [x[0] - 1, x[0]]
    if y[0] == y[1]:
        y = [y[0], y[0] + 1] if top < 0.5 else [y[0] - 1, y[0]]
    return GlyphArea(x[0], y[0], x[1], y[1])


_SIDES = {
    "UP": ("UP",),
    "DOWN": ("DOWN",),
    "LEFT": ("LEFT",),
    "RIGHT": ("RIGHT",),
    "VERTICAL": ("UP", "DOWN"),
    "HORIZONTAL": ("LEFT", "RIGHT"),
}
_LIGHT = "LIGHT"
_HEAVY = "HEAVY"
_DOUBLE = "DOUBLE"
_WEIGHTS = {"LIGHT": _LIGHT, "SINGLE": _LIGHT, "HEAVY": _HEAVY, "DOUBLE": _DOUBLE}
_DASHES = {"DOUBLE": 2, "TRIPLE": 3, "QUADRUPLE": 4}


def _choose_thickness(width: int) -> int:
    return max(1, round(width / 8))


def _draw_box(words: list[str], width: int, height: int) -> Iterator[GlyphShape]:
    """Yield the shapes of a box drawing character, such as `│`.

    Args:
        words: The words of the character's Unicode name.
        width, height: Size of the cell in pixels.
    """
    thick = _choose_thickness(width)
    if "DIAGONAL" in words:
        rising = ((0.0, float(height)), (float(width), 0.0))
        falling = ((0.0, 0.0), (float(width), float(height)))
        yield from (
            Bend(line, thick)
            for line, corner in ((rising, ["UPPER", "RIGHT"]), (falling, ["UPPER", "LEFT"]))
            if "CROSS" in words or words[2:4] == corner
        )
    elif "ARC" in words:
        yield _draw_arc("RIGHT" in words, "DOWN" in words, width, height, thick)
    elif "DASH" in words:
        yield from _draw_dashes(
            _DASHES[words[1]],
            "VERTICAL" in words,
            thick * (2 if words[0] == _HEAVY else 1),
            width,
            height,
        )
    else:
        yield from _draw_arms(_parse_arms(words), width, height, thick)


def _parse_arms(words: list[str]) -> dict[str, str]:
    """Return the weight of each line from the middle of a box drawing character, such as light, by its direction.

    Args:
        words: The words of the character's Unicode name.
    """
    arms: dict[str, str] = {}
    weight = ""
    parts = " ".join(words).split(" AND ")
    for part in parts:
        named = part.split()
        weight = next((_WEIGHTS[word] for word in named if word in _WEIGHTS), weight)
        arms |= {side: weight for word in named for side in _SIDES.get(word, ())}
    return arms


def _draw_arms(arms: Mapping[str, str], width: int, height: int, thick: int) -> Iterator[GlyphArea]:
    """Yield the lines of a box drawing character, which meet in the middle of the cell.

    Args:
        arms: The weight of each arm, by its direction.
        width, height: Size of the cell in pixels.
        thick: Thickness of a light line in pixels.
    """
    middle = {"x": (width - thick) // 2, "y": (height - thick) // 2}
    # A double line is two light ones, the width of one apart.
    strips = {
        _LIGHT: ((0, thick),),
        _HEAVY: ((-thick // 2, 2 * thick),),
        _DOUBLE: ((-thick, thick), (thick, thick)),
    }

    def find_edges(sides: tuple[str, str], axis: str) -> tuple[int, int]:
        """Return the first and the last edge, in pixels along `axis`, of the arms towards two opposite sides.

        Without such arms, these are the edges of a light line.
        """
        lines = [strip for side in sides if side in arms for strip in strips[arms[side]]] or [
            (0, thick)
        ]
        return middle[axis] + min(start for start, _ in lines), middle[axis] + max(
            start + size for start, size in lines
        )

    columns, rows = find_edges(("UP", "DOWN"), "x"), find_edges(("LEFT", "RIGHT"), "y")
    for side, weight in arms.items():
        for start, size in strips[weight]:
            if side in ("UP", "DOWN"):
                left = middle["x"] + start
                yield GlyphArea(
                    left,
                    0 if side == "UP" else rows[0],
                    left + size,
                    rows[1] if side == "UP" else height,
                )
            else:
                top = middle["y"] + start
                yield GlyphArea(
                    0 if side == "LEFT" else columns[0],
                    top,
                    columns[1] if side == "LEFT" else width,
                    top + size,
                )


def _draw_arc(right: bool, down: bool, width: int, height: int, thick: int) -> Bend:
    x, y = (width - thick) // 2 + thick / 2, (height - thick) // 2 + thick / 2
    end_x, end_y = (float(width) if right else 0.0), (float(height) if down else 0.0)
    radius = min(abs(end_x - x), abs(end_y - y))
    across, along = math.copysign(radius, end_x - x), math.copysign(radius, end_y - y)
    turns = [number * math.pi / 2 / (_ARC_POINTS - 1) for number in range(_ARC_POINTS)]
    curve = [
        (x + across * (1 - math.cos(turn)), y + along * (1 - math.sin(turn))) for turn in turns
    ]
    return Bend(((x, end_y), *curve, (end_x, y)), thick)


def _draw_dashes(
    count: int, upright: bool, thick: int, width: int, height: int
) -> Iterator[GlyphArea]:
    length, across = (height, width) if upright else (width, height)
    start = (across - thick) // 2
    for number in range(count):
        first, last = round(number * length / count), round((number + 0.6) * length / count)
        yield (
            GlyphArea(start, first, start + thick, last)
            if upright
            else GlyphArea(first, start, last, start + thick)
        )
