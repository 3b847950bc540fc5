"""The law of light noise: what a sensor reads is distributed as the mean of pixels that each have their own error."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from math import sqrt

import pytest

from tuisim.engine.core.noise import (
    add_noise_to_channel,
    add_noise_to_sums,
    compute_clamping,
    draw_reading_noise,
    generate_bytes,
)

COUNT = 305
"""Pixels of a disc of 20 mm."""
MOST = 5.0
"""Standard errors that an estimate may be from what it estimates: one of 1.7 million is farther."""


def mixed(*values: int) -> bytes:
    """A disc with equal parts of some greys."""
    return b"".join(bytes([values[at % len(values)]]) * 3 for at in range(COUNT))


DISCS: dict[str, tuple[bytes, int]] = {
    "white": (mixed(255), 10),
    "black": (mixed(0), 50),
    "at the edge of a line": (mixed(255, 0, 255, 131), 10),
    "grey, never clamped": (mixed(128, 110), 20),
    "grey, half of it clamped": (mixed(*range(0, 256, 5)), 100),
    "as strong as it can be": (mixed(40, 200), 128),
}


def drawn(disc: bytes, level: int, count: int) -> Iterator[tuple[float, ...]]:
    """Mean channels as they are read."""
    sums = sum(disc[0::3]), sum(disc[1::3]), sum(disc[2::3])
    for tick in range(count):
        yield tuple(
            one / COUNT
            for one in add_noise_to_sums(
                lambda: disc, COUNT, sums, level, draw_reading_noise(7, tick, "left")
            )
        )


def of_pixels(disc: bytes, level: int, count: int) -> Iterator[tuple[float, ...]]:
    """Mean channels of pixels that each have their own error, from Python's own random numbers."""
    chance = random.Random(11)
    errors = [round(level * (2 * byte / 255 - 1)) for byte in range(256)]
    tables = {
        value: bytes(min(max(value + error, 0), 255) for error in errors) for value in set(disc)
    }
    counts = {value: disc[0::3].count(value) for value in set(disc)}
    for _ in range(count):
        yield tuple(
            sum(
                sum(chance.randbytes(number).translate(tables[value]))
                for value, number in counts.items()
            )
            / COUNT
            for _ in range(3)
        )


def moments(values: list[float]) -> tuple[float, float]:
    mean = sum(values) / len(values)
    return mean, sum((value - mean) ** 2 for value in values) / len(values)


def compare(disc: bytes, level: int, count: int) -> None:
    """Assert that mean and variance agree, and that channels and neighbouring ticks are independent."""
    found = list(drawn(disc, level, count))
    expected = list(of_pixels(disc, level, count))
    for one, other in zip(zip(*found, strict=True), zip(*expected, strict=True), strict=True):
        (mean, variance), (usual, usual_variance) = moments(list(one)), moments(list(other))
        assert abs(mean - usual) <= MOST * sqrt((variance + usual_variance) / count)
        assert abs(variance / usual_variance - 1) <= MOST * sqrt(2 * 2 / count)
    red, green, blue = zip(*found, strict=True)
    for one, other in ((red, green), (green, blue), (red, blue), (red, red[1:]), (blue, blue[1:])):
        assert abs(correlation(one, other)) <= MOST / sqrt(count)


def correlation(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    pairs = list(zip(one, other, strict=False))
    (mean, variance), (usual, usual_variance) = (
        moments([pair[at] for pair in pairs]) for at in (0, 1)
    )
    return (
        sum((a - mean) * (b - usual) for a, b in pairs)
        / len(pairs)
        / sqrt(variance * usual_variance)
    )


@pytest.mark.parametrize("kind", DISCS)
def test_readings_are_distributed_as_means_of_pixels(kind: str) -> None:
    compare(*DISCS[kind], 2_000)


@pytest.mark.parametrize("level", [1, 10, 128])
def test_mean_and_variance_of_clamped_noise_are_computed_exactly(level: int) -> None:
    law = compute_clamping(level)
    errors = [round(level * (2 * byte / 255 - 1)) for byte in range(256)]
    for value in range(256):
        mean, variance = moments([float(min(max(value + error, 0), 255)) for error in errors])
        assert (value + law.shift[value], law.variance[value]) == pytest.approx(
            (mean, variance), abs=1e-6
        )


@pytest.mark.parametrize("kind", DISCS)
def test_noisy_pixels_sum_up_to_the_noisy_reading(kind: str) -> None:
    disc, level = DISCS[kind]
    channel = disc[0::3]
    sums = sum(channel), sum(channel), sum(channel)
    for tick in range(60):
        total = add_noise_to_sums(
            lambda: disc, COUNT, sums, level, draw_reading_noise(3, tick, "right")
        )[0]
        pixels = add_noise_to_channel(
            channel, total, level, generate_bytes(3, tick, "right", COUNT)
        )
        assert sum(pixels) == total
        assert all(
            abs(pixel - clear) <= level for pixel, clear in zip(pixels, channel, strict=True)
        )


def test_each_random_number_raises_only_its_own_colour_channel() -> None:
    disc, level = DISCS["grey, never clamped"]
    sums = sum(disc[0::3]), sum(disc[1::3]), sum(disc[2::3])
    still = add_noise_to_sums(lambda: disc, COUNT, sums, level, (0.0, 0.0, 0.0))
    for channel in range(3):
        numbers = [0.0, 0.0, 0.0]
        numbers[channel] = 1.0
        moved = add_noise_to_sums(lambda: disc, COUNT, sums, level, (*numbers,))
        assert [new > old for new, old in zip(moved, still, strict=True)] == [
            number > 0 for number in numbers
        ]


@pytest.mark.parametrize("other", [(2, 5, "left"), (1, 6, "left"), (1, 5, "right")])
def test_readings_noise_depends_on_seed_tick_and_sensor(other: tuple[int, int, str]) -> None:
    read: Callable[..., tuple[float, ...]] = draw_reading_noise
    assert read(1, 5, "left") == read(1, 5, "left") != read(*other)
