"""The process of a program: how it begins, and how it ends with its host."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.running import PATIENCE_S, Start, until
from tuisim.engine.core.tick_record import TICK_RECORD
from tuisim.engine.protocol import End, Ended, SetPose
from tuisim.engine.runs.child import process
from tuisim.engine.runs.child.events import decode_event


def test_a_run_whose_folder_cannot_be_used_says_why(tmp_path: Path) -> None:
    (commands, _), (events, event_fd), (lifeline, _), (lock, _) = pipes = [
        os.pipe() for _ in range(4)
    ]
    fds = (commands, event_fd, lifeline, lock)
    try:
        words = [
            sys.executable,
            "-m",
            "tuisim.engine.runtime",
            str(tmp_path / "gone"),
            *map(str, fds),
        ]
        done = subprocess.run(
            # In a group of its own: the child asks for a signal to its group at the end of the lifeline.
            words,
            pass_fds=fds,
            capture_output=True,
            start_new_session=True,
            timeout=PATIENCE_S,
            check=False,
        )
        os.close(event_fd)
        with open(events, "rb", closefd=False) as file:
            told = [decode_event(line) for line in file]
    finally:
        for fd in {fd for pipe in pipes for fd in pipe} - {event_fd}:
            os.close(fd)
    reason = "the run cannot start: No such file or directory"
    assert (told, done.stderr) == ([Ended(End.CRASHED, 0, 0, 1, reason)], b"")


def test_commands_sent_before_the_first_line_take_effect_at_it(
    start: Start, monkeypatch: pytest.MonkeyPatch
) -> None:
    make, written = process._open_pipe, list[int]()

    def pipe(reader: ExitStack, writer: ExitStack) -> tuple[int, int]:
        """The first pipe is that of the commands: one is in it before there is a child."""
        ends = make(reader, writer)
        if not written:
            written.append(os.write(ends[1], SetPose(1500.0, 500.0, 0.0).encode()))
        return ends

    monkeypatch.setattr(process, "_open_pipe", pipe)
    run = start("print(colorLeft.color)", live=True)
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert (ended.end, [row.text for row in run.output.read_all_rows()]) == ("finished", ["1"])


def test_a_killed_programs_process_leaves_every_printed_row(start: Start) -> None:
    run = start(
        "import time\nfor i in range(10**6):\n    print('A:', i)\n    time.sleep(0.01)", live=True
    )
    until(run, lambda: len(run.output.read_all_rows()) > 5)
    os.kill(run._process.pid, signal.SIGKILL)
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "crashed"
    assert "SIGKILL" in ended.summary
    texts = [row.text for row in run.output.read_all_rows()]
    assert texts == [f"A: {i}" for i in range(len(texts))]
    assert run.telemetry.count * TICK_RECORD.size > 0
