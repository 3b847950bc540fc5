"""A stand-in for the process pool: results computed from the task alone, for tests of what is made of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from tuisim.tasks.task import Result, Task, VariableStatistics

SEED_THAT_FAILS = 13


def result_of(task: Task, **changed: Any) -> Result:
    """Return a result whose pose depends on seed and noise; the seed 13 raises."""
    noise = task.spec.world.noise.motor
    seed = task.spec.seed
    failed = seed == SEED_THAT_FAILS
    found: dict[str, Any] = {
        "index": task.index,
        "parameters": task.parameters,
        "end": "raised" if failed else "finished",
        "exit_code": int(failed),
        "summary": "ValueError: 13" if failed else "",
        "error": "",
        "error_line": 3 if failed else 0,
        "ticks": 100 + seed,
        "time_s": 1.0 + seed / 100,
        "x_mm": 100.0 + noise * seed,
        "y_mm": 200.0 - seed / 3,
        "heading_deg": 90.0,
    }
    if not failed:
        found["variables"] = {
            "Colour": VariableStatistics(seed + 0.1, 2, seed + 0.05, 0.05, float(seed), seed + 0.1)
        }
    return Result(**found | changed)


def run_backwards(tasks: Iterable[Task], jobs: int = 0) -> Iterator[Result]:
    """Yield the results in reverse order, as `tasks.pool.run_many` may."""
    yield from map(result_of, reversed(list(tasks)))
