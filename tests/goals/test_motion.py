"""A robot that moves without its wheels: it is seen, and nothing else is taken for it."""

from __future__ import annotations

import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.conftest import Command
from tests.core.memory_sink import MemorySink
from tests.core.motors import run
from tuisim.core.drift_spec import DriftSpec
from tuisim.core.geometry import Pose
from tuisim.core.profile import PROFILES
from tuisim.core.simulation import Simulation
from tuisim.core.spec import NoiseSpec, Obstacle, RobotSpec, RunSpec, WorldSpec
from tuisim.core.tick_record import TICK_FIELDS
from tuisim.goals.motion import impossible_motion
from tuisim.protocol import SetButtons, SetPose, UserAction

BOXES = tuple(
    Obstacle(200.0 + 310 * number, 100.0 + 170 * (number % 5), 120, 90) for number in range(7)
)
DRIFT = DriftSpec(wheel_pc=2, spacing_pc=2, slip_pc=10, turn_slip_pc=10, backlash_deg=10)
WORLDS = {
    "free": WorldSpec(start=Pose(900, 600, -30)),
    "on an obstacle": WorldSpec(start=Pose(250, 150, 20), obstacles=BOXES),
    "noise and drift": WorldSpec(
        start=Pose(900, 600, 700), obstacles=BOXES, noise=NoiseSpec(0, 100), drift=DRIFT
    ),
}


def _driven(spec: RunSpec, chance: random.Random) -> Any:
    """The records of a robot with sudden commands at random."""
    sink = MemorySink()
    simulation = Simulation(spec, sink)
    for _ in range(12):
        left = chance.choice((0, 1050, chance.uniform(-1000, 1000)))
        run(simulation, simulation.left, left)
        run(simulation, simulation.right, chance.choice((left, -left, chance.uniform(-1000, 1000))))
        simulation.advance(chance.randrange(1, 90))
    return np.frombuffer(sink.records(), np.dtype(list(TICK_FIELDS))).copy()


@pytest.mark.parametrize("profile", sorted(PROFILES))
@pytest.mark.parametrize("world", WORLDS)
def test_wheels_obstacles_noise_and_drift_are_possible(profile: str, world: str) -> None:
    for seed in range(5):
        spec = RunSpec(RobotSpec(), WORLDS[world], PROFILES[profile], seed)
        records = _driven(spec, random.Random(seed))
        assert impossible_motion(records, spec, ()) == ""


def _moved(records: Any, name: str, by: float) -> None:
    records[name][200:] += by


CHANGES = {
    "x_mm": ("x_mm", 100.0),
    "y_mm": ("y_mm", -100.0),
    "heading_deg": ("heading_deg", 90.0),
    "no number": ("x_mm", float("nan")),
    "left_speed_dps": ("left_speed_dps", 5000.0),
}


@pytest.mark.parametrize("case", CHANGES)
def test_a_robot_that_is_elsewhere_without_its_wheels_is_seen(case: str) -> None:
    spec = RunSpec(RobotSpec(), WORLDS["on an obstacle"], PROFILES["robolab"], 1)
    records = _driven(spec, random.Random(1))
    _moved(records, *CHANGES[case])
    assert (
        impossible_motion(records, spec, ())
        == "the robot moved as no wheels can move it, at 2.00 s"
    )
    pressed = UserAction(3, SetButtons(("enter",)))
    assert impossible_motion(records, spec, (pressed,)) != ""
    assert impossible_motion(records, spec, (UserAction(200, SetPose(500, 500, 0)),)) == ""


def test_a_damaged_record_is_no_motion() -> None:
    spec = RunSpec(RobotSpec(), WORLDS["free"], PROFILES["robolab"], 1)
    records = _driven(spec, random.Random(1))
    records.view(np.uint8)[64 * 50 : 64 * 54] = np.arange(256)
    assert impossible_motion(records, spec, ()) == ""


def test_a_robot_that_creeps_without_its_wheels_or_begins_elsewhere_is_seen() -> None:
    spec = RunSpec(RobotSpec(), WORLDS["noise and drift"], PROFILES["robolab"], 1)
    records = _driven(spec, random.Random(1))[:1].repeat(500)
    records["tick"] = np.arange(500)
    assert impossible_motion(records, spec, ()) == ""
    records["y_mm"] += np.arange(500) * 0.1
    assert impossible_motion(records, spec, ()).endswith("at 0.01 s")
    elsewhere = replace(spec, world=replace(spec.world, start=Pose(905, 600, 700)))
    assert impossible_motion(records, elsewhere, ()).endswith("at 0.00 s")


TELEPORT = """\
import gc, time
gc.unfreeze()
drive = next(one for one in gc.get_objects() if type(one).__name__ == "BrickDrive")
time.sleep(0.5)
drive.x_mm = 1500
time.sleep(0.5)
print("there")
"""


@pytest.mark.slow
def test_a_program_that_moves_the_robot_itself_earns_nothing(tmp_path: Path, here: Command) -> None:
    (tmp_path / "class").mkdir()
    (tmp_path / "class" / "eve.py").write_text(TELEPORT)
    goals = "[[goal]]\nname = 'far'\nreach = { x_mm = 1500, at_end = true }\n[[goal]]\nname = 'said'\nprint = 'there'\n"
    (tmp_path / "task.toml").write_text(
        f"background = 'Empty_Map'\nstart = {{ x_mm = 500, y_mm = 500 }}\n{goals}"
    )
    done = here("mark", "task.toml", "class", "--seeds", "0", "--jobs", "1", "--no-isolate")
    row = next(line for line in done.stdout.splitlines() if line.startswith("eve"))
    assert row.split(maxsplit=5)[1:5] == ["0", "0%", "0", "0"]
    assert row.endswith("It does not count: the robot moved as no wheels can move it, at 0.51 s.")
