"""Motors and drive: figures of both profiles, and one answer however ticks are grouped."""

from dataclasses import replace
from random import Random

import pytest

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import COMMANDED, run
from tuisim.engine.core.drift_spec import NO_DRIFT
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES, ROBOLAB
from tuisim.engine.core.remote_spec import BeaconSpec
from tuisim.engine.core.sensors import measure_sensors
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.spec import (
    InfraredSpec,
    MotorSpec,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    TouchSpec,
    WorldSpec,
)
from tuisim.engine.core.values import list_values


def test_placing_the_robot_elsewhere_does_not_change_the_gyro_angle() -> None:
    sim = Simulation(RunSpec(RobotSpec(), WorldSpec(), ROBOLAB), MemorySink())
    sim.place(Pose(10.0, 20.0, -90.0))
    instant = sim.build_instant()
    assert instant.gyro_zero_deg - instant.pose.heading_deg == 0


@pytest.mark.parametrize("profile", COMMANDED)
def test_a_motor_stays_where_it_is_when_others_are_plugged_in(profile: str) -> None:
    ports = ("outA", "outD")
    robots = [
        RobotSpec(extra_motors=tuple(MotorSpec(port) for port in plugged))
        for plugged in ((), ports[:1], ports, ports[::-1])
    ]
    sim = build_simulation(RunSpec(robots[0], WorldSpec(), PROFILES[profile]), MemorySink())
    sim.change_robot(robots[1])
    run(sim, sim.others[0], 300)
    sim.advance(50)
    turned_deg = sim.others[0].position_deg
    assert turned_deg > 50
    for robot, turned in ((robots[2], (turned_deg, 0)), (robots[3], (0, turned_deg))):
        sim.change_robot(robot)
        assert tuple(motor.position_deg for motor in sim.others) == turned
        assert [sim.has_turned(number) for number in (0, 1)] == [deg > 0 for deg in turned]
        reported: list[object] = []
        sim.on_turns = reported.append
        sim.advance(0)
        assert reported == []


@pytest.mark.parametrize("profile", COMMANDED)
def test_a_robot_that_turns_on_the_spot_counts_whole_turns(profile: str) -> None:
    sim = Simulation(RunSpec(RobotSpec(), WorldSpec(), PROFILES[profile]), MemorySink())
    run(sim, sim.left, -300)
    run(sim, sim.right, 300)
    sim.advance(100)
    before = sim.build_instant()
    sim.advance(1900)
    after = sim.build_instant()
    turned_deg = before.turn_rate_dps * 1900 / sim.spec.profile.tick_hz
    assert turned_deg > 800
    gyro_deg = [one.pose.heading_deg - one.gyro_zero_deg for one in (before, after)]
    assert gyro_deg[1] - gyro_deg[0] == pytest.approx(turned_deg, rel=0.01)


def test_compute_due_ns_gives_the_first_nanosecond_of_a_tick() -> None:
    sim = Simulation(RunSpec(RobotSpec(), WorldSpec(), PROFILES["nbev3devsim"]), MemorySink())
    for tick in (1, 2, 3, 29, 30, 100_001):
        assert [sim.count_ticks(sim.compute_due_ns(tick) - off) for off in (0, 1)] == [
            tick,
            tick - 1,
        ]


FULL = WorldSpec(
    obstacles=(Obstacle(700, 350, 200, 150), Obstacle(1500, 500, 60, 400)),
    solid=True,
    start=Pose(400, 600, 20),
    noise=NoiseSpec(10, 20),
    drift=list_values(WorldSpec)["drift"].parse_text("typical"),
    beacon=BeaconSpec(1800, 200),
)
EQUIPPED = RobotSpec(
    weight=3.0,
    extra_motors=(MotorSpec("outA", low_deg=-90, high_deg=200),),
    touch_sensors=(TouchSpec(port="in2", y_mm=60),),
    infrared=InfraredSpec(port="in3", y_mm=50),
    color_sensors=(),
)
GIVEN = {
    "robolab": "33979 13731 1577 1 1184 10444.06 28207.83 14305.01 19505.04 4438 2141",
    "nbev3devsim": "36197 4905 1523 2 1614 8641.96 15716.41 4802.63 44415.61 4985.57 935",
    "lego-micropython": "42179 14582 1598 1 837 5925.44 28207.14 15097.03 13323.64 4497.9 3425",
    "pybricks4": "28832 15036 1614 2 804 4185.78 28083.86 15549.63 12449.11 4373.48 3242",
}
"""Sums of the sizes of all values after each command: readings, places, angles of motors, blocked ticks."""


@pytest.mark.parametrize("profile", GIVEN)
def test_a_random_drive_in_a_full_world_gives_the_recorded_rows(profile: str) -> None:
    spec = RunSpec(EQUIPPED, FULL, PROFILES[profile], seed=4)
    sim, dice, mat = (
        build_simulation(spec, MemorySink()),
        Random(2),
        Field(0, 0, memoryview(b""), {}),
    )
    rows = []
    for _ in range(30):
        motors = (sim.left, sim.right, *sim.others)
        for motor in motors:
            run(sim, motor, dice.randrange(-700, 900))
        sim.advance(dice.randrange(2 * spec.profile.tick_hz))
        seen = measure_sensors(EQUIPPED.sensors, sim.build_instant(), spec, mat)
        places = (sim.pose.x_mm, sim.pose.y_mm, sim.pose.heading_deg)
        blocked = motors[0].blocked_ticks + motors[2].blocked_ticks
        rows.append((*seen.values(), *places, *(one.position_deg for one in motors[::2]), blocked))
    sums = [sum(map(abs, values)) for values in zip(*rows, strict=True)]
    assert sums == pytest.approx(list(map(float, GIVEN[profile].split())), abs=0.01)


STEPPED = {
    "robolab": [0, 0, 546],
    "nbev3devsim": [2, 720, 248],
    "lego-micropython": [26, 2400, 524],
    "pybricks4": [25, 2400, 538],
}
"""Ticks that are run one by one, of 2,400 or 720: in the open, with noise, and among solid things."""


@pytest.mark.parametrize("profile", STEPPED)
def test_most_ticks_of_a_drive_are_computed_together(
    profile: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    stepped: list[Simulation] = []
    step = Simulation.tick_once

    def count(sim: Simulation) -> None:
        stepped.append(sim)
        step(sim)

    monkeypatch.setattr(Simulation, "tick_once", count)
    counts = []
    solid = replace(FULL, noise=NoiseSpec(), drift=NO_DRIFT)
    for world in (WorldSpec(), WorldSpec(noise=NoiseSpec(0, 20)), solid):
        sim = build_simulation(
            RunSpec(RobotSpec(weight=3.0), world, PROFILES[profile]), MemorySink()
        )
        dice = Random(2)
        for _ in range(8):
            for motor in (sim.left, sim.right):
                run(sim, motor, dice.randrange(-300, 900))
            sim.advance(3 * sim.spec.profile.tick_hz)
        counts.append(len(stepped))
        stepped.clear()
    assert counts == STEPPED[profile]
