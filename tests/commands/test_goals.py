"""`tuisim goals check`: what it prints, its exit codes, and runs that are damaged, interrupted or changed by hand."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image

from tests.cases import cases
from tests.conftest import Command
from tests.tasks.goals.recorded import Run, ahead, says, wait, world
from tuisim.engine.runs.records import HEADER_BYTES, TELEMETRY_FILE
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.worlds import WorldFile, save_world
from tuisim.tasks.goals.files import GoalsFile, list_example_names
from tuisim.tasks.goals.judge import judge

GOALS = """\
title = "A task"

[[goal]]
name = "there"
say = "Drive to x = 700."
points = 2
hint = "Drive on."
reach = { x_mm = 700 }

[[goal]]
name = "said"
print = "done"
"""


@pytest.fixture
def task(tmp_path: Path, home: Path) -> Path:
    path = tmp_path / "task.toml"
    path.write_text(GOALS)
    return path


def record(*, mm: float = 200, text: str = "done") -> Run:
    run = Run(RunStore(), world(), "")
    run.do((ahead(mm, 3), says(text, 4), wait(0.5, 5)))
    return run


def test_met_goals_are_listed_with_exit_code_0(task: Path, here: Command) -> None:
    record().end()
    done = here("goals", "check", task)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.split("\n") == [
        "run 1, task.py · A task: 2 of 2 goals, 3 of 3 points",
        "  ✓ there (2): Drive to x = 700.",
        "      met at 1.03 s, x 681 mm, y 500 mm, line 3",
        "  ✓ said (1)",
        "      met at 1.14 s, x 701 mm, y 500 mm, line 4",
        "",
    ]


def test_a_missed_goal_is_listed_with_exit_code_1(task: Path, here: Command) -> None:
    record(mm=100).end()
    done = here("goals", "check", task)
    assert done.returncode == 1
    assert done.stdout.split("\n")[:5] == [
        "run 1, task.py · A task: 1 of 2 goals, 1 of 3 points",
        "  ✗ there (2): Drive to x = 700.",
        "      missed at 1.07 s, x 600 mm, y 500 mm",
        "      At its nearest, at 0.57 s, the robot was 100 mm left of x = 700 mm (line 3).",
        "      Hint: Drive on.",
    ]


def test_goals_check_of_a_running_run_calls_unmet_goals_open(task: Path, here: Command) -> None:
    _running = record(mm=100)
    done = here("goals", "check", task)
    assert done.returncode == 1
    assert done.stdout.split("\n")[1:3] == [
        "  · there (2): Drive to x = 700.",
        "      At its nearest, at 0.57 s, the robot was 100 mm left of x = 700 mm (line 3).",
    ]


def test_json_has_points_and_states_of_goals(task: Path, here: Command) -> None:
    record(mm=100).end()
    (found,) = json.loads(here("goals", "check", task, "--json").stdout)
    assert (found["run"], found["points"], found["of"]) == (1, 1, 3)
    assert [
        (goal["name"], goal["state"], goal["line"], goal["hint"]) for goal in found["goals"]
    ] == [
        ("there", "missed", 3, "Drive on."),
        ("said", "met", 4, ""),
    ]
    assert found["goals"][1]["changes"][0] | {"x_mm": 0} == {
        "tick": 57,
        "time_s": 0.57,
        "state": "met",
        "x_mm": 0,
        "y_mm": 500,
    }


RUNS = {
    "none": ((), 0, [3]),
    "number": (("2",), 1, [2]),
    "several": (("3", "2"), 1, [3, 2]),
    "range beyond": (("2..99",), 1, [2, 3]),
}


@cases("words, code, numbers", RUNS)
def test_goals_are_checked_on_the_named_runs(
    words: tuple[str, ...], code: int, numbers: list[int], task: Path, here: Command
) -> None:
    for mm in (200, 100, 200):
        record(mm=mm).end()
    done = here("goals", "check", task, *words, "--json")
    assert (done.returncode, [run["run"] for run in json.loads(done.stdout)]) == (code, numbers)


BAD = {
    "no goals file": ((), "tuisim: GOALS is missing (see `tuisim goals check --help`)"),
    "no such run": (("{task}", "9"), "no run '9'"),
    "empty range": (("{task}", "7..9"), "RUN: no runs 7..9 (see `tuisim runs`)"),
    "range backwards": (("{task}", "3..1"), "RUN: no runs 3..1"),
    "no such file": (("none.toml",), "none.toml: there is no such file"),
    "long name": (("x" * 300 + ".toml",), "cannot be read: File name too long"),
}


@cases("words, message", BAD)
def test_wrong_words_for_goals_are_refused_in_one_line(
    words: tuple[str, ...], message: str, task: Path, here: Command
) -> None:
    record().end()
    done = here("goals", "check", *(word.format(task=task) for word in words))
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr


OWN_MATS = {
    "an image": "background = 'own.png'",
    "a name in a folder of mats": "background = 'other'\nmats = 'mats'",
}


@cases("mat", OWN_MATS)
def test_goals_check_has_no_note_on_a_run_on_its_tasks_own_mat(
    mat: str, task: Path, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mats").mkdir()
    for path in (tmp_path / "own.png", tmp_path / "mats" / "other.png"):
        Image.new("RGB", (200, 100), "white").save(path)
    task.write_text(f"{mat}\n{GOALS}")
    (tmp_path / "p.py").write_text("print('done')\n")
    assert here("run", task.name, "p.py").returncode == 0
    for named in (task.name, str(task)):
        assert here("goals", "check", named).stderr == ""


def test_goals_check_notes_a_run_that_started_elsewhere_than_its_task(
    task: Path, here: Command, tmp_path: Path
) -> None:
    task.write_text(f"background = 'Empty_Map'\n{GOALS}")
    (tmp_path / "p.py").write_text("# %%sim_magic_preloaded -b Loop -x 600\nprint('done')\n")
    assert here("run", task, "p.py").returncode == 0
    noted = "note: run 1 was not run in the world of task.toml: x_mm 600.0, not 100.0\n"
    assert here("goals", "check", task).stderr == noted


def test_goals_check_notes_a_run_in_another_world_or_changed_by_hand(
    task: Path, here: Command
) -> None:
    task.write_text(
        f"background = 'Loop'\n{GOALS}[start]\nx_mm = 200\n".replace("[start]", "[start]", 1)
    )
    run = record()
    run.recorder.act("set_noise", light=1, motor=0)
    run.end()
    done = here("goals", "check", task)
    assert done.stderr.split("\n") == [
        "note: run 1 was changed while it ran: 1 action of the user",
        "note: run 1 was not run in the world of task.toml: background Empty_Map, not Loop, x_mm 500.0, not 200.0",
        "",
    ]


def test_goals_check_notes_telemetry_that_is_cut_off_or_damaged(task: Path, here: Command) -> None:
    stored = record().end()
    path = stored.folder / TELEMETRY_FILE
    data = bytearray(path.read_bytes())
    data[HEADER_BYTES + 64 * 5 : HEADER_BYTES + 64 * 9] = bytes(range(256))
    path.write_bytes(data[: HEADER_BYTES + 64 * 50])
    done = here("goals", "check", task)
    assert done.returncode == 1
    assert "✗ there" in done.stdout
    assert "✓ said" in done.stdout
    assert done.stderr.startswith("note: telemetry.bin was truncated")


@pytest.mark.parametrize("lines", [0, 40], ids=["nothing printed", "printed"])
def test_goals_check_misses_goals_about_the_robot_without_telemetry(
    lines: int, task: Path, here: Command
) -> None:
    run = record()
    for _ in range(lines):
        run.recorder.print("more", 6)
    stored = run.end()
    (stored.folder / TELEMETRY_FILE).unlink()
    done = here("goals", "check", task)
    assert done.returncode == 1
    assert "The robot was not simulated at that time." in done.stdout


def test_goals_check_names_the_syntax_error_for_each_goal_about_the_program(
    task: Path, here: Command
) -> None:
    Path("broken.py").write_text("while True\n")
    here("run", "broken.py")
    task.write_text(
        f"{GOALS}[[goal]]\nname = 'still'\ntouch_nothing = true\n[[goal]]\nname = 'use'\nuse = 'print'\n"
    )
    done = here("goals", "check", task)
    assert (done.returncode, done.stdout.split("\n")[0]) == (
        1,
        "run 1, broken.py · A task: 0 of 4 goals, 0 of 5 points",
    )
    assert done.stdout.count("The program does not compile: expected ':' (line 1).") == 4


def test_goals_judge_only_a_limited_number_of_printed_rows(
    task: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tuisim.tasks.goals.evidence.MAX_ROWS", 5)
    run = Run(RunStore(), world(), "")
    run.do([says("x")] * 9 + [says("done")])
    assert [each.state for each in judge(GoalsFile.load(task).goals, run.end())] == [
        "missed",
        "missed",
    ]


@pytest.mark.slow
def test_goals_of_the_examples_are_found_by_name(here: Command, home: Path) -> None:
    record().end()
    for name in list_example_names():
        assert here("goals", "check", name).returncode == 1
        assert here("goals", "check", f"{name}_goals.toml").returncode == 1


def test_the_lines_printed_by_goals_mat_can_be_used_in_a_task(task: Path, here: Command) -> None:
    done = here("goals", "mat", "bands", "--seed", "7")
    assert (done.returncode, done.stderr) == (0, "")
    task.write_text(GOALS + done.stdout)
    (other,) = GoalsFile.load(task).worlds[1:]
    assert other.hidden and (task.parent / "bands-7.png").read_bytes().startswith(b"\x89PNG")
    build_run_spec(Settings.merge(other.settings))


WRONG_MATS = {
    "kind": ("band", "KIND: no such kind of mat 'band' (did you mean bands?)"),
    "seed": ("bands --seed -1", "--seed: must be from 0 to"),
    "format": (
        "bands --out a.jpg",
        "cannot write a.jpg: unknown format '.jpg' (a mat ends in .png)",
    ),
}


@pytest.mark.parametrize("case", WRONG_MATS)
def test_goals_mat_refuses_wrong_words_in_one_line(case: str, here: Command) -> None:
    words, said = WRONG_MATS[case]
    done = here("goals", "mat", *words.split())
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("tuisim: " + said)


def test_saving_a_world_into_a_goal_file_keeps_the_goals(task: Path) -> None:
    (task.parent / "base.toml").write_text("seed = 3\nbackground = 'Loop'\n")
    task.write_text(f"world = 'base.toml'\n{GOALS}")
    spec = build_run_spec(Settings.merge(WorldFile.load(task).settings))
    save_world(spec, task)
    assert build_run_spec(Settings.merge(WorldFile.load(task).settings)) == spec
    assert [goal.name for goal in GoalsFile.load(task).goals] == ["there", "said"]
