"""What a program is started with besides its text: arguments, a folder, and modules of its own."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pytest

from tests.app.app_help import open_lab, until
from tests.conftest import Command
from tests.running import until as until_so
from tuisim.app.app import AppSettings
from tuisim.app.branch import Branch
from tuisim.app.run_controller import RunController
from tuisim.app.setup.fields import find
from tuisim.app.setup.next_run import plan_rerun
from tuisim.base.source import Program
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.runs.handle import RunHandle
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.worlds import WorldFile, save_world

SHOWS = "# %%sim_magic\nimport sys\nprint(sys.argv)\n"


def until_line(handle: RunHandle) -> None:
    """Wait until a program has printed a second line."""
    until_so(handle, lambda: len(handle.output.read_all_rows()) > 1)


pytestmark = pytest.mark.usefixtures("home")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a program that shows its arguments, and a world for it that holds some."""
    (tmp_path / "p.py").write_text(SHOWS)
    (tmp_path / "lab.toml").write_text('program = "p.py"\narguments = ["from", "a world"]\n')
    (tmp_path / "none.toml").write_text("seed = 1\n")
    (tmp_path / "cells.ipynb").write_text("{}")
    return tmp_path


@pytest.mark.parametrize(
    "words, arguments",
    [
        ("p.py -- A B", ["A", "B"]),
        ("p.py --seed 3 -- --seed 4 -- -x", ["--seed", "4", "--", "-x"]),
        ("lab.toml", ["from", "a world"]),
        ("lab.toml -- A", ["A"]),
        ("lab.toml --", []),
    ],
)
def test_the_program_finds_its_arguments(
    folder: Path, here: Command, words: str, arguments: list[str]
) -> None:
    done = here("run", *words.split())
    (path, *found) = eval(done.stdout)
    assert (Path(path).name, found, done.returncode) == ("p.py", arguments, 0)


@pytest.mark.parametrize(
    "words, message",
    [
        ("run p.py p.py -- A", "tuisim: --: arguments go to one program (got 2)"),
        ("p.py p.py -- A", "tuisim: --: arguments go to one program (got 2)"),
        ("run -- A", "tuisim: --: arguments need a program (tuisim PROGRAM -- ARGUMENTS)"),
        ("-- A", "tuisim: --: arguments need a program (tuisim PROGRAM -- ARGUMENTS)"),
        (
            "run cells.ipynb -- A",
            "tuisim: --: cells.ipynb is a notebook; its cells take no arguments",
        ),
        ("open --run last -- A", "tuisim: --: a stored run has its own arguments (leave them out)"),
        (
            "none.toml -- A",
            "tuisim: --: none.toml has no program that the arguments could go to"
            " (tuisim PROGRAM none.toml -- ARGUMENTS)",
        ),
    ],
)
def test_arguments_without_a_single_program_are_refused(
    folder: Path, here: Command, words: str, message: str
) -> None:
    done = here(*words.split())
    assert (done.returncode, done.stderr.strip(), done.stdout) == (2, message, "")


@pytest.mark.parametrize(
    "value, message",
    [
        ('"A"', "arguments: must be a list, got 'A'"),
        ("[1]", 'arguments[1]: must be text, got 1 (in quotes, such as "5")'),
        ('["a", "b\\u0000"]', "arguments[2]: must be text without null characters"),
    ],
)
def test_arguments_in_a_world_file_that_are_no_list_of_texts_are_refused(
    folder: Path, here: Command, value: str, message: str
) -> None:
    (folder / "lab.toml").write_text(f'program = "p.py"\narguments = {value}\n')
    done = here("run", "lab.toml")
    assert (done.returncode, done.stderr.strip()) == (2, f"tuisim: lab.toml: {message}")


@pytest.mark.slow_cases("*-batch")
@pytest.mark.parametrize("command", ["run", "batch"])
@pytest.mark.parametrize("profile, is_told", [("ev3", True), ("robolab", False)])
def test_a_weight_that_the_profile_does_not_use_is_told(
    folder: Path, here: Command, command: str, profile: str, is_told: bool
) -> None:
    (folder / "robot.toml").write_text('weight = "light"\n')
    errors = here(command, "p.py", "-r", "robot.toml", "--profile", profile).stderr
    assert ("note: weight has no effect under profile ev3 (only robolab" in errors) is is_told


