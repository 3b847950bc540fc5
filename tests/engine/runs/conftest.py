"""Recorded runs: real files, written by the writers that the child uses, moved by the real simulation."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.engine.runs.run_recorder import Recorder, begun
from tuisim.engine.core.field import Field, build_disc_mask
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import NoiseSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore

MAT_WIDTH_PX, MAT_HEIGHT_PX = 90, 70


@pytest.fixture
def store(tmp_path: Path) -> RunStore:
    """An empty run store."""
    return RunStore(tmp_path / "home")


@pytest.fixture
def spec() -> RunSpec:
    """A robot at the upper left corner of the field, over the small mat of `field`."""
    return RunSpec(RobotSpec(), WorldSpec(start=Pose(5.0, 1110.0, -7.0)), ROBOLAB, seed=3)


@pytest.fixture
def noisy_spec(spec: RunSpec) -> RunSpec:
    """The same with noise on light and motors."""
    return RunSpec(
        spec.robot,
        WorldSpec(start=spec.world.start, noise=NoiseSpec(20, 50)),
        spec.profile,
        spec.seed,
    )


@pytest.fixture
def record(store: RunStore) -> Callable[..., Recorder]:
    """Start a run that is written by hand."""

    return partial(begun, store)


@pytest.fixture
def logged(record: Callable[..., Recorder], spec: RunSpec) -> StoredRun:
    """A finished run with four samples among other lines."""
    recorder = record(spec)
    recorder.print("Colour: 100.0", line=4)
    recorder.drive(300, 320, 10, line=6)
    recorder.print("hello", line=7)
    recorder.print("Colour: 86.27450980392157", line=8)
    recorder.drive(300, 320, 7, line=9)
    recorder.print("NA: -3e-05 12.25", line=10)
    recorder.print("Gyro: 5", line=11)
    return recorder.end()


@pytest.fixture(scope="session")
def field() -> Field:
    """A small mat of random pixels, prepared for the sensors of the default robot."""
    pixels = np.random.default_rng(7).integers(0, 256, (MAT_HEIGHT_PX, MAT_WIDTH_PX, 3), np.uint8)
    diameter = 20
    around = np.pad(pixels.astype(np.uint32), ((diameter, diameter), (diameter, diameter), (0, 0)))
    sums = np.zeros((MAT_HEIGHT_PX + diameter, MAT_WIDTH_PX + diameter, 3), np.uint32)
    for row, cells in enumerate(build_disc_mask(diameter)):
        for col, inside in enumerate(cells):
            if inside:
                sums += around[row : row + len(sums), col : col + sums.shape[1]]
    return Field(
        MAT_WIDTH_PX,
        MAT_HEIGHT_PX,
        memoryview(pixels.tobytes()),
        {diameter: memoryview(sums.tobytes()).cast("I")},
    )
