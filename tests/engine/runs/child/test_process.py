"""Threads of one process start runs at the same time."""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from threading import Barrier, BrokenBarrierError
from types import SimpleNamespace
from typing import Any

import pytest

from tests.running import over
from tuisim.base.source import Program
from tuisim.engine.runs.child import process
from tuisim.engine.runs.child.warm import WarmProcess
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.side_files import STACK_FILE
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

pytestmark = pytest.mark.usefixtures("real_forks")


@pytest.mark.slow
def test_runs_of_many_threads_share_one_warm_process(monkeypatch: pytest.MonkeyPatch) -> None:
    process.end_warm_process()
    begin, started, meeting = WarmProcess.__init__, [], Barrier(2)

    def counted(self: WarmProcess, *args: Any) -> None:
        started.append(self)
        # Where two are started, they meet.
        with suppress(BrokenBarrierError):
            meeting.wait(0.2)
        begin(self, *args)

    monkeypatch.setattr(WarmProcess, "__init__", counted)

    def end(_: int) -> str:
        handle = start_run(
            Program("p.py", "print('A: 1')"), build_run_spec(Settings()), RunOptions()
        )
        over(handle)
        assert handle.ended is not None
        return handle.ended.end

    with ThreadPoolExecutor(8) as pool:
        assert set(pool.map(end, range(24))) == {"finished"}
    assert len(started) == 1


def test_the_stack_dump_of_a_stuck_program_is_read_once_it_is_complete(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, parts = tmp_path / STACK_FILE, iter(["", "File", "File a", "File a", "late"])
    clock = SimpleNamespace(monotonic=lambda: 8.0, sleep=lambda _: path.write_text(next(parts)))
    monkeypatch.setattr(process, "time", clock)
    monkeypatch.setattr(process, "measure_waited_s", lambda _: 1.0)
    process.await_stack(tmp_path, os.getpid())
    assert next(parts) == "late"
