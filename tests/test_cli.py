"""The real command, end to end: what it prints where, what it writes, and how it exits."""

from __future__ import annotations

import errno
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

import tuisim as package
from tests.cases import cases
from tests.conftest import ROOT, Command
from tests.running import PATIENCE_S
from tuisim.cli import run_command

FIVE = "for number in range(5):\n    print('Number: ' + str(number))\n"
DRIVES = """\
# %%sim_magic_preloaded -b Grey_bands
import random
import threading
import time

def steer():
    for _ in range(20):
        tank_drive.on(SpeedPercent(random.randint(10, 60)), SpeedPercent(40))
        time.sleep(0.1)

thread = threading.Thread(target=steer)
thread.start()
for _ in range(30):
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    print('Distance: ' + str(ultrasonic.distance_centimeters))
    time.sleep(0.05)
thread.join()
"""
RAISES = FIVE + "print(sensor_val)\nsensor_val = 1\n"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    file = tmp_path / "prog.py"
    file.write_text(FIVE)
    return file


def test_run_prints_to_stdout_and_the_last_state_to_stderr(program: Path, here: Command) -> None:
    done = here("run", program.name)
    assert done.returncode == 0
    assert done.stdout == "".join(f"Number: {number}\n" for number in range(5))
    (line,) = done.stderr.splitlines()
    assert line.startswith(
        "prog.py: finished · 0.000 s, tick 0 · x 100.00 mm, y 800.00 mm, heading 0.00° · 5 samples"
    )


PUSHES = """#!/usr/bin/env python3
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
from time import sleep
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on(50, 50)
sleep(2)
"""


def test_the_last_line_says_that_the_robot_stood_at_the_wall(tmp_path: Path, here: Command) -> None:
    (tmp_path / "push.py").write_text(PUSHES)
    (tmp_path / "room.toml").write_text("seed = 0\n")
    told = {}
    for words in ("--walls on", "--profile robolab", "--world room.toml -y 800 -a 0"):
        done = here("run", "push.py", "-x", "2200", *words.split())
        told[words] = done.stderr.splitlines()[-1]
    assert (
        " · stood at the wall for 1.5 s; --walls off takes the walls away · 0 samples · run "
        in told["--walls on"]
    )
    assert "stood" not in told["--profile robolab"]
    assert (
        " · stood at the wall from 0.49 s on, its wheels pushed for 1.5 s · 0 samples · run "
        in told["--world room.toml -y 800 -a 0"]
    )
    done = here("run", "push.py", "-x", "2200", "--walls", "on", "--json")
    stood = json.loads(done.stdout)["standstill"]
    assert (stood["at"], stood["times"], stood["until_s"]) == ("the wall", 1, None)


def test_the_last_line_says_that_the_robot_left_the_field(tmp_path: Path, here: Command) -> None:
    (tmp_path / "push.py").write_text(PUSHES)
    done = here("run", "push.py", "-x", "2200")
    assert (
        " · left the field, which has no walls (--walls on) · 0 samples · run "
        in done.stderr.splitlines()[-1]
    )
    assert json.loads(here("run", "push.py", "-x", "2200", "--json").stdout)["left_field"]
    near = json.loads(here("run", "push.py", "-x", "1000", "--json").stdout)
    assert not near["left_field"]


def test_the_last_line_says_that_the_robot_is_off_a_mat_whose_walls_it_passes(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "push.py").write_text(PUSHES)
    ends = [
        here("run", "push.py", "--profile", "robolab", "-x", x_mm).stderr.splitlines()[-1]
        for x_mm in ("2200", "1000")
    ]
    assert [" · off the mat · " in end for end in ends] == [True, False]


def test_program_that_raises_shows_its_own_lines_only_and_keeps_its_rows(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "prog.py").write_text(RAISES)
    done = here("run", "prog.py", "--export", "rows.csv")
    assert done.returncode == 1
    assert 'File "prog.py", line 3' in done.stderr
    assert "NameError: name 'sensor_val' is not defined" in done.stderr
    assert "tuisim/" not in done.stderr
    assert done.stderr.count("Traceback") == 1
    assert len(pd.read_csv(tmp_path / "rows.csv")) == 5


