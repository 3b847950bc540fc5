"""`tuisim mark`, the whole command: the class has its expected marks, and nothing of the machine is in the results."""

from __future__ import annotations

import errno
import io
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from tests.cases import cases
from tests.conftest import ROOT, Command
from tests.running import PATIENCE_S
from tests.tasks.marks.hazards import ODD_NAME
from tests.tasks.marks.student import GOAL_POINTS, GOALS, Student
from tests.tasks.marks.test_sheet import LONG_SHEET
from tests.tasks.marks.the_class import CLASS, write_class
from tuisim.base.errors import HostError
from tuisim.cli import run_command
from tuisim.commands import mark
from tuisim.engine.runs.handle import RunHandle
from tuisim.tasks import execute
from tuisim.tasks.goals import patterns
from tuisim.tasks.marks import marking
from tuisim.tasks.marks.outcome import Outcome

FEW = ("ada.py", "ben.py", "gustav.py", "raises.py", "empty.py", "zip.py", "viktor")
PROCESSES_S = 600.0


def _few(*names: str) -> tuple[Student, ...]:
    return tuple(student for student in CLASS if student.name in names)


def _command(*words: str) -> list[str]:
    """Mark a class into files named the same wherever they are."""
    return [
        *(
            sys.executable,
            "-m",
            "tuisim",
            "mark",
            str(GOALS),
            "class",
            "--timeout",
            "30",
        ),
        *(
            "--export",
            "marks.csv",
            "--export",
            "marks.parquet",
            "--export",
            "marks.html",
            "--feedback",
            "feedback",
        ),
        *words,
    ]


def _mark(folder: Path, home: Path, *words: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(home)}
    return subprocess.run(
        _command(*words),
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=PROCESSES_S,
        check=False,
    )


def _results(folder: Path) -> dict[str, bytes]:
    """Return everything that marking has written, by path."""
    files = [
        path
        for path in folder.rglob("*")
        if path.is_file() and path.relative_to(folder).parts[0] != "class"
    ]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@pytest.fixture(scope="module")
def marked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the class, marked once by one command."""
    folder = tmp_path_factory.mktemp("marked")
    write_class(folder / "class")
    done = _mark(folder, tmp_path_factory.mktemp("home"), "--jobs", "2", "--seeds", "0")
    assert done.returncode == 0, done.stderr
    (folder / "stdout.txt").write_text(done.stdout)
    return folder


@pytest.mark.slow
def test_every_student_of_the_class_has_the_expected_marks(marked: Path) -> None:
    frame = pd.read_parquet(marked / "marks.parquet").set_index("student")
    wrong = []
    for student in CLASS:
        row = frame.loc[student.row]
        points = tuple(row[f"goal_{goal}"] for goal in GOAL_POINTS)
        expected = tuple(
            0.0 if goal in student.missed else float(most) for goal, most in GOAL_POINTS.items()
        )
        line = row["line"] if student.line else 0
        robust = 0.0 if student.missed else 1.0
        if (points, row["points"], row["robustness"], line) != (
            expected,
            student.points,
            robust,
            student.line,
        ):
            wrong.append((student.name, points, row["reason"], int(row["line"]), student.why))
    assert not wrong
    assert len(frame) == len(CLASS)


@pytest.mark.slow
def test_each_failed_run_has_a_report_and_each_student_feedback(marked: Path) -> None:
    page = (marked / "marks.html").read_text()
    links = [part.partition('"')[0] for part in page.split('href="')[1:]]
    assert links and all(
        (marked / link.replace("%20", " ")).is_file() for link in links if "%" not in link
    )
    assert "marks-runs/gustav-seed-0.html" in links and not any("ada" in link for link in links)
    assert len(list((marked / "feedback").iterdir())) == len(CLASS)


def _interrupt(folder: Path, home: Path) -> Path:
    """Interrupt a marking after two runs, and return its journal."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(home)}
    words = _command("--jobs", "1", "--seeds", "0,1")
    command = subprocess.Popen(
        words, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True
    )
    give_up = time.monotonic() + PATIENCE_S
    journals: list[Path] = []
    while not journals or journals[0].read_bytes().count(b"\n") < 2:
        assert time.monotonic() < give_up
        time.sleep(0.01)
        journals = list((home / "marks").glob("*.jsonl")) if home.exists() else []
    command.send_signal(signal.SIGINT)
    said = command.communicate(timeout=PATIENCE_S)[1]
    assert (command.returncode, "with --resume continues" in said) == (130, True)
    return journals[0]