@pytest.mark.parametrize("x_mm, is_told", [("9999", True), ("2000", False)])
def test_a_note_says_that_the_robot_starts_outside_the_mat(
    folder: Path, here: Command, x_mm: str, is_told: bool
) -> None:
    note = "note: the robot starts outside the mat, which is 2362 × 1143 mm"
    assert (note in here("run", "p.py", "-x", x_mm).stderr) is is_told


@pytest.mark.parametrize(
    "words, message",
    [
        (
            "run p.py --profile ev",
            "--profile: no such profile 'ev' (did you mean ev3?)",
        ),
        ("run p.py -b Lop", "-b: no such mat 'Lop' (did you mean Loop?)"),
        (
            "guide bands",
            "guide: no such page 'bands' (`tuisim guide` lists the pages, `tuisim guide --search bands` searches them)",
        ),
        (
            "mark nosuch folder",
            "nosuch: no such file (a file of a world or of goals is named NAME.toml; see `tuisim guide goal-files`)",
        ),
        ("runs delete 1", "runs: no such command 'delete' (did you mean `tuisim runs rm`?)"),
        ("runs report", "runs: no such command 'report' (`tuisim log report RUN` writes it)"),
    ],
)
def test_a_hint_names_what_is_near_or_where_the_names_are(
    folder: Path, here: Command, words: str, message: str
) -> None:
    assert here(*words.split()).stderr == f"tuisim: {message}\n"


def test_a_world_is_saved_with_the_arguments(folder: Path) -> None:
    save_world(build_run_spec(Settings()), folder / "new.toml", "log_greys", ("A", "B 'C"))
    assert Settings.merge(WorldFile.load(folder / "new.toml").settings)["arguments"] == (
        "A",
        "B 'C",
    )


def test_arguments_of_a_program_are_shown_with_its_run(folder: Path, here: Command) -> None:
    assert json.loads(here("run", "p.py", "--json", "--", "A", "B C").stdout)["arguments"] == [
        "A",
        "B C",
    ]
    assert "arguments: A 'B C'" in here("runs", "show", "last").stdout.splitlines()
    assert json.loads(here("runs", "show", "last", "--json").stdout)["arguments"] == ["A", "B C"]
    here("run", "p.py", "--", "A")
    assert "program arguments" in here("log", "diff", "1", "2").stdout


# Folder and modules

USES = """
import os, sys, traceback
import helper, tools.deep
from on_path import WHO
try:
    import absent
except ImportError as error:
    print(error)
print(sys.argv[1:], helper.NAME, helper.today(), tools.deep.DEPTH, WHO)
try:
    helper.fail()
except ValueError:
    print(traceback.format_exc())
import importlib
with open(helper.__file__, 'a') as file:
    file.write('NAME = 2')
print(importlib.reload(helper).NAME)
helper.fail()
"""
HELPER = "from datetime import date\nNAME = 1\ndef today(): return date.today()\ndef fail(): raise ValueError('ä')\n"