def test_a_program_named_like_a_module_that_the_library_imports_runs(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "beside.py").write_text("TIMES = 2\n")
    (tmp_path / "logging.py").write_text("from beside import TIMES\nprint(TIMES * colorLeft.rgb)\n")
    done = here("run", "logging.py")
    assert (done.returncode, done.stdout) == (0, "(255, 255, 255, 255, 255, 255)\n"), done.stderr


def test_json_is_one_object_alone_on_stdout(program: Path, here: Command) -> None:
    done = here("run", program.name, "--json", "--seed", 7, "-b", "Loop")
    facts = json.loads(done.stdout)
    wanted = {
        "program": "prog.py",
        "state": "finished",
        "seed": 7,
        "background": "Loop",
        "samples": 5,
        "exit_code": 0,
    }
    assert facts.items() >= wanted.items()
    assert "Number: 4" in done.stderr


EXITS = {
    "finished": ("pass\n", [], 0),
    "exit 0": ("import sys\nsys.exit()\n", [], 0),
    "exit 3": ("import sys\nsys.exit(3)\n", [], 1),
    "raised": ("1 / 0\n", [], 1),
    "syntax": ("x = = 1\n", [], 1),
    "process gone": ("import os\nos._exit(3)\n", [], 1),
    "time limit": ("import time\ntime.sleep(99)\n", ["--timeout", 5], 3),
    "time limit, paced": ("import time\ntime.sleep(99)\n", ["--timeout", 0.2, "--speed", 4], 3),
    "no answer": ("input('? ')\n", [], 1),
    "press": (
        "from ev3dev2.button import Button\nassert Button().wait_for_bump('enter', 1000)\n",
        ["--press", "enter@0.2-0.5", "--press", "up@0.3"],
        0,
    ),
    "answer": ("assert input('? ') == 'yes'\n", ["--input", "yes"], 0),
}


@cases("text, words, code", EXITS)
def test_each_end_of_a_run_has_its_exit_code(
    text: str, words: list[object], code: int, tmp_path: Path, here: Command
) -> None:
    (tmp_path / "prog.py").write_text(text)
    done = here("run", "prog.py", *words)
    assert done.returncode == code, done.stderr
    assert "tuisim/" not in done.stderr


def test_a_program_that_calls_input_without_answers_is_told_of_option_input(
    tmp_path: Path, here: Command
) -> None:
    (tmp_path / "prog.py").write_text("input('? ')\n")
    assert "--input TEXT" in here("run", "prog.py").stderr


def test_several_programs_run_in_turn_into_one_log_and_the_worst_exit_code_counts(
    tmp_path: Path, program: Path, here: Command
) -> None:
    (tmp_path / "bad.py").write_text(RAISES)
    done = here("run", "bad.py", program.name, "--export", "all.csv", "--export", "all.parquet")
    assert done.returncode == 1
    frame = package.read_log(tmp_path / "all.csv")
    assert frame["run"].tolist() == [1] * 5 + [2] * 5
    pd.testing.assert_frame_equal(frame, package.read_log(tmp_path / "all.parquet"))


def test_options_of_run_override_the_magic_line(tmp_path: Path, here: Command) -> None:
    (tmp_path / "prog.py").write_text(
        "%%sim_magic_preloaded -b Loop -x 700 -OHR\nprint(gyro.angle)\n"
    )
    facts = json.loads(here("run", "prog.py", "-b", "Square", "--json").stdout)
    assert (facts["background"], facts["x_mm"], facts["y_mm"], facts["heading_deg"]) == (
        "Square",
        700,
        300,
        -90,
    )


@pytest.mark.parametrize(
    "words",
    [
        [],
        pytest.param(["-N", 20, "-M", 50], marks=pytest.mark.slow),
        pytest.param(["--profile", "nbev3devsim"], marks=pytest.mark.slow),
    ],
    ids=["calm", "noise", "old"],
)
def test_the_same_run_gives_the_same_files_at_any_speed(
    words: list[object], tmp_path: Path, here: Command
) -> None:
    (tmp_path / "prog.py").write_text(DRIVES)
    speeds = {"max": "max", "again": "max", "paced": "40"}
    for name, speed in speeds.items():
        exports = ["--export", f"{name}.csv", "--telemetry", f"{name}.parquet"]
        assert here("run", "prog.py", "--speed", speed, *exports, *words).returncode == 0
    for suffix in ("csv", "csv.json", "parquet"):
        first, *others = [(tmp_path / f"{name}.{suffix}").read_bytes() for name in speeds]
        assert others == [first, first]


