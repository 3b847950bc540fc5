"""Tasks on a Dask cluster, with a scheduler that runs already or one on this machine.

Needs the extra `cluster`. Workers must have the same version of tuisim; programs with modules of their own must lie in
a folder that every worker sees under the same path.
"""

from __future__ import annotations

import logging
import queue
import re
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import suppress
from importlib import import_module
from itertools import islice
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

from tuisim.base.errors import ConfigError, HostError, TuisimError, counted
from tuisim.engine.runs.child.process import start_warm_process
from tuisim.engine.runs.temporary import create_batch_folder
from tuisim.tasks.execute import execute
from tuisim.tasks.task import Result, Task

if TYPE_CHECKING:
    from pathlib import Path

_Found = TypeVar("_Found")

PATIENCE_S = 4.0
"""How long scheduler and workers may take for an answer, and how long a cluster may be without a worker."""
_VERSION = "__import__('tuisim').__version__"
"""An expression for tuisim's version, which a worker evaluates that may not have tuisim."""
_GOES_ON = "with --out, --resume continues with the rows so far"


def call_within_s(seconds: float, call: Callable[..., _Found], *args: Any, **named: Any) -> _Found:
    """Call a function in a thread, wait for its result for at most some seconds, and return the result.

    Args:
        seconds: The longest time to wait.
        call: The function.
        *args, **named: Its arguments.

    Raises:
        TimeoutError: the call takes longer than `seconds`; it goes on in its thread.
    """
    answers: queue.SimpleQueue[tuple[_Found | None, BaseException | None]] = queue.SimpleQueue()

    def work() -> None:
        try:
            answers.put((call(*args, **named), None))
        except BaseException as error:  # The waiting thread raises it again.
            answers.put((None, error))

    threading.Thread(target=work, daemon=True).start()
    try:
        result, error = answers.get(timeout=seconds)
    except queue.Empty:
        raise TimeoutError(f"no answer within {seconds:g} s") from None
    if error is not None:
        raise error
    return result  # type: ignore[return-value]


