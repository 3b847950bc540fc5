"""How a file was read is found again as long as it is the same."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.cases import cases
from tuisim.analysis import source
from tuisim.analysis.source import LogRequest, find_choices
from tuisim.app.analyser.screen import read_doubtful
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.settings.preferences import find_preferences_file, keep

CHOICES = ReadChoices(time="boot", unit="ms", header=1, separator="semicolon", decimal=",")


@pytest.fixture
def file(tmp_path: Path, home: Path) -> Path:
    path = tmp_path / "log.csv"
    path.write_text("boot;light\n" + "".join(f"{20 * n};{n % 5}\n" for n in range(9)))
    return path


def test_choices_for_a_log_file_are_stored_in_the_home_and_found_by_any_path(
    file: Path, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert find_choices(str(file)) is None
    LogRequest(str(file)).remember(CHOICES)
    monkeypatch.chdir(file.parent)
    assert find_choices("log.csv") == find_choices(str(file)) == CHOICES
    assert sorted(file.parent.iterdir()) == [home, file]
    LogRequest("log.csv").remember(NO_CHOICES)
    assert find_choices(str(file)) == NO_CHOICES


def test_choices_for_a_log_file_are_forgotten_once_the_file_changes(file: Path) -> None:
    LogRequest(str(file)).remember(CHOICES)
    status = file.stat()
    os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns + 1))
    assert find_choices(str(file)) is None
    LogRequest(str(file)).remember(CHOICES)
    with file.open("a") as handle:
        handle.write("180;4\n")
    os.utime(file, ns=(status.st_atime_ns, status.st_mtime_ns + 1))
    assert find_choices(str(file)) is None
    file.unlink()
    LogRequest(str(file)).remember(CHOICES)
    assert find_choices(str(file)) is None


def test_choices_for_the_oldest_log_files_are_forgotten_first(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(source, "MAX_FILES", 2)
    files = [str(file.rename(tmp_path / "0"))] + [str(tmp_path / str(n)) for n in (1, 2)]
    for name in files:
        Path(name).write_text("a\n1\n")
        LogRequest(name).remember(CHOICES)
    assert [find_choices(name) for name in files] == [None, CHOICES, CHOICES]


@cases(
    "text",
    {
        "no JSON": "{",
        "another thing": '{"logs": 5}',
        "entries that are none": '{"logs": [5, {}, {"path": 5}]}',
        "a choice that is none": '{"logs": [{"path": "FILE", "size_bytes": SIZE, "mtime_ns": DATE,'
        ' "choices": {"separator": "x"}}]}',
        "a choice of another type": '{"logs": [{"path": "FILE", "size_bytes": SIZE, "mtime_ns": DATE,'
        ' "choices": {"header": "x"}}]}',
    },
)
def test_a_damaged_file_of_remembered_choices_raises_no_error(text: str, file: Path) -> None:
    keep("logs", [])
    status = file.stat()
    text = text.replace("FILE", str(file)).replace("SIZE", str(status.st_size))
    find_preferences_file().write_text(text.replace("DATE", str(status.st_mtime_ns)))
    assert LogRequest.restore(str(file)) == LogRequest(str(file))
    LogRequest(str(file)).remember(CHOICES)
    assert find_choices(str(file)) == CHOICES


def test_remembered_choices_apply_when_none_are_given_and_a_note_says_so(file: Path) -> None:
    LogRequest(str(file)).remember(CHOICES)
    *_, opened = LogRequest.restore(str(file)).open_pieces()
    assert opened.log.series("light").time_s[-1] == pytest.approx(0.16)
    options = "--time boot --unit ms --header 1 --separator semicolon --decimal ,"
    assert opened.log.notes[0].startswith(f"read as chosen in the analyser: {options} (")
    *_, opened = LogRequest.restore(str(file), ReadChoices(time="")).open_pieces()
    assert opened.log.series("light").time_s[-1] == 8
    assert opened.log.notes == ()


@cases(
    "name, text, is_shown",
    {
        "a time by name": ("log.csv", "t_ms,light\n0,1\n20,2\n", False),
        "lines of a program": ("log.txt", "Begin\nColour: 3\nColour: 4\nEnd\n", False),
        "names of variables": ("log.csv", "time,variable,value\n0,A,1\n1,A,2\n", False),
        "no column is surely the time": ("log.csv", "boot,light\n0,1\n20,2\n", True),
        "a line above": ("log.csv", "Lab 3\ntime,light\n0,1\n20,2\n", True),
        "commas in numbers": ("log.csv", 'time,light\n0,"1,000"\n20,"2,000"\n', True),
    },
)
def test_a_file_read_by_guesses_is_shown_first_until_choices_are_kept(
    name: str, text: str, is_shown: bool, tmp_path: Path, home: Path
) -> None:
    file = tmp_path / name
    file.write_text(text)
    assert (read_doubtful(LogRequest(str(file))) is not None) is is_shown
    assert read_doubtful(LogRequest(str(file), choices=ReadChoices(time=""))) is None
    LogRequest(str(file)).remember(NO_CHOICES)
    assert read_doubtful(LogRequest.restore(str(file))) is None


def test_how_to_read_stored_runs_and_pipes_is_not_asked() -> None:
    assert read_doubtful(LogRequest(runs=("last",))) is read_doubtful(LogRequest("-")) is None