def test_stored_runs_are_listed_shown_exported_and_removed(
    home: Path, program: Path, tmp_path: Path, here: Command
) -> None:
    assert here("runs").stdout == f"no runs yet in {home}\n"
    here("run", program.name, program.name)
    listed = json.loads(here("runs", "list", "--json").stdout)
    assert [(run["number"], run["program"], run["end"], run["samples"]) for run in listed] == [
        (1, "prog.py", "finished", 5),
        (2, "prog.py", "finished", 5),
    ]
    assert len(here("runs").stdout.splitlines()) == 3
    shown = here("runs", "show", "last")
    assert "prog.py: finished" in shown.stdout
    assert shown.stdout.endswith("Number: 4\n")
    assert len(json.loads(here("runs", "show", "1", "--json").stdout)["output"]) == 5
    assert (
        here("runs", "export", "1", "2", "--out", "rows.jsonl", "--telemetry", "t.csv").returncode
        == 2
    )
    assert (
        "is named twice"
        in here("runs", "export", "1", "--out", "t.csv", "--telemetry", "./t.csv").stderr
    )
    assert here("runs", "export", "1", "2", "--out", "rows.jsonl").returncode == 0
    assert len(package.read_log(tmp_path / "rows.jsonl")) == 10
    assert here("runs", "export", "2", "--telemetry", "t.csv").returncode == 0
    assert here("runs", "rm", "1", listed[0]["id"]).returncode == 0
    assert [run["number"] for run in json.loads(here("runs", "--json").stdout)] == [2]


def test_help_and_version_are_printed_to_stdout(here: Command) -> None:
    done = here("--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("Usage: tuisim")
    assert here("--version").stdout == f"tuisim {package.__version__}\n"


def test_an_internal_error_of_tuisim_is_told_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(words: object) -> int:
        raise ValueError("first line\nsecond line")

    monkeypatch.setattr("tuisim.cli._dispatch", fail)
    monkeypatch.delenv("TUISIM_DEBUG", raising=False)
    assert run_command([]) == 70
    said = "tuisim: internal error: ValueError: first line second line (TUISIM_DEBUG=1 shows the traceback)\n"
    assert capsys.readouterr().err == said


def test_an_error_of_the_disk_names_the_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(words: object) -> int:
        raise OSError(errno.EIO, "Input/output error", "module.py")

    monkeypatch.setattr("tuisim.cli._dispatch", fail)
    monkeypatch.setattr("tuisim.cli._silence_stdout", lambda: None)
    assert run_command([]) == 2
    assert capsys.readouterr().err == "tuisim: module.py: Input/output error\n"


def start(folder: Path, *words: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-m", "tuisim", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    "number, code", [(signal.SIGINT, 130), (signal.SIGTERM, 143)], ids=["ctrl-C", "terminate"]
)
def test_a_signal_stops_the_run_and_exports_its_rows(
    number: signal.Signals, code: int, tmp_path: Path
) -> None:
    (tmp_path / "prog.py").write_text(FIVE + "while True:\n    pass\n")
    running = start(tmp_path, "run", "prog.py", "--speed", "1", "--export", "rows.csv")
    assert running.stdout is not None
    for _ in range(5):
        running.stdout.readline()
    running.send_signal(number)
    _, errors = running.communicate(timeout=PATIENCE_S)
    assert running.returncode == code, errors
    assert "stopped" in errors
    assert "Traceback" not in errors
    assert len(pd.read_csv(tmp_path / "rows.csv")) == 5


@pytest.mark.slow
def test_a_closed_output_pipe_stops_the_run_without_a_message(tmp_path: Path) -> None:
    (tmp_path / "prog.py").write_text(
        "number = 0\nwhile True:\n    print(number)\n    number += 1\n"
    )
    running = start(tmp_path, "run", "prog.py", "--timeout", "1000000")
    assert running.stdout is not None
    assert running.stderr is not None
    running.stdout.readline()
    running.stdout.close()
    errors = running.stderr.read()
    running.stderr.close()
    assert running.wait(timeout=PATIENCE_S) == 141
    assert "Traceback" not in errors
    assert "BrokenPipe" not in errors
