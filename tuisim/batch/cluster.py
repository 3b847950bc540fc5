"""Tasks on a Dask cluster, with a scheduler that runs already or one on this machine.

Needs the extra `cluster`. Workers must have the same version of tuisim; programs with modules of their own must lie in
a folder that every worker sees under the same path.
"""

from __future__ import annotations

import logging
import queue
import re
from collections.abc import Generator, Iterable, Iterator
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING, Any

from tuisim.base.errors import ConfigError, HostError, TuisimError
from tuisim.batch.cluster_watch import ClusterWatch, call_within_s
from tuisim.engine.runs.child.process import start_warm_process
from tuisim.engine.runs.temporary import create_batch_folder
from tuisim.tasks.execute import execute
from tuisim.tasks.task import Result, Task

if TYPE_CHECKING:
    from pathlib import Path

CHUNK = 4
"""Tasks that a worker gets at once."""
AHEAD = 400
"""Chunks that the scheduler has at most: it keeps each in memory, and workers may join at any time."""
MAX_TRIES = 10
"""How many workers may die of a chunk before the batch fails."""
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
        tasks: The tasks; they are consumed as they are handed over, as by `run_many`.
        scheduler: Address of a scheduler, such as `tcp://host:8786`; empty starts a cluster on this machine.
        workers: Its number of worker processes.

    Raises:
        ConfigError: Dask is not installed, or there is no scheduler at the address.
        HostError: the cluster has no worker, one of them lacks tuisim or has another version, its workers die again and
            again, or the connection is lost; ten seconds after that at the latest.
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
    except Exception as error:  # What listens at an address may be anything, and raise anything.
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
    # Every exception, since it is raised again.
    except BaseException:
        # The client would wait for the end of a connection that it never had, when it is deleted.
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
    with suppress(Exception):  # What a lost scheduler raises when it is left does not matter.
        client.close(timeout=_CLOSE_S)


def _iterate_results(client: Any, watch: ClusterWatch, tasks: Iterator[Task]) -> Iterator[Result]:
    watch.wait_for_workers()
    done: queue.SimpleQueue[Any] = queue.SimpleQueue()
    pending = 0
    while True:
        while pending < AHEAD and (chunk := list(islice(tasks, CHUNK))):
            # Not pure: Dask would look for the same task among those of other batches.
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
            # The worker that has the result died: another one makes it again.
            done.put(future)
            continue
        except TuisimError:
            raise
        except Exception as error:  # Workers die, and packages on them may be wrong, in any manner.
            # If the scheduler is lost, it has cancelled the pending tasks: then this raises that as the reason.
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
