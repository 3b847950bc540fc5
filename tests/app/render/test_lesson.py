"""A lesson as lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.app.lesson_help import opened
from tuisim.app.render.lesson import Away, LessonView, draw_lesson
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.lessons.progress import StepState


def _lesson_view(tmp_path: Path, **changes: Any) -> LessonView:
    opened_lesson = opened(tmp_path).lesson
    assert opened_lesson is not None
    open_steps = (StepState.OPEN,) * 3
    return replace(LessonView(opened_lesson, open_steps, 0), **changes)


def test_each_page_of_a_lesson_shows_its_steps_story_and_reasons(tmp_path: Path) -> None:
    view = _lesson_view(tmp_path, states=(StepState.DONE, StepState.SKIPPED, StepState.OPEN), at=2)
    lesson = view.lesson
    assert lesson is not None
    view = replace(view, story="Your run: so.", done=replace(lesson.steps[1], why="Far enough."))
    missed = Judgement(lesson.goals[0], (Change(1, 0.1, GoalState.MISSED, 1, 2),), "Too short.")

    def page(number: int, **changes: Any) -> Sequence[str]:
        lines = draw_lesson(replace(view, **changes), number, 0, 40, 30).lines
        return ["".join(text for text, _ in line).rstrip() for line in lines]

    assert page(2)[:4] == [
        "Try it                               ✓–●",
        "✓ Drive",
        "Your run: so.",
        "Far enough.",
    ]
    assert page(2)[4:7] == ["M shows earlier steps again.", "", "3. Do it"]
    assert "skipped" in page(1)
    assert {"✗ Drive.", "  Too short."} <= set(page(1, at=1, judgements=(missed,)))
    failed = page(1, at=1, judgements=(missed,), error="NameError: no x (line 3)")
    assert failed[2] == "The program stopped with an error:"
    assert "· Drive." in failed
    assert "  Too short." not in failed
    assert page(2)[-1] == "Next: open the panel Chart."
    assert page(3)[1].startswith("The end of the lesson: a model answer")
    assert "A model answer:" not in page(3, states=(StepState.SKIPPED,) * 3, at=None)
    assert draw_lesson(LessonView(), 0, 0, 40, 5).lines[0][0][0] == "No lesson is open: M opens one"


@pytest.mark.parametrize(
    "at, text",
    [
        (0, "Q types"),
        (0, "Y shows hint"),
        (1, "d edits the program, R runs it"),
        (1, "M shows earlier steps"),
    ],
)
def test_keys_that_need_escape_first_are_called_so(at: int, text: str, tmp_path: Path) -> None:
    lesson = opened(tmp_path).lesson
    assert lesson is not None
    view = LessonView(lesson, tuple(StepState.OPEN for _ in lesson.steps), at, done=lesson.steps[0])
    lines = draw_lesson(view, at, 0, 80, 60, Away.LOG).lines
    assert f"escape, then {text}" in "\n".join("".join(part for part, _ in line) for line in lines)


def test_the_editor_has_a_key_of_its_own_that_runs_the_program(tmp_path: Path) -> None:
    lines = draw_lesson(_lesson_view(tmp_path, at=1), 1, 0, 80, 60, Away.EDITOR).lines
    assert "ctrl+r runs the program." in ["".join(part for part, _ in line) for line in lines]
