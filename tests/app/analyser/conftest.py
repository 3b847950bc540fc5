"""What the tests of the analyser share: a run over the grey bands."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.app.app_help import LOGS, program
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings


@pytest.fixture(scope="session")
def home_with_run(tmp_path_factory: pytest.TempPathFactory, shared_home: Path) -> Path:
    """A home in which the program has run."""
    folder = tmp_path_factory.mktemp("home")
    (folder / "cache").symlink_to(shared_home / "cache")
    spec = build_run_spec(Settings({"background": "Grey_bands"}))
    assert spec.world.noise == NoiseSpec()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TUISIM_HOME", str(folder))
        start_run(program(LOGS), spec, RunOptions(speed=0.0)).wait()
    return folder


@pytest.fixture
def run(home: Path, home_with_run: Path) -> StoredRun:
    """A run over the grey bands, in the home of the test."""
    shutil.copytree(home_with_run, home, ignore=shutil.ignore_patterns("cache"), dirs_exist_ok=True)
    store = RunStore()
    return store.load_run(store.runs()[-1].id)
