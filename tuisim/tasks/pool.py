"""The local process pool: workers that execute tasks side by side, each with a warm process of its own."""

from __future__ import annotations

import os
import signal
import sys
import threading
import types
from collections.abc import Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from itertools import islice
from multiprocessing import parent_process
from multiprocessing.context import SpawnContext, SpawnProcess
from pathlib import Path
from typing import Any

from tuisim.base.faults import describe_fault
from tuisim.base.folders import remove_tree
from tuisim.engine.protocol import End
from tuisim.engine.runs.child.process import start_warm_process
from tuisim.engine.runs.temporary import create_batch_folder
from tuisim.tasks.execute import build_unjudged, build_unknown_result, execute
from tuisim.tasks.task import Result, Task

CHUNK = 4
"""Number of tasks that a worker gets at once: handing over a single task costs as much as a short run."""
CHUNKS_AHEAD = 2
"""Chunks for each worker that are submitted in advance."""
MAX_TRIES = 3
"""A task whose workers have ended this often gets a result without a run."""


def count_processors() -> int:
    """Return the number of processors that this process may use."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:
        # macOS
        return os.cpu_count() or 1


def run_many(tasks: Iterable[Task], jobs: int = 0) -> Generator[Result]:
    """Execute tasks, and yield their results in the order in which they finish. Each `next` blocks.

    A result does not depend on the number of jobs. If a worker dies, its tasks are executed again. Closing the
    generator stops the running tasks.

    Args:
        tasks: The tasks; the next ones are taken as workers become free. If the iterator has stopped, its `next` is
            called again after each result, as it may then have further tasks.
        jobs: Number of workers; 0 is one for each processor. With 1, the tasks run in this process.

    Raises:
        LogError: the folder for the recordings cannot be created.
    """
    jobs = jobs or count_processors()
    folder = create_batch_folder()
    try:
        if jobs == 1:
            start_warm_process()
            yield from (execute(task, folder) for task in tasks)
            return
        pool = _Pool(jobs, folder)
        try:
            yield from pool.results(iter(tasks))
        finally:
            pool.stop()
    finally:
        remove_tree(folder)


class _Pool:
    """Worker processes; one that has died is replaced.

    Args:
        jobs: Number of workers.
        folder: For the recordings.
    """

    def __init__(self, jobs: int, folder: Path) -> None:
        self._jobs = jobs
        self._folder = folder
        self._pending: dict[Future[list[Result]], list[Task]] = {}
        self._tries: dict[int, int] = {}
        self._alone: list[Task] = []
        """Those of a chunk whose results could not be sent: one of them is to blame, and the others lose nothing."""
        self._start()

    def _start(self) -> None:
        self._context = _Context()
        self._executor = ProcessPoolExecutor(self._jobs, self._context, _prepare_worker)

    def results(self, tasks: Iterator[Task]) -> Iterator[Result]:
        """Yield the results of tasks as they finish."""
        while True:
            while len(self._pending) < self._jobs * CHUNKS_AHEAD and (
                chunk := self._take_chunk(tasks)
            ):
                self._submit(chunk)
            if not self._pending:
                return
            done, _ = wait(self._pending, return_when=FIRST_COMPLETED)
            try:
                for future in done:
                    chunk = self._pending[future]
                    results: list[Result] = []
                    if len(chunk) > 1 and _is_unsent(future):
                        self._alone += chunk
                    else:
                        results = _take_results(future, chunk)
                    del self._pending[future]
                    yield from results
            except BrokenProcessPool:
                yield from self._start_again()

    def _take_chunk(self, tasks: Iterator[Task]) -> list[Task]:
        """Return the next tasks for a worker: one task that must run alone, or else up to `CHUNK` tasks."""
        return [self._alone.pop()] if self._alone else list(islice(tasks, CHUNK))

    def _submit(self, chunk: list[Task]) -> None:
        self._pending[self._executor.submit(_execute_all, chunk, self._folder)] = chunk

    def _start_again(self) -> Iterator[Result]:
        """Replace all workers by new ones, and give them the unfinished tasks.

        Yield the results of tasks that have finished, and of tasks that have failed too often.
        """
        unfinished = [
            task
            for future, chunk in self._pending.items()
            if not _is_done(future)
            for task in chunk
        ]
        finished = [
            result for future in self._pending if _is_done(future) for result in future.result()
        ]
        self.stop()
        self._pending.clear()
        self._start()
        yield from finished
        for task in unfinished:
            self._tries[task.index] = self._tries.get(task.index, 0) + 1
            if self._tries[task.index] < MAX_TRIES:
                # Each task runs alone, since it is not known which of them has ended the worker.
                self._submit([task])
            else:
                why = f"the process that ran it has ended {MAX_TRIES} times"
                yield build_unknown_result(task, End.KILLED, why)

    def stop(self) -> None:
        """Kill the workers and the programs that they run."""
        self._executor.shutdown(wait=False, cancel_futures=True)
        for process in self._context.processes:
            process.kill()
        for process in self._context.processes:
            process.join()


def _take_results(future: Future[list[Result]], tasks: Sequence[Task]) -> list[Result]:
    try:
        return future.result()
    except BrokenProcessPool:
        raise
    except Exception as error:  # See `_is_unsent`.
        return [build_unjudged(task, describe_fault(error)) for task in tasks]


def _is_unsent(future: Future[list[Result]]) -> bool:
    """Return whether a worker could not send its results, for instance because they are too large."""
    error = future.exception()
    return isinstance(error, Exception) and not isinstance(error, BrokenProcessPool)


def _is_done(future: Future[list[Result]]) -> bool:
    return future.done() and not future.cancelled() and future.exception() is None


def _prepare_worker() -> None:
    # Ctrl+C reaches every process of the terminal; here it is ignored, and the parent ends this process.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    start_warm_process()


def _end_with_parent() -> None:
    """End this worker process once its parent has been killed.

    The process would not notice this otherwise, since other workers keep its pipe open.
    """
    parent = parent_process()
    assert parent is not None
    parent.join()
    os._exit(1)


def _execute_all(tasks: Sequence[Task], folder: Path) -> list[Result]:
    return [execute(task, folder) for task in tasks]


class _Worker(SpawnProcess):
    """A worker process that does not import the main module.

    Otherwise a script that starts a batch would start another batch in each worker.
    """

    @staticmethod
    def _Popen(process_obj: Any) -> Any:  # noqa: N802 - its name in the library
        main = sys.modules["__main__"]
        sys.modules["__main__"] = types.ModuleType("__main__")
        try:
            return SpawnProcess._Popen(process_obj)
        finally:
            sys.modules["__main__"] = main


class _Context(SpawnContext):
    """A multiprocessing context that starts `_Worker` processes, and keeps a list of them."""

    def __init__(self) -> None:
        super().__init__()
        self.processes: list[_Worker] = []

    def Process(self, *args: Any, **kwargs: Any) -> _Worker:  # type: ignore[override]  # noqa: N802
        """Return a new worker process, which is not yet started."""
        worker = _Worker(*args, **kwargs)
        self.processes.append(worker)
        return worker
