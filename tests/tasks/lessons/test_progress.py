"""The progress of a student: counted, told, kept with what others have kept, and damaged."""

from __future__ import annotations

from pathlib import Path

import pytest

from tuisim.base.errors import ConfigError
from tuisim.commands.learn import find_last_opened
from tuisim.tasks.lessons.catalogue import find_shipped_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.progress import (
    LessonProgress,
    StepProgress,
    StepState,
    find_folder,
    load_progress,
    prepare_program,
    save_progress,
)
from tuisim.tasks.lessons.spec import Lesson

NEW = LessonProgress()


@pytest.fixture
def lesson() -> Lesson:
    return load_lesson(find_shipped_paths()["band-values"])


def after(lesson: Lesson, *states: StepState) -> LessonProgress:
    """Progress with these states of the first steps."""
    progress = NEW
    for step, state in zip(lesson.steps, states, strict=False):
        progress = progress.update_step(step.name, state=state)
    return progress


def test_progress_counts_done_and_skipped_steps(lesson: Lesson) -> None:
    count = len(lesson.steps)
    done = StepState.DONE
    skipped = StepState.SKIPPED
    assert NEW.words(lesson) == "new"
    assert after(lesson, done).words(lesson) == f"1 of {count}"
    assert after(lesson, *[done] * count).words(lesson) == "done"
    assert after(lesson, skipped, *[done] * (count - 1)).words(lesson) == "done, 1 step skipped"


def test_the_first_open_step_of_a_lesson_is_the_current_one(lesson: Lesson) -> None:
    assert NEW.current(lesson) == 0
    assert after(lesson, StepState.DONE, StepState.OPEN).current(lesson) == 1
    assert after(lesson, *[StepState.SKIPPED] * len(lesson.steps)).current(lesson) is None


def test_progress_on_each_lesson_is_stored(home: Path) -> None:
    assert load_progress() == {}
    one = NEW.update_step("a", tries=2, hints=1)
    save_progress("one", one)
    save_progress("two", LessonProgress({}, "2026-01-02T00:00:00+00:00"))
    assert load_progress()["one"].of("a") == StepProgress(tries=2, hints=1)
    assert find_last_opened(load_progress()) == "two"
    assert find_last_opened({"one": one}) == ""


@pytest.mark.parametrize(
    "text", ["{", "[]", '{"one": 3}', '{"one": {"steps": {"a": {"state": "flown"}}}}']
)
def test_damaged_progress_is_told_and_stays(text: str, home: Path) -> None:
    file = find_folder() / "progress.json"
    file.parent.mkdir(parents=True)
    file.write_text(text)
    with pytest.raises(ConfigError, match="is damaged"):
        save_progress("one", NEW)
    assert file.read_text() == text


def test_a_students_program_of_a_lesson_is_not_overwritten_when_begun_again(
    lesson: Lesson, home: Path
) -> None:
    path = prepare_program(lesson)
    assert path.read_text() == lesson.program
    path.write_text("mine")
    assert prepare_program(lesson).read_text() == "mine"
    assert prepare_program(lesson, anew=True).read_text() == lesson.program
    assert path.with_suffix(".old.py").read_text() == "mine"
