"""`tuisim runs`: sizes, age, links, and outputs that are too long to be read first."""

from __future__ import annotations

import json
import re
import sqlite3
import tempfile
from collections.abc import Callable, Iterator
from contextlib import closing
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.engine.runs.run_recorder import PROGRAM, begun
from tuisim.cli import run_command
from tuisim.commands import runs as runs_command
from tuisim.commands.echo import size
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.protocol import End
from tuisim.engine.runs import store as store_module
from tuisim.engine.runs.catalogue import CATALOGUE_FILE
from tuisim.engine.runs.records import TELEMETRY_FILE, OutputRow
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import READS_FILE
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.views import OutputView

Make = Callable[..., StoredRun]
"""The fixture `make`."""


@pytest.fixture
def make(home: Path) -> Make:
    """`make(*lines)`: store a finished run that printed these lines."""

    def record(*lines: str) -> StoredRun:
        recorder = begun(RunStore(), RunSpec(RobotSpec(), WorldSpec(), ROBOLAB))
        for line in lines:
            recorder.drive(100, 100, 1)
            recorder.print(line)
        return recorder.end()

    return record


def test_the_list_of_runs_shows_their_sizes(make: Make, here: Command) -> None:
    run = make("a: 1")
    assert re.search(r"\d+\.\d kB", here("runs").stdout.splitlines()[1])
    (listed,) = json.loads(here("runs", "--json").stdout)
    assert listed["bytes"] == sum(path.stat().st_size for path in run.folder.iterdir())


def test_list_names_the_end_of_a_stopped_run_once(here: Command, home: Path) -> None:
    begun(RunStore(), RunSpec(RobotSpec(), WorldSpec(), ROBOLAB)).end(End.STOPPED, "stopped")
    assert here("runs").stdout.splitlines()[1].split().count("stopped") == 1


def test_the_list_of_runs_rounds_times_down_as_the_app_does(make: Make, here: Command) -> None:
    run = make("a: 1")
    with (
        closing(sqlite3.connect(run.folder.parent.parent / CATALOGUE_FILE)) as connection,
        connection,
    ):
        connection.execute("UPDATE runs SET time_s = 48.607")
    assert "48.60" in here("runs").stdout.splitlines()[1].split()


@pytest.mark.parametrize(
    "count, shown",
    [(0, "0.0 kB"), (1234, "1.2 kB"), (29_400_000, "29.4 MB"), (5e15, "5000.0 TB")],
)
def test_sizes_of_runs_are_rounded_to_their_unit(count: int, shown: str) -> None:
    assert size(count) == shown


AGES = {
    "one": ("3w", [2, 3], "1 run removed"),
    "days": ("10d", [3], "2 runs removed"),
    "hours": ("0.5h", [], "3 runs removed"),
}


@cases("age, left, said", AGES)
def test_runs_rm_older_than_removes_runs_of_that_age(
    make: Make, here: Command, age: str, left: list[int], said: str
) -> None:
    home = make().folder.parent.parent
    make(), make()
    with closing(sqlite3.connect(home / CATALOGUE_FILE)) as connection, connection:
        for number, days in ((1, 30), (2, 14), (3, 1)):
            made = datetime.now(UTC) - timedelta(days=days)
            connection.execute(
                "UPDATE runs SET created = ? WHERE number = ?", (made.isoformat(), number)
            )
    done = here("runs", "rm", "--older-than", age)
    assert said in done.stdout
    assert [run.number for run in RunStore().runs()] == left


BAD_AGES = {
    "no age": (("rm", "--older-than", "soon"), "'soon'"),
    "no unit": (("rm", "--older-than", "30"), "12h, 30d or 8w"),
    "with a run": (("rm", "last", "--older-than", "30d"), "takes no run"),
}


@cases("words, said", BAD_AGES)
def test_runs_rm_with_a_wrong_age_removes_no_run(
    make: Make, here: Command, words: tuple[str, ...], said: str
) -> None:
    make()
    done = here("runs", *words)
    assert done.returncode == 2
    assert said in done.stderr
    assert len(RunStore().runs()) == 1


def test_runs_rm_older_than_keeps_a_run_that_is_still_running(make: Make, here: Command) -> None:
    store = RunStore()
    store.create_run(PROGRAM, make().spec)
    assert "1 run removed" in here("runs", "rm", "--older-than", "0h").stdout
    assert [run.number for run in store.runs()] == [2]


def test_runs_rm_of_a_linked_folder_removes_only_the_link(
    make: Make, here: Command, tmp_path: Path
) -> None:
    folder = make("a: 1").folder
    elsewhere = folder.rename(tmp_path / "elsewhere")
    folder.symlink_to(elsewhere)
    done = here("runs", "rm", "last")
    assert (done.returncode, done.stderr.count("\n")) == (0, 1)
    assert str(elsewhere) in done.stderr
    assert list(folder.parent.iterdir()) == []
    assert (elsewhere / "output.bin").exists()
    assert RunStore().runs() == []


