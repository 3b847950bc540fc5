"""Checks of a command's output files, before it starts."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

from tuisim.errors import ConfigError
from tuisim.logs.export import check_target


def check_targets(targets: Iterable[str | Path]) -> None:
    """Raise if a file cannot be written, or is named twice.

    Raises:
        ConfigError: two of them are the same file.
        ExportError: one cannot be written.
    """
    seen: set[str] = set()
    for target in targets:
        check_target(target)
        real = os.path.realpath(target)
        if real in seen:
            raise ConfigError(f"{real} is named twice", "give each export its own file", key="--export")
        seen.add(real)
