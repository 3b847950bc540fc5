"""What the shell says of a stored run, after the defaults of the next ones have changed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.conftest import Command

RUN = ("run", "log_greys", "-N", 20, "-M", 10, "--seed", 3)
SAID = (
    ("log", "summary", "1"),
    ("log", "bands", "1", "--json"),
    ("log", "reckon", "1", "--json"),
    ("log", "plot", "1"),
    ("runs", "show", "1"),
)
FILES = (
    ("log", "report", "1", "--out", "report.html"),
    ("runs", "picture", "1", "--at", 2, "--out", "picture.svg"),
)
CONFIG = """\
[simulation]
background = "Loop"
profile = "nbev3devsim"
robot = "Small_Robot"
motornoise = 40
sensornoise = 90
drift = "typical"
"""


@pytest.mark.slow
def test_log_commands_on_a_stored_run_ignore_the_users_defaults_for_new_runs(
    here: Command, home: Path
) -> None:
    assert here(*RUN).returncode == 0

    def collect() -> list[str | bytes]:
        texts: list[str | bytes] = [here(*words).stdout for words in SAID]
        for words in FILES:
            assert here(*words).returncode == 0
            path = Path(str(words[-1]))
            texts.append(path.read_bytes())
            path.unlink()
        return texts

    before = collect()
    (home / "config.toml").write_text(CONFIG, encoding="utf-8")
    facts = json.loads(here("run", "read_once", "--json").stdout)
    assert facts["profile"] == "nbev3devsim"
    assert collect() == before