class ClusterWatch:
    """Checks a Dask cluster from time to time: whether it has a scheduler and suitable workers.

    Args:
        client: The client of the cluster.
        name: The address of the cluster, for errors.
        clock: Returns the time in seconds.
        sleep: Waits for a number of seconds.
    """

    EVERY_S: ClassVar[float] = 1.0

    def __init__(
        self,
        client: Any,
        name: str,
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        self.name = name
        self._client = client
        self._clock = clock
        self._sleep = sleep
        # An import statement would break the order of packages, since `tuisim` imports all of them.
        self._version = import_module("tuisim").__version__
        self._known: set[str] = set()
        self._look_at = 0.0
        self._wrong_since: float | None = None

    def wait_for_workers(self) -> None:
        """Block until the cluster has a worker, and all workers have been checked.

        Raises:
            HostError: the cluster has no scheduler or gets no worker for `PATIENCE_S` seconds; or a worker has no
                tuisim, or another version.
        """
        while True:
            self.look()
            if self._known:
                return
            self._sleep(self.EVERY_S)

    def look(self) -> None:
        """Check the cluster, unless it was checked just before.

        Raises:
            HostError: the cluster has had no scheduler, no worker, or no answer from its workers for `PATIENCE_S`
                seconds; or a worker has no tuisim, or another version.
        """
        begun = self._clock()
        if begun < self._look_at:
            return
        wrong, hint = self._find_fault()
        now = self._clock()
        self._look_at = now + self.EVERY_S
        if not wrong:
            self._wrong_since = None
            return
        if self._wrong_since is None:
            self._wrong_since = begun
        if now - self._wrong_since >= PATIENCE_S:
            raise HostError(f"{self.name}: {wrong}", hint)

    def explain(self) -> None:
        """Check whether the cluster has a fault at this moment.

        Raises:
            HostError: the cluster has a fault.
        """
        wrong, hint = self._find_fault()
        if wrong:
            raise HostError(f"{self.name}: {wrong}", hint)

    def _find_fault(self) -> tuple[str, str]:
        """Return the fault of the cluster at this moment, and a hint; empty texts if it has none."""
        if self._client.status != "running":
            return "the scheduler is lost", _GOES_ON
        try:
            workers = set(call_within_s(PATIENCE_S, self._client.nthreads))
        except OSError:
            # OSError includes `TimeoutError` and all errors of connections.
            return "the scheduler does not answer", _GOES_ON
        if not workers:
            hint = f"start one with `dask worker {self.name}`" if not self._known else _GOES_ON
            return "the cluster has no worker", hint
        if new := workers - self._known:
            try:
                self._check(sorted(new))
            except OSError:
                return f"workers do not answer: {len(new)} of {len(workers)}", _GOES_ON
            self._known |= new
        return "", ""

    def _check(self, workers: list[str]) -> None:
        """Check that workers have the same version of tuisim.

        Raises:
            HostError: a worker has no tuisim, or another version.
        """
        run = self._client.run
        versions = call_within_s(
            PATIENCE_S, run, eval, _VERSION, workers=workers, on_error="return"
        )
        wrong = {
            worker: version for worker, version in versions.items() if version != self._version
        }
        for worker, version in sorted(wrong.items()):
            has = (
                f"tuisim {version}, not {self._version}"
                if isinstance(version, str)
                else f"no tuisim: {version}"
            )
            more = f" (and {counted(len(wrong) - 1, 'other worker')})" if len(wrong) > 1 else ""
            raise HostError(f"the worker {worker} has {has}{more}", "all need the same version")


CHUNK = 4
"""Tasks that a worker gets at once."""
AHEAD = 400
"""Chunks that the scheduler has at most: it keeps each in memory, and workers may join at any time."""
MAX_TRIES = 10
"""The number of workers that may die while executing one chunk before the batch fails."""
CONNECT_S = 5.0
_RESULT_S, _CLOSE_S = 2.0, 1.0
_ADDRESS = re.compile(r"(\w+://)?[^\s/]+:\d+")

_folders: dict[str, Path] = {}
"""Folder for recordings in this process, if it is a worker."""


def run_on_cluster(
    tasks: Iterable[Task], scheduler: str = "", workers: int = 0
) -> Generator[Result]:
    """Execute tasks on a Dask cluster, and yield their results in the order in which they arrive. Each `next` blocks.

    A result does not depend on the worker. Tasks of a worker that has died are executed on another one.

    Args:
        tasks: The tasks; the next ones are taken as workers become free. If the iterator has stopped, its `next` is
            called again after each result, as it may then have further tasks.
        scheduler: Address of a scheduler, such as `tcp://host:8786`; empty starts a cluster on this machine.
        workers: Number of worker processes of a cluster on this machine.

    Raises:
        ConfigError: Dask is not installed, or there is no scheduler at the address.
        HostError: the cluster has no worker, one of them lacks tuisim or has another version, its workers die again and
            again, or the connection has been lost for ten seconds.
    """
    if scheduler and not _ADDRESS.fullmatch(scheduler):
        hint = "its host and port, such as tcp://host:8786"
        raise ConfigError(
            f"is not an address of a scheduler: {scheduler!r}", hint, key="--scheduler"
        )
    distributed = _load_dask()
    cluster = None
    try:
        if scheduler:
            client = call_within_s(CONNECT_S + 1, _build_client, distributed, scheduler)
        else:
            cluster = distributed.LocalCluster(
                n_workers=workers,
                threads_per_worker=1,
                processes=True,
                dashboard_address=None,
                # Without this, the scheduler's web server takes a fixed port, even without a dashboard, or warns.
                scheduler_kwargs={"dashboard_address": "127.0.0.1:0"},
            )
            client = distributed.Client(cluster, set_as_default=False)
    except Exception as error:  # Any server may listen at the address and cause any error.
        raise _build_scheduler_error(scheduler, error) from None
    try:
        yield from _iterate_results(
            client, ClusterWatch(client, scheduler or "this machine"), iter(tasks)
        )
    finally:
        _close(client)
        if cluster is not None:
            cluster.close()


def _build_client(distributed: Any, scheduler: str) -> Any:
    client = object.__new__(distributed.Client)
    try:
        client.__init__(scheduler, timeout=CONNECT_S, set_as_default=False)
    # Every exception is handled here and raised again.
    except BaseException:
        # Without this, the deletion of the client would wait for the end of a connection that never began.
        client.status = "closed"
        raise
    return client


def _load_dask() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise ConfigError(
            "needs Dask", "pip install -e '.[cluster]' in the clone of tuisim", key="--scheduler"
        ) from error
    # Dask logs a lost connection with tracebacks; we report it as one error.
    for name in ("asyncio", *logging.root.manager.loggerDict):
        if name.partition(".")[0] in ("asyncio", "distributed", "tornado"):
            logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    return distributed


def _build_scheduler_error(scheduler: str, error: Exception) -> ConfigError:
    why = str(error).partition("\n")[0] or type(error).__name__
    if isinstance(error, MemoryError):
        # Dask takes the greeting of another kind of server for the size of a message.
        why = "what answers there is not a scheduler"
    if scheduler:
        return ConfigError(
            f"no scheduler answers at {scheduler}: {why}",
            "start one with `dask scheduler`",
            key="--scheduler",
        )
    return ConfigError(
        f"no cluster can be started on this machine: {why}", "--jobs needs no Dask", key="--workers"
    )


def _close(client: Any) -> None:
    with suppress(Exception):  # Errors while disconnecting from a lost scheduler do not matter.
        client.close(timeout=_CLOSE_S)


def _iterate_results(client: Any, watch: ClusterWatch, tasks: Iterator[Task]) -> Iterator[Result]:
    watch.wait_for_workers()
    done: queue.SimpleQueue[Any] = queue.SimpleQueue()
    pending = 0
    while True:
        while pending < AHEAD and (chunk := list(islice(tasks, CHUNK))):
            # With `pure=False`, Dask does not look for an equal task among those of other batches.
            future = client.submit(_execute_all, chunk, pure=False, retries=MAX_TRIES)
            future.add_done_callback(done.put)
            pending += 1
        if not pending:
            return
        watch.look()
        try:
            future = done.get(timeout=watch.EVERY_S)
        except queue.Empty:
            continue
        try:
            outcome = future.result(timeout=_RESULT_S)
        except TimeoutError:
            # The worker with the result has died, and another one computes it again.
            done.put(future)
            continue
        except TuisimError:
            raise
        except Exception as error:  # A dying worker, or wrong packages on it, can cause any error.
            # If the scheduler is lost, it has cancelled the pending tasks: `explain` then raises the loss as the
            # reason.
            watch.explain()
            why = str(error).partition("\n")[0]
            raise HostError(
                f"{watch.name}: a worker failed: {type(error).__name__}: {why}"
            ) from None
        pending -= 1
        yield from outcome


def _execute_all(tasks: list[Task]) -> list[Result]:
    if "here" not in _folders:
        start_warm_process()
        _folders["here"] = create_batch_folder()
    return [execute(task, _folders["here"]) for task in tasks]
