"""The profile `nbev3devsim` to the last bit: recorded programs, and a second model beside the first."""

from __future__ import annotations

import gzip
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.core.motor_lab import Course, Job, courses
from tests.core.motor_programs import PROGRAMS
from tests.core.tick_model import Lab
from tuisim.config.files import Location
from tuisim.config.robots import ROBOTS, robot_from_json
from tuisim.core.geometry import Pose
from tuisim.core.spec import RobotSpec, WorldSpec
from tuisim.errors import RobotError

with gzip.open(Path(__file__).with_name("motor_records.jsonl.gz"), "rt", encoding="utf-8") as _file:
    RECORDS: Mapping[str, dict[str, Any]] = {
        record["name"]: record for record in map(json.loads, _file)
    }

START = (1000.0, 500.0, 0.0)


def _robot(described: str | dict[str, Any]) -> RobotSpec:
    if isinstance(described, str):
        return ROBOTS[described]
    return robot_from_json(described, "recorded", Location("robot.json", RobotError)).spec


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Course]:
    """What becomes of every program, recorded or not: one process for all of them is quick."""
    jobs = {
        name: Job(
            one["program"],
            WorldSpec(start=Pose(*map(float, one["start"]))),
            _robot(one["robot"]),
            one["preload"],
        )
        for name, one in RECORDS.items()
    }
    jobs |= {
        name: Job(text, WorldSpec(start=Pose(*START)), RobotSpec())
        for name, text in PROGRAMS.items()
    }
    return dict(zip(jobs, courses(jobs.values(), tmp_path_factory.mktemp("lab")), strict=True))


@pytest.mark.slow_cases("on_spin")
@pytest.mark.parametrize("name", RECORDS)
def test_a_recorded_program(name: str, lab: Mapping[str, Course]) -> None:
    record, done = RECORDS[name], lab[name]
    assert done.rows == [row[2:] for row in record["rows"]]
    assert done.lines == [tuple(line) for line in record["lines"]]
    assert (done.end, done.end_tick, done.end_ms) == (
        record["status"],
        record["end_tick"],
        record["end_ms"],
    )


def _model(name: str) -> Any:
    return Lab(PROGRAMS[name], *START)  # type: ignore[no-untyped-call]


@pytest.mark.slow_cases("pairs made anew")
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_under_both_models(name: str, lab: Mapping[str, Course]) -> None:
    done, model = lab[name], _model(name)
    assert done.end == "finished"
    assert done.rows == model.rows
    assert done.lines == model.lines
    assert (done.end_tick, done.end_ms) == (model.tick, model.ms)
