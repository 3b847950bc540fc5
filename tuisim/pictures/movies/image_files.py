"""Frames as an animated GIF."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt
from PIL.Image import Dither, Image, Quantize, fromarray, new

PALETTE_FRAMES = 6
"""Frames that the palette of a GIF is derived from."""
_COLORS = 255
_EXACT = 64
"""Colours of a GIF, of which one more stands for what stays the same from frame to frame, and how many of them are the
most frequent ones, unchanged."""


def encode_gif(
    frames: Iterator[Image], samples: Sequence[Image], durations_ms: Sequence[int]
) -> bytes:
    """Return an animated GIF that repeats for ever.

    Args:
        frames: The frames; at least one.
        samples: Frames from whose colours the palette is made.
        durations_ms: How long each frame is shown; multiples of 10.
    """
    palette = _Palette(samples)
    content = io.BytesIO()
    reduced = map(palette.reduce, frames)
    next(reduced).save(
        content,
        "GIF",
        save_all=True,
        append_images=reduced,
        loop=0,
        duration=list(durations_ms),
        disposal=1,
        optimize=True,
    )
    return content.getvalue()


class _Palette:
    """At most 255 colours: the most frequent ones of some frames unchanged, and colours near the others.

    Args:
        frames: The frames.
    """

    def __init__(self, frames: Sequence[Image]) -> None:
        pixels = np.concatenate([np.asarray(frame).reshape(-1, 3) for frame in frames])
        packed = _pack_pixels(pixels)
        colors, counts = np.unique(packed, return_counts=True)
        self._frequent = np.sort(colors[np.argsort(-counts, kind="stable")[:_EXACT]])
        content = b"".join(int(color).to_bytes(3, "big") for color in self._frequent)
        others = pixels[~np.isin(packed, self._frequent)]
        if len(others):
            left = _COLORS - len(self._frequent)
            reduced = fromarray(others[np.newaxis]).quantize(left, Quantize.MEDIANCUT)
            content += bytes(reduced.getpalette() or ())
        self._image = new("P", (1, 1))
        self._image.putpalette(content)

    def reduce(self, frame: Image) -> Image:
        """Return a frame in the colours of the palette."""
        reduced = frame.quantize(palette=self._image, dither=Dither.NONE)
        # Pillow takes colours that differ little for the same, also where one of them is in the palette.
        packed = _pack_pixels(np.asarray(frame))
        nearest = np.minimum(np.searchsorted(self._frequent, packed), len(self._frequent) - 1)
        numbers = np.where(self._frequent[nearest] == packed, nearest, np.asarray(reduced)).astype(
            np.uint8
        )
        exact = fromarray(numbers)
        exact.putpalette(reduced.getpalette() or ())
        return exact


def _pack_pixels(pixels: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    """Return red, green and blue of each pixel as one number."""
    return pixels.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)
