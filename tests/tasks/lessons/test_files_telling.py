"""A telling has the world, goals and checks of another lesson, and texts and programs of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.tasks.lessons.test_files import GOAL, HEAD, RUN, lesson
from tuisim.base.errors import ConfigError
from tuisim.tasks.lessons.files import load_lesson, merge_telling
from tuisim.tasks.lessons.spec import Lesson, RunCheck

ANSWER = "## One\n```python answer\nprint(1)\n```\n"


def told(folder: Path, front: str) -> Lesson:
    """A telling with these keys."""
    (folder / "it.md").write_text(
        lesson(f"{HEAD}minutes = 3\nseed = 5\n{GOAL}{RUN}hints = ['a']\n", ANSWER)
    )
    (folder / "it-other.md").write_text(
        lesson(front, ANSWER.replace("One", "Other").replace("1", "2"))
    )
    return load_lesson(folder / "it-other.md")


def test_what_a_lessons_version_leaves_out_is_taken_from_the_lesson(tmp_path: Path) -> None:
    found = told(tmp_path, "tells = 'it.md'\ntitle = 'U'\n[[step]]\nname = 'a'\nhints = ['b']\n")
    assert (found.name, found.title, found.why, found.minutes, found.settings) == (
        "it-other",
        "U",
        "W",
        3,
        {"floor": False, "seed": 5},
    )
    (step,) = found.steps
    assert (step.title, step.hints, step.check, step.answer) == (
        "Other",
        ("b",),
        RunCheck(("end",)),
        "print(2)\n",
    )


BAD = {
    "no file": ("tells = 'none.md'\n", "none.md: there is no such lesson"),
    "no name": ("tells = 5\n", "it-other.md, line 2: tells: must be text, got 5"),
    "a telling": (
        "tells = 'it-other.md'\n",
        "line 2: tells: it-other.md is a version of a lesson itself (name the",
    ),
    "a step more": (
        "tells = 'it.md'\n[[step]]\nname = 'b'\nrun = 'end'\n",
        "there are 2 steps [[step]], but 1 sections",
    ),
}


@cases("front, message", BAD)
def test_a_faulty_version_of_a_lesson_is_refused(front: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as raised:
        told(tmp_path, front)
    assert message in str(raised.value)


MERGED = {
    "a table": ({"a": {"b": 1, "c": 2}}, {"a": {"c": 3}}, {"a": {"b": 1, "c": 3}}),
    "a list": ({"a": [1, 2]}, {"a": [3]}, {"a": [3]}),
    "tables by name": (
        [{"name": "a", "b": 1}, {"name": "c"}],
        [{"name": "d"}, {"name": "a", "b": 2}],
        [{"name": "a", "b": 2}, {"name": "c"}, {"name": "d"}],
    ),
    "tables by where": (
        [{"where": "a", "b": 1}],
        [{"where": "a", "c": 2}],
        [{"where": "a", "b": 1, "c": 2}],
    ),
}


@cases("other, own, both", MERGED)
def test_values_in_a_lessons_version_take_precedence(
    other: object, own: object, both: object
) -> None:
    assert merge_telling(other, own) == both
