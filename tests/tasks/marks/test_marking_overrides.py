"""A tutor's own points and comments take precedence; what the runs have earned stays known."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.tasks.marks.test_sheet import COLUMNS, SHEET
from tuisim.base.errors import ConfigError
from tuisim.tasks.marks.feedback import build_feedback
from tuisim.tasks.marks.marking import apply_overrides, read_overrides
from tuisim.tasks.marks.page import build_page
from tuisim.tasks.marks.sheet import Sheet

NAMES = [row.name for row in SHEET.rows]
TEXT = """\
[ada]
comment = "Neat."
[ben.goals]
place = 6
[cleo]
points = 4.5
"""


def _sheet(tmp_path: Path, text: str = TEXT) -> Sheet:
    path = tmp_path / "own.toml"
    path.write_text(text)
    return apply_overrides(SHEET, read_overrides(path, COLUMNS, NAMES))


def test_a_teacher_can_override_points_of_a_goal_or_the_whole_task(tmp_path: Path) -> None:
    frame = _sheet(tmp_path).build_frame().set_index("student")
    columns = ["points", "earned", "goal_place", "goal_wall", "comment"]
    assert frame.loc[["ada", "ben", "cleo"], columns].to_numpy().tolist() == [
        [10.0, 10.0, 7.0, 3.0, "Neat."],
        [9.0, 8.25, 6.0, 3.0, ""],
        [4.5, 0.0, 0.0, 0.0, ""],
    ]


def test_page_and_feedback_show_the_teachers_points_and_comments(tmp_path: Path) -> None:
    sheet = _sheet(tmp_path)
    page = build_page(sheet)
    assert '<div class="comment">Neat.</div>' in page and "the runs have earned 8.25" in page
    assert "Comment: Neat." in build_feedback(sheet, sheet.rows[0])


@pytest.mark.parametrize(
    "text, what",
    [
        ("[adda]\npoints = 1\n", "did you mean ada?"),
        ("[ada]\npoint = 1\n", "ada.point: no such key"),
        ('[ada]\npoints = "3"\n', "ada.points"),
        ("[ada.goals]\nplce = 1\n", "ada.goals.plce: no such key"),
        ("ada = 3\n", "ada"),
        ("", "is empty"),
    ],
)
def test_a_faulty_file_of_overridden_points_names_student_and_key(
    tmp_path: Path, text: str, what: str
) -> None:
    with pytest.raises(ConfigError, match=re.escape(what)):
        _sheet(tmp_path, text)