@pytest.mark.slow
def test_a_resumed_marking_gives_the_bytes_of_another_one_elsewhere(tmp_path: Path) -> None:
    folder, home, elsewhere = (tmp_path / name for name in ("work", "home", "elsewhere"))
    for place in folder, elsewhere:
        write_class(place / "class", _few(*FEW, "endless.py", "thread.py", "deletes", ODD_NAME))
    journal = _interrupt(folder, home)
    done = journal.read_bytes().count(b"\n")
    assert not (folder / "marks.csv").exists()
    # A run that is known is not run again, so that its line in the journal is the only one.
    again = _mark(folder, home, "--jobs", "1", "--seeds", "0,1", "--resume")
    assert again.returncode == 0, again.stderr
    lines = [line for line in journal.read_bytes().split(b"\n") if line]
    assert 2 <= done < len(lines) == len({line[:80] for line in lines})
    whole = _mark(elsewhere, tmp_path / "another home", "--jobs", "2", "--seeds", "0,1")
    assert (whole.returncode, whole.stdout) == (0, again.stdout)
    resumed = _results(folder)
    first = _results(elsewhere)
    assert sorted(resumed) == sorted(first)
    assert [name for name in first if first[name] != resumed[name]] == []


@pytest.mark.slow
def test_a_class_is_marked_as_a_table(tmp_path: Path, here: Command) -> None:
    write_class(tmp_path / "class", _few("ada.py", "gustav.py", "raises.py", "zip.py"))
    (tmp_path / "class" / "notes.doc").write_text("")
    done = here("mark", GOALS, "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    assert (done.returncode, done.stdout.splitlines()) == (
        0,
        [
            "student  points  robustness  levels  place  heading  wall  done  reason",
            "ada      10      100%        4       3      1        1     1",
            "gustav   7       0%          4       0      1        1     1     "
            "line 5: At the end the robot was 46 mm from (1750, 500).",
            "raises   0       0%          0       0      0        0     0     "
            "ZeroDivisionError: division by zero (line 5)",
            "zip      0       0%          0       0      0        0     0     "
            "SyntaxError: Non-UTF-8 code starting with '\\xff', but no encoding declared; save it as UTF-8 (line 1)",
            "",
            "4 students, 1 seed: mean 4.25 of 10 points; 1 with all points",
        ],
    )
    # Where bubblewrap is missing, a line says so.
    notes = [line for line in done.stderr.splitlines() if not line.startswith("note: bwrap ")]
    assert notes == ["note: not marked, because they are not Python programs: notes.doc"]


