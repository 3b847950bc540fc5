"""Batches on a Dask cluster: a scheduler and workers in processes of their own, as a department starts them."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from tests.batch.test_pool import LOGS, by_index, task
from tests.running import PATIENCE_S
from tuisim.batch.cluster import run_on_cluster
from tuisim.batch.pool import run_many
from tuisim.errors import ConfigError

pytestmark = pytest.mark.slow


class Department:
    """A scheduler and two workers, each a process that talks over TCP."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._stack, self._folder = stack, folder
        file = folder / "scheduler.json"
        self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", str(file))
        self._file = file
        self.workers = [
            self._start("worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-nanny", "--no-dashboard")
            for _ in range(2)
        ]

    def _start(self, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "dask", *words]
        process = self._stack.enter_context(
            subprocess.Popen(command, cwd=self._folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        )
        self._stack.callback(process.kill)
        return process

    @property
    def address(self) -> str:
        """Where the scheduler listens; blocks until both workers are there."""
        import distributed

        with distributed.Client(scheduler_file=str(self._file), timeout=PATIENCE_S, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=PATIENCE_S)
            return str(client.scheduler.address)


@pytest.fixture
def department(tmp_path: Path) -> Iterator[Department]:
    with ExitStack() as stack:
        yield Department(tmp_path, stack)


def test_a_cluster_gives_the_same_bits(department: Department) -> None:
    tasks = [task(LOGS, index) for index in range(20)]
    expected = by_index(list(run_many(tasks, 1)))
    assert by_index(list(run_on_cluster(tasks, department.address))) == expected


def test_a_worker_that_is_killed_loses_nothing(department: Department) -> None:
    tasks = [task(LOGS, index) for index in range(40)]
    expected = by_index(list(run_many(tasks, 1)))
    results = run_on_cluster(tasks, department.address)
    found = [next(results)]
    os.kill(department.workers[0].pid, signal.SIGKILL)
    assert by_index([*found, *results]) == expected


def test_a_cluster_on_this_machine() -> None:
    tasks = [task(LOGS, index) for index in range(8)]
    assert by_index(list(run_on_cluster(tasks, workers=2))) == by_index(list(run_many(tasks, 1)))


def test_an_address_without_a_scheduler_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tuisim.batch.cluster.CONNECT_S", 0.5)
    with pytest.raises(ConfigError, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        next(run_on_cluster([task(LOGS)], "tcp://127.0.0.1:9"))
