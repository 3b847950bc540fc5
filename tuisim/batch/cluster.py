"""Tasks on a Dask cluster, with a scheduler that runs already or one on this machine.

Needs the extra `cluster`. Workers must have the same version of tuisim; programs with modules of their own must lie in
a folder that every worker sees under the same path.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import islice
from typing import TYPE_CHECKING, Any

from tuisim.batch.execute import execute
from tuisim.batch.task import Result, Task
from tuisim.errors import ConfigError, HostError
from tuisim.runs.child.process import warm_up
from tuisim.runs.temporary import batch_folder

if TYPE_CHECKING:
    from pathlib import Path

CHUNK = 4
"""Tasks that a worker gets at once."""
AHEAD = 400
"""Chunks that the scheduler has at most: it keeps each in memory, and workers may join at any time."""
MOST_TRIES = 10
"""How many workers may die of a chunk before the batch fails."""
CONNECT_S = 10
_ADDRESS = re.compile(r"(\w+://)?[^\s/]+:\d+")

_folders: dict[str, Path] = {}
"""Folder for recordings in this process, if it is a worker."""


def run_on_cluster(tasks: Iterable[Task], scheduler: str = "", workers: int = 0) -> Iterator[Result]:
    """Execute tasks on a Dask cluster, and yield their results in the order in which they arrive. Each `next` blocks.

    A result does not depend on the worker. Tasks of a worker that has died are executed on another one.

    Args:
        tasks: The tasks; they are consumed as they are handed over.
        scheduler: Address of a scheduler, such as `tcp://host:8786`; empty starts a cluster on this machine.
        workers: Its number of worker processes.

    Raises:
        ConfigError: Dask is not installed, or there is no scheduler at the address.
        HostError: the connection to the cluster is lost, or its workers die again and again.
    """
    if scheduler and not _ADDRESS.fullmatch(scheduler):
        hint = "its host and port, such as tcp://host:8786"
        raise ConfigError(f"is no address of a scheduler: {scheduler!r}", hint, key="--scheduler")
    distributed = _dask()
    try:
        if scheduler:
            client = distributed.Client(scheduler, timeout=CONNECT_S, set_as_default=False)
        else:
            cluster = distributed.LocalCluster(
                n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None
            )
            client = distributed.Client(cluster, set_as_default=False)
    except (OSError, ValueError) as error:
        what = f"no scheduler answers at {scheduler}: {error}"
        raise ConfigError(what, "start one with `dask scheduler`", key="--scheduler") from error
    try:
        yield from _results(client, distributed.as_completed(loop=client.loop), iter(tasks))
    except (distributed.KilledWorker, distributed.CancelledError, OSError) as error:
        raise HostError(f"the cluster does not answer: {error}", scheduler) from error
    finally:
        client.close()
        if not scheduler:
            cluster.close()


def _dask() -> Any:
    try:
        import distributed
    except ImportError as error:
        raise ConfigError(
            "needs Dask", "pip install -e '.[cluster]' in the clone of tuisim", key="--scheduler"
        ) from error
    return distributed


def _results(client: Any, done: Any, tasks: Iterator[Task]) -> Iterator[Result]:
    while done.count() < AHEAD and (chunk := list(islice(tasks, CHUNK))):
        done.add(_submit(client, chunk))
    for future in done:
        found = future.result()
        if chunk := list(islice(tasks, CHUNK)):
            done.add(_submit(client, chunk))
        yield from found


def _submit(client: Any, chunk: list[Task]) -> Any:
    # Not pure: Dask would look for the same task among those of other batches.
    return client.submit(_execute_all, chunk, pure=False, retries=MOST_TRIES)


def _execute_all(tasks: list[Task]) -> list[Result]:
    if "here" not in _folders:
        warm_up()
        _folders["here"] = batch_folder()
    return [execute(task, _folders["here"]) for task in tasks]
