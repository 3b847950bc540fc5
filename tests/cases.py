"""Cases of a test, each with a name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from inspect import signature
from itertools import product
from typing import Any

import pytest


def cases(arguments: str, table: Mapping[str, object]) -> pytest.MarkDecorator:
    """Run a test for each row of a table: its key names the case, its value has the arguments."""
    return pytest.mark.parametrize(arguments, table.values(), ids=table)


def for_each(**values: Iterable[object]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run a test of a rule for all values, in each combination, as one test: many cases cost more than what they run.

    A failure names its values.
    """
    rows = [dict(zip(values, row, strict=True)) for row in product(*values.values())]
    return _as_one([(row, row) for row in rows])


def for_rows(
    arguments: str, table: Mapping[str, Any] | Iterable[Any]
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Run a test for each row of a table, as `cases` does, or of a list, but as one test.

    The rows share its fixtures.
    """
    names = arguments.split(", ")
    named = table.items() if isinstance(table, Mapping) else ((row, row) for row in table)
    return _as_one(
        [
            (case, dict(zip(names, row if len(names) > 1 else [row], strict=True)))
            for case, row in named
        ]
    )


def _as_one(
    rows: Sequence[tuple[object, Mapping[str, object]]],
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    def as_one(test: Callable[..., None]) -> Callable[..., None]:
        @wraps(test)
        def run(**fixtures: object) -> None:
            for case, row in rows:
                try:
                    test(**row, **fixtures)
                except BaseException as error:  # whatever it is, it is raised again
                    error.add_note(f"for {case}")
                    raise

        asked = signature(test)
        fixtures = [one for name, one in asked.parameters.items() if name not in rows[0][1]]
        run.__signature__ = asked.replace(parameters=fixtures)  # type: ignore[attr-defined]
        return run

    return as_one
