"""The world beside a log: which logs have one, and where the robot is in it."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa
import pytest

from tests.engine.runs.run_recorder import begun
from tuisim.analysis.source import LogRequest, OpenedLog
from tuisim.app.analyser.world import has_poses, load_world
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tree import dump_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.logs.columns import choose_columns
from tuisim.logs.log import Log

SPEC = RunSpec(RobotSpec(), WorldSpec(start=Pose(300, 500, 0)), ROBOLAB)
POSES: dict[str, list[float | None]] = {
    "x_mm": [1.0, 2.0],
    "y_mm": [3.0, 4.0],
    "heading_deg": [5.0, None],
}


def opened(metadata: dict[str, object], **columns: list[float | None]) -> OpenedLog:
    """A file with metadata."""
    table = pa.table({"time": [0.0, 1.0], "light": [1.0, 2.0], **columns})
    return OpenedLog(
        LogRequest(file="a.csv"), Log("a.csv", table, choose_columns(table), metadata=metadata)
    )


@pytest.fixture
def run(home: Path) -> StoredRun:
    """A run of half a second in two lines."""
    recorder = begun(RunStore(), SPEC)
    recorder.drive(360, 360, 20, line=3)
    recorder.drive(0, 0, 30, line=4)
    return recorder.end()


@pytest.mark.parametrize(
    "log, has",
    [
        (opened({"runs": [dump_run(SPEC)]}, **POSES), True),
        (opened({"runs": [{**dump_run(SPEC), "run": 1, "program": "p.py"}]}, **POSES), True),
        (opened({"runs": [dump_run(SPEC)]}, x_mm=POSES["x_mm"]), False),
        (opened({"runs": [{"robot": 3}]}, **POSES), False),
        (opened({}, **POSES), False),
    ],
    ids=["poses", "as exported", "no heading", "damaged", "nothing known"],
)
def test_a_log_file_shows_a_world_only_if_it_describes_its_run(log: OpenedLog, has: bool) -> None:
    assert has_poses(log) is has
    assert (load_world(log, 0) is not None) is has


def test_the_world_beside_a_log_file_has_the_pose_of_the_selected_row(home: Path) -> None:
    world = load_world(opened({"runs": [dump_run(SPEC)]}, **POSES), 0)
    assert world is not None
    assert [world.find_snapshot(float(row), row).instant.pose for row in (0, 1)] == [
        Pose(1, 3, 5),
        Pose(2, 4, 0),
    ]


def test_the_world_beside_a_stored_run_can_show_any_instant_between_samples(run: StoredRun) -> None:
    table = pa.table({"time": [0.0], "light": [1.0]})
    log = OpenedLog(
        LogRequest(runs=(run.id,)), Log("run", table, choose_columns(table)), runs=(run,)
    )
    world = load_world(log, 0)
    assert world is not None and has_poses(log)
    assert [world.find_snapshot(time_s, 0).line for time_s in (0.1, 0.4)] == [3, 4]
    assert (
        world.find_snapshot(0.1, 0).instant.pose.x_mm
        < world.find_snapshot(0.4, 0).instant.pose.x_mm
    )
    # Sensors show what the program reads.
    assert world.find_snapshot(0.1, 0).program == run.program
    # Before the first and after the last tick stand the ends.
    assert world.find_snapshot(-5.0, 0).instant.pose == SPEC.world.start
    assert world.find_snapshot(99.0, 0).instant.tick == 50
