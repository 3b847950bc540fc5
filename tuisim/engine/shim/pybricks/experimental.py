"""`pybricks.experimental`: running functions at the same time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any


def run_parallel(*functions: Callable[[], Any]) -> dict[Callable[[], Any], Any]:
    """Run functions in separate threads, wait until all have ended, and return their results by function.

    Raises:
        TypeError: there are fewer than two functions, or an argument is not a function.
        RuntimeError: an error has ended one of them; the others go on until the program ends.
    """
    # Imported here because the functions of the module must be patched before.
    import threading

    if len(functions) < 2 or not all(map(callable, functions)):
        raise TypeError("run_parallel() needs two or more functions")
    results: dict[Callable[[], Any], Any] = {}
    errors: list[BaseException] = []
    is_over = threading.Semaphore(0)

    def run(function: Callable[[], Any]) -> None:
        try:
            results[function] = function()
        except Exception as error:  # whatever it is, it ends the wait for all functions
            errors.append(error)
            raise
        finally:
            is_over.release()

    for function in functions:
        name = getattr(function, "__name__", None)
        threading.Thread(target=run, name=name, args=(function,)).start()
    for _ in functions:
        is_over.acquire()
        if errors:
            raise RuntimeError(f"run_parallel: {errors[0]!r}", results)
    return results
