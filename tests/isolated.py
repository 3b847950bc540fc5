"""What tests of isolated programs need of the machine."""

from __future__ import annotations

from functools import cache

import pytest

from tuisim.base.errors import ConfigError
from tuisim.engine.runs.child.isolation import check_isolation


@cache
def refusal() -> str:
    """Return why this machine cannot isolate programs; empty if it can."""
    try:
        check_isolation()
    except ConfigError as error:
        return str(error)
    return ""


needs_isolation = pytest.mark.skipif(
    bool(refusal()), reason=f"programs cannot be isolated here: {refusal()}"
)
