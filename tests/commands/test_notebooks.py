"""A folder of notebooks on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.programs.test_notebook_file import BESIDE, LESSON, VARIABLES, write

RGB = "%%sim_magic_preloaded\nprint(colorLeft.rgb)\n"


@pytest.fixture
def course(tmp_path: Path) -> Path:
    """Three notebooks in two folders; the last one has modules beside it, and starts in a world of its own."""
    folder = tmp_path / "course"
    for name in ("2 more", "10 last/.ipynb_checkpoints"):
        (folder / name).mkdir(parents=True)
    write(
        folder / "2 more" / "b.ipynb",
        [("code", "%sim_magic -b Rainbow_bands -x 300"), ("code", RGB)],
    )
    write(folder / "2 more" / "a.ipynb", [("markdown", "# Only text")])
    write(folder / "10 last" / "l.ipynb", [*BESIDE, ("code", RGB)])
    write(folder / "10 last" / ".ipynb_checkpoints" / "l-checkpoint.ipynb", [("code", RGB)])
    (folder / "10 last" / "drive_lib.py").write_text("SPEED = 30\n")
    return folder


def test_all_notebooks_of_a_folder_run_in_order_each_in_its_own_world(
    course: Path, here: Command
) -> None:
    done = here("run", course, "--all")
    printed = done.stdout.splitlines()[:3]
    table = done.stdout.splitlines()[3:]
    assert (done.returncode, printed) == (
        0,
        ["(255, 0, 0)", f"30 {course.parent.name}", "(255, 255, 255)"],
    )
    names = ["2 more/b.ipynb#1", "10 last/l.ipynb#1", "10 last/l.ipynb#2"]
    assert [line.split("  ")[0] for line in table] == ["cell", *names]


BROKEN: dict[str, tuple[str | list[tuple[str, str]], str]] = {
    "no notebook": ("{", "2.ipynb"),
    "wrong mat": ([("code", "%%sim_magic -b Nope\npass")], "2.ipynb#1"),
    "damaged picture": ([("code", "%%sim_magic -b ./1.ipynb\npass")], "2.ipynb#1"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_what_is_wrong_in_one_notebook_keeps_no_other_from_running(
    name: str, here: Command, tmp_path: Path
) -> None:
    content, label = BROKEN[name]
    for number in (1, 3):
        write(tmp_path / f"{number}.ipynb", [("code", f"%%sim_magic\nprint({number})\n")])
    if isinstance(content, str):
        (tmp_path / "2.ipynb").write_text(content)
    else:
        write(tmp_path / "2.ipynb", content)
    done = here("run", tmp_path, "--all")
    assert done.stdout.splitlines()[:2] == ["1", "3"]
    assert [line.split()[:2] for line in done.stdout.splitlines()[-3:]] == [
        ["1.ipynb#1", "finished"],
        [label, "not_run"],
        ["3.ipynb#1", "finished"],
    ]
    assert done.returncode == 2
    assert f"tuisim: {label} was not run: " in done.stderr


def test_the_worst_end_is_the_exit_code_and_json_tells_each(here: Command, tmp_path: Path) -> None:
    write(tmp_path / "1.ipynb", LESSON)
    write(tmp_path / "2.ipynb", [("code", "%%sim_magic -b Nope\npass")])
    done = here("run", tmp_path, "--all", "--json")
    ends = [
        (one["program"], one["state"], one["exit_code"])
        for one in map(json.loads, done.stdout.splitlines())
    ]
    assert (done.returncode, ends[2:]) == (
        2,
        [("1.ipynb#3", "raised", 1), ("2.ipynb#1", "not_run", 2)],
    )


@cases(
    "cells, words, told",
    {
        "no notebooks": ([], "--all", "is a folder without notebooks"),
        "no programs": ([("markdown", "# Text")], "--all", "has no notebook with a program"),
        "none that runs here": (VARIABLES[:2], "--all", "has no notebook with a program"),
        "not told to": (LESSON, "", "is a folder of 1 notebook (tuisim run "),
        "wrong switch": (LESSON, "--all -b Nope", "tuisim: -b: no such mat 'Nope'"),
        "arguments": (LESSON, "--all -- 5", "notebooks take no arguments"),
        "telemetry": (LESSON, "--all --telemetry t.csv", "--telemetry: takes one program"),
    },
)
def test_a_folder_without_notebooks_to_run_is_refused_with_the_reason(
    cells: list[tuple[str, str]], words: str, told: str, here: Command, tmp_path: Path
) -> None:
    (tmp_path / "course").mkdir()
    if cells:
        write(tmp_path / "course" / "l.ipynb", cells)
    done = here("run", "course", *words.split())
    assert (done.returncode, done.stdout) == (2, "")
    assert told in done.stderr


def test_running_a_folder_with_one_program_says_how_to_name_it(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "team").mkdir()
    (tmp_path / "team" / "main.py").write_text("print(1)\n")
    assert (
        "team: is a folder without notebooks (name its program team/main.py)"
        in here("run", "team").stderr
    )
