"""Pipes, devices, folders, links and holes of 64 GB in place of each file that is read: an error, and no waiting."""

from __future__ import annotations

import os
import resource
import shutil
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.commands.test_runs_damaged import record, row
from tests.conftest import ROOT, Command
from tuisim.cli import EXIT_OUR_MISTAKE
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    OUTPUT_FILE,
    TELEMETRY_FILE,
    Stream,
    pack_header,
)
from tuisim.engine.runs.views import OutputView, TelemetryView

HUGE = 64 << 30


class StuckError(Exception):
    """A command waits for something that never comes."""


def pipe(path: Path) -> None:
    os.mkfifo(path)


def device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def sparse(path: Path) -> None:
    with path.open("wb") as stream:
        stream.truncate(HUGE)


KINDS: dict[str, Callable[[Path], None]] = {
    "a pipe": pipe,
    "a device": device,
    "a hole of 64 GB": sparse,
}

SHOWN = (
    "runs",
    "runs show 1",
    "log summary 1",
    "log report 1",
    "runs rerun 1",
    "doctor",
    "runs",
)
FILES: dict[str, tuple[str, ...]] = {
    "RUN/run.json": SHOWN,
    "RUN/telemetry.bin": SHOWN,
    "RUN/output.bin": SHOWN,
    "RUN/actions.jsonl": SHOWN,
    "RUN/stop.json": SHOWN,
    "RUN/modules.jsonl": SHOWN,
    "RUN/lock": SHOWN,
    "RUN/notes.jsonl": SHOWN,
    "home/runs.db": ("runs", "runs show 1"),
    "home/runs.lock": ("runs", "runs rm 1"),
    "home/config.toml": ("config", "runs"),
    "home/preferences.json": ("runs", "doctor", "log summary log.csv"),
    "home/lessons/progress.json": ("learn",),
    "log.csv": ("log summary log.csv", "log report log.csv"),
    "log.csv.json": ("log summary log.csv",),
    "program.py": ("run program.py",),
    "world.toml": ("run none.py --world world.toml",),
    "robot.toml": ("robots robot.toml",),
    "profile.toml": ("profiles profile.toml",),
    "obstacles.toml": ("obstacles obstacles.toml",),
    "goals.toml": ("goals check goals.toml 1",),
    "batch.toml": ("batch batch.toml",),
    "notebook.ipynb": ("run notebook.ipynb",),
    "mat.png": ("backgrounds mat.png",),
}
MAY_WAIT = {("log.csv", "a pipe")}
"""A log may come through a pipe."""


@contextmanager
def without_waiting() -> Iterator[None]:
    """Break off what waits, and what takes memory without end."""

    def stuck(*_: object) -> None:
        raise StuckError

    before = signal.signal(signal.SIGALRM, stuck)
    limit = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (8 << 30, limit[1]))
    signal.alarm(60)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)
        resource.setrlimit(resource.RLIMIT_AS, limit)


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("file", FILES)
def test_no_command_waits_for_a_pipe_or_device_in_the_place_of_a_file(
    home: Path, here: Command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str, kind: str
) -> None:
    if (file, kind) in MAY_WAIT:
        return
    monkeypatch.chdir(tmp_path)
    run = record()
    (tmp_path / "log.csv").write_text("time,red\n0.0,1\n0.1,2\n")
    shutil.copy(ROOT / "programs" / "square_goals.toml", tmp_path / "goals.toml")
    place, _, name = file.partition("/")
    path = {"RUN": run, "home": home}[place] / name if name else tmp_path / file
    path.parent.mkdir(exist_ok=True)
    path.unlink(missing_ok=True)
    KINDS[kind](path)
    with without_waiting():
        for words in FILES[file]:
            done = here(*words.split())
            assert done.returncode != EXIT_OUR_MISTAKE, f"{words}: {done.stderr}"
            assert done.stderr.count("\n") <= 3, f"{words}: {done.stderr}"


def test_commands_do_not_wait_for_a_pipe_in_the_place_of_a_run_file(
    home: Path, here: Command
) -> None:
    run = record()
    for name in ("notes.jsonl", TELEMETRY_FILE, "lock"):
        (run / name).unlink(missing_ok=True)
        pipe(run / name)
    with without_waiting():
        assert "pipe" not in here("runs", "show", "1").stderr
        assert here("log", "report", "1").returncode == 2
        assert here("doctor").returncode == 0


def test_reading_a_sparse_recording_does_not_copy_its_hole_into_memory(home: Path) -> None:
    run = record()
    row(Stream.STDOUT, b"last")(run)
    records = TelemetryView(run).count
    rows = OutputView(run).length
    for name, claimed, magic, size in (
        (TELEMETRY_FILE, (HUGE - HEADER_BYTES) // 64, b"TUISIMTL", 64),
        (OUTPUT_FILE, 200 << 20, b"TUISIMOU", 0),
    ):
        with (run / name).open("r+b") as stream:
            stream.write(pack_header(magic, size, claimed))
            stream.truncate(HUGE)
    with without_waiting():
        telemetry = TelemetryView(run)
        output = OutputView(run)
        # What is whole is read, with at most one part of the hole.
        assert records <= telemetry.count <= 1 << 17
        assert rows <= output.length <= 8 << 20
        assert "lost" in telemetry.note
        assert "lost" in output.note
