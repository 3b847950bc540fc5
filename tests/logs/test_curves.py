"""A curve has no bands, however slow it is and however finely it is read."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cases import cases
from tests.logs.test_bands_widths import read_mat
from tuisim.engine.runs.arrays import FloatArray
from tuisim.logs.plateaus import find_plateaus

PLACES = np.arange(4000.0)
RADIAL = np.round(35.0 + 0.025 * PLACES + 8e-6 * PLACES**2) / 2.55

CURVES = {
    "a sine": 50.0 + 40.0 * np.sin(PLACES / 500.0),
    "a slower sine": 50.0 + 40.0 * np.sin(PLACES / 1000.0),
    "a sine in steps of 0.1": np.round(50.0 + 40.0 * np.sin(PLACES / 500.0), 1),
    "a chirp": 50.0 + 40.0 * np.sin((PLACES / 400.0) ** 2),
    "a decay": 100.0 * np.exp(-PLACES[:3000] / 600.0),
    "a damped oscillation": 50.0 + 40.0 * np.exp(-PLACES / 1500.0) * np.cos(PLACES / 300.0),
    "a ramp in whole numbers": np.round(np.linspace(0.0, 100.0, 3000)),
    "a short ramp in whole numbers": np.round(np.linspace(0.0, 100.0, 300)),
    "a ramp of a sensor with 256 steps": np.round(np.linspace(0.0, 255.0, 3000)) / 2.55,
    "a root": np.sqrt(PLACES[:3000]),
    "a soft step": 50.0 + 50.0 * np.tanh(PLACES[:3000] / 400.0 - 3.75),
    "a gradient of greys": RADIAL,
    "a gradient of greys at twice the speed": RADIAL[::2],
}


@cases("values", CURVES)
def test_a_curve_has_no_bands(values: FloatArray) -> None:
    assert not len(find_plateaus(values))


def test_only_the_flat_tops_of_a_wave_in_whole_numbers_are_bands() -> None:
    wave = np.round(50.0 + 40.0 * np.sin(PLACES / 500.0))
    assert set(find_plateaus(wave)["level"]) == {10.0, 90.0}


def test_a_flat_part_before_a_curve_is_a_band() -> None:
    values = np.concatenate(([10.0] * 400, 110.0 - 100.0 * np.exp(-PLACES[:1500] / 300.0)))
    assert find_plateaus(values)["level"] == pytest.approx([10.0], abs=0.1)


@pytest.mark.parametrize("seed", range(3))
def test_a_slow_robot_finds_no_bands_on_edges_that_noise_hides(seed: int) -> None:
    edges_mm = 60.0 + 200.0 * np.arange(5.0)
    values = read_mat(np.arange(0.0, 900.0, 0.4), edges_mm, 20.0)
    values += np.random.default_rng(seed).normal(0.0, 0.6, len(values))
    assert find_plateaus(values)["level"] == pytest.approx(
        [100.0, 86.0, 100.0, 50.0, 0.0, 83.0], abs=1.0
    )
