"""A recorded run for the tests of movies."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.runs.run_recorder import begun
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.store import RunStore
from tuisim.pictures.movies.clip import ClipRun

SPEC = RunSpec(RobotSpec(), WorldSpec("Grey_bands", start=Pose(600, 570, 0)), ROBOLAB)


@pytest.fixture
def recorded(home: Path) -> ClipRun:
    """Half a second in which the robot drives, and two values are printed."""
    recorder = begun(RunStore(), SPEC)
    for value in (100, 50):
        recorder.print(f"Colour: {value}")
        recorder.drive(1000, 1000, 25)
    return ClipRun(recorder.end())
