"""The search for bands in a process of its own."""

from __future__ import annotations

import sys
from types import ModuleType

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from tuisim.base.errors import LogError
from tuisim.logs import pieces as pieces_module
from tuisim.logs import plateaus as plateaus_module
from tuisim.logs.plateaus import find_plateaus, find_plateaus_in_subprocess


@pytest.mark.slow
def test_plateaus_found_in_a_subprocess_equal_those_found_directly() -> None:
    rng = np.random.default_rng(4)
    values = np.repeat(rng.uniform(0.0, 100.0, 30), 40) + rng.normal(0.0, 0.3, 1200)
    values[[3, 700]] = np.nan, 500.0
    plateaus = find_plateaus(values)
    assert len(plateaus)
    assert_array_equal(find_plateaus_in_subprocess(values, lambda: False), plateaus)


def test_the_death_of_the_search_process_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(LogError, match="exit code 1"):
        find_plateaus_in_subprocess(np.zeros(9), lambda: False)


def test_the_search_process_stops_when_its_search_is_cancelled() -> None:
    values = np.random.default_rng(4).integers(0, 5, 2_000_000).astype(np.float64)
    with pytest.raises(LogError, match="stopped"):
        find_plateaus_in_subprocess(values, lambda: True)


def test_the_search_process_imports_the_package_of_this_process() -> None:
    assert plateaus_module.__file__ == str(
        plateaus_module._PACKAGE_FOLDER / "tuisim" / "logs" / "plateaus.py"
    )


@pytest.mark.parametrize(
    "module, name, number",
    [
        (plateaus_module, "_FEW_STARTS", 0),
        (plateaus_module, "_FEW_STARTS", 10**6),
        (pieces_module, "_MAX_SAMPLES_TOGETHER", 1),
    ],
)
def test_the_size_of_stretches_searched_together_does_not_change_plateaus(
    module: ModuleType, name: str, number: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(5)
    values = np.repeat(rng.uniform(0.0, 100.0, 40), rng.integers(2, 60, 40))
    values += rng.normal(0.0, 0.5, len(values)) + 40.0 * (rng.random(len(values)) < 0.02)
    found = find_plateaus(values)
    monkeypatch.setattr(module, name, number)
    assert_array_equal(find_plateaus(values), found)


@pytest.mark.parametrize("values", [slice(2), slice(-2, None)], ids=["begin", "end"])
def test_a_long_log_may_begin_and_end_with_a_level_of_two_values(values: slice) -> None:
    noisy = np.random.default_rng(1).normal(
        20.0, 0.3, plateaus_module.MAX_SAMPLES_CUT_ANYWHERE + 1000
    )
    noisy[values] += 30.0
    assert sorted(find_plateaus(noisy)["level"].round(-1)) == [20.0, 50.0]
