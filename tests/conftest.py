"""What all tests share: a home of their own, so that no test reads or writes the user's runs."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tuisim.cli import run_command

ROOT = Path(__file__).resolve().parent.parent


Command = Callable[..., "subprocess.CompletedProcess[str]"]
"""`tuisim(*words)`: runs the real command in an own folder; `environment` adds variables."""


@pytest.fixture(scope="session", autouse=True)
def _own_home(tmp_path_factory: pytest.TempPathFactory) -> object:
    """One home for the whole session, because preparing a mat for each test would be slow."""
    patch = pytest.MonkeyPatch()
    patch.setenv("TUISIM_HOME", str(tmp_path_factory.mktemp("home")))
    patch.delenv("TUISIM_ASSETS", raising=False)
    yield
    patch.undo()


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty home for tests that look at what is stored."""
    folder = tmp_path / "home"
    monkeypatch.setenv("TUISIM_HOME", str(folder))
    return folder


@pytest.fixture(scope="session")
def root() -> Path:
    """The folder that holds the package, the mats and the programs."""
    return ROOT


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Command:
    """As `tuisim`, but in this process, which saves the start of another one where that is not what is tested."""
    monkeypatch.chdir(tmp_path)

    def run(*words: object) -> subprocess.CompletedProcess[str]:
        try:
            code = run_command([str(word) for word in words])
        except SystemExit as left:
            # Help and version end the process that they are asked in.
            code = int(left.code or 0)
        said = capsys.readouterr()
        return subprocess.CompletedProcess([], code, said.out, said.err)

    return run


@pytest.fixture
def tuisim(tmp_path: Path) -> Command:
    """The real `tuisim` command, run in `tmp_path` with nothing on its stdin."""

    def run(*words: object, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "tuisim", *map(str, words)],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": str(ROOT), **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=120,
            check=False,
        )

    return run
