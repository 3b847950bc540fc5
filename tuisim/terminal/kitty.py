"""The graphics protocol of kitty, with placeholders: images that appear wherever certain characters are.

Dialogs, panels and terminal multiplexers handle such a character like any other one.

Reference: https://sw.kovidgoyal.net/kitty/graphics-protocol/#unicode-placeholders
"""

from __future__ import annotations

import re
import zlib
from base64 import b64encode
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.terminal.pixels import Pixels


PAGE = "tuisim"
"""The name that the page of a browser answers."""
TERMINALS: Mapping[str, str] = {
    "kitty": "https://sw.kovidgoyal.net/kitty/graphics-protocol/#unicode-placeholders (since 0.28)",
    PAGE: "tuisim/web/page/pictures.js: the page of a browser, see `wrap_page`",
    "ghostty": "https://ghostty.org/docs/features (kitty graphics protocol with Unicode placeholders)",
}
"""Terminals that have placeholders, by name, and where that is written."""
PLACEHOLDER = "\U0010eeee"
DIACRITICS = "\u0305\u030d\u030e\u0310\u0312\u033d\u033e\u033f"
"""Characters that follow a placeholder, and say which row and column of the image it shows; the first ones of the
protocol."""
MAX_CELLS = len(DIACRITICS)
"""Most rows and columns of an image."""
QUERY_IMAGE = 31
QUERY = f"\x1b_Gi={QUERY_IMAGE},s=1,v=1,a=q,U=1,t=d,f=24;AAAA\x1b\\"
"""Asks whether a terminal knows the protocol with placeholders; the answer ends in `OK` then.

A terminal without placeholders ignores the whole command, as kitty 0.26 does, and gives no answer.
"""
_CHUNK = 4096
"""Most characters of data in one command."""
_COMPRESSION = 1
_PAGE_COMMAND = 7766
"""Number of the operating system command that brings a command to a page."""
_PLACEHOLDERS = re.compile(f"(?:{PLACEHOLDER}..)+")


def encode(
    picture: Pixels, image: int, cols: int, rows: int, *, answers_errors: bool = True
) -> str:
    """Return the codes that send a picture to the terminal, which shows the picture where its placeholders are.

    Args:
        picture: Shape (height, width, 3).
        image: Its number, from 1 to 0xFFFFFF; it replaces an image with this number.
        cols: Number of cells across, at most `MAX_CELLS`.
        rows: Number of cells from top to bottom, at most `MAX_CELLS`.
        answers_errors: Whether the terminal answers if it cannot show the picture.
    """
    data = b64encode(zlib.compress(picture.tobytes(), _COMPRESSION)).decode()
    chunks = [data[position : position + _CHUNK] for position in range(0, len(data), _CHUNK)]
    quiet = 1 if answers_errors else 2
    keys = f"a=T,U=1,q={quiet},f=24,o=z,i={image},s={picture.shape[1]},v={picture.shape[0]},c={cols},r={rows},"
    parts = []
    for position, chunk in enumerate(chunks, 1):
        parts.append(f"\x1b_G{keys}m={int(position < len(chunks))};{chunk}\x1b\\")
        keys = ""
    return "".join(parts)


DELETE_ALL = "\x1b_Ga=d,d=A,q=2\x1b\\" + f"\x1b_Ga=d,d=R,x=1,y={0xFFFFFF},q=2\x1b\\"
"""Deletes all images and their data: those that were placed on the screen, and by number, since kitty 0.33, those at
placeholders, which are not placed anywhere."""


def delete(image: int) -> str:
    """Return the codes that delete an image and its data."""
    return f"\x1b_Ga=d,d=I,q=2,i={image}\x1b\\"


def build_placeholder(col: int, row: int) -> str:
    """Return the text of a cell in whose place the terminal shows the part of an image at a column and row.

    The foreground colour of the cell is the number of the image.
    """
    return PLACEHOLDER + DIACRITICS[row] + DIACRITICS[col]


def wrap_page(codes: str) -> str:
    """Return codes in the form in which the page of a browser reads them.

    The page's terminal, xterm.js, ignores commands of this kind, and would draw a placeholder as a character.
    """
    return _PLACEHOLDERS.sub(
        "\x1b[8m\\g<0>\x1b[28m", codes.replace("\x1b_G", f"\x1b]{_PAGE_COMMAND};G")
    )


def wrap_tmux(codes: str) -> str:
    """Return codes in the form in which tmux passes them on to its own terminal, if its settings allow that."""
    return "\x1bPtmux;" + codes.replace("\x1b", "\x1b\x1b") + "\x1b\\"
