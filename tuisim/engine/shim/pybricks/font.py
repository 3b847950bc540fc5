"""`Font` of `pybricks.media.ev3dev`."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

from tuisim.engine.shim.fonts import sized
from tuisim.engine.shim.pybricks.brick import Connected, invalid_argument, text_of, whole

if TYPE_CHECKING:
    from PIL.ImageFont import ImageFont

FAMILY = "Lucida"
SIZE_PX = 12
"""Height in pixels of the letters of the screen's default font, which belongs to `FAMILY`."""
LARGEST_PX = 128
"""Letters of a larger font are drawn at this size, which is the screen's height."""
BLANK = " "


class Font(Connected):
    """A font of the screen. Its letters are drawn with another font of the same size and weight.

    Args:
        family: A name; all families look alike here.
        size: In pixels.
        bold: Whether strokes are bold.
        monospace: Whether all characters are equally wide.
        lang, script: Ignored: characters beyond Latin 1 are drawn as question marks.
    """

    DEFAULT: ClassVar[Font]

    def __init__(
        self,
        family: str | None = None,
        size: float = SIZE_PX,
        bold: bool = False,
        monospace: bool = False,
        lang: str | None = None,
        script: str | None = None,
    ) -> None:
        if whole(size) <= 0:
            raise invalid_argument()
        for text in (family, lang, script):
            if text is not None:
                text_of(text)
        self._family, self._size_px = family or FAMILY, min(whole(size), LARGEST_PX)
        self._bold, self._monospace = bool(bold), bool(monospace)

    @cached_property
    def drawn(self) -> ImageFont:
        """The font as a Pillow font object."""
        return sized(self._size_px, self._bold, self._monospace)

    @property
    def family(self) -> str:
        """The name of the font's family."""
        return self._family

    @property
    def style(self) -> str:
        """The weight of the font: `Bold` or `Regular`."""
        return "Bold" if self._bold else "Regular"

    @cached_property
    def width(self) -> int:
        """Width of the font's widest character in pixels."""
        return max(self.text_width(chr(code)) for code in range(ord(BLANK), ord("~") + 1))

    @cached_property
    def height(self) -> int:
        """Height of a line of text in this font, in pixels."""
        return int(self.drawn.getbbox(BLANK)[3])

    def text_width(self, text: str, /) -> int:
        """Return the width of a text in this font, in pixels."""
        return int(self.drawn.getlength(drawable(text_of(text))))

    def text_height(self, text: str, /) -> int:
        """Return the height of a text in this font, in pixels."""
        text_of(text)
        return self.height


Font.DEFAULT = Font()


def drawable(text: str) -> str:
    """Return a text as one line of Latin 1; characters that cannot be drawn become question marks or blanks."""
    latin = text.encode("latin-1", "replace").decode("latin-1")
    return "".join(letter if letter.isprintable() else BLANK for letter in latin)
