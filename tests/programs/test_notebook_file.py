"""Notebooks on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.programs.notebook_file import read_notebook_programs

LESSON = [
    ("markdown", "# Lesson\n"),
    ("code", "%load_ext tuisim"),
    ("markdown", "## Hello"),
    ("code", "%%sim_magic_preloaded\nprint('Colour: 1')\n"),
    ("code", "%sim_magic -b Grey_bands -x 300\n"),
    ("markdown", "## Grey\ntext"),
    (
        "code",
        "\n%%sim_magic_preloaded -A\nprint('Colour: ' + str(colorLeft.reflected_light_intensity_pc))\n",
    ),
    ("code", "data_df = %sim_data\ndata_df.head()"),
    ("code", "%%sim_magic -b Loop\n1 / 0\n"),
]


def write(path: Path, cells: list[tuple[str, str]]) -> Path:
    rows = [
        {"cell_type": kind, "metadata": {}, "source": text.splitlines(keepends=True)}
        for kind, text in cells
    ]
    path.write_text(json.dumps({"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": rows}))
    return path


@pytest.mark.parametrize("command", [("run",), ()], ids=["run", "open"])
def test_a_notebook_lists_its_programs(
    command: tuple[str, ...], here: Command, tmp_path: Path
) -> None:
    done = here(*command, write(tmp_path / "lesson.ipynb", LESSON))
    rows = [line.split() for line in done.stdout.splitlines()[1:4]]
    assert rows == [
        ["1", "Hello", "preloaded"],
        ["2", "Grey", "Grey_bands", "preloaded"],
        ["3", "Grey", "Loop", "none"],
    ]
    assert (done.returncode, done.stderr) == (0, "")


def test_a_cell_runs_in_the_world_that_cells_before_it_set(here: Command, tmp_path: Path) -> None:
    done = here("run", f"{write(tmp_path / 'lesson.ipynb', LESSON)}#2")
    assert (done.returncode, done.stdout) == (0, "Colour: 86.27450980392157\n")


def test_running_all_cells_of_a_notebook_prints_one_table(here: Command, tmp_path: Path) -> None:
    done = here("run", write(tmp_path / "lesson.ipynb", LESSON), "--all")
    assert done.returncode == 1
    table = done.stdout.splitlines()[-3:]
    assert [line.split()[:3] for line in table] == [
        ["lesson.ipynb#1", "finished", "1"],
        ["lesson.ipynb#2", "finished", "1"],
        ["lesson.ipynb#3", "raised", "0"],
    ]
    assert "line 2" in done.stderr


BESIDE = [
    (
        "code",
        "%%sim_magic\nimport drive_lib\nfrom pathlib import Path\nprint(drive_lib.SPEED, Path.cwd().name)",
    )
]
"""A cell that takes a module which lies beside its notebook."""


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_a_cell_finds_modules_beside_its_notebook(
    profile: str, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "lessons"
    elsewhere = tmp_path / "elsewhere"
    folder.mkdir()
    elsewhere.mkdir()
    write(folder / "l.ipynb", BESIDE)
    (folder / "drive_lib.py").write_text("SPEED = 30\n")
    monkeypatch.chdir(elsewhere)
    done = here("run", "../lessons/l.ipynb", "--all", "--profile", profile)
    starts_in = "lessons" if profile == "ev3" else "elsewhere"
    assert (done.returncode, done.stdout.splitlines()[0]) == (0, f"30 {starts_in}"), done.stderr


VARIABLES = [
    ("code", "x = 300"),
    ("code", "%%sim_magic_preloaded -b Grey_bands -x $_x\nprint('never')\n"),
    ("code", "for x in (1, 2):\n    %sim_magic --xpos={x + 300} -y 500\n"),
    (
        "code",
        "%%sim_magic_preloaded\nprint('Colour: ' + str(colorLeft.reflected_light_intensity_pc))\n",
    ),
]
"""Cells whose magics take values from the notebook, and a program after them."""


def test_a_cell_with_a_variable_of_the_notebook_is_skipped(here: Command, tmp_path: Path) -> None:
    lesson = write(tmp_path / "lesson.ipynb", VARIABLES)
    done = here("run", lesson, "--all")
    assert done.returncode == 0
    assert done.stdout.splitlines()[0] == "Colour: 100.0"
    assert [line.split()[:2] for line in done.stdout.splitlines()[2:]] == [
        ["lesson.ipynb#2", "finished"]
    ]
    notes = [
        "lesson.ipynb#1 is skipped: $_x is defined only in the notebook",
        f"{lesson}, cell 3: {{x + 300}} is defined only in the notebook, and is ignored",
    ]
    assert done.stderr.splitlines()[:2] == [f"tuisim: {note}" for note in notes]


@cases(
    "words, unknown, settings",
    {
        "value": ("-b Loop -x $_x", "$_x", {"background": "Loop"}),
        "joined": ("-x$x -b Loop", "$x", {"background": "Loop"}),
        "braces": ("--xpos={2 * x} -b Loop", "{2 * x}", {"background": "Loop"}),
        "two": ("-x {x} -y $y.z -R", "{x}, $y.z", {"autorun": True}),
        "alone": ("$words", "$words", {}),
        "a real dollar": ("-b my$$mat", "", {"background": "my$$mat"}),
    },
)
def test_what_only_the_notebook_knows_is_left_out(
    words: str, unknown: str, settings: dict[str, object], tmp_path: Path
) -> None:
    (found,) = read_notebook_programs(
        write(tmp_path / "one.ipynb", [("code", f"%%sim_magic {words}\npass\n")])
    )
    assert (found.unknown, dict(found.source.options)) == (unknown, settings)


def test_files_in_magics_are_looked_for_beside_the_notebook(tmp_path: Path) -> None:
    cells = [("code", "%sim_magic -b ./maze.png"), ("code", "%%sim_magic -r bot.toml\npass\n")]
    (found,) = read_notebook_programs(Path(write(tmp_path / "lesson.ipynb", cells)))
    wanted = {"background": str(tmp_path / "maze.png"), "robot": str(tmp_path / "bot.toml")}
    assert found.source.options == wanted


def test_json_stands_alone_on_stdout_also_for_all_cells(here: Command, tmp_path: Path) -> None:
    lesson = write(tmp_path / "lesson.ipynb", LESSON)
    done = here("run", lesson, "--all", "--json")
    states = [json.loads(line)["state"] for line in done.stdout.splitlines()]
    assert states == ["finished", "finished", "raised"]
    # A list would be no answer to one that wants data.
    done = here("run", lesson, "--json")
    assert (done.returncode, done.stdout) == (2, "")
    assert "has 3 program cells; name one (--all, or " in done.stderr


@cases(
    "content, cell, told",
    {
        "missing": (None, "", "there is no such notebook"),
        "torn": ("{", "", "is not a readable notebook"),
        "not cells": ('{"cells": [1]}', "", "is not a readable notebook"),
        "empty": ('{"cells": []}', "", "has no program cells"),
        "no such cell": (LESSON, "#4", "a number from 1 to 3"),
        "no number": (LESSON, "#x", "a number from 1 to 3"),
        "variable": (VARIABLES, "#1", "$_x is defined only in the notebook (run the cell there"),
        "wrong switch": ([("code", "%%sim_magic -Y\npass")], "", "cell 1: no such option"),
        "wrong mat": ([("code", "%%sim_magic -b Nope\npass")], "", "bad.ipynb#1: -b: no such mat"),
        "wrong magic": ([("code", "%%sim_magic_preload\npass")], "", "cell 1: no such magic %%sim"),
        "deep": ('{"cells": ' + "[" * 100_000, "", "is not a readable notebook"),
        "no text": (
            '{"cells": [{"cell_type": "code", "source": [1]}]}',
            "",
            "not a readable notebook",
        ),
    },
)
def test_a_notebook_that_cannot_be_run_says_why(
    content: str | list[tuple[str, str]] | None, cell: str, told: str, here: Command, tmp_path: Path
) -> None:
    path = tmp_path / "bad.ipynb"
    if isinstance(content, str):
        path.write_text(content)
    elif content is not None:
        write(path, content)
    done = here("run", f"{path}{cell}")
    assert (done.returncode, done.stdout) == (2, "")
    assert told in done.stderr
    assert done.stderr.count("\n") == 1
