"""How wheel motors are built in: mounted the other way round, or with gears between motor and wheel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.cases import for_each
from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.engine.core.drive import (
    BrickDrive,
    BrowserDrive,
    Drive,
    EvenGlide,
    Glide,
    Records,
    turn_rate_dps,
)
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import NoiseSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tick_record import TICK_FIELDS

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


TICKS = 60
TICK_HZ = 100


def roll_one_by_one(drive: Drive, turns_deg: tuple[float, float]) -> list[tuple[float, ...]]:
    """Return the fields of each tick's record: the pose, then those of the motors."""
    rows: list[tuple[float, ...]] = []
    for tick in range(1, TICKS + 1):
        drive.roll(*turns_deg)
        pose = drive.x_mm, drive.y_mm, drive.heading_deg, drive.gyro_zero_deg
        motors = [(tick * deg, TICK_HZ * deg) for deg in turns_deg]
        rows.append((tick, *pose, *motors[0], *motors[1]))
    return rows


def new_records() -> Records:
    buffer = bytearray(64 * TICKS)
    offsets = range(0, 64 * TICKS, 64)
    return Records(buffer, offsets, range(1, TICKS + 1), 0, 0, 0, TICK_HZ)


@for_each(
    turns_deg=[(-3.0, 5.0), (5.0, -3.0), (2.0, 6.0), (4.0, 4.0)],
    early=[0.0, 0.5],
    kind=[BrickDrive, BrowserDrive],
)
def test_driving_many_ticks_at_once_equals_driving_them_one_by_one(
    kind: Callable[[RobotSpec, Pose, float], Drive], early: float, turns_deg: tuple[float, float]
) -> None:
    rolled, gliding, even = (kind(RobotSpec(), Pose(900.0, 500.0, 340.0), early) for _ in range(3))
    rows = roll_one_by_one(rolled, turns_deg)
    counts = [[tick * deg for tick in range(1, TICKS + 1)] for deg in turns_deg]
    sides = [*zip(turns_deg, counts, strict=True)]
    together = new_records()
    evenly = new_records()
    gliding.glide(together, *(Glide([deg] * TICKS, places) for deg, places in sides))
    even.glide_evenly(evenly, *(EvenGlide(deg, iter(places)) for deg, places in sides))
    names = ["tick", "x_mm", "y_mm", "heading_deg", "gyro_zero_deg", *MOTOR_FIELDS]
    for records, drive in ((together, gliding), (evenly, even)):
        found = np.frombuffer(records.buffer, np.dtype(list(TICK_FIELDS)))
        columns = np.column_stack([found[name] for name in names])
        np.testing.assert_allclose(columns, rows, rtol=1e-6)
        pose = drive.x_mm, drive.y_mm, drive.heading_deg, drive.gyro_zero_deg
        assert pose == pytest.approx(rows[-1][1:5])


@pytest.mark.parametrize("step", [1, 8, 400])
@pytest.mark.parametrize(
    "sides", [("left",), ("right",), ("left", "right")], ids=["left", "right", "both"]
)
@pytest.mark.parametrize("profile", ["robolab"])
def test_a_reversed_motor_run_backwards_drives_like_a_normal_one_forwards(
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
def test_a_gear_ratio_divides_the_wheels_turns(profile: str, gear_ratio: float) -> None:
    robot = RobotSpec(weight=0.0)
    speeds = (250.0, 310.0)
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
                sim.build_instant().turn_rate_dps,
            )
        )
    assert ends[1] == pytest.approx(ends[0])
