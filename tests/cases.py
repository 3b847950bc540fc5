"""Cases of a test, each with a name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import product

import pytest


def cases(arguments: str, table: Mapping[str, object]) -> pytest.MarkDecorator:
    """Run a test for each row of a table: its key names the case, its value has the arguments."""
    return pytest.mark.parametrize(arguments, table.values(), ids=table)


def for_each(**values: Iterable[object]) -> Callable[[Callable[..., None]], Callable[[], None]]:
    """Run a test of a rule for all values, in each combination, as one test: many cases cost more than what they run.

    A failure names its values.
    """

    def as_one(test: Callable[..., None]) -> Callable[[], None]:
        rows = [dict(zip(values, row, strict=True)) for row in product(*values.values())]

        def run() -> None:
            for row in rows:
                try:
                    test(**row)
                except Exception as error:  # whatever it is, it is raised again
                    error.add_note(f"for {row}")
                    raise

        run.__name__ = test.__name__
        run.__doc__ = test.__doc__
        run.__module__ = test.__module__
        run.__qualname__ = test.__qualname__
        return run

    return as_one
