"""The real command with world files and with robots and obstacles of one's own."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.conftest import Command
from tuisim.base.errors import ConfigError
from tuisim.commands.resolve import NO_CONFIG, prepare_app
from tuisim.settings.command_line import Arguments

LAB = """\
program = "sub/where.py"
background = "Square"
robot = { base = "Small_Robot", wheel_diameter_mm = 40 }
seed = 5
[start]
x_mm = 600
"""
WHERE = "# %%sim_magic_preloaded -b Loop -y 700 --seed 3\nprint('Value: ' + str(tank_drive.left_motor.position))\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "lab.toml").write_text(LAB)
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "where.py").write_text(WHERE)
    (tmp_path / "other.py").write_text(WHERE)
    return tmp_path


# The words of `tuisim run`, and what is then known of the run.
RUNS: dict[str, tuple[list[object], dict[str, Any]]] = {
    "the world's own program": (
        ["lab.toml"],
        {"program": "where.py", "background": "Square", "seed": 5, "x_mm": 600},
    ),
    "another program": (
        ["lab.toml", "other.py"],
        {"program": "other.py", "background": "Square", "seed": 5},
    ),
    "switches win": (
        ["lab.toml", "-b", "Loop", "-x", 5, "--seed", 9],
        {"background": "Loop", "seed": 9, "x_mm": 5},
    ),
}


@cases("words, facts", RUNS)
def test_command_line_options_override_the_world_file_and_that_the_magic_line(
    words: list[object], facts: dict[str, Any], folder: Path, here: Command
) -> None:
    done = here("run", *words, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout).items() >= facts.items()


def test_several_programs_run_in_one_world(folder: Path, here: Command) -> None:
    done = here("run", "lab.toml", "other.py", "sub/where.py", "--json")
    assert [json.loads(line)["seed"] for line in done.stdout.splitlines()] == [5, 5]


def test_printed_robots_and_obstacles_can_be_used_as_files(folder: Path, here: Command) -> None:
    (folder / "mine.toml").write_text(here("robots", "Small_Robot").stdout)
    (folder / "boxes.toml").write_text(here("obstacles", "Wall").stdout)
    assert here("robots", "mine.toml").stdout == (folder / "mine.toml").read_text()
    done = here("run", "other.py", "-r", "mine.toml", "-o", "boxes.toml", "--json")
    assert json.loads(done.stdout)["robot"] == "Small_Robot"


def test_files_of_a_magic_line_are_looked_for_beside_the_program(
    folder: Path, here: Command
) -> None:
    (folder / "sub" / "eyes.toml").write_text("[color_sensors.left]\ndiameter_mm = 8\n")
    (folder / "sub" / "look.py").write_text(
        "# %%sim_magic_preloaded -r eyes.toml\nprint(colorLeft.rgb)\n"
    )
    done = here("run", "sub/look.py", "--json")
    assert json.loads(done.stdout)["robot"] == "eyes"


@pytest.mark.parametrize(
    "text, said",
    [
        ("seed = 3", "lab.toml names no program (tuisim run PROGRAM…)"),
        ("program = 'whre.py'", "whre.py: there is no such program"),
        (
            "program = 'sub/whre.py'",
            "sub/whre.py: there is no such program (did you mean where.py?)",
        ),
        ("program = 3", "lab.toml: program: must be text, got 3"),
    ],
    ids=["no program", "missing program", "misspelt program", "program's type"],
)
def test_running_a_world_file_without_a_program_says_so_in_one_line(
    text: str, said: str, folder: Path, here: Command
) -> None:
    (folder / "lab.toml").write_text(text)
    done = here("run", "lab.toml")
    assert done.stderr.startswith(f"tuisim: {said}")
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)


def test_nothing_is_run_if_a_later_world_has_a_damaged_picture(
    folder: Path, home: Path, root: Path, here: Command
) -> None:
    (folder / "mat.png").write_bytes((root / "backgrounds" / "Square.png").read_bytes()[:3000])
    (folder / "bad.py").write_text("# %%sim_magic -b mat.png\n")
    done = here("run", "other.py", "bad.py")
    assert done.stderr.startswith("tuisim: ")
    assert "mat.png: is " in done.stderr
    assert (done.returncode, done.stdout, len(done.stderr.splitlines())) == (2, "", 1)
    assert not list(home.glob("runs/*"))


def test_profiles_of_ones_own_stand_beside_the_others(folder: Path, here: Command) -> None:
    (folder / "slow.toml").write_text("color_read_ms = 25\n")
    lines = here("profiles", "ev3", "slow.toml").stdout.splitlines()
    assert [line.split()[:5] for line in lines if line.startswith("color_read")] == [
        ["color_read", "1.2", "ms", "25", "ms"]
    ]
    assert "measured on the old simulator" in next(
        line for line in lines if line.startswith("color_read")
    )


WAITS = """\
# %%sim_magic_preloaded --press enter@1 --press in1@1
from ev3dev2.button import Button
Button().wait_for_pressed('enter')
print('Pressed: 1')
"""
"""With a hand that presses what it waits for."""
PRESSES: dict[str, tuple[list[str], int]] = {
    "the first line": (["run", "waits.py"], 1),
    "the command line wins": (["run", "waits.py", "--press", "enter@2"], 2),
    "a world wins over the first line": (["run", "hands.toml", "waits.py"], 3),
    "a batch in a world": (["batch", "hands.toml", "waits.py"], 3),
}


@cases("words, time_s", PRESSES)
def test_presses_planned_in_the_magic_line_or_world_file_happen(
    words: list[str], time_s: int, folder: Path, here: Command
) -> None:
    (folder / "waits.py").write_text(WAITS)
    (folder / "hands.toml").write_text('press = ["enter@3"]\n')
    done = here(*words, "--json")
    assert done.returncode == 0, done.stderr
    (found,) = (json.loads(line) for line in done.stdout.splitlines())
    assert int(found["time_s"]) == time_s


def test_a_wrong_press_in_the_first_line_is_told_in_one_sentence(
    folder: Path, here: Command
) -> None:
    (folder / "waits.py").write_text(WAITS.replace("enter@1", "entre@1"))
    for command in ("run", "batch"):
        done = here(command, "waits.py")
        assert (done.returncode, done.stdout, done.stderr) == (
            2,
            "",
            "tuisim: waits.py, line 1: --press: 'entre' cannot be pressed (did you mean enter?)\n",
        )


@cases(
    "word, is_new",
    {
        "a new file": ("mine.py", True),
        "a file that is there": ("other.py", False),
        "no such folder": ("no/mine.py", None),
        "a name without a suffix": ("mine", None),
    },
)
def test_opening_a_python_file_that_does_not_exist_begins_a_new_program(
    word: str, is_new: bool | None, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    arguments = Arguments(world=None, settings={})
    with suppress(ConfigError):
        program = prepare_app([word], arguments, NO_CONFIG, can_begin=True).program
        assert program is not None
        assert (program.name, program.text == "") == (word, is_new)
        return
    assert is_new is None
