"""Searches what a run printed for the regular expressions of goals, within a limit of processor time."""

from __future__ import annotations

import time
from collections.abc import Callable

from tuisim.tasks.goals.condition import UnjudgedError

Search = Callable[[str], bool]
"""Whether an expression is found in a text.

Raises:
    UnjudgedError: that cannot be said in time.
"""

LIMIT_S = 2.0
"""Processor time for one expression and everything that a run printed."""


def build_search(pattern: str) -> Search:
    """Return a function that returns whether a regular expression matches anywhere in a text.

    Raises:
        UnjudgedError: the engine for searches with a time limit does not support the expression.
    """
    # Imported on demand: most goals have no regular expression.
    import regex

    try:
        compiled = regex.compile(pattern)
    except regex.error as error:
        raise UnjudgedError(
            f"The regular expression {pattern!r} cannot be searched for: {error}; that is a fault of the task"
        ) from None
    left_s = LIMIT_S

    def search(text: str) -> bool:
        nonlocal left_s
        begin_s = time.process_time()
        try:
            if left_s <= 0:
                raise TimeoutError
            return compiled.search(text, timeout=left_s) is not None
        except TimeoutError:
            raise UnjudgedError(
                f"The regular expression {pattern!r} takes more than {LIMIT_S:g} s of processor time for what was "
                "printed; that is a fault of the task"
            ) from None
        finally:
            left_s -= time.process_time() - begin_s

    return search