def test_a_students_long_name_does_not_push_the_marks_off_the_screen(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    screen = Terminal()
    monkeypatch.setattr(sys, "stdout", screen)
    monkeypatch.setenv("COLUMNS", "80")
    mark._print(LONG_SHEET)
    heading, row, *_ = screen.getvalue().split("\n")
    assert (len(heading) <= 80, row.split()[1:]) == (True, ["0", "0%", "0", "0", "0"])


BAD = {
    "no folder": ("goals.toml", "no folder of programs is named (tuisim mark GOALS FOLDER…)"),
    "no such folder": ("goals.toml clas", "clas: there is no such file or folder"),
    "folder without programs": ("goals.toml empty", "empty: has no programs"),
    "goals without a goal": ("world.toml class", "world.toml, line 1: goal: there are no goals"),
    "no such seeds": ("goals.toml class --seeds 3..x", "--seeds: "),
    "one seed and many": (
        "goals.toml class --seed 3",
        "no such option: --seed (did you mean --seeds",
    ),
    "a speed": ("goals.toml class --speed 1", "no such option: --speed"),
    "no workers": (
        "goals.toml class --jobs 0",
        "--jobs: must be a whole number from 1 to 1000, got '0'",
    ),
    "unknown format": (
        "goals.toml class --export marks.doc",
        "cannot write marks.doc: unknown format '.doc'",
    ),
    "page into no folder": ("goals.toml class --export no/marks.html", "there is no folder no"),
    "a file twice": (
        "goals.toml class --export m.csv --export ./m.csv",
        "--export: a file is named twice",
    ),
    "feedback into a file": (
        "goals.toml class --feedback goals.toml",
        "--feedback: goals.toml is not a folder",
    ),
    "unknown mat": ("goals.toml class -b Grey", "no such mat 'Grey'"),
}


@cases("words, message", BAD)
def test_bad_input_is_refused_before_anything_is_run(
    tmp_path: Path, here: Command, words: str, message: str
) -> None:
    write_class(tmp_path / "class", _few("ada.py"))
    (tmp_path / "empty").mkdir()
    (tmp_path / "goals.toml").write_bytes(GOALS.read_bytes())
    (tmp_path / "world.toml").write_text('background = "Loop"\n')
    before = sorted(tmp_path.rglob("*"))
    done = here("mark", *words.split())
    assert (done.returncode, done.stdout, message in done.stderr) == (2, "", True), done.stderr
    assert sorted(tmp_path.rglob("*")) == before


def test_a_wrong_file_of_a_student_is_named_without_the_path_of_the_class(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class" / "ada").mkdir(parents=True)
    (tmp_path / "class" / "ada" / "main.py").write_text("# %%sim_magic -r robot.toml\n")
    (tmp_path / "class" / "ada" / "robot.toml").write_text("base = 1\n")
    (tmp_path / "goals.toml").write_text("[[goal]]\nname = 'done'\nfinish = true\n")
    done = here("mark", "goals.toml", tmp_path / "class", "--seeds", "0")
    assert ("  robot.toml: base: " in done.stdout, str(tmp_path) in done.stdout) == (True, False), (
        done.stdout
    )


UNREADABLE = {
    "latin-1": "print('grün')\n".encode("latin-1"),
    "null": b"print('green')\n\0",
    "tabs": b"if True:\n\tpass\n        pass\n",
}
STILL_GOALS = """
background = "Empty_Map"
[[goal]]
name = "still"
touch_nothing = true
[[goal]]
name = "said"
print = "green"
"""


@pytest.mark.slow
def test_a_program_that_cannot_be_read_gets_what_a_syntax_error_gets(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class").mkdir()
    for name, content in {**UNREADABLE, "syntax": b"print('green'\n"}.items():
        (tmp_path / "class" / f"{name}.py").write_bytes(content)
    (tmp_path / "goals.toml").write_text(STILL_GOALS)
    done = here(
        "mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--export", "marks.csv"
    )
    frame = pd.read_csv(tmp_path / "marks.csv").set_index("student")
    assert (done.returncode, set(frame["points"])) == (0, {0.0}), done.stdout
    assert all(reason.startswith(("SyntaxError: ", "TabError: ")) for reason in frame["reason"]), (
        done.stdout
    )


def test_the_world_of_the_goals_replaces_that_of_a_magic_line(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class").mkdir()
    cheat = "# %%sim_magic_preloaded -b Empty_Map -x 1750 -y 500\n"
    (tmp_path / "class" / "cheat.py").write_text(cheat)
    done = here("mark", GOALS, "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    assert done.stdout.splitlines()[1].split()[:2] == ["cheat", "0"]


BOTH_LIBRARIES = {
    "dev": "from ev3dev2.motor import MoveTank\nMoveTank('outB', 'outC').on_for_seconds(50, 50, 1)\n",
    "lego": "from pybricks.ev3devices import Motor\nfrom pybricks.parameters import Port\n"
    "Motor(Port.C).run_angle(300, 90)\n",
}
FINISH = "[[goal]]\nname = 'done'\nfinish = true\n"


@pytest.mark.parametrize(
    "task, points, told",
    [
        ("background = 'Loop'\n", ["1", "1"], ""),
        (
            "profile = 'robolab'\n",
            ["1", "0"],
            "lego.py uses pybricks, and the profile robolab is for ev3dev2",
        ),
    ],
    ids=["a mat", "a profile of ev3dev2"],
)
def test_each_program_runs_by_the_rules_for_its_library(
    tmp_path: Path, here: Command, task: str, points: list[str], told: str
) -> None:
    (tmp_path / "class").mkdir()
    for name, text in BOTH_LIBRARIES.items():
        (tmp_path / "class" / f"{name}.py").write_text(text)
    (tmp_path / "goals.toml").write_text(task + FINISH)
    done = here("mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    assert [line.split()[1] for line in done.stdout.splitlines()[1:3]] == points, done.stdout
    assert told in done.stdout


def test_a_task_with_the_profile_of_another_library_than_all_programs_is_refused(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "lego.py").write_text(BOTH_LIBRARIES["lego"])
    (tmp_path / "goals.toml").write_text("profile = 'ev3'\n" + FINISH)
    done = here("mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--keep", "none")
    assert (done.returncode, done.stdout) == (2, "")
    assert "profile: lego.py uses pybricks, and the profile ev3 is for ev3dev2" in done.stderr


@pytest.mark.parametrize(
    "number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["int", "term"]
)
def test_a_signal_ends_a_marking_in_good_order(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    number: int,
    code: int,
) -> None:
    def interrupted(*_: object) -> Iterator[tuple[str, Outcome]]:
        os.kill(os.getpid(), number)
        yield "ada", Outcome(0, "finished")

    write_class(tmp_path / "class", _few("ada.py"))
    # Where the command does not handle it, the signal must not end the tests.
    monkeypatch.setattr(marking, "run_entries", interrupted)
    before = signal.signal(number, lambda *_: None)
    try:
        assert run_command(["mark", str(GOALS), str(tmp_path / "class")]) == code
    finally:
        signal.signal(number, before)
    assert "--resume continues" in capsys.readouterr().err


@pytest.mark.slow
def test_a_program_that_this_machine_cannot_read_is_missing_in_the_marks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_class(tmp_path / "class", _few("ada.py"))
    (tmp_path / "class" / "eve.py").write_text("print(1)")
    opened = Path.open

    def fails(path: Path, *how: Any, **more: Any) -> Any:
        if path.name == "eve.py":
            raise OSError(errno.EIO, os.strerror(errno.EIO))
        return opened(path, *how, **more)

    monkeypatch.setattr(Path, "open", fails)
    assert (
        run_command(["mark", str(GOALS), str(tmp_path / "class"), "--seeds", "0", "--keep", "none"])
        == 1
    )
    said = capsys.readouterr()
    assert "ada      10      100%" in said.out
    assert "the marks do not include eve: eve.py: cannot be read: Input/output error" in said.err


def test_a_mat_that_cannot_be_read_is_the_students_own_fault(tmp_path: Path, here: Command) -> None:
    (tmp_path / "goals.toml").write_text(
        'title = "Done"\n[[goal]]\nname = "finish"\nfinish = true\n'
    )
    harms: dict[str, Callable[[Path], object]] = {
        "eve": lambda mat: mat.write_bytes(b"no image"),
        "zoe": os.mkfifo,
    }
    for name, harm in harms.items():
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "main.py").write_text("# %%sim_magic -b ./mat.png\nprint(1)\n")
        harm(tmp_path / "class" / name / "mat.png")
    done = here("mark", "goals.toml", "class", "--seeds", "0", "--jobs", "1", "--no-isolate")
    assert done.returncode == 0
    assert done.stderr == (
        "note: left out, because they are not part of a hand-in: zoe/mat.png, which is not a file\n"
    )
    rows = [line.split(maxsplit=4) for line in done.stdout.splitlines()[1:3]]
    assert [row[:4] for row in rows] == [["eve", "0", "0%", "0"], ["zoe", "0", "0%", "0"]]
    assert rows[0][4].startswith("mat.png: is not a readable image")
    assert rows[1][4].startswith("mat.png: is not a regular file")


def test_a_run_that_could_not_be_started_is_missing_in_the_marks_until_it_is_resumed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    write_class(tmp_path / "class", _few("ada.py"))
    words = [
        "mark",
        str(GOALS),
        str(tmp_path / "class"),
        "--seeds",
        "0,1",
        "--jobs",
        "1",
        "--keep",
        "none",
    ]
    seeds: list[int] = []

    def started(*of_run: Any, **more: Any) -> RunHandle:
        spec = of_run[1]
        seeds.append(spec.seed)
        if seeds == [0, 1]:
            raise HostError("the program's process cannot be started: Too many open files")
        return RunHandle(*of_run, **more)

    monkeypatch.setattr(execute, "RunHandle", started)
    assert run_command(words) == 1
    said = capsys.readouterr()
    assert "ada      10      100%" in said.out
    assert (
        "this machine could not make 1 run; the marks do not include: ada with seed 1" in said.err
    )
    assert "Too many open files; the same command with --resume" in said.err

    assert run_command([*words, "--resume"]) == 0
    assert seeds == [0, 1, 1]


def test_a_careless_regular_expression_is_named_and_the_rest_is_marked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(patterns, "LIMIT_S", 0.02)
    goals = "[[goal]]\nname = 'said'\nprint = '((a|aa)+)+$'\n[[goal]]\nname = 'other'\nprint = '[a-z]'\n"
    (tmp_path / "goals.toml").write_text(f"background = 'Empty_Map'\n{goals}")
    (tmp_path / "class").mkdir()
    for name, text in {"ada": "aaa", "ben": "a" * 60 + "!"}.items():
        (tmp_path / "class" / f"{name}.py").write_text(f"print({text!r})\n")
    words = [
        "mark",
        str(tmp_path / "goals.toml"),
        str(tmp_path / "class"),
        "--seeds",
        "0",
        "--jobs",
        "1",
    ]
    assert run_command(words) == 1
    said = capsys.readouterr()
    assert "ada      2       100%        1     1" in said.out
    assert (
        "ben      ?       0%          ?     1      The regular expression '((a|aa)+)+$' takes more than"
        in said.out
    )
    assert "tuisim: “said” cannot be judged, so there are no points for ben:" in said.err


def test_a_marking_without_a_place_for_copies_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, here: Command
) -> None:
    write_class(tmp_path / "class", _few("ada.py"))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    done = here("mark", GOALS, "class", "--jobs", "1")
    assert (done.returncode, "no folder for temporary runs can be created" in done.stderr) == (
        2,
        True,
    ), done.stderr