@pytest.mark.parametrize("form", [(), ("--json",)], ids=["text", "json"])
def test_runs_show_prints_output_while_it_is_still_reading(
    make: Make, here: Command, monkeypatch: pytest.MonkeyPatch, form: tuple[str, ...]
) -> None:
    make("first", "second")
    whole = OutputView.rows

    def cut_short(self: OutputView) -> Iterator[OutputRow]:
        yield next(whole(self))
        raise KeyboardInterrupt

    monkeypatch.setattr(OutputView, "rows", cut_short)
    assert "first" in here("runs", "show", "last", *form).stdout


def test_samples_of_a_long_output_are_not_counted_first(
    make: Make, here: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    make("a: 1")
    assert "1 sample · run 1" in here("runs", "show", "last").stdout
    monkeypatch.setattr(runs_command, "QUICK_BYTES", 10)
    assert "sample" not in here("runs", "show", "last").stdout


def test_a_listing_counts_only_so_many_samples(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    home = [make("a: 1", "b"), make("a: 1", "a: 2")][0].folder.parent.parent
    (home / CATALOGUE_FILE).unlink()
    monkeypatch.setattr(store_module, "_COUNT_A_LISTING_BYTES", 70)
    assert [[run.samples for run in RunStore().runs()] for _ in range(2)] == [[1, None], [1, 2]]


@pytest.mark.parametrize(
    "words, said",
    [
        (["runs", "rerun", "last"], "telemetry.bin was truncated: the last"),
        (
            ["log", "summary", "last", "--telemetry"],
            "no ticks: its recording is empty or truncated",
        ),
    ],
    ids=["rerun", "log of every tick"],
)
def test_a_recording_that_lost_all_its_ticks_is_called_cut_off(
    make: Make, here: Command, words: list[str], said: str
) -> None:
    telemetry = make("a: 1").folder / TELEMETRY_FILE
    telemetry.write_bytes(telemetry.read_bytes()[:100])
    done = here(*words)
    assert (done.returncode, said in done.stderr) == (2, True), done.stderr


def test_rerun_without_a_folder_for_temporary_files_says_why(
    make: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    make("a: 1")
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "missing"))
    assert run_command(["runs", "rerun", "last"]) == 2
    reason = "no folder for temporary runs can be created: No such file or directory"
    assert capsys.readouterr().err == f"tuisim: {tmp_path}/missing: {reason}\n"


def test_a_file_that_a_run_read_is_listed_and_a_rerun_says_if_it_changed(
    here: Command, home: Path, tmp_path: Path
) -> None:
    (tmp_path / "first.py").write_text("open('cal\\x1b.txt', 'w').write('42')\n")
    (tmp_path / "second.py").write_text("open('cal\\x1b.txt').read()\n")
    file = tmp_path / "cal\x1b.txt"
    here("run", "first.py")
    here("run", "second.py")
    assert "file " not in here("runs", "show", "1").stdout
    assert (
        f"file read (2 bytes): {tmp_path}/cal\ufffd.txt"
        in here("runs", "show", "2").stdout.splitlines()
    )
    (listed,) = json.loads(here("runs", "show", "2", "--json").stdout)["files_read"]
    assert (listed["path"], listed["there"], listed["bytes"]) == (str(file), True, 2)
    assert here("runs", "rerun", "2").stderr == ""
    file.write_text("43")
    assert here("runs", "rerun", "2").stderr == (
        f"note: a file that the program opens has changed since: {tmp_path}/cal\ufffd.txt\n"
    )
    file.unlink()
    (note,) = json.loads(here("runs", "rerun", "2", "--json").stdout)["notes"]
    assert note == f"a file that the program opens is gone: {file}"


def test_a_file_that_a_run_looked_for_in_vain_is_listed(
    here: Command, home: Path, tmp_path: Path
) -> None:
    (tmp_path / "tries.py").write_text("try:\n    open('cal.txt')\nexcept OSError:\n    pass\n")
    here("run", "tries.py")
    assert (
        f"file looked for, and not there: {tmp_path}/cal.txt"
        in here("runs", "show", "1").stdout.splitlines()
    )
    (tmp_path / "cal.txt").write_text("")
    assert "was not there, and is there now" in here("runs", "rerun", "1").stderr


def test_runs_show_notes_a_damaged_list_of_read_files(make: Make, here: Command) -> None:
    run = make("a: 1")
    (run.folder / READS_FILE).write_text("3\n")
    shown = here("runs", "show", "1").stdout
    assert READS_FILE in shown
    assert "a: 1" in shown
