"""What the text of a program says before it runs."""

from __future__ import annotations

import warnings
from functools import lru_cache


@lru_cache(16)
def fault_in(text: str) -> tuple[str, int] | None:
    """Return why a program does not compile, and the line, 0 if there is none; None if it compiles."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            # From bytes: a line may name an encoding that there is not.
            compile(text.encode("utf-8", "surrogateescape"), "program", "exec", dont_inherit=True)
    except SyntaxError as error:
        return error.msg, error.lineno or 0
    except (ValueError, RecursionError, MemoryError) as error:
        return str(error) or type(error).__name__, 0
    return None
