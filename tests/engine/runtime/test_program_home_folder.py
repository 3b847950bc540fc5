"""Files in the home folder of the brick are those beside the program."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.running import Done, over
from tuisim.base.source import Program
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

pytestmark = pytest.mark.usefixtures("home")


def _run(folder: Path, text: str, profile: str = "ev3") -> Done:
    spec = build_run_spec(Settings.merge({"profile": profile}))
    program = Program(
        "p.py", f"import os\nfrom pathlib import Path\n{text}", path=str(folder / "p.py")
    )
    return over(start_run(program, spec, RunOptions()))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "own" / "data").mkdir(parents=True)
    (tmp_path / "own" / "a.txt").write_text("first")
    (tmp_path / "own" / "data" / "b.txt").write_text("second")
    (tmp_path / "own" / "data" / "c.py").write_text("name = 'third'\n")
    return tmp_path / "own"


READS = {
    "open": ("print(open('/home/robot/a.txt').read())", "first"),
    "a folder above": ("print(open('/home/robot/projects/x/a.txt').read())", "first"),
    "a folder beside": ("print(Path('/home/robot/x/data/b.txt').read_text())", "second"),
    "descriptor": (
        "print(os.read(os.open('/home/robot/a.txt', os.O_RDONLY), 9).decode())",
        "first",
    ),
    "is there": (
        "print(os.path.isfile('/home/robot/x/a.txt'), os.path.exists('/home/robot/c'))",
        "True False",
    ),
    "list": ("print(*sorted(os.listdir('/home/robot/projects')))", "a.txt data"),
    "change": ("os.chdir('/home/robot/x')\nprint(open('a.txt').read())", "first"),
    "modules": (
        "import sys\nsys.path.append('/home/robot/x/data')\nimport c\nprint(c.name)",
        "third",
    ),
    "another home": ("print(os.path.exists('/home/robots/a.txt'))", "False"),
    "out of it": ("print(os.path.exists('/home/robot/../a.txt'))", "False"),
}


@pytest.mark.parametrize("case", READS)
def test_paths_in_the_bricks_home_folder_read_files_beside_the_program(
    folder: Path, case: str
) -> None:
    text, expected = READS[case]
    done = _run(folder, text)
    assert (done.lines, done.errors) == ([expected], [])


def test_nothing_is_written_outside_the_programs_folder(folder: Path) -> None:
    for name in ("new.txt", "projects/x/log.txt", "data/inside.txt"):
        assert _run(folder, f"open('/home/robot/{name}', 'w').write('1')").errors == []
    written = [path for path in folder.rglob("*") if path.is_file() and path.read_text() == "1"]
    names = sorted(str(path.relative_to(folder)) for path in written)
    assert names == ["data/inside.txt", "log.txt", "new.txt"]


CHANGES = {
    "a folder": ("os.makedirs('/home/robot/logs/1', exist_ok=True)", ["logs", "logs/1"], []),
    "a folder that is there": ("os.makedirs('/home/robot/data', exist_ok=True)", [], []),
    "a file in a new folder": (
        "os.mkdir('/home/robot/logs')\nopen('/home/robot/logs/1.csv', 'w').close()",
        ["logs", "logs/1.csv"],
        [],
    ),
    "a file removed": ("os.remove('/home/robot/a.txt')", [], ["a.txt"]),
    "a file renamed": ("os.rename('/home/robot/a.txt', '/home/robot/b.txt')", ["b.txt"], ["a.txt"]),
    "a folder removed": ("Path('/home/robot/e').mkdir()\nos.rmdir('/home/robot/e')", [], []),
}


@pytest.mark.parametrize("case", CHANGES)
def test_changing_files_in_the_bricks_home_folder_changes_those_beside_the_program(
    folder: Path, case: str
) -> None:
    text, added, removed = CHANGES[case]
    before = {str(path.relative_to(folder)) for path in folder.rglob("*")}
    assert _run(folder, text).errors == []
    after = {str(path.relative_to(folder)) for path in folder.rglob("*")}
    assert (sorted(after - before), sorted(before - after)) == (added, removed)


def test_the_error_about_a_missing_file_names_the_folder_of_the_program(folder: Path) -> None:
    errors = _run(folder, "open('/home/robot/none.txt')").errors
    assert (
        errors[-1] == f"FileNotFoundError: [Errno 2] No such file or directory: '{folder}/none.txt'"
    )


def test_in_the_course_profile_the_bricks_home_folder_does_not_exist(folder: Path) -> None:
    errors = _run(folder, "open('/home/robot/a.txt')", "robolab").errors
    assert errors[-1].endswith("'/home/robot/a.txt'")
