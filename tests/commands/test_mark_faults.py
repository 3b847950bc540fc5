"""What goes wrong with one hand-in is that student's row: the others have the rows that they have without it."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any
from unittest.mock import MagicMock

import pytest

from tests.conftest import Command
from tuisim.base.faults import report_file
from tuisim.cli import run_command
from tuisim.tasks import execute
from tuisim.tasks.marks import reports, runs

GOALS = """\
title = "Say"
background = "Empty_Map"
[[goal]]
name = "said"
points = 2
print = 'Done: 2'
"""
HONEST = {"ada.py": "print('Done: 2')\n", "ben.py": "print('Done: 3')\n"}
ODD_NAME = os.fsdecode(b"m\xff.py")
ODD = {
    "huge.py": "print('A: 1e155')\nprint('A: 0')\nprint('Done: 2')\n",
    "high.py": "print('A: 1.7e308')\nprint('A: -1.7e308')\nprint('Done: 2')\n",
    "less.py": "x = 1.0\nfor _ in range(1100):\n    print('Error:', x)\n    x *= 2\nprint('Done: 2')\n",
    f"name/{ODD_NAME}": "print('Done: 2')\n",
}
EXPORTS = ("marks.csv", "marks.html", "marks.jsonl", "moodle.csv", "canvas.csv", "told")


@pytest.fixture
def mark(tmp_path: Path) -> Callable[..., tuple[int, dict[str, list[str]]]]:
    """A function that marks files, and returns the exit code and the rows of `marks.csv` by student."""

    def run(files: dict[str, str], *, keep: str = "none") -> tuple[int, dict[str, list[str]]]:
        folder = tmp_path / str(len(list(tmp_path.iterdir())))
        folder.mkdir()
        (folder / "goals.toml").write_text(GOALS)
        for name, text in files.items():
            path = folder / "class" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        words = ["mark", str(folder / "goals.toml"), str(folder / "class"), "--seeds", "0"]
        words += ["--jobs", "1", "--no-isolate", "--keep", keep]
        for export in EXPORTS:
            option = {"moodle.csv": "--moodle", "canvas.csv": "--canvas", "told": "--feedback"}
            words += [option.get(export, "--export"), str(folder / export)]
        code = run_command(words)
        assert not [name for name in EXPORTS if not (folder / name).exists()]
        with open(folder / "marks.csv", newline="") as file:
            return code, {row[0]: row for row in csv.reader(file)}

    return run


def test_programs_with_huge_numbers_or_odd_names_are_marked(mark: Any) -> None:
    _, before = mark(HONEST)
    code, rows = mark({**HONEST, **ODD})
    assert code == 0
    assert {name: rows[name] for name in before} == before
    assert [rows[name][2] for name in ("ada", "ben", "high", "huge", "less", "name")] == [
        *("2.0", "0.0"),
        *["2.0"] * 4,
    ]
    assert rows["name"][1] == r"m\xff.py"


def _fail(where: Sequence[Any]) -> Callable[..., Any]:
    """Return a function that fails for the student zoltan, and is the real one for others."""
    place, name = where
    real = getattr(place, name)

    def fail(*given: Any, **more: Any) -> Any:
        if "zoltan" in repr((given, more)):
            raise ZeroDivisionError("ours")
        return real(*given, **more)

    return fail


@pytest.mark.parametrize(
    "where",
    [
        (runs, "compute_digest"),
        (runs, "copy_files"),
        (execute, "RunHandle"),
        (execute, "_build_result"),
        (runs, "build_outcome"),
    ],
    ids=lambda where: str(where[1]),
)
def test_a_fault_of_tuisim_while_marking_costs_one_students_row_only(
    mark: Any,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    where: Sequence[Any],
) -> None:
    _, before = mark(HONEST)
    monkeypatch.setattr(where[0], where[1], _fail(where))
    code, rows = mark({**HONEST, "zoltan.py": "print('Done: 2')\n"})
    assert code == 1
    assert {name: rows[name] for name in before} == before
    assert "could not be judged: ZeroDivisionError: ours" in rows["zoltan"]
    assert rows["zoltan"][2] == ""
    assert str(report_file()) in capsys.readouterr().err
    assert "in fail\n" in report_file().read_text()


def test_marks_are_exported_also_if_no_student_could_be_judged(
    mark: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runs, "copy_files", MagicMock(side_effect=MemoryError))
    files = {**HONEST, "zoltan.py": "print('Done: 2')\n"}
    code, rows = mark(files)
    assert code == 1 and [rows[name.removesuffix(".py")][2] for name in files] == ["", "", ""]


def test_the_page_of_marks_is_written_even_if_one_report_fails(
    mark: Any, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    where = reports, "_build_report"
    monkeypatch.setattr(*where, _fail(where))
    code, rows = mark({**HONEST, "zoltan.py": "print('Done: 3')\n"}, keep="all")
    assert code == 2 and rows["zoltan"][2] == "0.0"
    assert "is without 1 report: zoltan: could not be judged" in capsys.readouterr().err


DAMAGING = """\
import os
for fd in os.listdir("/proc/self/fd"):
    try:
        if os.readlink(f"/proc/self/fd/{fd}").endswith("NAME"):
            os.pwrite(int(fd), b"\\xff", 8)
    except OSError:
        pass
print("Done: 3")
"""


@pytest.mark.parametrize("name", ["commands.bin", "motors.bin", "readings.bin", ".bin"])
def test_a_marking_is_no_failure_because_a_program_has_damaged_its_recording(
    mark: Any, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.setitem(globals(), "GOALS", f"profile = 'ev3'\n{GOALS}")
    code, rows = mark({**HONEST, "zoltan.py": DAMAGING.replace("NAME", name)}, keep="all")
    assert code == 0 and rows["zoltan"][2] == "0.0"


GRADEBOOKS = {
    "Ben Weiß_4713_assignsubmission_file_/lab/main.py": "open('log.txt', 'w')\nprint('Done: 2')\n",
    "Ben Weiß_4713_assignsubmission_onlinetext_/onlinetext.html": "<p>text</p>",
    "weissben_LATE_12_340_main.py": "import helper\n",
    "weissben_12_340_helper.py": "print('Done: 2')\n",
    "weissben_12_99_main.py": "print('Done: 3')\n",
    "ada/lab1/main.py": "print('Done: 2')\n",
    "__MACOSX/ada/._main.py": "",
}


def test_downloads_of_gradebooks_are_marked_as_they_are(
    mark: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, rows = mark(GRADEBOOKS)
    assert code == 0
    marks = [("ada", "2.0"), ("Ben Weiß", "2.0"), ("weissben", "2.0")]
    assert [(name, row[2]) for name, row in rows.items()][1:] == marks
    assert capsys.readouterr().err.count("__MACOSX") == 1
    (book,) = tmp_path.glob("*/moodle.csv")
    assert "\nParticipant 4713,Ben Weiß,,2," in book.read_text("utf-8")
    assert "\nweissben,12,,,,2" in book.with_name("canvas.csv").read_text("utf-8")


def test_the_list_of_runs_names_the_student_of_a_marked_run(tmp_path: Path, here: Command) -> None:
    (tmp_path / "goals.toml").write_text(GOALS)
    (tmp_path / "class" / "Ada Lovelace").mkdir(parents=True)
    (tmp_path / "class" / "Ada Lovelace" / "main.py").write_text("x = 1\n")
    assert here("mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1").returncode == 0
    assert "student:Ada_Lovelace" in here("runs", "list").stdout
