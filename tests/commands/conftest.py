"""What the tests of batches on the command line share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.batch.stand_in import run_backwards
from tuisim.batch import sweep
from tuisim.cli import run_command

PROGRAM = "tank_drive.on_for_seconds(40, 40, 0.3)\nprint('Gyro: ' + str(gyro.angle))\n"


SPEC = """
[batch]
program = "mine.py"
seeds = "0..2"
out = "rows.csv"
set.noise.motor = [0, 20]
expressions.far_mm = "hypot(x_mm, y_mm)"
"""


Batch = Callable[..., int]


@pytest.fixture
def batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Batch:
    """Run the command in an own folder, with results that are computed and come in reverse order."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sweep, "run_many", run_backwards)
    Path("mine.py").write_text(PROGRAM)
    return lambda *words: run_command(["batch", *words])
