"""Frames as animated images: GIF and WebP."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL.Image import Dither, Image, Quantize, fromarray, new

Draw = Callable[[int], Image]
"""Returns a frame by its index; called in order."""

PALETTE_FRAMES = 6
"""Frames that the palette of a GIF is derived from."""
_COLORS, _EXACT = 255, 64
"""Colours of a GIF, of which one more stands for what stays the same from frame to frame, and how many of them are the
most frequent ones, unchanged."""


def gif(draw: Draw, palette_of: Sequence[Image], durations_ms: Sequence[int]) -> bytes:
    """Return an animated GIF that repeats for ever.

    Args:
        draw: Draws the frames.
        palette_of: Frames whose colours its palette holds.
        durations_ms: How long each frame is shown; multiples of 10.
    """
    palette = _Palette(palette_of)
    frames = (palette.reduced(draw(at)) for at in range(len(durations_ms)))
    return _saved(
        next(frames), frames, "GIF", duration=list(durations_ms), disposal=1, optimize=True
    )


class _Palette:
    """At most 255 colours: the most frequent ones of some frames unchanged, and some near the others.

    Args:
        frames: The frames.
    """

    def __init__(self, frames: Sequence[Image]) -> None:
        pixels = np.concatenate([np.asarray(frame).reshape(-1, 3) for frame in frames])
        packed = _packed(pixels)
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

    def reduced(self, frame: Image) -> Image:
        """Return a frame in these colours."""
        reduced = frame.quantize(palette=self._image, dither=Dither.NONE)
        # Pillow takes colours that differ little for the same, also where one of them is in the palette.
        packed = _packed(np.asarray(frame))
        nearest = np.minimum(np.searchsorted(self._frequent, packed), len(self._frequent) - 1)
        numbers = np.where(self._frequent[nearest] == packed, nearest, np.asarray(reduced)).astype(
            np.uint8
        )
        exact = fromarray(numbers)
        exact.putpalette(reduced.getpalette() or ())
        return exact


def _packed(pixels: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint32]:
    """Return each red, green and blue as one number."""
    return pixels.astype(np.uint32) @ np.array([1 << 16, 1 << 8, 1], np.uint32)


class _Reel(Image):
    """All frames as one image that draws a frame when it is asked for, so that they need not be in memory."""

    def __init__(self, draw: Draw, count: int) -> None:
        super().__init__()
        self._draw, self._at = draw, -1
        self.n_frames = count
        self.seek(0)

    def seek(self, frame: int) -> None:
        """Go to a frame; never back."""
        if frame > self._at:
            drawn = self._draw(frame)
            self.im, self._mode, self._size, self._at = drawn.im, drawn.mode, drawn.size, frame

    def tell(self) -> int:
        """Return the index of the frame."""
        return self._at


def webp(draw: Draw, durations_ms: Sequence[int], *, lossless: bool = True) -> bytes:
    """Return an animated WebP that repeats for ever."""
    # Without loss, the quality is the effort. More of it takes several times as long and saves a tenth.
    how = {"lossless": True, "quality": 20} if lossless else {"lossless": False, "quality": 40}
    reel = _Reel(draw, len(durations_ms))
    return _saved(
        reel, (), "WEBP", duration=list(durations_ms), method=2, minimize_size=True, **how
    )


def _saved(first: Image, others: Iterable[Image], kind: str, **how: Any) -> bytes:
    content = io.BytesIO()
    first.save(content, kind, save_all=True, append_images=others, loop=0, **how)
    return content.getvalue()
