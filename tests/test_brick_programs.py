"""Programs as schools, teams and beginners write them for a real brick run as they do there.

`expect.txt` was written before the program was run here.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import tuisim
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
def test_a_brick_program_does_what_it_does_on_a_brick(
    name: str, robot: str, tmp_path: Path, here: Command
) -> None:
    place = ["-x", 157, "-y", 800] if name in FROM_THE_LEFT else []
    file = ["-r", FOLDER / name / robot] if robot else []
    check_typed(
        FOLDER / name,
        run_typed(FOLDER / name, here, tmp_path, *place, *file),
        EXIT_CODES.get(name, 0),
    )


P_LINE = """
from ev3dev2.sensor.lego import ColorSensor
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
cs = ColorSensor()
tank = MoveTank(OUTPUT_B, OUTPUT_C)
while True:
    turn = KP * (cs.reflected_light_intensity - 50)
    tank.on(max(-100, min(100, 30 + turn)), max(-100, min(100, 30 - turn)))
"""
"""It never calibrates: white paper reads 85 and black 5, so its target is off the middle."""


@pytest.mark.slow
@pytest.mark.parametrize("gain", [0.6, 1.0, 2.0])
def test_a_program_with_a_p_controller_follows_the_line_round_the_loop(gain: float) -> None:
    run = tuisim.simulate(
        f"KP = {gain}\n{P_LINE}", background="Loop", x=220, y=400, angle=90, timeout_s=40
    )
    path = run.telemetry
    direction = np.unwrap(np.arctan2(path.y_mm - 571.0, path.x_mm - 1181.0))
    assert direction[0] - direction[-1] > 2.0 * np.pi
