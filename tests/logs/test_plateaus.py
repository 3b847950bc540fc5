"""The search for bands in a process of its own."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

from tuisim.errors import LogError
from tuisim.logs import plateaus as plateaus_module
from tuisim.logs.plateaus import plateaus, plateaus_in_subprocess


@pytest.mark.slow
def test_finds_the_same_as_here() -> None:
    rng = np.random.default_rng(4)
    values = np.repeat(rng.uniform(0.0, 100.0, 30), 40) + rng.normal(0.0, 0.3, 1200)
    values[[3, 700]] = np.nan, 500.0
    assert plateaus_in_subprocess(values, lambda: False) == plateaus(values) != []


def test_says_that_there_is_no_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    with pytest.raises(LogError, match="No such file"):
        plateaus_in_subprocess(np.zeros(9), lambda: False)


def test_says_that_the_process_has_died(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(LogError, match="exit code 1"):
        plateaus_in_subprocess(np.zeros(9), lambda: False)


def test_ends_when_nobody_waits_for_it() -> None:
    values = np.random.default_rng(4).integers(0, 5, 2_000_000).astype(np.float64)
    with pytest.raises(LogError, match="stopped"):
        plateaus_in_subprocess(values, lambda: True)


def test_it_imports_the_package_of_this_process() -> None:
    assert plateaus_module.__file__ == str(plateaus_module._PACKAGE_FOLDER / "tuisim" / "logs" / "plateaus.py")
