"""What has a level, and what moves."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.cases import for_each, for_rows
from tests.logs.test_bands import made_log, short_log
from tuisim.logs.plateaus import find_plateaus


def ramp(samples: int, low: float = 40.0, high: float = 88.0) -> list[float]:
    """Return samples at equal steps."""
    return [float(value) for value in np.linspace(low, high, samples)]


UNLEVEL = {
    **{f"{samples} samples of a ramp": ramp(samples) for samples in (3, 4, 5, 6, 7, 10, 40, 300)},
    "a slow ramp far from zero": ramp(40, 1000.0, 1090.0),
    "an angle": [90.0, 181.0, 271.0, 361.0],
    "a growing slope": (np.linspace(0.0, 1.0, 10) ** 2 * 100.0).tolist(),
    "a wave": (50.0 + 30.0 * np.sin(np.linspace(0.0, 6.0, 15))).tolist(),
    "a saw-tooth far from zero": (120.0 + np.arange(300.0) % 7).tolist(),
    "a few far-apart samples": [361.0, 90.0, 300.0, 181.0],
    "three steps down": [60.0, 41.0, 12.0],
}


@for_rows("values", UNLEVEL)
def test_no_plateau_is_found_in_a_signal_that_keeps_moving(values: list[float]) -> None:
    rng = np.random.default_rng(1)
    assert not len(find_plateaus(np.array(values)))
    assert not len(find_plateaus(np.array(values) + rng.normal(0.0, 0.3, len(values))))


@for_each(samples=[8, 10, 14, 20, 30], noise=[0.0, 0.4])
def test_a_slope_between_two_levels_is_not_taken_for_a_level(samples: int, noise: float) -> None:
    values = np.array([60.0] * 20 + ramp(samples, 62.0, 88.0) + [90.0] * 20)
    values += np.random.default_rng(2).normal(0.0, noise, len(values))
    found = find_plateaus(values)
    assert found["level"] == pytest.approx([60.0, 90.0], abs=0.5)


@pytest.mark.parametrize("make", [lambda seed: made_log(seed).values, lambda seed: short_log(seed)])
def test_a_plateaus_spread_is_that_of_its_samples_without_strays(
    make: Callable[[int], NDArray[np.float64]],
) -> None:
    for seed in range(60):
        values = make(seed)
        for plateau in find_plateaus(values):
            part = values[plateau["start"] : plateau["stop"]]
            # Without strays, which are those farthest from the level.
            nearest = np.argsort(np.abs(part - plateau["level"]))[: len(part) - plateau["strays"]]
            spread = part[nearest].std(ddof=1) if len(nearest) > 1 else 0.0
            assert plateau["spread"] == pytest.approx(spread, abs=0.05)
            assert plateau["strays"] <= len(part) / 3


@pytest.mark.parametrize("samples", [30, 50, 100, 400])
def test_levels_at_both_ends_of_a_slow_slope_are_found(samples: int) -> None:
    values = np.array([10.0] * 20 + ramp(samples, 10.0, 90.0) + [90.0] * 20)
    found = find_plateaus(values)
    # The first steps of the slowest slope are no farther from the level than the smallest step.
    assert found["level"] == pytest.approx([10.0, 90.0], abs=0.02)
    assert max(found["spread"]) < 0.1


@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_the_top_between_two_slopes_is_a_level(noise: float) -> None:
    values = np.array(ramp(60, 0.0, 177.0) + [180.0] * 20 + ramp(40, 176.0, 20.0))
    values += np.random.default_rng(3).normal(0.0, noise, len(values))
    (top,) = find_plateaus(values)
    assert top["level"] == pytest.approx(180.0, abs=noise)
    assert top["stop"] - top["start"] == pytest.approx(20, abs=1 + 4 * noise)
