"""The class of 60 students: its files and its expected marks are consistent."""

from __future__ import annotations

from pathlib import Path

from tests.marks.hazards import HAZARDS
from tests.marks.student import EVERY
from tests.marks.the_class import CLASS, write_class


def test_sixty_students_of_all_kinds_have_expected_marks(tmp_path: Path) -> None:
    folder = write_class(tmp_path / "class")
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        student.name for student in CLASS
    )
    assert (len(CLASS), len(HAZARDS)) == (60, 16)
    assert all(
        tuple(goal for goal in EVERY if goal in student.missed) == student.missed
        for student in CLASS
    )
    # Each total of the marks below is given to somebody, so that a wrong one cannot hide.
    assert {student.points for student in CLASS} == {0, 4, 6, 7, 9, 10}
