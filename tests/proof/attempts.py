"""Runs cases of the kinds, each kind in a process of its own, and counts the faults."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from itertools import islice
from multiprocessing import get_context
from random import Random

from tests.proof.kind import fault_of, watch_over
from tests.proof.kinds import KINDS

MOST_FAULTS = 20
"""A kind ends after so many: the rest would say the same."""

FIXED_SEEDS = (2884166750, 4026029529, 2413497143)
"""Drawn once: what their first cases find comes from the change that is tested."""
FIXED_CASES = 8
FEWER = {
    "clients": 1,
    "crashes": 4,
    "enemies": 2,
    "limits": 4,
    "monkey": 1,
    "class": 8,
    "numbers": 3,
    "stateful": 4,
}
"""Of each kind and fixed seed, and of those whose cases take seconds: a minute on two cores."""


@dataclass(frozen=True, slots=True)
class Result:
    """What a kind found."""

    kind: str
    cases: int
    elapsed_s: float
    faults: tuple[str, ...]
    """The names of the cases that showed one."""


def case_names(kind: str, seed: int | None) -> Iterator[str]:
    """Yield the names of the cases of a seed, or, without one, of the same cases each time."""
    if seed is not None:
        yield from KINDS[kind].names(Random(f"{seed} {kind}"))
        return
    for fixed in FIXED_SEEDS:
        yield from islice(case_names(kind, fixed), FEWER.get(kind, FIXED_CASES))


def attempt(kind: str, seed: int | None, most_s: float) -> Result:
    """Run cases of a kind until the time is over, or there are no more; print each fault at once, and the count."""
    watch_over()
    start_s = time.monotonic()
    faults: list[str] = []
    count = 0
    for name in case_names(kind, seed):
        if (count and time.monotonic() - start_s >= most_s) or len(faults) >= MOST_FAULTS:
            break
        count += 1
        if text := fault_of(KINDS[kind], name):
            faults.append(name)
            print(f"FAULT  {kind} --case {name}\n{text}", flush=True)
    if not count:
        faults.append("none")
        print(f"FAULT  {kind}: it has no case", flush=True)
    elapsed_s = time.monotonic() - start_s
    # The table comes when all are done.
    print(
        f"{kind}: {count} cases in {elapsed_s:.0f} s, {len(faults)} faults",
        file=sys.stderr,
        flush=True,
    )
    return Result(kind, count, elapsed_s, tuple(faults))


def _attempt_apart(kind: str, seed: int | None, most_s: float) -> Result:
    """Run cases in a process of its own: what a case leaves behind does not concern the other kinds."""
    start_s = time.monotonic()
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        try:
            return pool.submit(attempt, kind, seed, most_s).result()
        except BrokenProcessPool:
            print(f"FAULT  {kind}: its process died", flush=True)
            return Result(kind, 0, time.monotonic() - start_s, ("process",))


def attempts(kinds: Sequence[str], seed: int | None, minutes: float, jobs: int) -> Iterator[Result]:
    """Share the time over all kinds; yield the results in the order of the kinds."""
    share_s = minutes * 60 * min(jobs, len(kinds)) / len(kinds)
    with ThreadPoolExecutor(jobs) as pool:
        yield from pool.map(lambda kind: _attempt_apart(kind, seed, share_s), kinds)
