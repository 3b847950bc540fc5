"""Fonts by name: those that the brick has, drawn from Pillow's own where their files are missing.

The published library has no font files. What stands in for one has its size, its weight, its
slant and, where all its letters are of one width, that width; the shapes are another font's.
"""

from __future__ import annotations

import io
import struct
import sys
import types
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, wraps
from typing import TYPE_CHECKING, Any

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
"""Family, styles and sizes in pixels."""

_CELLS: Mapping[str, Mapping[int, int]] = {
    "cour": {8: 5, 10: 6, 12: 7, 14: 9, 18: 11, 24: 15},
    "lut": {8: 5, 10: 6, 12: 7, 14: 9, 18: 11, 19: 11, 24: 14},
    "tech": {14: 8},
    "term": {14: 8},
}
"""Width of every letter in pixels, by family and size; the letters of other families have widths of their own."""

_LETTERS = tuple(chr(code) for code in (*range(32, 127), *range(160, 256)))
_FINE = 6
"""Letters are drawn so many times larger first."""
_BOLDER = 0.035
"""Bold strokes reach so much further to each side, in parts of the size."""
_SLANT = 0.2
_DARK_FROM = {8: 64, 10: 80, 12: 96}
"""A pixel is dark from this grey on, of 255, by size: thin strokes would be lost in small letters."""
_DARK_FROM_USUALLY = 120
_BOLD_DARKER = 24

_PLAIN_CELL_PX = (6, 11)
"""Letters of Pillow's plain font."""
_PLAIN_BASE_PX, _PLAIN_CAPITAL_PX = 9, 6
"""Its base line from the top, and the height of its capitals."""
_CAPITAL = 0.7
"""Height of capitals in parts of the size."""


@dataclass(frozen=True, slots=True)
class Face:
    """What is known of a font by its name."""

    size_px: int
    bold: bool
    slanted: bool
    cell_px: int | None
    """Width of every letter; None if each has its own."""


FACES: Mapping[str, Face] = {
    f"{family}{style}{size:02}": Face(
        size, style.startswith("B"), "I" in style or "O" in style, _CELLS.get(family, {}).get(size)
    )
    for family, styles, sizes in _FAMILIES
    for style in styles
    for size in sizes
}
"""The fonts of the brick."""


@cache
def plain_font() -> ImageFont:
    """Return the font that the Pillow on the brick writes with if none is named, whatever Pillow this is."""
    from PIL import ImageFont

    # Newer ones write with a smooth font, whose grey edges a black and white display tears apart.
    plain: Any = getattr(ImageFont, "load_default_imagefont", ImageFont.load_default)
    found: ImageFont.ImageFont = plain()
    return found


def patch_fonts_module(module: types.ModuleType) -> None:
    """Finish `ev3dev2.fonts` after its import: every font of the brick can be loaded."""
    fonts: Any = module
    available, load = fonts.available, fonts.load
    said: list[str] = []

    @wraps(available)
    def all_available() -> list[str]:
        return sorted({*available(), *FACES})

    @wraps(load)
    def load_or_draw(name: str) -> ImageFont:
        if name not in FACES or name in available():
            found: ImageFont = load(name)
            return found
        if not said:
            said.append(name)
            print(
                f"{name}: the published library has no font files; another font stands in, of that size and weight",
                file=sys.__stderr__,
            )
        return drawn(FACES[name])

    fonts.available, fonts.load = all_available, load_or_draw


@cache
def drawn(face: Face) -> ImageFont:
    """Return a font of a face, drawn from the one that comes with Pillow."""
    from PIL import ImageFont
    from PIL.FontFile import FontFile

    large = ImageFont.load_default(face.size_px * _FINE)
    assert isinstance(large, ImageFont.FreeTypeFont)
    file = FontFile()
    for letter in _LETTERS:
        picture, left_px, width_px = _letter(large, letter, face)
        box = picture.getbbox() or (0, 0, 1, 1)
        ink = picture.crop(box)
        # What lies beside the way of the pen would be cut off.
        x = max(0, min(box[0] + left_px, width_px - ink.width))
        # Places count from the pen on the base line, y down.
        place = (x, box[1] - face.size_px, x + ink.width, box[3] - face.size_px)
        file.glyph[ord(letter)] = ((width_px, 0), place, (0, 0, *ink.size), ink)
    file.compile()
    assert file.bitmap is not None
    numbers = (
        number
        for move, to, of in (entry or ((0, 0), (0,) * 4, (0,) * 4) for entry in file.metrics)
        for number in (*move, *to, *of)
    )
    head = b"PILfont\n;;;;;;%d;\nDATA\n" % file.ysize
    font = ImageFont.ImageFont()
    font._load_pilfont_data(io.BytesIO(head + struct.pack(">2560h", *numbers)), file.bitmap.convert("L"))
    return font


def _letter(large: FreeTypeFont, letter: str, face: Face) -> tuple[Picture, int, int]:
    """Draw a letter, its base line `size_px` below the picture's top.

    Returns:
        The picture, where its left edge is beside the pen, and how far the pen moves on.
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
        pen.text((margin_px * _FINE, base), letter, 255, large, anchor="ls", stroke_width=stroke, stroke_fill=255)
    else:
        plain = _plain_letter(letter, times * _FINE)
        image.paste(plain, (margin_px * _FINE, base - round(_PLAIN_BASE_PX * times * _FINE)))
    if face.slanted:
        # About half the height of a capital, so that as little as can be hangs over on either side.
        still = base * (1 - _CAPITAL / 2)
        image = image.transform(image.size, Image.Transform.AFFINE, (1, _SLANT, -_SLANT * still, 0, 1, 0))
        own_px += round(_SLANT * _CAPITAL * face.size_px / 2)
    width_px = face.cell_px or own_px + (1 if face.bold else 0)
    squeezed = min(1.0, width_px / own_px)
    wide_px = max(1, round(image.width / _FINE * squeezed))
    small = image.resize((wide_px, high_px), Image.Resampling.BOX)
    left_px = round((width_px - (image.width / _FINE - 2 * margin_px) * squeezed) / 2 - margin_px * squeezed)
    dark_from = _DARK_FROM.get(face.size_px, _DARK_FROM_USUALLY) + (_BOLD_DARKER if face.bold else 0)
    return small.point([255 * (grey >= dark_from) for grey in range(256)], "1"), left_px, width_px


def _plain_letter(letter: str, times: float) -> Picture:
    """Return a letter of the plain font, enlarged: the other font has none with accents."""
    from PIL import Image, ImageDraw

    image = Image.new("L", _PLAIN_CELL_PX)
    ImageDraw.Draw(image).text((0, 0), letter, 255, plain_font())
    wide, high = _PLAIN_CELL_PX
    return image.resize((round(wide * times), round(high * times)), Image.Resampling.NEAREST)
