"""Checks whether a Dask cluster can work: a batch would wait in silence for one that cannot."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any, ClassVar, TypeVar

from tuisim.base.errors import HostError, counted

_Found = TypeVar("_Found")

PATIENCE_S = 4.0
"""How long scheduler and workers may take for an answer, and how long a cluster may be without a worker."""
_VERSION = "__import__('tuisim').__version__"
"""Evaluated by a worker, which may know nothing of tuisim."""
_GOES_ON = "with --out, --resume continues with the rows so far"


def call_within_s(seconds: float, call: Callable[..., _Found], *args: Any, **named: Any) -> _Found:
    """Call a function in a thread, and return what it returns.

    Raises:
        TimeoutError: it takes longer than `seconds`; it goes on in its thread.
    """
    answers: queue.SimpleQueue[tuple[_Found | None, BaseException | None]] = queue.SimpleQueue()

    def work() -> None:
        try:
            answers.put((call(*args, **named), None))
        except BaseException as error:  # Raised again in the thread that waits.
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
    """Checks from time to time whether a cluster can work.

    Args:
        client: The client of the cluster.
        name: The address of the cluster, for errors.
        clock: Returns the time in seconds.
        sleep: Waits for some seconds.
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
        # An import statement would break the order of rooms, since `tuisim` imports all of them.
        self._version = import_module("tuisim").__version__
        self._known: set[str] = set()
        self._look_at = 0.0
        self._wrong_since: float | None = None

    def wait_for_workers(self) -> None:
        """Block until there is a worker, and all workers have been checked.

        Raises:
            HostError: as `look`.
        """
        while True:
            self.look()
            if self._known:
                return
            self._sleep(self.EVERY_S)

    def look(self) -> None:
        """Check the cluster, unless it was checked just before.

        Raises:
            HostError: it has had no scheduler or no worker for a while, or a worker has no tuisim or another version.
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
        """Raise HostError if the cluster cannot work at this moment."""
        wrong, hint = self._find_fault()
        if wrong:
            raise HostError(f"{self.name}: {wrong}", hint)

    def _find_fault(self) -> tuple[str, str]:
        """Return why the cluster cannot work at this moment, and what helps; empty texts if it can."""
        if self._client.status != "running":
            return "the scheduler is lost", _GOES_ON
        try:
            workers = set(call_within_s(PATIENCE_S, self._client.nthreads))
        except OSError:
            # `TimeoutError` and all errors of connections.
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
        """Raise HostError if a worker has no tuisim, or another version."""
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
