"""Noise that depends only on seed, tick and sensor: reading a value twice or late does not change it.

The stream is SHAKE-128, the same on every machine and Python version.

The light noise adds an error to each pixel under a sensor, evenly distributed and clamped to the range of a pixel. A
sensor reads the mean of many pixels, so only the error of the mean is drawn, from a normal distribution with the mean
and the spread that the errors of these pixels have together. The errors of the pixels themselves are drawn only when
somebody looks at the pixels, in such a way that their mean is the value that was read.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, lru_cache
from itertools import accumulate
from math import cos, log, pi, sin, sqrt
from struct import Struct
from typing import Any, NamedTuple

_BLOCK_TICKS = 256
_PIXEL_MAX = 255
_NUMBERS = 2**32
_TURN = 2 * pi / _NUMBERS
_EXTREMES = bytes((0, _PIXEL_MAX))
_FOUR_NUMBERS = Struct("<4I")
_READING_BYTES = _FOUR_NUMBERS.size
_WHEEL_NUMBERS = Struct(f"<{2 * _BLOCK_TICKS}I")


@cache
def _load_shake_128() -> Any:
    # Imported on first use: a program without noise starts faster.
    from hashlib import shake_128

    return shake_128


def prepare() -> None:
    """Import the module that generates random bytes, so that the first call of `generate_bytes` need not import it."""
    _load_shake_128()


def generate_bytes(seed: int, tick: int, channel: str, size: int) -> bytes:
    """Return random bytes that are always the same for the same arguments.

    Args:
        seed: The seed of the run.
        tick: The tick, or another number that makes the bytes differ.
        channel: A name for what the bytes are used for, such as a sensor's: each name has bytes of its own.
        size: The number of bytes.
    """
    random: bytes = _load_shake_128()(f"{seed}/{tick}/{channel}".encode()).digest(size)
    return random


@lru_cache(maxsize=8)
def _list_errors(level: int) -> tuple[int, ...]:
    """Return for each value of a random byte, 0 to 255, the error that it causes in a channel of a pixel.

    The errors are whole numbers, evenly distributed from -level to level.
    """
    return tuple(round(level * (2 * byte / 255 - 1)) for byte in range(256))


class Clamping(NamedTuple):
    """The mean and the variance of the light noise of a pixel, after its noisy value is clamped to 0 … 255.

    Both depend on the value, 0 to 255, that the pixel has without noise. Each noise level has an object of this class.
    """

    shift: tuple[float, ...]
    """Mean error of each pixel value, 0 to 255; not 0 near both ends, because noisy values are clamped there."""
    variance: tuple[float, ...]
    """Variance of the error of each pixel value, 0 to 255."""
    even: bytes
    """The pixel values that are never clamped: their mean error is 0, and the variance is `even_variance`."""
    even_variance: float


@lru_cache(maxsize=8)
def compute_clamping(level: int) -> Clamping:
    """Return mean and variance that noise of up to ±`level` has after clamping, for each value of a pixel."""
    errors = sorted(_list_errors(level))
    first = [0, *accumulate(errors)]
    second = [0, *accumulate(error * error for error in errors)]
    shift = []
    variance = []
    count = len(errors)
    below = 0
    above = len(errors)
    for value in range(_PIXEL_MAX + 1):
        # Errors between the indices `below` and `above` keep the value in the range.
        while below and errors[below - 1] >= -value:
            below -= 1
        while below < count and errors[below] < -value:
            below += 1
        while above and errors[above - 1] > _PIXEL_MAX - value:
            above -= 1
        under = below
        over = count - above
        total = first[above] - first[below] - under * value + over * (_PIXEL_MAX - value)
        squares = (
            second[above] - second[below] + under * value**2 + over * (_PIXEL_MAX - value) ** 2
        )
        shift.append(total / count)
        variance.append(squares / count - (total / count) ** 2)
    even = bytes(value for value in range(_PIXEL_MAX + 1) if level <= value <= _PIXEL_MAX - level)
    return Clamping(tuple(shift), tuple(variance), even, second[-1] / count)


def add_noise_to_sums(
    disc: Callable[[], bytes],
    count: int,
    sums: tuple[int, int, int],
    level: int,
    normals: tuple[float, ...],
) -> tuple[int, int, int]:
    """Return the sums of red, green and blue of some pixels with the light noise added.

    Args:
        disc: Returns the pixels, three bytes each; not called if all are white, or all black.
        count: The number of pixels.
        sums: The sums of red, green and blue without noise.
        level: The largest error of a pixel.
        normals: Three normally distributed numbers.
    """
    max_sum = _PIXEL_MAX * count
    if sums == (0, 0, 0) or sums == (max_sum, max_sum, max_sum):
        red = green = blue = b"\xff" * count if sums[0] else bytes(count)
    else:
        pixels = disc()
        red, green, blue = pixels[0::3], pixels[1::3], pixels[2::3]
    shift, spread = red_shift, red_spread = _compute_shift(red, level)
    first = round(sums[0] + shift + spread * normals[0])
    # Most mats are grey: equal channels have the same mean error, which is then computed only once.
    shift, spread = (red_shift, red_spread) if green == red else _compute_shift(green, level)
    second = round(sums[1] + shift + spread * normals[1])
    shift, spread = (red_shift, red_spread) if blue == red else _compute_shift(blue, level)
    third = round(sums[2] + shift + spread * normals[2])
    if 0 <= first <= max_sum and 0 <= second <= max_sum and 0 <= third <= max_sum:
        return first, second, third
    return min(max(first, 0), max_sum), min(max(second, 0), max_sum), min(max(third, 0), max_sum)


def _compute_shift(values: bytes, level: int) -> tuple[float, float]:
    """Return the mean and the standard deviation of the error that noise causes in the sum of some pixel values.

    Args:
        values: The values of one channel of the pixels.
        level: The largest error of a pixel.
    """
    law = compute_clamping(level)
    count = len(values)
    if values.count(values[0]) == count:
        return count * law.shift[values[0]], sqrt(count * law.variance[values[0]])
    clamped = values.translate(None, law.even)
    variance = (count - len(clamped)) * law.even_variance
    if not clamped:
        return 0.0, sqrt(variance)
    # Most values that errors can clamp are those of black or white: these are counted without a loop.
    dark = clamped.count(0)
    bright = clamped.count(_PIXEL_MAX)
    shift = dark * law.shift[0] + bright * law.shift[_PIXEL_MAX]
    variance += dark * law.variance[0] + bright * law.variance[_PIXEL_MAX]
    if dark + bright < len(clamped):
        for value in clamped.translate(None, _EXTREMES):
            shift += law.shift[value]
            variance += law.variance[value]
    return shift, sqrt(variance)


@lru_cache(maxsize=8)
def _generate_reading_block(seed: int, block: int, channel: str) -> bytes:
    return generate_bytes(seed, block, f"{channel}/mean", _BLOCK_TICKS * _READING_BYTES)


def draw_numbers(seed: int, tick: int, channel: str, count: int) -> list[float]:
    """Return random numbers, uniformly distributed from 0 up to 1, that are always the same for the same arguments.

    Args:
        seed: The seed of the run.
        tick: The tick, or another number that makes the numbers differ.
        channel: A name for what the numbers are used for: each name has numbers of its own.
        count: How many numbers to return.
    """
    numbers = Struct(f"<{count}I").unpack(generate_bytes(seed, tick, channel, 4 * count))
    return [number / _NUMBERS for number in numbers]


def draw_reading_noise(seed: int, tick: int, channel: str) -> tuple[float, float, float]:
    """Return three normally distributed numbers for the light noise of a colour sensor's reading in one tick.

    `channel` is the name of the sensor: each sensor has noise of its own.
    """
    block, offset = divmod(tick, _BLOCK_TICKS)
    numbers = _FOUR_NUMBERS.unpack_from(
        _generate_reading_block(seed, block, channel), offset * _READING_BYTES
    )
    radius, turn, other, further = numbers
    # The Box-Muller transform: two numbers come from one pair of evenly distributed ones, the third from another.
    far = sqrt(-2 * log((radius + 1) / _NUMBERS))
    angle = turn * _TURN
    return (
        far * cos(angle),
        far * sin(angle),
        sqrt(-2 * log((other + 1) / _NUMBERS)) * cos(further * _TURN),
    )


def add_noise_to_channel(pixels: bytes, total: int, level: int, random: bytes) -> bytes:
    """Return one channel of some pixels with errors of up to ±level, chosen so that the sum is `total`.

    Args:
        pixels: The values of the channel.
        total: Their sum after the noise, from `add_noise_to_sums`.
        level: The largest error of a pixel.
        random: As many random bytes as there are pixels.
    """
    errors = _list_errors(level)
    values = [
        min(max(pixel + errors[byte], 0), _PIXEL_MAX)
        for pixel, byte in zip(pixels, random, strict=True)
    ]
    missing = total - sum(values)
    step = 1 if missing > 0 else -1
    # Steps of 1 at pixels in a random order hardly change how the errors are distributed.
    order = sorted(range(len(values)), key=random.__getitem__)
    while missing:
        before = missing
        for index in order:
            if (
                missing
                and 0 <= values[index] + step <= _PIXEL_MAX
                and abs(values[index] + step - pixels[index]) <= level
            ):
                values[index] += step
                missing -= step
        if missing == before:
            break
    return bytes(values)


@lru_cache(maxsize=8)
def _generate_wheel_block(
    seed: int, block: int, most: float, channel: str = "wheels"
) -> tuple[list[float], list[float]]:
    numbers = _WHEEL_NUMBERS.unpack(generate_bytes(seed, block, channel, _WHEEL_NUMBERS.size))
    noises = [(number / 2147483647.5 - 1.0) * most for number in numbers]
    return noises[0::2], noises[1::2]


def draw_noises(seed: int, tick: int, count: int, most_dps: int) -> tuple[list[float], list[float]]:
    """Return the speed noise of the left and the right wheel in `count` ticks from `tick` on, in degrees per second.

    It is uniformly distributed from -most_dps to most_dps.
    """
    block, offset = divmod(tick, _BLOCK_TICKS)
    left, right = _generate_wheel_block(seed, block, most_dps)
    left, right = left[offset : offset + count], right[offset : offset + count]
    while len(left) < count:
        block = block + 1
        missing = count - len(left)
        more = _generate_wheel_block(seed, block, most_dps)
        left, right = left + more[0][:missing], right + more[1][:missing]
    return left, right


def draw_noise(seed: int, tick: int, most_dps: int) -> tuple[float, float]:
    """Return the speed noise of the left and the right wheel in one tick, in degrees per second.

    It is uniformly distributed from -most_dps to most_dps.
    """
    left, right = _generate_wheel_block(seed, tick // _BLOCK_TICKS, most_dps)
    return left[tick % _BLOCK_TICKS], right[tick % _BLOCK_TICKS]


def draw_slip(seed: int, tick: int) -> tuple[float, float]:
    """Return two random factors for a tick: for how much the left and the right wheel slide on the floor.

    The factors are uniformly distributed around 0, with a variance of 1.
    """
    left, right = _generate_wheel_block(seed, tick // _BLOCK_TICKS, sqrt(3), "slip")
    return left[tick % _BLOCK_TICKS], right[tick % _BLOCK_TICKS]
