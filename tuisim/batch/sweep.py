"""Runs a plan on the processes of this machine, or on a Dask cluster: the rows of its runs, as they finish."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, MutableMapping
from contextlib import closing
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.batch.plan import Plan
from tuisim.batch.table import Row, row_of
from tuisim.tasks.pool import run_many
from tuisim.tasks.task import Result, Task

if TYPE_CHECKING:
    from tuisim.batch.partial import PartialTable


@dataclass(frozen=True, slots=True)
class Workers:
    """The processes that execute tasks."""

    jobs: int = 0
    """Number of local worker processes; 0 is one for each processor."""
    scheduler: str = ""
    """Address of a Dask scheduler, such as `tcp://host:8786`; empty for none."""
    dask_workers: int = 0
    """Number of workers of a Dask cluster on this machine; 0 for none."""

    def run(self, tasks: Iterable[Task]) -> Generator[Result]:
        """Execute tasks, and yield their results as they finish; see `run_many` and `run_on_cluster`."""
        if not self.scheduler and not self.dask_workers:
            return run_many(tasks, self.jobs)
        # Imported on demand: Dask need not be installed.
        from tuisim.batch.cluster import run_on_cluster

        return run_on_cluster(tasks, self.scheduler, self.dask_workers)


def run_plan(
    plan: Plan,
    rows: MutableMapping[int, Row],
    *,
    workers: Workers,
    partial: PartialTable | None = None,
    on_row: Callable[[Row], None] = lambda _: None,
) -> None:
    """Execute the tasks of a plan that are not done, and block until they are.

    An interrupt stops the tasks that are running and is raised; the rows of those that are done stay.

    Args:
        rows: Rows by the index of their task; those that are there are done, the others are added as they finish.
        workers: The processes that execute the tasks.
        partial: An open file that gets each row as well.
        on_row: Called with each new row.

    Raises:
        ConfigError, HostError: there is no such cluster, or it is lost.
        ExportError: the partial file cannot be written.
        LogError: the folder for the recordings cannot be created.
    """
    several = len(plan.subjects) > 1
    # What is done by now is taken out of the tasks before the first new row comes.
    tasks = plan.tasks(frozenset(rows))
    # Closed, the results stop the tasks that are running.
    with closing(workers.run(tasks)) as results:
        for result in results:
            label = plan.subject_at(result.index).label if several else ""
            row = row_of(result, label, plan.seed_at(result.index))
            rows[result.index] = row
            if partial is not None:
                partial.add(row)
            on_row(row)
