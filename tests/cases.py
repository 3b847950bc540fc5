"""Cases of a test, each with a name."""

from __future__ import annotations

from collections.abc import Mapping

import pytest


def cases(arguments: str, table: Mapping[str, object]) -> pytest.MarkDecorator:
    """Run a test for each row of a table: its key names the case, its value has the arguments."""
    return pytest.mark.parametrize(arguments, table.values(), ids=table)
