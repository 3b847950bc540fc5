"""Fonts by name: those of the brick, drawn from Pillow's own font if their files are missing.

The published library has no font files. A replacement has the size, weight and slant of the
original and, for monospaced fonts, its character width; the shapes are those of another font.
"""

from __future__ import annotations

import io
import struct
import sys
import types
import warnings
from collections.abc import Mapping
from functools import cache, wraps
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass

if TYPE_CHECKING:
    from PIL.Image import Image as Picture
    from PIL.ImageFont import FreeTypeFont, ImageFont

_SIX = (8, 10, 12, 14, 18, 24)
_SEVEN = (8, 10, 12, 14, 18, 19, 24)

_FAMILIES: tuple[tuple[str, tuple[str, ...], tuple[int, ...]], ...] = (
    ("char", ("B", "BI", "I", "R"), _SIX),
    ("cour", ("B", "BO", "O", "R"), _SIX),
    ("helv", ("B", "BO", "O", "R"), _SIX),
    ("lu", ("BIS", "BS", "IS", "RS"), _SEVEN),
    ("lub", ("B", "BI", "I", "R"), _SEVEN),
    ("lut", ("BS", "RS"), _SEVEN),
    ("ncen", ("B", "BI", "I", "R"), _SIX),
    ("symb", ("",), _SIX),
    ("tech", ("", "B"), (14,)),
    ("term", ("", "B"), (14,)),
    ("tim", ("B", "BI", "I", "R"), _SIX),
)
"""The brick's font families: the name of each, the styles that it has (B bold, I or O slanted), and its sizes in
pixels.
"""

_CELLS: Mapping[str, Mapping[int, int]] = {
    "cour": {8: 5, 10: 6, 12: 7, 14: 9, 18: 11, 24: 15},
    "lut": {8: 5, 10: 6, 12: 7, 14: 9, 18: 11, 19: 11, 24: 14},
    "tech": {14: 8},
    "term": {14: 8},
}
"""Width in pixels of every character of the monospaced families, by family and size; the families that are not named
are proportional.
"""
_CELL = 0.6
"""Width of every character of a monospaced font whose size is not in `_CELLS`, as a fraction of the size."""

_LETTERS = tuple(chr(code) for code in (*range(32, 127), *range(160, 256)))
_FINE = 6
"""Glyphs are drawn this many times larger than they are needed, and then reduced, so that their edges become greys."""
_BOLDER = 0.035
"""Width that a bold stroke has in addition on each side, as a fraction of the font's size."""
_SLANT = 0.2
_DARK_FROM = {8: 64, 10: 80, 12: 96}
"""The grey, 0 to 255, from which a pixel of a glyph is black, by the font's size in pixels: low for small letters,
which would otherwise lose thin strokes.
"""
_DARK_FROM_USUALLY = 120
_BOLD_DARKER = 24

_PLAIN_CELL_PX = (6, 11)
"""Width and height in pixels of a character in Pillow's default font."""
_PLAIN_BASE_PX, _PLAIN_CAPITAL_PX = 9, 6
"""In Pillow's default font, the distance of the baseline from the top of a character, and the height of a capital."""
_CAPITAL = 0.7
"""Height of a capital letter as a fraction of the font's size."""


@dataclass(frozen=True, slots=True)
class Face:
    """The properties of a font that can be read from its name, such as `courB24`."""

    size_px: int
    bold: bool
    slanted: bool
    cell_px: int | None
    """Width of every character in pixels; None for a proportional font."""


FACES: Mapping[str, Face] = {
    f"{family}{style}{size:02}": Face(
        size, style.startswith("B"), "I" in style or "O" in style, _CELLS.get(family, {}).get(size)
    )
    for family, styles, sizes in _FAMILIES
    for style in styles
    for size in sizes
}
"""The properties of the brick's fonts, by the font's name, such as `courB24`."""


@cache
def plain_font() -> ImageFont:
    """Return the default font of the brick's Pillow, in whatever version of Pillow is installed."""
    from PIL import ImageFont

    # Newer versions default to a smooth font, whose grey edges look ragged on a black and white display.
    plain: Any = getattr(ImageFont, "load_default_imagefont", ImageFont.load_default)
    font: ImageFont.ImageFont = plain()
    return font


def quiet_pillow(_module: types.ModuleType) -> None:
    """Hide Pillow's deprecation warnings, which do not matter to a program: on the brick, Pillow stays the same."""
    warnings.filterwarnings("ignore", r".* will be removed in Pillow ", DeprecationWarning)


def patch_fonts_module(module: types.ModuleType) -> None:
    """Patch `ev3dev2.fonts` after its import so that every font of the brick can be loaded."""
    fonts: Any = module
    available = fonts.available
    load = fonts.load
    warned: list[str] = []

    @wraps(available)
    def all_available() -> list[str]:
        return sorted({*available(), *FACES})

    @wraps(load)
    def load_or_draw(name: str) -> ImageFont:
        if name not in FACES or name in available():
            found: ImageFont = load(name)
            return found
        if not warned:
            warned.append(name)
            print(
                f"{name}: the published library has no font files; another font stands in, of that size and weight",
                file=sys.__stderr__,
            )
        return drawn(FACES[name])

    fonts.available = all_available
    fonts.load = load_or_draw


