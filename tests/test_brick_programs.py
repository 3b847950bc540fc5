"""Programs as schools, teams and beginners write them for a real brick run as they do there.

`expect.txt` says in words what a brick does; it was written before the program was run here.
"""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.conftest import ROOT, Command

FOLDER = ROOT / "tests" / "brick_programs"
PROGRAMS = sorted(path.name for path in FOLDER.iterdir())
EXIT_CODES = {
    "08_wro_menu": 3,
    "24_rc_tank": 3,
    "30_too_fast": 1,
    "31_wrong_port": 1,
    "34_guard_forever": 3,
}
"""Of those that do not finish: three wait or drive for ever, two have a mistake in them."""


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_it_does_what_a_brick_does(name: str, tmp_path: Path, here: Command) -> None:
    folder = tmp_path / name
    shutil.copytree(FOLDER / name, folder)
    robot = ["-r", folder / "robot.toml"] if (folder / "robot.toml").exists() else []
    done = here("run", folder / "main.py", "--profile", "ev3", *robot, "--timeout", 90)
    assert done.returncode == EXIT_CODES.get(name, 0), done.stderr
    assert done.stdout == (folder / "stdout.txt").read_text(encoding="utf-8")
    assert "tuisim/" not in done.stderr
