"""Batches on a Dask cluster: a scheduler and workers in processes of their own, as a department starts them."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import ROOT
from tests.running import PATIENCE_S
from tests.tasks.test_pool import LOGS, by_index, task
from tuisim.base.errors import ConfigError, HostError
from tuisim.batch.cluster import run_on_cluster
from tuisim.tasks.pool import run_many

pytestmark = pytest.mark.slow


WITHOUT_TUISIM = """
import sys
class Nothing:
    def find_spec(self, name, *_):
        if name.partition(".")[0] == "tuisim":
            raise ModuleNotFoundError("No module named 'tuisim'")
sys.meta_path.insert(0, Nothing())
"""
OF_ANOTHER_VERSION = "import tuisim; tuisim.__version__ = '0.9.0'"
_DASK = "import sys; from dask.__main__ import main; sys.argv = ['dask', *sys.argv[1:]]; main()"


class Department:
    """A scheduler and workers, each a process that talks over TCP."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        self._stack = stack
        self._folder = folder
        self._file = folder / "scheduler.json"
        words = (
            "--host",
            "127.0.0.1",
            "--port",
            "0",
            "--no-dashboard",
            "--scheduler-file",
            str(self._file),
        )
        self.scheduler = self._start("", "scheduler", *words)
        self.workers: list[subprocess.Popen[bytes]] = []

    def add(self, count: int = 1, first: str = "") -> None:
        """Start workers, which execute a text of Python first."""
        words = (
            "worker",
            "--scheduler-file",
            str(self._file),
            "--nthreads",
            "1",
            "--no-nanny",
            "--no-dashboard",
        )
        self.workers += [self._start(first, *words) for _ in range(count)]

    def _start(self, first: str, *words: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-c", f"{first}\n{_DASK}", *words]
        process = self._stack.enter_context(
            subprocess.Popen(
                command, cwd=self._folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
        )
        self._stack.callback(process.kill)
        return process

    @property
    def address(self) -> str:
        """Where the scheduler listens; blocks until all workers are there."""
        import distributed

        with distributed.Client(
            scheduler_file=str(self._file), timeout=PATIENCE_S, set_as_default=False
        ) as client:
            if self.workers:
                client.wait_for_workers(len(self.workers), timeout=PATIENCE_S)
            return str(client.scheduler.address)


@pytest.fixture
def department(tmp_path: Path) -> Iterator[Department]:
    with ExitStack() as stack:
        yield Department(tmp_path, stack)


def test_a_cluster_gives_the_same_results_as_one_process(department: Department) -> None:
    department.add(2)
    tasks = [task(LOGS, index) for index in range(20)]
    expected = by_index(list(run_many(tasks, 1)))
    assert by_index(list(run_on_cluster(tasks, department.address))) == expected


def test_a_killed_worker_of_a_cluster_loses_no_result(department: Department) -> None:
    department.add(2)
    tasks = [task(LOGS, index) for index in range(40)]
    expected = by_index(list(run_many(tasks, 1)))
    results = run_on_cluster(tasks, department.address)
    found = [next(results)]
    os.kill(department.workers[0].pid, signal.SIGKILL)
    assert by_index([*found, *results]) == expected


@pytest.fixture
def dask_here() -> Iterator[None]:
    """A machine on which Dask's usual port is in use."""
    with ExitStack() as stack:
        with suppress(OSError):
            stack.enter_context(socket.create_server(("", 8787)))
        yield


@pytest.mark.usefixtures("dask_here")
def test_a_cluster_of_local_workers_gives_the_same_results_as_one_process() -> None:
    tasks = [task(LOGS, index) for index in range(8)]
    assert by_index(list(run_on_cluster(tasks, workers=2))) == by_index(list(run_many(tasks, 1)))


UNFIT = {
    "no worker": (None, "the cluster has no worker"),
    "without tuisim": (WITHOUT_TUISIM, "has no tuisim: No module named 'tuisim'"),
    "of another version": (OF_ANOTHER_VERSION, "has tuisim 0.9.0, not "),
}


@cases("first, message", UNFIT)
def test_a_cluster_that_cannot_work_is_told_in_one_line(
    department: Department, tmp_path: Path, first: str | None, message: str
) -> None:
    if first is not None:
        department.add(1, first)
    _check_told(tmp_path, department.address, message)


def _check_told(folder: Path, address: str, message: str) -> None:
    """Check that a batch tells in one line that a cluster cannot work."""
    (folder / "p.py").write_text("print('a: 1')\n")
    command = [
        sys.executable,
        "-m",
        "tuisim",
        "batch",
        "p.py",
        "--seeds",
        "0..9",
        "--scheduler",
        address,
    ]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        command,
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (2, "", 1), done.stderr
    assert message in done.stderr


def test_an_address_where_another_server_answers_is_refused_in_one_line(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listens, ThreadPoolExecutor(1) as pool:
        greeted = pool.submit(lambda: listens.accept()[0])
        greeted.add_done_callback(lambda found: found.result().sendall(b"SSH-2.0-OpenSSH_9.6\r\n"))
        address = f"tcp://127.0.0.1:{listens.getsockname()[1]}"
        _check_told(
            tmp_path,
            address,
            f"no scheduler answers at {address}: what answers there is not a scheduler",
        )
        greeted.result().close()


def _kill_scheduler(department: Department) -> None:
    department.scheduler.kill()


def _stop_scheduler(department: Department) -> None:
    department.scheduler.send_signal(signal.SIGSTOP)


def _kill_workers(department: Department) -> None:
    for worker in department.workers:
        worker.kill()


BREAKS = {
    "scheduler killed": (_kill_scheduler, "the scheduler (is lost|does not answer)"),
    "scheduler stopped": (_stop_scheduler, "the scheduler (does not answer|is lost)"),
    "workers killed": (_kill_workers, "the cluster has no worker"),
}


@cases("break_it, message", BREAKS)
def test_a_cluster_that_breaks_in_mid_batch_ends_with_the_reason(
    department: Department, break_it: Callable[[Department], None], message: str
) -> None:
    department.add(1)
    tasks = (task(LOGS, index) for index in range(2000))
    results = run_on_cluster(tasks, department.address)
    next(results)
    break_it(department)
    with pytest.raises(HostError, match=message):
        for _ in results:
            pass


def test_an_address_without_a_scheduler_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tuisim.batch.cluster.CONNECT_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as listens:
        address = f"tcp://127.0.0.1:{listens.getsockname()[1]}"
        with pytest.raises(ConfigError, match=f"no scheduler answers at {address}"):
            next(run_on_cluster([task(LOGS)], address))


def test_an_address_without_a_scheduler_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tuisim.batch.cluster.CONNECT_S", 0.5)
    with pytest.raises(ConfigError, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        next(run_on_cluster([task(LOGS)], "tcp://127.0.0.1:9"))
