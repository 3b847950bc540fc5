"""The class that tests mark: 60 students, with their expected marks."""

from __future__ import annotations

from pathlib import Path

from tests.tasks.marks.hazards import HAZARDS
from tests.tasks.marks.near_misses import NEAR_MISSES
from tests.tasks.marks.right import RIGHT
from tests.tasks.marks.student import Student

CLASS: tuple[Student, ...] = (*RIGHT, *NEAR_MISSES, *HAZARDS)


def write_class(folder: Path, students: tuple[Student, ...] = CLASS) -> Path:
    """Write the students' files and folders into a folder, and return it."""
    folder.mkdir(parents=True, exist_ok=True)
    for student in students:
        student.write(folder)
    return folder
