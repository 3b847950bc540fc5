"""What a watch on a cluster tells, by a client and a clock made for the test."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import pytest

from tests.cases import cases
from tuisim import __version__
from tuisim.base.errors import HostError
from tuisim.batch import cluster
from tuisim.batch.cluster import ClusterWatch, call_within_s

NOBODY = ModuleNotFoundError("No module named 'tuisim'")


class Cluster:
    """A client of a cluster that takes each state of a list in turn, and stays in the last."""

    def __init__(self, *states: dict[str, Any] | str | Exception) -> None:
        self._states = list(states)
        self.now = 0.0
        self.asked: list[list[str]] = []

    @property
    def status(self) -> str:
        return "connecting" if self._states[0] == "lost" else "running"

    def nthreads(self) -> dict[str, int]:
        state = self._states[0]
        if isinstance(state, Exception):
            raise state
        assert isinstance(state, dict)
        return dict.fromkeys(state, 1)

    def run(
        self, _call: Callable[..., object], _text: str, workers: list[str], on_error: str
    ) -> dict[str, Any]:
        assert on_error == "return"
        self.asked.append(workers)
        state = self._states[0]
        assert isinstance(state, dict)
        return {worker: state[worker] for worker in workers}

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        if len(self._states) > 1:
            del self._states[0]

    def watch(self) -> ClusterWatch:
        return ClusterWatch(self, "tcp://lab:8786", lambda: self.now, self.sleep)


CANNOT_WORK = {
    "no worker": (
        ({},),
        "tcp://lab:8786: the cluster has no worker (start one with `dask worker tcp://lab:8786`)",
    ),
    "no worker any more": (
        ({"a": __version__}, {}),
        "tcp://lab:8786: the cluster has no worker (with --out, --resume continues with the rows so far)",
    ),
    "no tuisim": (
        ({"a": __version__, "b": NOBODY},),
        "the worker b has no tuisim: No module named 'tuisim' (all need the same version)",
    ),
    "another version": (
        ({"a": "0.9.0", "b": "0.8.0", "c": __version__},),
        f"the worker a has tuisim 0.9.0, not {__version__} (and 1 other worker) (all need the same version)",
    ),
    "a worker that joins late": (
        ({"a": __version__}, {"a": __version__, "b": "0.9.0"}),
        f"the worker b has tuisim 0.9.0, not {__version__} (all need the same version)",
    ),
    "lost": (
        ({"a": __version__}, "lost"),
        "tcp://lab:8786: the scheduler is lost (with --out, --resume continues with the rows so far)",
    ),
    "a scheduler that hangs": (
        ({"a": __version__}, TimeoutError()),
        "tcp://lab:8786: the scheduler does not answer (with --out, --resume continues with the rows so far)",
    ),
}


@cases("states, message", CANNOT_WORK)
def test_a_cluster_that_cannot_work_is_told_within_ten_seconds(
    states: tuple[Any, ...], message: str
) -> None:
    cluster = Cluster(*states)
    watch = cluster.watch()
    with pytest.raises(HostError) as told:
        watch.wait_for_workers()
        while cluster.now < 60:
            cluster.sleep(0.5)
            watch.look()
    assert (str(told.value), cluster.now < 10) == (message, True)


def test_a_late_worker_or_a_short_loss_of_connection_does_not_end_a_batch() -> None:
    cluster = Cluster({}, {}, {"a": __version__}, "lost", "lost", {"a": __version__})
    watch = cluster.watch()
    watch.wait_for_workers()
    for _ in range(20):
        cluster.sleep(1)
        watch.look()
    # A worker that is known is not asked again.
    assert cluster.asked == [["a"]]


def test_a_cluster_whose_workers_do_not_answer_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def hangs(_seconds: float, call: Callable[..., Any], *words: Any, **named: Any) -> Any:
        if words:
            raise TimeoutError
        return call()

    monkeypatch.setattr(cluster, "call_within_s", hangs)
    with pytest.raises(HostError, match="workers do not answer: 2 of 2"):
        Cluster({"a": __version__, "b": __version__}).watch().wait_for_workers()


def test_call_within_s_gives_the_result_the_error_or_a_timeout() -> None:
    over = threading.Event()
    with pytest.raises(TimeoutError, match="no answer within"):
        call_within_s(0.001, over.wait)
    over.set()
    assert call_within_s(60, divmod, 7, 2) == (3, 1)
    with pytest.raises(ZeroDivisionError):
        call_within_s(60, divmod, 7, 0)
