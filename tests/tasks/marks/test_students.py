"""The students of a class are found in files and folders; each run gets its own copy."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cases import cases
from tests.tasks.marks.the_class import CLASS, write_class
from tuisim.base.errors import ConfigError
from tuisim.programs.program_settings import build_program_settings
from tuisim.tasks.marks import students
from tuisim.tasks.marks.journal import Journal
from tuisim.tasks.marks.outcome import GoalOutcome, Outcome
from tuisim.tasks.marks.students import find_outside_option, find_students
from tuisim.tasks.marks.workspace import build_program, compute_digest, copy_files


def _folder(tmp_path: Path, *files: str) -> Path:
    for file in files:
        path = tmp_path / "class" / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"print({file!r})\n")
    return tmp_path / "class"


def test_every_student_of_the_class_is_found(tmp_path: Path) -> None:
    found = find_students([str(write_class(tmp_path / "class"))])
    assert len(found.students) == len(CLASS)
    assert all(one.source for one in found.students)
    assert {one.name: one.main for one in found.students if not one.path.is_file()} == {
        "deletes": "main.py",
        "vera": "main.py",
        "viktor": "main.py",
        "wanda": "robot.py",
        "xaver": "main.py",
        'Zoë & <b>Max\ufffd[31m "Ü" 🐍': "main.py",
    }


CASES = {
    "main.py before others": (("ada/other.py", "ada/main.py"), "", "main.py", ""),
    "the only program": (("ada/robot.py", "ada/notes.txt"), "", "robot.py", ""),
    "the one in the goals": (("ada/main.py", "ada/follow.py"), "follow.py", "follow.py", ""),
    "not the one in the goals": (("ada/main.py",), "follow.py", "main.py", ""),
    "which one": (
        ("ada/a.py", "ada/b.py"),
        "",
        "",
        "which of a.py, b.py is the main program? (main.py)",
    ),
    "none": (("ada/notes.txt",), "", "", "there is no Python file, only: notes.txt (main.py)"),
    "an archive": (("ada/robot.7Z",), "", "", "robot.7Z: it is an archive; unpack it (main.py)"),
    "a Mac's": (("ada/._robot.py", "ada/robot.py", "ada/.main.py"), "", "robot.py", ""),
    "a package": (("ada/__init__.py", "ada/robot.py"), "", "robot.py", ""),
    "too deep": (("ada/lab1/main.py", "ada/__pycache__/x.pyc"), "", "main.py", ""),
    "beside another": (
        ("ada/lab1/main.py", "ada/notes.txt"),
        "",
        "",
        "there is no Python file, only: lab1/, notes.txt (main.py)",
    ),
    "text": (
        ("ada/main.py.txt",),
        "",
        "",
        "main.py.txt: its name ends in .txt; rename it to end in .py (main.py)",
    ),
}


@cases("files, program, main, problem", CASES)
def test_the_main_program_of_a_students_folder_is_found(
    tmp_path: Path, files: tuple[str, ...], program: str, main: str, problem: str
) -> None:
    (found,) = find_students([str(_folder(tmp_path, *files))], program).students
    assert (found.name, found.main, found.problem) == ("ada", main, problem)


def test_archives_and_text_files_are_listed_as_students_with_a_problem(tmp_path: Path) -> None:
    found = find_students(
        [str(_folder(tmp_path, "ada.zip", "ben.py.txt", "cleo.tar.gz", "dora.py", "list.txt"))]
    )
    assert [(one.name, one.problem.partition(":")[0]) for one in found.students] == [
        ("ada", "ada.zip"),
        ("ben", "ben.py.txt"),
        ("cleo", "cleo.tar.gz"),
        ("dora", ""),
    ]
    assert found.ignored == ("list.txt",)


def _notebook(path: Path, *cells: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        json.dumps({"cells": [{"cell_type": "code", "source": cell} for cell in cells]})
    )
    return path


def test_a_notebook_is_a_program(tmp_path: Path) -> None:
    cell = "%%sim_magic_preloaded -b Loop\nimport helper\nprint(helper.x)\n"
    _notebook(tmp_path / "class" / "ada" / "robot.ipynb", "1 + 1", cell)
    (tmp_path / "class" / "ada" / "helper.py").write_text("x = 3\n")
    _notebook(tmp_path / "class" / "ben.ipynb", cell, cell.replace("3", "4"))
    ada, ben = find_students([str(tmp_path / "class")]).students
    assert ada.problem == "which of helper.py, robot.ipynb is the main program? (main.py)"
    hint = '(in the goals file: program = "ben.ipynb#2")'
    assert ben.problem == f"ben.ipynb: which of its 2 program cells is the program? {hint}"
    _, chosen = find_students([str(tmp_path / "class")], "ben.ipynb#2").students
    assert chosen.source is not None and chosen.source.program.name == "ben.ipynb#2"
    folder = copy_files(chosen, tmp_path / "copy")
    program = build_program(chosen, folder)
    assert (program.path, program.module_folder) == ("", str(folder))


def test_a_folder_or_file_named_directly_is_a_student(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada/main.py", "ada/helper.py", "ben.py")
    found = find_students([str(folder / "ada"), str(folder / "ben.py")])
    assert [one.name for one in found.students] == ["ada", "ben"]


def test_students_of_equal_names_have_the_name_of_their_folder(tmp_path: Path) -> None:
    folders = [str(_folder(tmp_path / name, "ada.py")) for name in ("x", "y")]
    group = _folder(tmp_path / "z", "ben.py").rename(tmp_path / "group")
    (group / "ada.py").write_text("")
    assert [one.name for one in find_students([*folders, str(group)]).students] == [
        "class/ada",
        "class/ada (2)",
        "group/ada",
        "ben",
    ]


def test_a_file_keeps_its_ending_where_a_neighbour_has_its_name(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada.py", "ada/main.py", "ben.PY", "cleo.v2.py")
    found = find_students([str(folder)]).students
    assert [(one.name, one.main) for one in found] == [
        ("ada", "main.py"),
        ("ada.py", "ada.py"),
        ("ben", "ben.PY"),
        ("cleo.v2", "cleo.v2.py"),
    ]


def test_hidden_files_and_results_of_marking_are_not_taken_for_students(tmp_path: Path) -> None:
    folder = _folder(
        tmp_path, "ada.py", ".hidden.py", "__pycache__/x.py", "feedback/ada.txt", "slides.odp"
    )
    found = find_students([str(folder)], excluded=frozenset({(folder / "feedback").resolve()}))
    assert ([one.name for one in found.students], found.ignored) == (["ada"], ("slides.odp",))


def test_pipes_devices_and_odd_names_affect_only_their_own_row(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada.py")
    os.mkfifo(folder / "pipe.py")
    (folder / "loop.py").symlink_to("loop.py")
    (folder / "zero.py").symlink_to("/dev/zero")
    (folder / os.fsdecode(b"bad\xff.py")).write_text("")
    found = {one.name: one for one in find_students([str(folder)]).students}
    assert {name for name, one in found.items() if one.source} == {"ada", r"bad\xff"}
    assert {name for name, one in found.items() if one.problem} == {"loop", "pipe", "zero"}
    place = copy_files(found[r"bad\xff"], tmp_path / "copy")
    assert Path(build_program(found[r"bad\xff"], place).path).is_file()


@pytest.mark.parametrize("word", ["nowhere", "class"])
def test_folders_without_programs_are_refused(tmp_path: Path, word: str) -> None:
    (tmp_path / "class").mkdir()
    with pytest.raises(ConfigError, match=word):
        find_students([str(tmp_path / word)])


def test_a_program_sees_a_copy_of_its_own_files_only(tmp_path: Path) -> None:
    folder = _folder(
        tmp_path, "ada/main.py", "ada/data/hops.csv", "ada/__pycache__/main.pyc", "ben.py"
    )
    os.mkfifo(folder / "ada" / "pipe")
    (folder / "ada" / "link").symlink_to("data/hops.csv")
    ada, ben = find_students([str(folder)]).students
    program = build_program(ada, copy_files(ada, tmp_path / "0"))
    place = Path(program.working_directory)
    assert place == tmp_path / "0"
    assert sorted(path.name for path in place.iterdir()) == ["data", "link", "main.py"]
    assert (place / "link").is_symlink() and Path(program.path) == place / "main.py"
    assert [path.name for path in copy_files(ben, tmp_path / "1").iterdir()] == ["ben.py"]


def test_a_students_digest_changes_with_each_of_the_files(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada/main.py", "ada/data/hops.csv")
    (ada,) = find_students([str(folder)]).students
    before = compute_digest(ada)
    assert compute_digest(ada) == before
    (folder / "ada/data/hops.csv").write_text("other\n")
    assert compute_digest(ada) != before


OUTCOME = Outcome(
    3,
    "raised",
    "ValueError: \ud800",
    2,
    "Traceback …",
    1.5,
    (GoalOutcome("place", False, "why", 2),),
)


def test_a_journal_knows_what_an_interrupted_marking_has_done(tmp_path: Path) -> None:
    path = tmp_path / "home" / "journal.jsonl"
    with Journal(path, resumes=False) as journal:
        journal.add("a", OUTCOME)
        journal.add("b", OUTCOME)
    # Killed in the middle of a line.
    path.write_bytes(path.read_bytes()[:-20])
    with Journal(path, resumes=True) as journal:
        assert journal.known == {"a": OUTCOME}
        journal.add("c", OUTCOME)
    with Journal(path, resumes=True) as journal:
        assert set(journal.known) == {"a", "c"}
    with Journal(path, resumes=False) as journal:
        assert not journal.known
    assert path.stat().st_mode & 0o777 == 0o600


SECRET = "secret = 1\n"
LINKS = {
    "the file": ("eve.py", "../secret.py", "it is a link; hand in the files themselves"),
    "the folder": ("eve", "../elsewhere", "it is a link; hand in the files themselves"),
    "a module": (
        "eve/lib/helper.py",
        "../../../secret.py",
        "lib/helper.py is a link that leads out of the folder",
    ),
    "a folder inside": ("eve/lib", "../..", "lib is a link that leads out of the folder"),
    "an absolute one": (
        "eve/main.py",
        "/etc/hostname",
        "main.py is a link that leads out of the folder",
    ),
}


@cases("link, target, problem", LINKS)
@pytest.mark.parametrize("by_name", [False, True], ids=["in a class", "by name"])
def test_a_link_out_of_a_students_folder_is_refused_by_name(
    tmp_path: Path, link: str, target: str, problem: str, by_name: bool
) -> None:
    folder = _folder(tmp_path, "ada.py", "eve/main.py" if link.startswith("eve/") else "ben.py")
    (tmp_path / "secret.py").write_text(SECRET)
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "main.py").write_text(SECRET)
    place = folder / link
    place.parent.mkdir(exist_ok=True)
    place.unlink(missing_ok=True)
    place.symlink_to(target)
    words = [str(path) for path in folder.iterdir()] if by_name else [str(folder)]
    found = {student.name: student for student in find_students(words).students}
    eve = found["eve"]
    assert (eve.source, eve.text, eve.problem) == (None, "", problem)
    assert found["ada"].source is not None


def _nested(folder: Path) -> None:
    (folder / "/".join("d" * 100)).mkdir(parents=True)


def _large(folder: Path) -> None:
    with open(folder / "data", "wb") as file:
        file.truncate(64 << 30)


def _many(folder: Path) -> None:
    for number in range(21):
        (folder / str(number)).touch()


@pytest.mark.parametrize(
    "hands_in, problem",
    [
        (_nested, "its folders are nested more than 50 deep"),
        (_large, "it has more than 20 files or 1,024 MiB"),
        (_many, "it has more than 20 files or 1,024 MiB"),
    ],
    ids=["nested", "large", "many"],
)
def test_a_folder_that_cannot_be_copied_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, hands_in: Callable[[Path], None], problem: str
) -> None:
    monkeypatch.setattr(students, "MOST_FILES", 20)
    (tmp_path / "eve").mkdir()
    (tmp_path / "eve" / "main.py").write_text("x = 1")
    hands_in(tmp_path / "eve")
    (student,) = find_students([str(tmp_path)]).students
    assert (student.problem, student.source) == (problem, None)


def test_a_link_inside_a_students_folder_is_followed(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada/code/robot.py")
    (folder / "ada" / "main.py").symlink_to("code/robot.py")
    (found,) = find_students([str(folder)]).students
    assert found.text == "print('ada/code/robot.py')\n"


@pytest.mark.parametrize("option", ["-r", "-b", "-o", "--profile", "--mats"])
def test_a_magic_line_may_not_name_files_outside_the_folder(tmp_path: Path, option: str) -> None:
    folder = _folder(tmp_path, "ada/main.py", "ben/main.py")
    (folder / "ada" / "main.py").write_text(f"# %%sim_magic {option} ../../secret.toml\n")
    (folder / "ben" / "main.py").write_text(f"# %%sim_magic {option} ./own.toml\n")
    ada, ben = find_students([str(folder)]).students
    assert (bool(find_outside_option(ada)), find_outside_option(ben)) == (True, "")


@pytest.mark.parametrize(
    "words, is_refused",
    [
        ("-b ./mat.png", False),
        ("-r ben/robot.toml", True),
        ("-b ./zoe.py", True),
        ("--mats .", True),
        ("--mats ben", True),
    ],
)
def test_a_magic_line_of_a_file_may_not_name_what_is_another_students(
    tmp_path: Path, words: str, is_refused: bool
) -> None:
    folder = _folder(tmp_path, "ada.py", "ben/main.py", "zoe.py")
    (folder / "ada.py").write_text(f"# %%sim_magic {words}\n")
    ada = find_students([str(folder)]).students[0]
    assert bool(find_outside_option(ada)) == is_refused


def test_a_students_single_file_cannot_import_other_students_programs(tmp_path: Path) -> None:
    folder = _folder(tmp_path, "ada.py", "ben.py")
    (folder / "ada.py").write_text(
        "try:\n    from ben import *\nexcept ImportError:\n    pass\nprint(1)\n"
    )
    before = find_students([str(folder)]).students[0].source
    assert before
    settings = build_program_settings(before)
    (folder / "ben.py").write_text(
        "from ev3dev2.motor import *\ntank_drive = MoveTank(OUTPUT_A, OUTPUT_D)\n"
    )
    after = find_students([str(folder)]).students[0].source
    assert after and after.program.prelude == before.program.prelude
    assert build_program_settings(after) == settings
