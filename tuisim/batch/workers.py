"""Who executes the tasks of a batch: the processes of this machine, or a Dask cluster."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from tuisim.batch.pool import run_many
from tuisim.batch.task import Result, Task


@dataclass(frozen=True, slots=True)
class Workers:
    """The processes that execute tasks."""

    jobs: int = 0
    """Number of local worker processes; 0 is one for each processor."""
    scheduler: str = ""
    """Address of a Dask scheduler, such as `tcp://host:8786`; empty for none."""
    dask_workers: int = 0
    """Number of workers of a Dask cluster on this machine; 0 for none."""

    def run(self, tasks: Iterable[Task]) -> Iterator[Result]:
        """Execute tasks, and yield their results as they finish; see `run_many` and `run_on_cluster`."""
        if not self.scheduler and not self.dask_workers:
            return run_many(tasks, self.jobs)
        # Imported on demand: Dask need not be installed.
        from tuisim.batch.cluster import run_on_cluster

        return run_on_cluster(tasks, self.scheduler, self.dask_workers)


LOCAL = Workers()
"""One worker process for each processor of this machine."""
