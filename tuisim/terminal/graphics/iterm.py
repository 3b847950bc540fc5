"""Inline images of iTerm2, which WezTerm shows as well.

Reference: https://iterm2.com/documentation-images.html
"""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.terminal.pixels import Pixels


_COMPRESSION = 1
"""Of PNG: a tenth of the time of the default, for a few per cent more bytes."""


def encode(picture: Pixels, cols: int, rows: int) -> str:
    """Return the codes that draw a picture at the cursor, scaled to some columns and rows of cells."""
    # Imported on demand: few terminals need it.
    from PIL import Image

    file = BytesIO()
    Image.fromarray(picture).save(file, "PNG", compress_level=_COMPRESSION)
    data = file.getvalue()
    keys = f"inline=1;size={len(data)};width={cols};height={rows};preserveAspectRatio=0;doNotMoveCursor=1"
    return f"\x1b]1337;File={keys}:{b64encode(data).decode()}\x07"
