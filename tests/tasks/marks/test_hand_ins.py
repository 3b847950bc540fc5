"""Hand-ins as Moodle, Canvas and Macs deliver them."""

from __future__ import annotations

import os
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.tasks.marks.hand_ins import GradebookKind
from tuisim.tasks.marks.students import StudentsFound, find_students

MOODLE = GradebookKind.MOODLE
CANVAS = GradebookKind.CANVAS


def _find(tmp_path: Path, files: Mapping[str, str | bytes]) -> StudentsFound:
    (tmp_path / "unpacked").mkdir()
    for name, text in files.items():
        path = tmp_path / "class" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode() if isinstance(text, str) else text)
    return find_students([str(tmp_path / "class")], unpacked=tmp_path / "unpacked")


def zipped(path: Path, *names: str) -> bytes:
    """Return a zip with a program for each name."""
    with zipfile.ZipFile(path, "w") as archive:
        for name in names:
            archive.writestr(name, f"print({name!r})\n")
    found = path.read_bytes()
    path.unlink()
    return found


DELIVERED: dict[str, tuple[tuple[str, ...], tuple[str, str, Mapping[GradebookKind, str]]]] = {
    "Moodle's folders": (
        (
            "Ben Weiß_4713_assignsubmission_file_/main.py",
            "Ben Weiß_4713_assignsubmission_onlinetext_/onlinetext.html",
        ),
        ("Ben Weiß", "main.py", {MOODLE: "4713"}),
    ),
    "Moodle's folder with a folder": (
        ("A_B_7_assignsubmission_file_/lab/robot.py",),
        ("A_B", "robot.py", {MOODLE: "7"}),
    ),
    "Moodle's files": (
        (
            "Eva_9_assignsubmission_file_main.py",
            "Eva_9_assignsubmission_file_helper.py",
            "Eva_9_assignsubmission_onlinetext_onlinetext.html",
        ),
        ("Eva", "main.py", {MOODLE: "9"}),
    ),
    "Canvas's attempts": (
        (
            "weissben_LATE_12_340_main.py",
            "weissben_12_99_old.py",
            "weissben_12_340_my_helper.py",
        ),
        ("weissben", "main.py", {CANVAS: "12"}),
    ),
    "Canvas's names of a second attempt": (
        ("weissben_12_340_robot-1.py", "weissben_12_99_robot.py"),
        ("weissben", "robot.py", {CANVAS: "12"}),
    ),
    "a Mac's": (
        ("ada/robot.py", "ada/._robot.py", "__MACOSX/ada/._robot.py"),
        ("ada", "robot.py", {}),
    ),
}


@cases("files, student", DELIVERED)
def test_files_of_one_student_are_joined_in_one_row(
    tmp_path: Path,
    files: tuple[str, ...],
    student: tuple[str, str, Mapping[GradebookKind, str]],
) -> None:
    (found,) = _find(tmp_path, {name: f"print({name!r})\n" for name in files}).students
    assert (found.name, found.main, found.ids, found.problem) == (*student, "")
    assert "99" not in found.text


def test_students_of_one_name_have_rows_of_their_own(tmp_path: Path) -> None:
    names = (f"Ben_{number}_assignsubmission_file_/main.py" for number in (1, 2))
    found = _find(tmp_path, dict.fromkeys(names, "")).students
    assert [(one.name, one.ids[MOODLE]) for one in found] == [("Ben 1", "1"), ("Ben 2", "2")]


def test_system_and_cache_folders_among_hand_ins_are_ignored_and_named_once(tmp_path: Path) -> None:
    names = ("__MACOSX/ada/._main.py", ".git/x", "node_modules/x.py", "__pycache__/x.pyc")
    inside = ("ada/main.py", "ada/venv/bin/x.py", "ben/main.py", "ben/venv/x.py", "ben/._main.py")
    for name in ("ada", "ben"):
        (tmp_path / "class" / name).mkdir(parents=True)
        os.mkfifo(tmp_path / "class" / name / "pipe")
    found = _find(tmp_path, dict.fromkeys((*names, *inside), ""))
    assert [one.name for one in found.students] == ["ada", "ben"]
    assert sorted(found.left_out) == sorted(
        [".git", "._main.py", "__MACOSX", "__pycache__", "node_modules", "venv"]
        + [f"{name}/pipe, which is not a file" for name in ("ada", "ben")]
    )