@pytest.fixture
def stored(folder: Path, here: Command, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A run with modules beside it, in a folder and on the user's PYTHONPATH; returns their folder."""
    made = {
        "mine/uses.py": USES,
        "mine/helper.py": HELPER,
        "mine/tools/deep.py": "DEPTH = 3\n",
        "elsewhere/on_path.py": "import datetime\nWHO = datetime.datetime.now().year\n",
    }
    for name, text in made.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    monkeypatch.setenv("PYTHONPATH", "elsewhere")
    done = here("run", "mine/uses.py", "--", "A")
    assert done.stdout.splitlines()[:2] == ["No module named 'absent'", "['A'] 1 2020-01-01 3 2020"]
    assert (
        done.stderr.count("helper.py\", line 4, in fail\n    def fail(): raise ValueError('ä')")
        == 1
    )
    monkeypatch.delenv("PYTHONPATH")
    return folder


def _change(folder: Path) -> None:
    (folder / "mine/helper.py").write_text("NAME = 'other'\n" * 9)
    (folder / "mine/tools/deep.py").write_text("DEPTH = 4\n")
    (folder / "mine/absent.py").touch()


def _remove(folder: Path) -> None:
    for name in ("mine", "elsewhere"):
        shutil.rmtree(folder / name)
    # The program itself writes there.
    (folder / "mine").mkdir()


@pytest.mark.parametrize("change", [_change, _remove])
def test_a_rerun_uses_the_modules_stored_with_the_run(
    stored: Path, here: Command, change: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert callable(change)
    change(stored)
    monkeypatch.chdir(stored.parent)
    done = here("runs", "rerun", "last")
    assert (done.stdout, done.returncode) == ("bit-identical: recording, output, settings\n", 0)


def test_a_branch_has_the_arguments_and_modules_of_its_run(stored: Path) -> None:
    _change(stored)
    run = RunStore().load_run("last")
    edited = Program("uses.py", "# edited\n" + USES, path=run.program.path)
    branch = Branch(Recording(run), 0, edited, None, goes_on=False)
    runs = RunController(None, plan_rerun(run.spec), 0.0)
    runs.start_branch(branch)
    assert runs.run is not None
    with closing(runs.run) as handle:
        until_line(handle)
        assert [row.text for row in handle.output.read_all_rows()][1] == "['A'] 1 2020-01-01 3 2020"
    assert (handle.program.text[:8], handle.program.modules_from) == ("# edited", run.folder)


def test_stepping_through_a_stored_run_uses_its_stored_arguments_and_modules(stored: Path) -> None:
    run = RunStore().load_run("last")
    program = Recording(run).program
    assert (program.arguments, program.python_path) == (("A",), (str(stored / "elsewhere"),))
    assert (program.working_directory, program.modules_from) == (str(stored), run.folder)


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_on_the_brick_a_program_starts_in_its_own_folder(
    folder: Path, here: Command, profile: str
) -> None:
    (folder / "own").mkdir()
    (folder / "own/cfg.json").write_text("found")
    reads = (
        "# %%sim_magic\nimport os\nprint(os.path.exists('cfg.json'), os.path.exists(__file__))\n"
    )
    (folder / "own/reads.py").write_text(reads)
    on_brick = PROFILES[profile].starts_in_own_folder
    assert here("run", "own/reads.py", "--profile", profile).stdout == f"{on_brick} True\n"


# The app


def shows(folder: Path, *arguments: str) -> AppSettings:
    """The app with the program that shows its arguments."""
    path = str(folder / "p.py")
    settings = Settings({"arguments": arguments, "speed": 0.0})
    return AppSettings(
        build_run_spec(settings), settings, program=Program("p.py", SHOWS, path=path), speed=0.0
    )


@pytest.mark.slow
async def test_arguments_of_the_program_can_be_edited_in_the_app(folder: Path) -> None:
    async with open_lab(shows(folder, "A", "B C")) as (pilot, app):
        edit = find(app.run_controller.next_run, "arguments")
        assert edit is not None
        assert edit.read(app.run_controller.next_run) == "A 'B C'"
        assert app.loader.try_change(lambda plan: edit.write(plan, "X 'Y Z'"))
        await pilot.press("R")
        await until(
            pilot,
            lambda: app.run_controller.run is not None and app.run_controller.run.ended is not None,
        )
        run = RunStore().load_run("last")
        assert run.program.arguments == ("X", "Y Z")
        assert app.run_controller.timeline.recording is not None
        assert app.run_controller.timeline.recording.program.arguments == ("X", "Y Z")
        assert not app.loader.try_change(lambda plan: edit.write(plan, "'open"))
        (folder / "q.py").write_text(SHOWS)
        app.loader.open_file(str(folder / "q.py"))
        assert app.run_controller.next_run.settings["arguments"] == ()


ASKS = "# %%sim_magic\nwhile True:\n    print(input('? '))\n"


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["pipe", "file"])
def test_lines_on_stdin_answer_input_until_they_end(
    tmp_path: Path, here: Command, kind: str
) -> None:
    (tmp_path / "asks.py").write_text(ASKS)
    (tmp_path / "answers").write_text("one\n\nthree")
    command = [sys.executable, "-m", "tuisim", "run", "asks.py"]
    with (tmp_path / "answers").open() as answers:
        given = {"stdin": answers} if kind == "file" else {"input": "one\n\nthree"}
        done = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, check=False, **given
        )
    assert (done.returncode, done.stdout) == (1, "one\n\nthree\n")
    assert "EOFError" in done.stderr
    assert "one" in here("runs", "rerun", "last").stdout


@pytest.mark.slow
def test_with_option_input_a_program_does_not_read_stdin(tmp_path: Path) -> None:
    (tmp_path / "asks.py").write_text(ASKS)
    command = [sys.executable, "-m", "tuisim", "run", "asks.py", "--input", "given"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, check=False, input="piped\n"
    )
    assert done.stdout == "given\n"
