"""Runs a plan: the rows of its runs, as they finish."""

from __future__ import annotations

from collections.abc import Callable, Generator, MutableMapping

from tuisim.batch.partial import PartialTable
from tuisim.batch.plan import Plan
from tuisim.batch.table import Row, row_of
from tuisim.batch.workers import LOCAL, Workers


def run_plan(
    plan: Plan,
    rows: MutableMapping[int, Row],
    *,
    workers: Workers = LOCAL,
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
        LogError: a recording cannot be read, or a run to be kept cannot be stored.
    """
    several = len(plan.subjects) > 1
    # What is done by now is taken out of the tasks before the first new row comes.
    results = workers.run(plan.tasks(frozenset(rows)))
    try:
        for result in results:
            label = plan.subject_at(result.index).label if several else ""
            row = row_of(result, label, plan.seed_at(result.index))
            rows[result.index] = row
            if partial is not None:
                partial.add(row)
            on_row(row)
    finally:
        # Stops the tasks that are running.
        if isinstance(results, Generator):
            results.close()
