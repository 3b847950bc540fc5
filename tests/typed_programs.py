"""Collections of programs that run as people typed them.

Each program is a folder: `main.py` with what it needs, `expect.txt`, which says in words what a brick does, and
`stdout.txt` with the lines that it prints.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tests.conftest import Command


def names_in(collection: Path) -> list[str]:
    """Return the names of all programs of a collection."""
    return sorted(path.name for path in collection.iterdir())


def run_typed(
    program: Path, here: Command, tmp_path: Path, *options: object
) -> subprocess.CompletedProcess[str]:
    """Run a copy of a program in the terminal."""
    copy = tmp_path / program.name
    shutil.copytree(program, copy)
    return here("run", copy / "main.py", "--timeout", 90, *options)


def check_typed(program: Path, done: subprocess.CompletedProcess[str], code: int) -> None:
    """Check how a program ended, and what it printed."""
    assert done.returncode == code, done.stderr
    assert done.stdout == (program / "stdout.txt").read_text(encoding="utf-8")
    assert "tuisim/" not in done.stderr
