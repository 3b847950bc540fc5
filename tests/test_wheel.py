"""The wheel is whole: an installed copy finds its mats and programs, away from any checkout."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

from tests.conftest import ROOT


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the content of the wheel, as an installer would lay it out."""
    folder = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    zipfile.ZipFile(wheel).extractall(folder / "site")
    return folder / "site"


def tuisim_in(installed: Path, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-P", "-m", "tuisim", *words],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(installed)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_installed_copy_runs_its_own_programs(installed: Path, tmp_path: Path) -> None:
    listed = tuisim_in(installed, tmp_path, "programs")
    assert str(installed) in listed.stdout
    done = tuisim_in(installed, tmp_path, "run", "read_once")
    assert (done.returncode, done.stdout.splitlines()[-1]) == (0, "color_name: White"), done.stderr


def test_wheel_holds_every_mat_program_style_and_module(installed: Path) -> None:
    for folder, pattern in (
        ("backgrounds", "*.png"),
        ("backgrounds", "*.toml"),
        ("programs", "*.py"),
    ):
        wanted = {path.name for path in (ROOT / folder).glob(pattern)}
        assert wanted == {
            path.name for path in (installed / "tuisim" / "_assets" / folder).glob(pattern)
        }
    for pattern in ("*.tcss", "*.py", "*.html", "*.css", "*.js", "*.ttf", "LICENSE-*"):
        wanted = {str(path.relative_to(ROOT)) for path in (ROOT / "tuisim").rglob(pattern)}
        found = {path.relative_to(installed) for path in (installed / "tuisim").rglob(pattern)}
        assert wanted == {str(path) for path in found if "_assets" not in path.parts}
    (wheel,) = installed.parent.glob("*.whl")
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if "__pycache__" in name]
