"""Programs as schools, teams and beginners write them for a real brick run as they do there.

`expect.txt` was written before the program was run here.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.conftest import ROOT, Command
from tests.typed_programs import check_typed, names_in, run_typed

FOLDER = ROOT / "tests" / "brick_programs"
PROGRAMS = names_in(FOLDER)
EXIT_CODES = {
    "08_wro_menu": 3,
    "24_rc_tank": 3,
    "30_too_fast": 1,
    "31_wrong_port": 3,
    "34_guard_forever": 3,
}
"""Of those that do not finish: four wait or drive for ever, one has a mistake in it."""
FROM_THE_LEFT = {"03_stop_at_wall", "13_sumo", "25_ir_seek", "28_inches"}
"""Those whose output tells how far the wall is."""
WITH_FILE = [name for name in PROGRAMS if (FOLDER / name / "robot.toml").exists()]
"""Those that come with a file of their robot, which must do the same as the robot that is read from them."""


@pytest.mark.slow
@pytest.mark.parametrize(
    "name, robot",
    [*((name, "") for name in PROGRAMS), *((name, "robot.toml") for name in WITH_FILE)],
    ids=[*PROGRAMS, *(f"{name} with its file" for name in WITH_FILE)],
)
def test_it_does_what_a_brick_does(name: str, robot: str, tmp_path: Path, here: Command) -> None:
    place = ["-x", 157, "-y", 800] if name in FROM_THE_LEFT else []
    file = ["-r", FOLDER / name / robot] if robot else []
    check_typed(
        FOLDER / name,
        run_typed(FOLDER / name, here, tmp_path, *place, *file),
        EXIT_CODES.get(name, 0),
    )
