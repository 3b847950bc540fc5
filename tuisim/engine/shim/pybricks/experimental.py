"""`pybricks.experimental`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def run_parallel(*functions: Callable[[], Any]) -> tuple[Any, ...]:
    """Run functions in threads of their own, wait until all are done, and return their results.

    The result of a function that an error has ended is None.
    """
    # Not earlier: its functions are patched first.
    import threading

    results: list[Any] = [None] * len(functions)

    def run(at: int) -> None:
        results[at] = functions[at]()

    threads = [
        threading.Thread(target=run, name=getattr(function, "__name__", None), args=(at,))
        for at, function in enumerate(functions)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return tuple(results)
