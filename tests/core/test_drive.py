"""How wheel motors are built in: mounted the other way round, or with gears between motor and wheel."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.core.memory_sink import MemorySink
from tests.core.motors import commanded
from tuisim.core.drive import turn_rate_dps
from tuisim.core.geometry import Pose
from tuisim.core.profile import PROFILES
from tuisim.core.simulation import Simulation
from tuisim.core.spec import NoiseSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.core.tick_record import TICK_FIELDS

MOTOR_FIELDS = [
    f"{side}_{what}" for side in ("left", "right") for what in ("position_deg", "speed_dps")
]
WORLD = WorldSpec(start=Pose(2150.0, 571.0, 20.0), solid=True)
"""Near a wall, which the robot meets and is pushed aside from."""


def driven(
    profile: str, robot: RobotSpec, left: float, right: float, step: int = 400
) -> Simulation:
    """Drive along an arc, then straight on, by motors at these speeds."""
    sim = Simulation(RunSpec(robot, WORLD, PROFILES[profile]), MemorySink())
    for left_dps, right_dps in ((left, right), (left, left * (1 if left * right > 0 else -1))):
        commanded(sim.left).run(left_dps)
        commanded(sim.right).run(right_dps)
        for _ in range(0, 400, step):
            sim.advance(step)
    return sim


def records(sim: Simulation) -> np.ndarray:
    sink = sim._sink
    assert isinstance(sink, MemorySink)
    return np.frombuffer(sink.records(), np.dtype(list(TICK_FIELDS))).copy()


@pytest.mark.parametrize("step", [1, 8, 400])
@pytest.mark.parametrize(
    "sides", [("left",), ("right",), ("left", "right")], ids=["left", "right", "both"]
)
@pytest.mark.parametrize("profile", ["robolab"])
def test_a_reversed_motor_that_runs_backwards_drives_as_a_usual_one_forwards(
    profile: str, sides: tuple[str, ...], step: int
) -> None:
    robot = RobotSpec(left_reversed="left" in sides, right_reversed="right" in sides)
    left, right = 250.0, 310.0
    usual = records(driven(profile, RobotSpec(), left, right))
    given = -left if robot.left_reversed else left, -right if robot.right_reversed else right
    found = records(driven(profile, robot, *given, step))
    for name in MOTOR_FIELDS:
        if name.startswith(sides):
            found[name] = 0.0 - found[name]
    assert found.tolist() == usual.tolist()
    assert turn_rate_dps(*given, robot) == turn_rate_dps(left, right, RobotSpec())


def test_reversed_motors_turn_the_wheels_backwards_in_the_browser_simulator_too() -> None:
    sim = Simulation(
        RunSpec(
            RobotSpec(left_reversed=True, right_reversed=True), WorldSpec(), PROFILES["nbev3devsim"]
        ),
        MemorySink(),
    )
    commanded(sim.left).run(300.0)
    commanded(sim.right).run(300.0)
    sim.advance(60)
    assert sim.pose.x_mm < WorldSpec().start.x_mm
    assert sim.left.position_deg > 0


@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim"])
@pytest.mark.parametrize("gear_ratio", [0.5, 3.0])
def test_a_gear_divides_the_turns_of_the_motor(profile: str, gear_ratio: float) -> None:
    robot, speeds = RobotSpec(weight=0.0), (250.0, 310.0)
    world = WorldSpec(start=Pose(500.0, 571.0, 20.0), noise=NoiseSpec())
    ends = []
    for spec, factor in ((robot, 1.0), (replace(robot, gear_ratio=gear_ratio), gear_ratio)):
        sim = Simulation(RunSpec(spec, world, PROFILES[profile]), MemorySink())
        for motor, dps in zip((sim.left, sim.right), speeds, strict=True):
            commanded(motor).run(dps * factor)
        sim.advance(100)
        counts = sim.left.position_deg / factor, sim.right.position_deg / factor
        ends.append(
            (
                *counts,
                sim.pose.x_mm,
                sim.pose.y_mm,
                sim.pose.heading_deg,
                sim.instant().turn_rate_dps,
            )
        )
    assert ends[1] == pytest.approx(ends[0])
