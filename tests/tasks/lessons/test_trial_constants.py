"""A program that reads and drives as a model answer, but prints what that printed in one world, must not pass."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.constants import print_constants
from tests.running import over
from tests.tasks.lessons.test_trial import LESSONS
from tuisim.engine.runs.handle import start_run
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judgement import GoalState
from tuisim.tasks.goals.spec import LogCondition, Reading
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons.spec import Lesson, LessonStep, RunCheck
from tuisim.tasks.lessons.trial import build_task
from tuisim.tasks.pool import run_many

STEPS = {
    f"{lesson.name} {step.name}": (lesson, step)
    for lesson in LESSONS.values()
    for step in lesson.steps
    if isinstance(step.check, RunCheck)
    and any(
        isinstance(part, LogCondition) and part.reading is Reading.COLOR
        for goal in lesson.goals
        if goal.name in step.check.goals
        for part in goal.parts
    )
}
"""Those that ask for a level of light."""
STEPS["dead-reckoning y"] = next(
    (LESSONS["dead-reckoning"], step)
    for step in LESSONS["dead-reckoning"].steps
    if step.name == "y"
)


def _misses(lesson: Lesson, check: RunCheck, other: TrialWorld | None, text: str) -> bool:
    (result,) = run_many([build_task(lesson, text, seed=1, other=other)], jobs=1)
    goals = other.goals if other else check.goals
    return any(
        each.state is not GoalState.MET for each in result.judgements if each.goal.name in goals
    )


def test_eleven_steps_check_printed_constants() -> None:
    assert len(STEPS) == 11


@pytest.mark.quick_cases("read-errors mend")
@pytest.mark.parametrize(("lesson", "step"), STEPS.values(), ids=STEPS)
def test_constants_do_not_pass(lesson: Lesson, step: LessonStep, tmp_path: Path) -> None:
    assert isinstance(step.check, RunCheck)
    task = build_task(lesson, step.answer, seed=1)
    handle = start_run(task.program, task.spec, task.options, RunStore(tmp_path))
    lines = over(handle).lines
    handle.close()
    assert lines
    text = print_constants(step.answer, lines)
    assert any(_misses(lesson, step.check, other, text) for other in step.check.also)