@cases(
    "name, inside, main",
    {
        "beside others": ("ada.zip", ("main.py", "helper.py"), "main.py"),
        "in a folder": ("ada/robot.zip", ("robot/robot.py", "__MACOSX/._robot.py"), "robot.py"),
        "of Moodle": ("ada_4_assignsubmission_file_/lab.zip", ("lab\\main.py",), "main.py"),
        "of Canvas": ("ada_4_5_lab-2.zip", ("lab/main.py", "lab/data/a.py"), "main.py"),
    },
)
def test_a_students_zip_is_read_like_a_folder(
    tmp_path: Path, name: str, inside: tuple[str, ...], main: str
) -> None:
    (found,) = _find(tmp_path, {name: zipped(tmp_path / "x", *inside)}).students
    assert (found.name, found.main, found.problem) == ("ada", main, "")


def test_a_zip_of_a_whole_class_is_read_like_its_folder(tmp_path: Path) -> None:
    names = ("Ben_1_assignsubmission_file_/main.py", "Eva_2_assignsubmission_file_/main.py")
    (tmp_path / "class.zip").write_bytes(zipped(tmp_path / "x", *names))
    (tmp_path / "unpacked").mkdir()
    found = find_students([str(tmp_path / "class.zip")], unpacked=tmp_path / "unpacked")
    assert [one.name for one in found.students] == ["Ben", "Eva"]


@pytest.mark.parametrize(
    "data", [b"", b"PK\x03\x04 no zip", b"PK\x05\x06" + bytes(18)], ids=["empty", "odd", "nothing"]
)
def test_a_damaged_zip_affects_only_its_students_row(tmp_path: Path, data: bytes) -> None:
    ada, ben = _find(tmp_path, {"ada.zip": data, "ben.py": ""}).students
    assert ada.problem and not ada.is_unread and ben.source is not None


def test_a_forged_file_name_does_not_hand_in_for_another_student(tmp_path: Path) -> None:
    """A file has the name that its student gave it: it says no more than whose number comes first."""
    forged = "Eve_7_assignsubmission_file_Ada_9_assignsubmission_file_main.py"
    found = _find(tmp_path, {"Ada_9_assignsubmission_file_main.py": "1\n", forged: "2\n"})
    rows = {student.name: (student.text, dict(student.ids)) for student in found.students}
    assert rows == {"Ada": ("1\n", {MOODLE: "9"}), forged.removesuffix(".py"): ("2\n", {})}


@pytest.mark.parametrize("name", ["..", ".", "..."])
def test_a_zip_whose_name_leads_elsewhere_is_unpacked_in_a_folder_of_its_own(
    tmp_path: Path, name: str
) -> None:
    inner = zipped(tmp_path / "zip", "main.py")
    found = _find(tmp_path, {"ada.zip": inner, f"eve/{name}.zip": inner, "zoe.zip": inner})
    assert [student.name for student in found.students] == ["ada", "eve", "zoe"]
    for student in found.students:
        assert (student.path / "main.py").read_text() == "print('main.py')\n"


def test_students_whose_names_differ_by_a_number_stay_separate(tmp_path: Path) -> None:
    files = ["ada_1_5_a.py", "ada_2_6_b.py", "ada 1.py", "ada 1 (2).py"]
    found = _find(tmp_path, {name: f"{name!r}\n" for name in files})
    names = {student.name: student.text for student in found.students}
    assert len(names) == len(files)
    assert names["ada 1 (2)"] == "'ada 1 (2).py'\n"
