"""The lessons of tuisim: model answers pass, wrong answers do not, and every lesson is complete."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest

from tests.cases import for_each
from tuisim.cli import COMMANDS
from tuisim.commands.learn import find_warnings, learn
from tuisim.engine.runs.store import RunStore
from tuisim.programs.program_file import list_programs
from tuisim.tasks.goals.spec import LogCondition
from tuisim.tasks.lessons.catalogue import find_shipped_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.spec import Lesson, QuestionCheck, RunCheck
from tuisim.tasks.lessons.trial import build_task, find_faults, run_model
from tuisim.tasks.pool import run_many

LESSONS = {name: load_lesson(path) for name, path in find_shipped_paths().items()}


@pytest.mark.quick_cases("first-run", "stop-and-look")
@pytest.mark.parametrize("name", LESSONS)
def test_a_lessons_model_answers_pass_and_its_wrong_answers_do_not(name: str) -> None:
    assert find_faults(LESSONS[name]) == []


@for_each(name=LESSONS)
def test_each_built_in_lesson_has_texts_hints_and_wrong_programs(name: str) -> None:
    lesson = LESSONS[name]
    assert lesson.path.name.isascii()
    assert 20 < len(lesson.why) <= 300
    assert re.fullmatch(r"[^.?!]+[^.?!]*[.?!]( [^.?!]+[.?!]){0,2}", lesson.why), (
        "one to three sentences"
    )
    assert find_warnings(lesson) == []
    for step in lesson.steps:
        assert step.hints, f"{step.name}: no hint"
        assert len(step.text) < 700, f"{step.name}: too long for a small terminal"


@for_each(name=LESSONS)
def test_the_text_of_a_lessons_step_mentions_the_names_that_its_goals_need(name: str) -> None:
    lesson = LESSONS[name]
    needed = {goal.name: goal.condition for goal in LESSONS[name].goals}
    for step in lesson.steps:
        conditions = (
            [needed[goal] for goal in step.check.goals] if isinstance(step.check, RunCheck) else []
        )
        for condition in conditions:
            if isinstance(condition, LogCondition):
                assert condition.name in f"{step.text} {lesson.program}", (
                    f"{step.name}: does not say {condition.name}"
                )


def _end(lesson: Lesson, text: str, field: str, seed: int = 0) -> float:
    """A field of the result of a program in the world of a lesson."""
    (result,) = run_many([build_task(lesson, text, seed)], jobs=1)
    return float(getattr(result, field))


MEASURED: dict[str, Callable[[Lesson], float]] = {
    "first-run where": lambda lesson: _end(lesson, lesson.program, "x_mm"),
    "sensor-eyes percent": lambda lesson: _read(lesson, LIGHT),
    "log-period period": lambda lesson: (
        _end(lesson, lesson.program, "time_s") / (_rows(lesson) - 1)
    ),
    "log-period distance": lambda lesson: 0.11 * 0.5 * 1050 / 360 * 3.14159 * 56,
    "exact-moves rotation": lambda lesson: _end(lesson, lesson.program, "x_mm") - 500,
    "exact-moves quarter": lambda lesson: 180 / 4 / 56,
    "noise white": lambda lesson: _read(
        lesson, f"tank_drive.on_for_rotations(-30, -30, 160 / 175.93)\n{LIGHT}"
    ),
    "export rows": lambda lesson: _rows(lesson),
    "prime-hub heading": lambda lesson: _end(lesson, lesson.program, "heading_deg"),
    "dead-reckoning true-y": lambda lesson: _end(lesson, lesson.program, "y_mm", seed=1),
    "pid-line error": lambda lesson: _read(
        lesson,
        lesson.steps[0].answer.replace(
            "    turn = KP", "    print(f'Light: {error + TARGET}')\n    turn = KP"
        ),
    ),
}
LIGHT = "print('Light: ' + str(colorLeft.reflected_light_intensity_pc))\n"


def _read(lesson: Lesson, text: str) -> float:
    (result,) = run_many([build_task(lesson, text, 0)], jobs=1)
    return result.variables["Light"].last


def _rows(lesson: Lesson) -> float:
    (result,) = run_many([build_task(lesson, lesson.program, 0)], jobs=1)
    return result.variables["Colour"].count


@pytest.mark.parametrize("name", MEASURED)
def test_the_answer_of_a_lessons_step_is_what_a_student_measures(name: str) -> None:
    lesson, _, step_name = name.partition(" ")
    (step,) = [step for step in LESSONS[lesson].steps if step.name == step_name]
    assert isinstance(step.check, QuestionCheck)
    assert isinstance(step.check.answer, int | float)
    assert MEASURED[name](LESSONS[lesson]) == pytest.approx(
        step.check.answer, abs=step.check.within
    )


def test_a_question_about_a_runs_end_tells_how_to_get_the_robot_there() -> None:
    checks = [step.check for lesson in LESSONS.values() for step in lesson.steps]
    words = [
        check.where
        for check in checks
        if isinstance(check, QuestionCheck) and check.run and check.at_x_mm
    ]
    # A robot that was moved by hand begins its next run where it stands, and would end elsewhere once more.
    assert words and all("m and R" in each for each in words)


def test_presses_planned_in_a_programs_first_line_happen_in_a_lessons_trial() -> None:
    lesson = LESSONS["exact-moves"]
    task = build_task(lesson, "# %%sim_magic_preloaded --press enter@1-2\n", 0)
    hz = task.spec.profile.tick_hz
    assert [action.tick for action in task.options.actions] == [hz, 2 * hz]


def test_no_lesson_has_the_name_of_a_command_or_an_example() -> None:
    taken = {*COMMANDS, *learn.listing, *(file.path.stem for file in list_programs())}
    assert set(LESSONS) & taken == set()


@pytest.mark.usefixtures("home")
def test_the_model_answer_drives_and_is_not_stored() -> None:
    recording = run_model(load_lesson(find_shipped_paths()["exact-moves"]), None)
    assert recording.name == "the model answer"
    assert not recording.folder.exists()
    assert recording.telemetry.record(recording.newest).pose != recording.telemetry.record(0).pose
    assert RunStore().runs() == []
