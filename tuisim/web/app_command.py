"""The command that starts the app of a visitor."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

_BOOT = "import sys; sys.path.append(sys.argv.pop(1)); from tuisim.__main__ import main; sys.exit(main())"
"""Startup code of an app: the package comes last in the path, as in the child of a run."""
_PACKAGE_FOLDER = str(Path(__file__).parent.parent.parent)


def app_command(words: Sequence[str], first: str = "") -> list[str]:
    """Return the command, as words, of an app.

    Args:
        words: What it opens, as words of `tuisim open`.
        first: Code for its start.
    """
    return [sys.executable, "-P", "-c", first + _BOOT, _PACKAGE_FOLDER, "open", *words]
