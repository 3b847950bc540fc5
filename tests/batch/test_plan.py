"""Plans: the tasks of all combinations of programs and parameters, and what identifies a batch."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.batch.parameters import RandomDraw, SampleValues
from tuisim.batch.plan import Plan, Subject
from tuisim.engine.runs.handle import RunOptions
from tuisim.settings.options import Settings

HERE = Path("--set")


def subject(
    name: str = "a.py", given: tuple[str, ...] = (), settings: Mapping[str, Any] | None = None
) -> Subject:
    return Subject(Program(name, "pass"), Settings(settings or {}), frozenset(given))


def plan(choices: dict[str, Any], *subjects: Subject, **how: Any) -> Plan:
    return Plan(subjects or (subject(),), choices, HERE, **how)


def test_every_combination_is_a_task_and_the_seed_varies_fastest() -> None:
    tasks = list(
        plan(
            {"noise.motor": (0, 20), "seed": (5, 6)}, subject("a.py"), subject("b.py")
        ).iterate_tasks()
    )
    found = [
        (task.index, task.program.name, task.spec.world.noise.motor, task.spec.seed)
        for task in tasks
    ]
    assert found == [
        (0, "a.py", 0, 5),
        (1, "a.py", 0, 6),
        (2, "a.py", 20, 5),
        (3, "a.py", 20, 6),
        (4, "b.py", 0, 5),
        (5, "b.py", 0, 6),
        (6, "b.py", 20, 5),
        (7, "b.py", 20, 6),
    ]
    assert tasks[2].parameters == {"noise.motor": 20, "seed": 5}


def test_without_parameters_there_is_one_task_with_the_chosen_seed() -> None:
    (task,) = plan({}, subject(settings={"seed": 4})).iterate_tasks()
    assert (task.spec.seed, dict(task.parameters)) == (4, {})


def test_a_program_runs_in_the_folder_and_with_the_modules_of_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PYTHONPATH", "own")
    (task,) = plan({}).iterate_tasks()
    assert (task.program.working_directory, task.program.python_path) == (
        str(tmp_path),
        (str(tmp_path / "own"),),
    )


def test_a_plan_leaves_out_tasks_that_are_done() -> None:
    assert [task.index for task in plan({"seed": (1, 2, 3, 4)}).iterate_tasks({0, 2})] == [1, 3]


def test_arguments_of_the_program_are_a_parameter() -> None:
    found = [task.program.arguments for task in plan({"arguments": ("5 fast", 6)}).iterate_tasks()]
    assert found == [("5", "fast"), ("6",)]


@cases(
    "name, whole",
    {
        "whole": ("noise.motor", True),
        "real": ("robot.wheel_diameter_mm", False),
    },
)
def test_random_values_are_whole_where_the_setting_takes_whole_numbers(
    name: str, whole: bool
) -> None:
    values = [
        task.parameters[name]
        for task in plan({name: SampleValues(RandomDraw.RANDOM, 50, 60, 4)}).iterate_tasks()
    ]
    assert {type(value) for value in values} == {int if whole else float}


def test_a_mat_brings_its_start_pose_unless_one_is_chosen() -> None:
    mats = {"background": ("Lollipop", "Loop")}
    own = [task.spec.world.start for task in plan(mats).iterate_tasks()]
    chosen = [
        task.spec.world.start
        for task in plan(
            mats, subject("a.py", ("start.x_mm",), {"start.x_mm": 321.0})
        ).iterate_tasks()
    ]
    assert own[0] != own[1]
    assert [(pose.x_mm, pose.y_mm) for pose in chosen] == [(321.0, pose.y_mm) for pose in own]


@cases(
    "choices, words",
    {
        "too large": ({"noise.motor": (0, 501)}, "noise.motor: must be a whole number from 0"),
        "seed": ({"seed": (-1,)}, "seed: .*whole number from 0"),
        "sample": (
            {"noise.motor": SampleValues(RandomDraw.RANDOM, 600, 700, 2)},
            "noise.motor: must be",
        ),
    },
)
def test_wrong_parameters_are_found_before_anything_is_run(choices: Any, words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        plan(choices)


def test_a_profile_for_another_library_is_found_before_anything_is_run() -> None:
    pybricks = Program("p.py", "from pybricks.tools import wait\n")
    known = Subject(pybricks, Settings({"profile": "lego-micropython"}))
    assert len(plan({"profile": ("lego-micropython", "pybricks4")}, known)) == 2
    with pytest.raises(
        ConfigError, match=r"p\.py uses pybricks, and the profile ev3 is for ev3dev2"
    ):
        plan({"profile": ("pybricks4", "ev3")}, known)


@cases(
    "other, same",
    {
        "equal": (plan({"seed": (1, 2)}), True),
        "other seeds": (plan({"seed": (1, 3)}), False),
        "another parameter": (plan({"noise.motor": (0,), "seed": (1, 2)}), False),
        "other settings": (plan({"seed": (1, 2)}, subject(settings={"noise.light": 3})), False),
        "other text": (
            plan({"seed": (1, 2)}, Subject(Program("a.py", "print()"), Settings())),
            False,
        ),
        "other limit": (
            plan({"seed": (1, 2)}, options=RunOptions(time_limit_s=5)),
            False,
        ),
    },
)
def test_a_batch_is_identified_by_all_that_its_rows_depend_on(other: Plan, same: bool) -> None:
    assert (plan({"seed": (1, 2)}).build_identity() == other.build_identity()) is same