def sized(size_px: int, bold: bool, monospace: bool) -> ImageFont:
    """Return an upright font of any height.

    Args:
        size_px: The height in pixels.
        bold: Whether strokes are bold.
        monospace: Whether all characters are equally wide.
    """
    cell_px = _CELLS["lut"].get(size_px, max(1, round(_CELL * size_px))) if monospace else None
    return drawn(Face(size_px, bold, slanted=False, cell_px=cell_px))


@cache
def drawn(face: Face) -> ImageFont:
    """Return a bitmap font for a face, drawn from the font that comes with Pillow."""
    from PIL import ImageFont
    from PIL.FontFile import FontFile

    large = ImageFont.load_default(face.size_px * _FINE)
    assert isinstance(large, ImageFont.FreeTypeFont)
    file = FontFile()
    for letter in _LETTERS:
        picture, left_px, width_px = _letter(large, letter, face)
        box = picture.getbbox() or (0, 0, 1, 1)
        ink = picture.crop(box)
        # Pillow cuts off what is to the left of the pen, so letters that begin there are moved to the right.
        x = max(0, min(box[0] + left_px, width_px - ink.width))
        # Pillow's coordinates are relative to the pen on the baseline; y points down.
        place = (x, box[1] - face.size_px, x + ink.width, box[3] - face.size_px)
        file.glyph[ord(letter)] = ((width_px, 0), place, (0, 0, *ink.size), ink)
    file.compile()
    assert file.bitmap is not None
    empty = ((0, 0), (0,) * 4, (0,) * 4)
    numbers: list[int] = []
    for entry in file.metrics:
        for part in entry or empty:
            numbers.extend(part)
    head = b"PILfont\n;;;;;;%d;\nDATA\n" % file.ysize
    font = ImageFont.ImageFont()
    font._load_pilfont_data(
        io.BytesIO(head + struct.pack(">2560h", *numbers)), file.bitmap.convert("L")
    )
    return font


def _letter(large: FreeTypeFont, letter: str, face: Face) -> tuple[Picture, int, int]:
    """Draw a letter with its baseline `size_px` below the top of the image.

    Args:
        large: The font from which it is drawn, at a larger size.
        letter: The letter.
        face: The size and the style that it gets.

    Returns:
        The image, its left edge relative to the pen, and the advance of the pen.
    """
    from PIL import Image, ImageDraw

    margin_px = face.size_px // 2
    known = letter.isascii()
    times = _CAPITAL * face.size_px / _PLAIN_CAPITAL_PX
    own_px = max(1, round(large.getlength(letter) / _FINE if known else times * _PLAIN_CELL_PX[0]))
    high_px = face.size_px + margin_px
    image = Image.new("L", ((own_px + 2 * margin_px) * _FINE, high_px * _FINE))
    base = face.size_px * _FINE
    if known:
        stroke = round(base * _BOLDER) if face.bold else 0
        pen = ImageDraw.Draw(image)
        pen.text(
            (margin_px * _FINE, base),
            letter,
            255,
            large,
            anchor="ls",
            stroke_width=stroke,
            stroke_fill=255,
        )
    else:
        plain = _plain_letter(letter, times * _FINE)
        image.paste(plain, (margin_px * _FINE, base - round(_PLAIN_BASE_PX * times * _FINE)))
    if face.slanted:
        # The middle of a capital's height stays where it is, so that the slant overhangs little on either side.
        still = base * (1 - _CAPITAL / 2)
        image = image.transform(
            image.size, Image.Transform.AFFINE, (1, _SLANT, -_SLANT * still, 0, 1, 0)
        )
        own_px += round(_SLANT * _CAPITAL * face.size_px / 2)
    width_px = face.cell_px or own_px + (1 if face.bold else 0)
    squeezed = min(1.0, width_px / own_px)
    wide_px = max(1, round(image.width / _FINE * squeezed))
    small = image.resize((wide_px, high_px), Image.Resampling.BOX)
    left_px = round(
        (width_px - (image.width / _FINE - 2 * margin_px) * squeezed) / 2 - margin_px * squeezed
    )
    dark_from = _DARK_FROM.get(face.size_px, _DARK_FROM_USUALLY) + (
        _BOLD_DARKER if face.bold else 0
    )
    return small.point([255 * (grey >= dark_from) for grey in range(256)], "1"), left_px, width_px


def _plain_letter(letter: str, times: float) -> Picture:
    """Return a grey picture of a letter of the plain font, with height and width multiplied by `times`."""
    from PIL import Image, ImageDraw

    image = Image.new("L", _PLAIN_CELL_PX)
    ImageDraw.Draw(image).text((0, 0), letter, 255, plain_font())
    wide, high = _PLAIN_CELL_PX
    return image.resize((round(wide * times), round(high * times)), Image.Resampling.NEAREST)
