"""`pybricks.tools`: a stopwatch, and a log whose rows are samples of the run, too."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.engine.shim.pybricks.lab import Lab
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.runs.records import Stream
from tuisim.engine.shim.pybricks.tools import DataLog, StopWatch, wait


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Lab:
    monkeypatch.chdir(tmp_path)
    return Lab(MotorLaw.PYBRICKS, {})


def test_wait_lets_whole_milliseconds_pass(lab: Lab) -> None:
    wait(12.9)
    wait(0)
    wait(-5)
    assert lab.now == 12_000_000
    with pytest.raises(TypeError):
        wait("1")  # type: ignore[arg-type]


def test_a_stopwatch_counts_while_it_runs(lab: Lab) -> None:
    watch = StopWatch()
    wait(100)
    watch.pause()
    wait(50)
    assert watch.time() == 100
    watch.resume()
    wait(7)
    assert watch.time() == 107
    watch.reset()
    wait(3)
    assert watch.time() == 3
    watch.pause()
    watch.reset()
    wait(9)
    assert watch.time() == 0


def test_a_datalog_writes_a_file_and_records_samples(lab: Lab, tmp_path: Path) -> None:
    log = DataLog("time", "light in %", name="run", timestamp=False)
    log.log(1, 50)
    log.log(2, "none", 7.5)
    assert (
        (tmp_path / "run.csv").read_text() == repr(log) == "time, light in %\n1, 50\n2, none, 7.5\n"
    )
    log.file.close()
    assert lab.shown == [("light_in: 50", Stream.DATA), ("value3: 7.5", Stream.DATA)]


def test_an_appended_log_has_one_header(lab: Lab, tmp_path: Path) -> None:
    for at in range(2):
        log = DataLog("a", name="run", timestamp=False, append=True)
        log.log(at)
        log.file.close()
    assert (tmp_path / "run.csv").read_text() == "a\n0\n1\n"


def test_a_datalog_without_a_name_is_named_after_the_time(lab: Lab, tmp_path: Path) -> None:
    DataLog(extension="txt").file.close()
    (file,) = tmp_path.iterdir()
    date, clock = file.stem.removeprefix("log_").rsplit("_", 1)
    assert (len(date.split("_")), len(clock), file.suffix) == (6, 6, ".txt")
