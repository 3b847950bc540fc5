"""The profile `nbev3devsim` to the last bit, as recorded.

The old simulator ran the first 101 programs, and a second model without a line of tuisim the other 20, with threads.
"""

from __future__ import annotations

import gzip
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.engine.core.motor_lab import Course, Job, courses
from tuisim.base.errors import RobotError
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import RobotSpec, WorldSpec
from tuisim.engine.files import Location
from tuisim.settings.robots import ROBOTS, parse_json_robot

with gzip.open(Path(__file__).with_name("motor_records.jsonl.gz"), "rt", encoding="utf-8") as _file:
    RECORDS: Mapping[str, dict[str, Any]] = {
        record["name"]: record for record in map(json.loads, _file)
    }


def _robot(described: str | dict[str, Any]) -> RobotSpec:
    if isinstance(described, str):
        return ROBOTS[described]
    return parse_json_robot(described, "recorded", Location("robot.json", RobotError)).spec


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Course]:
    """What becomes of every program: one process for all of them is quick."""
    jobs = {
        name: Job(
            one["program"],
            WorldSpec(start=Pose(*map(float, one["start"]))),
            _robot(one["robot"]),
            one["preload"],
        )
        for name, one in RECORDS.items()
    }
    return dict(zip(jobs, courses(jobs.values(), tmp_path_factory.mktemp("lab")), strict=True))


@pytest.mark.slow_cases("on_spin", "pairs_made_anew")
@pytest.mark.parametrize("name", RECORDS)
def test_programs_run_as_recorded_from_the_old_simulator(
    name: str, lab: Mapping[str, Course]
) -> None:
    record = RECORDS[name]
    done = lab[name]
    assert done.rows == [row[2:] for row in record["rows"]]
    assert done.lines == [tuple(line) for line in record["lines"]]
    assert (done.end, done.end_tick, done.end_ms) == (
        record["status"],
        record["end_tick"],
        record["end_ms"],
    )
