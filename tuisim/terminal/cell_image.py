"""A screen of character cells as a picture: PNG and SVG that look as a terminal shows the cells.

Blocks, lines and braille are drawn as shapes, which join as they do in a terminal; everything else with DejaVu Sans
Mono, of which `fonts` holds the characters of Latin, Greek and Cyrillic text, and symbols.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from html import escape
from importlib.resources import files
from itertools import groupby
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from rich.cells import split_graphemes
from rich.color import Color
from rich.style import Style

from tuisim.terminal.glyph_shapes import Bend, GlyphArea, GlyphDot, GlyphShape, draw_character
from tuisim.terminal.pixels import Rgb

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageFont import FreeTypeFont


@dataclass(frozen=True, slots=True)
class Look:
    """The style of a cell: its colours and attributes."""

    ink: Rgb = (216, 222, 230)
    """Colour of the character."""
    ground: Rgb = (18, 18, 18)
    """Colour behind the character."""
    bold: bool = False
    italic: bool = False
    underline: bool = False
    strike: bool = False


PLAIN = Look()

Cell = tuple[str, Look]
"""A character and its style; the character of the right half of a wide one is empty."""

CellGrid = Sequence[Sequence[Cell]]
"""Rows of equal length."""

CELL_PX = (10, 20)
"""Width and height of a cell."""
_BASELINE = 15
"""Row of pixels on which the letters stand."""
_FONT_PX = CELL_PX[0] / 0.602
"""Size of the font: the width of its letters is 0.602 of it."""

_FINE = 4
"""Shapes are drawn this many times larger and then reduced, for smooth curves."""
_ITALIC = 0.2
"""Slant of the letters: the font has only upright ones."""

_DIM = 0.5
"""Share of its own colour that dim text keeps."""


def split_cells(runs: Iterable[tuple[str, Style | None]], width: int) -> list[Cell]:
    """Return pieces of styled text as `width` cells: longer text is cut, shorter text padded."""
    row: list[Cell] = []
    for text, style in runs:
        look = _look(style) if style else PLAIN
        for start, end, cells in split_graphemes(text)[0]:
            if cells:
                row += [(text[start:end], look), *[("", look)] * (cells - 1)]
    return row[:width] + [(" ", PLAIN)] * (width - len(row))


def _look(style: Style) -> Look:
    ink = _resolve_color(style.color, PLAIN.ink)
    ground = _resolve_color(style.bgcolor, PLAIN.ground)
    if style.reverse:
        ink, ground = ground, ink
    if style.dim:
        red, green, blue = (
            round(_DIM * channel + (1 - _DIM) * other)
            for channel, other in zip(ink, ground, strict=True)
        )
        ink = red, green, blue
    return Look(
        ink, ground, bool(style.bold), bool(style.italic), bool(style.underline), bool(style.strike)
    )


def _resolve_color(color: Color | None, default: Rgb) -> Rgb:
    if color is None or color.is_default:
        return default
    red, green, blue = color.get_truecolor()
    return red, green, blue


Mask = npt.NDArray[np.uint8]
"""The share of each pixel that a character covers, 0 to 255."""


def draw_cells(grid: CellGrid) -> Image:
    """Return the picture of rows of cells; each cell has the size `CELL_PX`."""
    from PIL import Image

    rows, columns = len(grid), len(grid[0]) if grid else 0
    width, height = CELL_PX
    kinds: dict[tuple[str, bool, bool, bool, bool], int] = {}
    masks: list[Mask] = []
    numbers = np.zeros((rows, columns), np.intp)
    colors = np.zeros((2, rows, columns, 3), np.uint8)
    for y, row in enumerate(grid):
        wide = ""
        for x, (text, look) in enumerate(row):
            # The right half of a wide character is the rest of its mask.
            key = text or f"\0{wide}", look.bold, look.italic, look.underline, look.strike
            wide = text
            if key not in kinds:
                kinds[key] = len(masks)
                masks.append(_draw_mask(*key))
            numbers[y, x] = kinds[key]
            colors[:, y, x] = look.ink, look.ground
    if not masks:
        return Image.new("RGB", (1, 1))
    # The shape is (rows, height, columns, width), which is the order of the pixels in the picture.
    shares = np.stack(masks)[numbers].transpose(0, 2, 1, 3)[..., None].astype(np.uint16)
    ink, ground = colors[:, :, None, :, None].astype(np.uint16)
    pixels = (ink * shares + ground * (255 - shares) + 127) // 255
    return Image.fromarray(pixels.astype(np.uint8).reshape(rows * height, columns * width, 3))


@lru_cache(maxsize=4096)
def _draw_mask(text: str, bold: bool, italic: bool, underline: bool, strike: bool) -> Mask:
    """Return how much of each pixel of a cell a character covers, 0 to 255, shape (height, width) of a cell.

    If `text` is a NUL and a wide character, the result is for the right half of this character.
    """
    width, height = CELL_PX
    right = text.startswith("\0")
    text = text.removeprefix("\0")
    shapes = draw_character(text, width, height)
    if shapes is not None:
        mask = np.zeros((height, width), np.uint8) if right else _draw_shapes(shapes)
    else:
        mask = _write_character(text, bold, italic)[:, width * right : width * (right + 1)].copy()
    for line, y in ((underline, height - 3), (strike, height // 2)):
        if line:
            mask[y : y + 1] = 255
    return mask


def _draw_shapes(shapes: Sequence[GlyphShape]) -> Mask:
    from PIL import Image, ImageDraw

    width, height = CELL_PX
    image = Image.new("L", (width * _FINE, height * _FINE))
    draw = ImageDraw.Draw(image)
    for shape in shapes:
        match shape:
            case GlyphArea():
                corners = (
                    shape.left * _FINE,
                    shape.top * _FINE,
                    shape.right * _FINE - 1,
                    shape.bottom * _FINE - 1,
                )
                draw.rectangle(corners, round(255 * shape.opacity))
            case GlyphDot():
                x = shape.x * _FINE
                y = shape.y * _FINE
                radius = shape.radius * _FINE
                draw.ellipse((x - radius, y - radius, x + radius - 1, y + radius - 1), 255)
            case Bend():
                points = [(x * _FINE - 0.5, y * _FINE - 0.5) for x, y in shape.points]
                draw.line(points, 255, round(shape.width * _FINE), joint="curve")
    return np.asarray(image.reduce(_FINE)).copy()


@lru_cache(maxsize=1)
def _load_font() -> FreeTypeFont:
    from PIL import ImageFont

    content = files("tuisim.pictures.charts").joinpath("fonts", "DejaVuSansMono.ttf").read_bytes()
    return ImageFont.truetype(io.BytesIO(content), _FONT_PX, layout_engine=ImageFont.Layout.BASIC)


def _write_character(text: str, bold: bool, italic: bool) -> Mask:
    """Return how much of each pixel of two neighbouring cells a character covers, 0 to 255.

    A narrow character is in the left cell.
    """
    from PIL import Image, ImageDraw

    width, height = CELL_PX
    image = Image.new("L", (2 * width, height))
    if text.strip():
        draw = ImageDraw.Draw(image)
        for more in range(1 + bold):
            draw.text((more * 0.6, _BASELINE), text, 255, _load_font(), "ls")
        if italic:
            slant = (1, _ITALIC, -_ITALIC * _BASELINE, 0, 1, 0)
            image = image.transform(
                image.size, Image.Transform.AFFINE, slant, Image.Resampling.BILINEAR
            )
    return np.asarray(image)


def draw_cells_svg(grid: CellGrid, title: str) -> str:
    """Return the content of an SVG file with the picture of rows of cells, in which text stays text."""
    rows, columns = len(grid), len(grid[0]) if grid else 0
    width, height = columns * CELL_PX[0], rows * CELL_PX[1]
    size = f'viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
    font = f'font-family="\'DejaVu Sans Mono\', monospace" font-size="{_FONT_PX:.2f}"'
    return "\n".join(
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" {size} {font} role="img" shape-rendering="crispEdges">',
            f"<title>{escape(title)}</title>",
            *_draw_svg_grounds(grid),
            *_draw_svg_shapes(grid),
            *_draw_svg_texts(grid),
            "</svg>",
            "",
        )
    )


def _format_hex(rgb: Rgb) -> str:
    return f"#{bytes(rgb).hex()}"


def _draw_svg_grounds(grid: CellGrid) -> Iterator[str]:
    """Yield an SVG path for each background colour of the cells."""
    paths: dict[Rgb, list[str]] = {}
    for y, row in enumerate(grid):
        x = 0
        for ground, run in groupby(look.ground for _, look in row):
            count = len(list(run))
            area = GlyphArea(0, 0, count * CELL_PX[0], CELL_PX[1])
            paths.setdefault(ground, []).append(
                _draw_svg_area(area, x * CELL_PX[0], y * CELL_PX[1])
            )
            x += count
    for color, parts in paths.items():
        yield f'<path fill="{_format_hex(color)}" d="{"".join(parts)}"/>'


def _draw_svg_area(area: GlyphArea, x: float, y: float) -> str:
    return f"M{x + area.left:g} {y + area.top:g}H{x + area.right:g}V{y + area.bottom:g}H{x + area.left:g}z"


def _draw_svg_shapes(grid: CellGrid) -> Iterator[str]:
    """Yield SVG elements for the shapes of glyphs, such as blocks and lines of boxes.

    All rectangles of one colour and opacity are one path; each dot and each line is an element of its own.
    """
    paths: dict[tuple[Rgb, float], list[str]] = {}
    for y, row in enumerate(grid):
        for x, (text, look) in enumerate(row):
            left = x * CELL_PX[0]
            top = y * CELL_PX[1]
            for shape in draw_character(text, *CELL_PX) or ():
                match shape:
                    case GlyphArea():
                        paths.setdefault((look.ink, shape.opacity), []).append(
                            _draw_svg_area(shape, left, top)
                        )
                    case GlyphDot():
                        place = (
                            f'cx="{left + shape.x:g}" cy="{top + shape.y:g}" r="{shape.radius:.2f}"'
                        )
                        yield f'<circle {place} fill="{_format_hex(look.ink)}" shape-rendering="auto"/>'
                    case Bend():
                        points = " ".join(
                            f"{left + at_x:.1f},{top + at_y:.1f}" for at_x, at_y in shape.points
                        )
                        line = f'stroke="{_format_hex(look.ink)}" stroke-width="{shape.width:g}" shape-rendering="auto"'
                        yield f'<polyline points="{points}" fill="none" {line}/>'
    for (color, opacity), parts in paths.items():
        faint = f' fill-opacity="{opacity:g}"' if opacity < 1 else ""
        yield f'<path fill="{_format_hex(color)}"{faint} d="{"".join(parts)}"/>'


def _draw_svg_texts(grid: CellGrid) -> Iterator[str]:
    """Yield the text of each row in pieces of one style; each character has a position of its own."""
    width, height = CELL_PX
    for y, row in enumerate(grid):
        column = 0
        for look, run in groupby(row, key=lambda cell: cell[1]):
            cells = list(run)
            written = [
                (x, text)
                for x, (text, _) in enumerate(cells, column)
                if text.strip() and draw_character(text, width, height) is None
            ]
            if written:
                yield _draw_svg_text(written, y, look)
            yield from _draw_svg_lines(column, column + len(cells), y, look)
            column += len(cells)


def _draw_svg_text(written: Sequence[tuple[int, str]], y: int, look: Look) -> str:
    # Each character has a position; a combining one has that of its letter.
    places = " ".join(str(x * CELL_PX[0]) for x, text in written for _ in text)
    text = escape("".join(text for _, text in written))
    style = ' font-weight="bold"' * look.bold + ' font-style="italic"' * look.italic
    return f'<text x="{places}" y="{y * CELL_PX[1] + _BASELINE}" fill="{_format_hex(look.ink)}"{style}>{text}</text>'


def _draw_svg_lines(first: int, end: int, y: int, look: Look) -> Iterator[str]:
    width, height = CELL_PX
    for line, down in ((look.underline, height - 3), (look.strike, height // 2)):
        if line:
            place = f'x="{first * width}" y="{y * height + down}" width="{(end - first) * width}" height="1"'
            yield f'<rect {place} fill="{_format_hex(look.ink)}"/>'
