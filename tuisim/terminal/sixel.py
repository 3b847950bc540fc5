"""Sixel: a picture as a string of characters for six pixels each.

Reference: DEC, VT330/VT340 Programmer Reference Manual, volume 2 (Graphics Programming), chapter 14.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuisim.terminal.pixels import Pixels, unpack_rgb

BAND_PX = 6
"""A character of sixel data stands for this many pixels, one below the other."""
MAX_COLORS = 256
"""Number of colours that every terminal with sixel supports."""
PERCENT = 100
"""Largest value of a colour channel in sixel codes."""
_BEGIN = "\x1bP0;1q"
_END = "\x1b\\"
"""`_BEGIN` and `_END` enclose a sixel picture; `_BEGIN` says that pixels that are not drawn keep their colour."""
_FIRST_CHARACTER = 63
_SHORT_RUN = 3
"""A run of more equal characters than this is sent as their number and one of them, which is shorter."""


def encode(picture: Pixels) -> str:
    """Return the sixel codes that draw a picture at the cursor; terminals differ in where the cursor is afterwards.

    Args:
        picture: Shape (height, width, 3). If it has more than `MAX_COLORS` colours, each is replaced by the nearest one
            of a palette.
    """
    height_px, width_px = picture.shape[:2]
    colors, numbers = _find_palette(picture)
    parts = [f'{_BEGIN}"1;1;{width_px};{height_px}']
    parts += [_define_color(number, color) for number, color in enumerate(colors)]
    parts += [
        "-".join(
            _encode_band(numbers[top : top + BAND_PX]) for top in range(0, height_px, BAND_PX)
        ),
        _END,
    ]
    return "".join(parts)


def _find_palette(picture: Pixels) -> tuple[list[tuple[int, ...]], npt.NDArray[np.intp]]:
    """Return the colours of a picture, and the index of the colour of each pixel, shape (height, width)."""
    packed = picture.astype(np.int32) @ np.array([1 << 16, 1 << 8, 1], np.int32)
    colors_found, numbers = np.unique(packed, return_inverse=True)
    if len(colors_found) > MAX_COLORS:
        return _reduce_palette(picture)
    return [unpack_rgb(color) for color in colors_found.tolist()], numbers.reshape(packed.shape)


def _reduce_palette(picture: Pixels) -> tuple[list[tuple[int, ...]], npt.NDArray[np.intp]]:
    # This is imported on demand, since most pictures have few colours.
    from PIL import Image

    image = Image.fromarray(picture).quantize(MAX_COLORS, dither=Image.Dither.NONE)
    channels = image.getpalette() or []
    colors = [tuple(channels[start : start + 3]) for start in range(0, len(channels), 3)]
    return colors, np.asarray(image, np.intp)


def _define_color(number: int, color: tuple[int, ...]) -> str:
    red, green, blue = (round(channel * PERCENT / 255) for channel in color)
    return f"#{number};2;{red};{green};{blue}"


def _encode_band(numbers: npt.NDArray[np.intp]) -> str:
    """Return the codes of up to six rows of pixels, one colour after another.

    Args:
        numbers: The index of the colour of each pixel, shape (rows, width).
    """
    colors, places = np.unique(numbers, return_inverse=True)
    rows, cols = numbers.shape
    bits = np.repeat(1 << np.arange(rows), cols)
    positions = places.ravel() * cols + np.tile(np.arange(cols), rows)
    columns = (
        np.bincount(positions, bits, len(colors) * cols).astype(np.intp).reshape(len(colors), cols)
    )
    # A run begins at each change, and in the first column.
    begins = np.diff(columns, axis=1, prepend=-1) != 0
    owners, starts = np.nonzero(begins)
    values = columns[begins]
    lengths = np.diff(starts, append=cols)
    last = np.flatnonzero(np.diff(owners, append=len(colors)))
    # A run at the end of a colour is left out if it draws nothing.
    lengths[last] = np.where(values[last] == 0, 0, cols - starts[last])
    lines: list[list[str]] = [[f"#{color}"] for color in colors.tolist()]
    characters = map(chr, (values + _FIRST_CHARACTER).tolist())
    for owner, character, length in zip(owners.tolist(), characters, lengths.tolist(), strict=True):
        lines[owner].append(character * length if length <= _SHORT_RUN else f"!{length}{character}")
    return "$".join(map("".join, lines))
