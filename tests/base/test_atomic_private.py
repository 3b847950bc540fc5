"""What is kept of a user is the user's own: nobody else can read it, whatever the umask says."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.conftest import Command
from tuisim.analysis.source import Note, find_notes_file, write_notes
from tuisim.app.editor.text_file import keep_draft
from tuisim.app.kept_breaks import StoredBreaks, keep
from tuisim.app.setup.poses import save_pose
from tuisim.engine.core.geometry import Pose


@pytest.fixture
def open_umask() -> Iterator[None]:
    """A umask that keeps nothing from anybody."""
    before = os.umask(0)
    yield
    os.umask(before)


def test_home_is_private_and_exports_are_as_the_umask_says(
    home: Path, open_umask: None, here: Command, tmp_path: Path
) -> None:
    program = tmp_path / "p.py"
    program.write_text("tank_drive.on_for_seconds(20, 30, 0.1)\nprint('a: 1')\n")
    assert here("run", "p.py", "--press", "enter@0.05", "--export", "a.csv").returncode == 0
    keep_draft(str(program), "x")
    keep(str(program), StoredBreaks())
    save_pose("here", Pose(1.0, 2.0, 3.0))
    write_notes(find_notes_file(tmp_path / "a.csv"), [Note("x", 0.0, 0.0)])
    rights = {path: stat.S_IMODE(path.stat().st_mode) for path in (home, *home.rglob("*"))}
    assert len(rights) > 12
    assert not {
        path.name: oct(mode)
        for path, mode in rights.items()
        if mode != (0o700 if path.is_dir() else 0o600)
    }
    assert stat.S_IMODE((tmp_path / "a.csv").stat().st_mode) == 0o666
