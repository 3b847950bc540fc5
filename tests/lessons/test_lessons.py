"""The lessons of tuisim: model answers pass, wrong answers do not, and every lesson is complete."""

from __future__ import annotations

import re

import pytest

from tuisim.cli import COMMANDS
from tuisim.commands.learn import learn
from tuisim.config.program_file import programs
from tuisim.lessons.catalogue import shipped_paths
from tuisim.lessons.files import load_lesson
from tuisim.lessons.spec import Question, Run
from tuisim.lessons.trial import faults

LESSONS = {name: load_lesson(path) for name, path in shipped_paths().items()}


@pytest.mark.parametrize("name", LESSONS)
def test_model_answers_pass_and_wrong_answers_do_not(name: str) -> None:
    assert faults(LESSONS[name]) == []


@pytest.mark.parametrize("name", LESSONS)
def test_lesson_is_complete(name: str) -> None:
    lesson = LESSONS[name]
    assert lesson.path.name.isascii()
    assert 20 < len(lesson.why) <= 300
    assert re.fullmatch(r"[^.?!]+[^.?!]*[.?!]( [^.?!]+[.?!]){0,2}", lesson.why), "one to three sentences"
    for step in lesson.steps:
        wrong = step.wrong_programs if isinstance(step.check, Run) else step.wrong
        choices = isinstance(step.check, Question) and step.check.choices
        assert wrong or choices or name == "first-run", f"{step.name}: no wrong answer"
        assert step.hints, f"{step.name}: no hint"
        assert len(step.text) < 700, f"{step.name}: too long for a small terminal"


def test_names_are_not_those_of_commands_or_examples() -> None:
    taken = {*COMMANDS, *learn.listing, *(file.path.stem for file in programs())}
    assert set(LESSONS) & taken == set()
