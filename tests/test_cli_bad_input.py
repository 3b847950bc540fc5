"""Bad input to the real command: one clear line, exit code 2, nothing written."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command

# Words of the command line, and what the line on stderr must say.
BAD = {
    "missing program": ("run nope.py", "nope.py: there is no such program"),
    "misspelt program": ("run porg.py", "did you mean prog.py?"),
    "page unlike any": (
        "guide linefollower",
        "`tuisim guide --search linefollower` searches them)",
    ),
    "misspelt example": (
        "run log_grey",
        "log_grey: there is no such program (did you mean log_greys?)",
    ),
    "misspelt example's file": ("run log_gery.py", "did you mean log_greys.py?"),
    "file like a command": ("log.py", "log.py: there is no such program"),
    "misspelt command": (
        "anlyse last",
        "anlyse: no such command or program (did you mean `tuisim analyse`?)",
    ),
    "misspelt command's help": ("rnu --help", "did you mean `tuisim run`?"),
    "second program missing": ("run prog.py nope.py", "nope.py: there is no such program"),
    "no program": ("run", "no program is named (tuisim run PROGRAM…)"),
    "folder of notebooks as program": (
        "run .",
        ".: is a folder of 1 notebook (tuisim run . --all runs them all)",
    ),
    "directory as program": ("run empty", "empty: is a folder without notebooks"),
    "binary as program": ("run binary.py", "is not Python text"),
    "notebook as program": ("run book.ipynb", "not a readable notebook"),
    "wrong magic": ("run magic.py", "magic.py, line 1: -x: must be a number"),
    "unknown mat": (
        "run prog.py -b Grey_band",
        "no such mat 'Grey_band' (did you mean Grey_bands?",
    ),
    "unknown robot": (
        "run prog.py -r Smal_Robot",
        "no such robot 'Smal_Robot' (did you mean Small_Robot",
    ),
    "timeout": ("run prog.py --timeout 0", "--timeout: must be a number from 0.001"),
    "press": (
        "run prog.py --press entre@1",
        "--press: 'entre' cannot be pressed (did you mean enter?)",
    ),
    "a command that is gone": ("man", "man: no such command or program (`tuisim --help` lists"),
    "a command of two groups": (
        "export last",
        "did you mean `tuisim runs export last --out FILE` or `tuisim log export last --out FILE`?",
    ),
    "another word for a command of a group": (
        "compare 1 2",
        "compare: no such command or program (did you mean `tuisim log diff 1 2`?)",
    ),
    "a log for a program": (
        "run rows.csv",
        "rows.csv: is a log, not a program (`tuisim analyse rows.csv` opens it)",
    ),
    "a log in the app": (
        "rows.csv",
        "the analyser needs a terminal (without one, use `tuisim log`)",
    ),
    "an option that is gone": (
        "doctor --clean",
        "no such option: --clean (tuisim removes the files of killed processes when it runs again)",
    ),
    "unknown option": (
        "run prog.py --zigzag",
        "no such option: --zigzag (see `tuisim run --help`)",
    ),
    "misspelt option": (
        "run prog.py --exprot x.csv",
        "no such option: --exprot (did you mean --export",
    ),
    "another word for an option": (
        "run prog.py --time-limit 3",
        "no such option: --time-limit (did you mean --timeout?)",
    ),
    "another word for a file": (
        "runs picture last --save a.png",
        "no such option: --save (did you mean --out?)",
    ),
    "misspelt shared option": (
        "prog.py --backgroud Loop",
        "no such option: --backgroud (did you mean --background",
    ),
    "misspelt option of an action": (
        "runs show 1 --jsno",
        "no such option: --jsno (did you mean --json?)",
    ),
    "option of another action": (
        "runs show 1 --telemetry t.csv",
        "no such option: --telemetry (see `tuisim runs show",
    ),
    "option without its value": ("prog.py -b -O", "option '-b' requires an argument"),
    "export without a format": ("run prog.py --export rows", ".csv"),
    "export into no folder": ("run prog.py --export no/rows.csv", "no/rows.csv"),
    "export onto a folder": ("run prog.py --export folder.csv", "folder.csv"),
    "second export wrong": ("run prog.py --export rows.csv --export rows.doc", ".csv"),
    "telemetry onto a folder": ("run prog.py --telemetry folder.csv", "folder.csv"),
    "telemetry of two": (
        "run prog.py prog.py --telemetry t.csv",
        "--telemetry: takes one program (got 2)",
    ),
    "app without a terminal": ("", "the app needs a terminal"),
    "open without a terminal": ("open prog.py", "the app needs a terminal"),
    "missing program in the app": ("nope.py", "nope.py: there is no such program"),
    "wrong switch in the app": ("-x abc", "-x: must be a number"),
    "colours": (
        "prog.py --colors 17",
        "--colors: no such value '17' (one of auto, truecolor, 256, 16, 8, none)",
    ),
    "unknown run": ("runs show 99999", "99999"),
    "which run": ("runs show", "show: no run given"),
    "compact": ("runs compact", "no such command 'compact' (recordings are plain files;"),
    "another word for a command": (
        "log stats last",
        "no such command 'stats' (did you mean `tuisim log summary`?)",
    ),
    "unknown action": ("runs shwo 1", "no such command 'shwo' (did you mean show?)"),
    "export names its files": (
        "runs export 1 a.csv",
        "export: a.csv is a file, not a run (to write this file, use --out a.csv)",
    ),
    "export needs a file": ("runs export 1", "needs a run and a file"),
    "too many words": ("backgrounds Loop", "Loop"),
    "two programs in the app": ("prog.py magic.py", "two programs: prog.py and magic.py"),
    "two worlds": ("run a.toml b.toml prog.py", "--world: two worlds: a.toml and b.toml"),
    "unknown robot to show": (
        "robots Smal_Robot",
        "no such robot 'Smal_Robot' (did you mean Small_Robot",
    ),
    "unknown obstacles to show": (
        "obstacles Posts",
        "no such obstacles 'Posts' (did you mean Square_posts",
    ),
    "unknown profile to show": ("profiles ev4", "no such profile 'ev4' (did you mean ev3?"),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "prog.py").write_text("print('Number: 1')\n")
    (tmp_path / "magic.py").write_text("# %%sim_magic -x abc\n")
    (tmp_path / "rows.csv").write_text("time,light\n0,1\n")
    (tmp_path / "binary.py").write_bytes(b"\xff\xfe\x00\x01")
    (tmp_path / "book.ipynb").write_text("{}")
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "empty").mkdir()
    return tmp_path


@cases("words, said", BAD)
def test_bad_input_is_refused_in_one_line_and_writes_nothing(
    words: str, said: str, folder: Path, home: Path, here: Command
) -> None:
    before = sorted(folder.rglob("*"))
    done = here(*words.split())
    (line,) = done.stderr.splitlines()
    assert line.startswith("tuisim: ")
    assert said in line
    assert (done.returncode, done.stdout) == (2, "")
    # No run was begun, and no file, whole or half, was written.
    assert sorted(folder.rglob("*")) == before


@pytest.mark.slow
def test_a_home_folder_that_cannot_be_used_is_refused_in_one_line(
    folder: Path, tuisim: Command
) -> None:
    (folder / "occupied").write_text("a file")
    done = tuisim("run", "prog.py", TUISIM_HOME=str(folder / "occupied"))
    (line,) = done.stderr.splitlines()
    assert line.startswith("tuisim: ")
    assert "occupied" in line
    assert (done.returncode, done.stdout) == (2, "")
