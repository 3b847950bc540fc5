"""Runs in odd surroundings work, or say in one sentence why not."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.running import PATIENCE_S

SIBLINGS = {
    "its own": ("import random\nprint('A:', random.x)", 0, "A: 1\n", ""),
    "missing name": (
        "import random\nrandom.randint(1, 2)",
        1,
        "",
        "random.py beside the program shadows",
    ),
    "missing in a library": ("import tempfile", 1, "", "random.py beside the program shadows"),
    "not wanted": ("print('A: 1')", 0, "A: 1\n", ""),
}


@pytest.mark.slow_cases("missing name")
@cases("text, code, out, told", SIBLINGS)
def test_a_program_beside_a_module_named_like_one_of_pythons_is_told_so(
    here: Command, tmp_path: Path, text: str, code: int, out: str, told: str
) -> None:
    (tmp_path / "random.py").write_text("x = 1\n")
    (tmp_path / "main.py").write_text(text)
    done = here("run", "main.py", "--preload", "none")
    assert (done.returncode, done.stdout) == (code, out)
    assert told in done.stderr


@pytest.mark.slow
def test_the_command_runs_beside_modules_named_like_pythons(
    tuisim: Command, tmp_path: Path
) -> None:
    for name in ("random", "json", "select"):
        (tmp_path / f"{name}.py").write_text("x = 1\n")
    (tmp_path / "main.py").write_text("print('A: 1')")
    done = tuisim("run", "main.py")
    assert (done.returncode, done.stdout) == (0, "A: 1\n")


@pytest.mark.parametrize("name", ["errors", "core", "source"])
def test_a_program_cannot_import_the_simulators_modules_as_its_own(
    here: Command, tmp_path: Path, name: str
) -> None:
    (tmp_path / "main.py").write_text(f"import {name}")
    done = here("run", "main.py")
    assert done.returncode == 1
    assert f"No module named {name!r}" in done.stderr


@pytest.mark.parametrize("allowed", [10, 14, 40])
def test_a_limit_of_too_few_open_files_is_told_in_one_sentence(
    tmp_path: Path, root: Path, allowed: int
) -> None:
    (tmp_path / "main.py").write_text("print('A: 1')")
    words = [sys.executable, "-m", "tuisim", "run", "main.py"]
    done = subprocess.run(
        words,
        cwd=tmp_path,
        env={"PYTHONPATH": str(root), "TUISIM_HOME": str(tmp_path)},
        # Of the hard limit too: what may be raised is raised.
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (allowed, allowed)),
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    said = f"tuisim: this shell allows no more than {allowed} open files (tuisim needs 64: ulimit -n 64)\n"
    assert (done.returncode, done.stdout, done.stderr) == (2, "", said)
