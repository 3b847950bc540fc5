"""The files for gradebooks, and the class list that names the students."""

from __future__ import annotations

import csv
import re
from dataclasses import replace
from pathlib import Path

import pytest

from tests.tasks.marks.test_sheet import SHEET
from tuisim.base.errors import ConfigError
from tuisim.tasks.marks.gradebook import Roster, read_roster, write_gradebook
from tuisim.tasks.marks.hand_ins import GradebookKind

SOURCES = ("",) * len(SHEET.rows)


def _rows(path: Path) -> list[list[str]]:
    with path.open(newline="") as handle:
        return list(csv.reader(handle))


def _roster(tmp_path: Path, text: str) -> Roster:
    path = tmp_path / "roster.csv"
    path.write_bytes(text.encode())
    return read_roster(path)


def test_moodle_finds_students_by_user_name_number_and_address(tmp_path: Path) -> None:
    roster = _roster(
        tmp_path, "submission,username,ID number,Email address\nben,b1,0042,ben@x.org\n"
    )
    write_gradebook(tmp_path / "m.csv", GradebookKind.MOODLE, SHEET, SOURCES, roster, goals=False)
    heads, ada, ben, *_ = _rows(tmp_path / "m.csv")
    assert heads == ["Username", "ID number", "Email address", "Grey bands", "Feedback"]
    assert ada[:4] == ["ada", "", "", "10"]
    assert ben[:4] == ["b1", "0042", "ben@x.org", "8.25"] and ben[4].startswith(
        "ben: 8.25 of 10 points"
    )


def test_moodles_worksheet_finds_students_by_the_number_in_their_names(tmp_path: Path) -> None:
    ada, ben, *_ = SHEET.rows
    rows = (replace(ada, ids={GradebookKind.MOODLE: "4713"}), ben)
    sheet = replace(SHEET, rows=rows)
    sources = ("", "")
    write_gradebook(
        tmp_path / "m.csv", GradebookKind.MOODLE, sheet, sources, Roster({}), goals=False
    )
    heads, *found = _rows(tmp_path / "m.csv")
    assert heads == [
        *("Identifier", "Full name", "Last modified (grade)", "Grade", "Feedback comments")
    ]
    assert [row[:4] for row in found] == [
        ["Participant 4713", "ada", "", "10"],
        ["", "ben", "", "8.25"],
    ]
    roster = _roster(tmp_path, "submission,username\nada,al1\n")
    write_gradebook(tmp_path / "m.csv", GradebookKind.MOODLE, sheet, sources, roster, goals=False)
    assert _rows(tmp_path / "m.csv")[1][0] == "al1"


def test_canvas_finds_students_by_the_user_in_their_names(tmp_path: Path) -> None:
    sheet = replace(SHEET, rows=(replace(SHEET.rows[0], ids={GradebookKind.CANVAS: "12"}),))
    write_gradebook(tmp_path / "c.csv", GradebookKind.CANVAS, sheet, ("",), Roster({}), goals=False)
    assert _rows(tmp_path / "c.csv")[2] == ["ada", "12", "", "", "", "10"]


def test_canvas_gets_points_possible_and_a_column_a_goal(tmp_path: Path) -> None:
    roster = _roster(
        tmp_path, "\ufeffStudent;ID;SIS User ID;SIS Login ID;Section\nBen B.;7;s7;ben;A\n"
    )
    write_gradebook(tmp_path / "c.csv", GradebookKind.CANVAS, SHEET, SOURCES, roster, goals=True)
    heads, possible, ada, ben, *_ = _rows(tmp_path / "c.csv")
    names = ["Grey bands", "Grey bands: place", "Grey bands: wall"]
    assert heads == ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", *names]
    assert possible == ["Points Possible", "", "", "", "", "10", "7", "3"]
    assert ada == ["ada", "", "", "ada", "", "10", "7", "3"]
    assert ben == ["Ben B.", "7", "s7", "ben", "A", "8.25", "5.25", "3"]


def test_hidden_goals_and_points_taken_off_are_only_in_the_total(tmp_path: Path) -> None:
    place, wall = SHEET.columns
    sheet = replace(SHEET, columns=(replace(place, hidden=True), replace(wall, points=-3.0)))
    write_gradebook(
        tmp_path / "m.csv", GradebookKind.CANVAS, sheet, SOURCES, Roster({}), goals=True
    )
    assert _rows(tmp_path / "m.csv")[0][-2:] == ["Section", "Grey bands"]


def test_no_cell_of_an_exported_gradebook_is_a_formula(tmp_path: Path) -> None:
    roster = _roster(tmp_path, 'submission,Email address\nada,"=cmd()"\nben,\'=cmd()\n')
    for kind in GradebookKind:
        write_gradebook(tmp_path / "x.csv", kind, SHEET, SOURCES, roster, goals=True)
        cells = [cell for row in _rows(tmp_path / "x.csv") for cell in row]
        assert not [cell for cell in cells if re.match(r"[=+@\t\r-]", cell)]


def test_a_class_list_tells_who_handed_in_nothing_and_who_is_not_listed(tmp_path: Path) -> None:
    roster = _roster(tmp_path, "submission,username\nben,b\n,nobody\nzoe,z\n\n")
    names = [row.name for row in SHEET.rows]
    assert roster.absent(names) == ["zoe"] and set(roster.missing(names)) == set(names) - {"ben"}


@pytest.mark.parametrize(
    "text, what",
    [
        ("", "no column that names the submissions"),
        ("name,mail\nben,x\n", "submission, Username, SIS Login ID"),
        ("submission\nben\nben\n", "two rows for 'ben'"),
        ('submission\n"ben\n', "is not a CSV file"),
        ("submission\nb\xe9n\n".encode("latin-1"), "is not a CSV file in UTF-8"),
    ],
)
def test_a_faulty_class_list_is_refused_with_the_reason(
    tmp_path: Path, text: str | bytes, what: str
) -> None:
    path = tmp_path / "roster.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ConfigError, match=re.escape(what)):
        read_roster(path)
