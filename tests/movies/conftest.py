"""A recorded run for the tests of movies."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.runs.run_recorder import begun
from tuisim.core.geometry import Pose
from tuisim.core.profile import ROBOLAB
from tuisim.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.movies.clip import Recorded
from tuisim.runs.store import RunStore

SPEC = RunSpec(RobotSpec(), WorldSpec("Grey_bands", start=Pose(600, 570, 0)), ROBOLAB)


@pytest.fixture
def recorded(home: Path) -> Recorded:
    """Half a second in which the robot drives, and two values are printed."""
    recorder = begun(RunStore(), SPEC)
    for value in (100, 50):
        recorder.print(f"Colour: {value}")
        recorder.drive(1000, 1000, 25)
    return Recorded(recorder.end())
