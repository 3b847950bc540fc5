"""Noise that depends only on seed, tick and sensor: reading a value twice or late does not change it.

The stream is SHAKE-128, the same on every machine and Python version.
"""

from __future__ import annotations

from functools import lru_cache

_BLOCK_TICKS = 256


def stream(seed: int, tick: int, channel: str, size: int) -> bytes:
    """Return `size` random bytes for one seed, tick and channel."""
    # Imported on first use: a program without noise starts faster.
    from hashlib import shake_128

    return shake_128(f"{seed}/{tick}/{channel}".encode()).digest(size)


@lru_cache(maxsize=8)
def _offsets(level: int) -> bytes:
    """Rounded uniform ±level for each byte value, plus 128; +128 itself does not fit a byte."""
    return bytes(min(255, 128 + round(level * (2 * byte / 255 - 1))) for byte in range(256))


_CLAMP = bytes(min(255, max(0, total - 128)) for total in range(512))


def disturb_pixels(pixels: bytes, level: int, seed: int, tick: int, channel: str) -> bytes:
    """Return `pixels` with uniform ±level added to each byte, rounded and clamped to 0 … 255."""
    offsets = stream(seed, tick, channel, len(pixels)).translate(_offsets(level))
    clamp = _CLAMP
    return bytes([clamp[pixel + offset] for pixel, offset in zip(pixels, offsets, strict=True)])


@lru_cache(maxsize=8)
def _wheel_block(seed: int, block: int) -> tuple[float, ...]:
    raw = stream(seed, block, "wheels", _BLOCK_TICKS * 8)
    return tuple(
        int.from_bytes(raw[at : at + 4], "little") / 2147483647.5 - 1.0 for at in range(0, _BLOCK_TICKS * 8, 4)
    )


def wheel_noise(seed: int, tick: int) -> tuple[float, float]:
    """Return two uniform numbers in -1 … 1, for the left and right wheel in one tick."""
    block, offset = divmod(tick, _BLOCK_TICKS)
    numbers = _wheel_block(seed, block)
    return numbers[2 * offset], numbers[2 * offset + 1]
