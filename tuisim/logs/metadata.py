"""What the metadata of a log tell of its runs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.tree import load_run

SCALES = "scales"
"""Key in the metadata of a run: its value lists when the program changed what it counts as a degree of a motor."""


def read_spec(metadata: Mapping[str, Any], run: int = 0) -> RunSpec | None:
    """Return the specification of a run from the metadata of a log; None if they lack it, or are damaged.

    Args:
        metadata: The metadata.
        run: Index of the run among the runs of the log, from 0.
    """
    try:
        entry = metadata["runs"][run]
        return load_run(
            {key: value for key, value in entry.items() if key not in ("run", "program", SCALES)}
        )
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, ConfigError):
        return None
