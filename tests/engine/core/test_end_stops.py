"""End stops: a motor turns as far as they allow, stalls there, and presses what it presses."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import COMMANDED, commanded
from tuisim.engine.core.end_stops import NEAR_DEG
from tuisim.engine.core.motors import POSITION, STOPPED
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.spec import MotorSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.state import end_flag
from tuisim.engine.core.tick_record import END_FLAGS, TICK_RECORD

ROBOT = RobotSpec(
    extra_motors=(MotorSpec("outD"), MotorSpec("outA", low_deg=-90.0, high_deg=180.0)), weight=0.0
)
LOW, HIGH = (end_flag(ROBOT, "outA", end) for end in ("low", "high"))


def arm_of(robot: RobotSpec = ROBOT, profile: str = "robolab") -> Simulation:
    return build_simulation(RunSpec(robot, WorldSpec(), PROFILES[profile]), MemorySink())


@pytest.mark.parametrize("profile", COMMANDED)
@pytest.mark.parametrize(
    "dps, end_deg, flag", [(-200.0, -90.0, LOW), (500.0, 180.0, HIGH)], ids=["low", "high"]
)
def test_a_motor_stops_at_its_end_stop(profile: str, dps: float, end_deg: float, flag: int) -> None:
    sim = arm_of(profile=profile)
    arm = sim.others[1]
    # The browser simulator has no negative speeds.
    commanded(arm).run_to(
        dps * 10, abs(dps), backwards=dps < 0
    ) if profile == "nbev3devsim" else commanded(arm).run(dps)
    sim.advance(sim.spec.profile.tick_hz * 2)
    counted_deg = end_deg * (2 if profile == "nbev3devsim" else 1)
    assert arm.position_deg == pytest.approx(counted_deg, abs=1e-9)
    assert (arm.mode != STOPPED, sim.build_instant().press_flags) == (True, flag)


def test_an_arm_at_its_end_stop_is_stalled_after_100_ms() -> None:
    sim = arm_of()
    arm = sim.others[1]
    commanded(arm).run(-200.0)
    ends = []
    while sim.tick < 100:
        sim.changed = False
        sim.advance(100 - sim.tick, until_change=True)
        ends.append(sim.tick)
    # 45 ticks to the stop, then 100 ms without motion.
    assert ends == [45 + sim.stall_ticks, 100]
    assert arm.blocked_ticks == 100 - 45
    assert arm.moving_dps == 0.0


def test_a_move_blocked_by_an_end_stop_never_ends_unless_its_goal_is_the_stop() -> None:
    sim = arm_of()
    arm = sim.others[1]
    commanded(arm).run_to(200.0, 300.0, backwards=False)
    sim.advance(200)
    assert (arm.position_deg, arm.mode) == (180.0, POSITION)
    commanded(arm).run_to(-90.0, 300.0, backwards=True)
    sim.advance(200)
    assert (arm.position_deg, arm.mode) == (-90.0, STOPPED)


def test_setting_a_motors_position_does_not_move_its_end_stops() -> None:
    sim = arm_of()
    arm = sim.others[1]
    commanded(arm).run(-200.0)
    sim.advance(100)
    commanded(arm).stop()
    arm.position_deg = 0.0
    commanded(arm).run(200.0)
    sim.advance(200)
    assert arm.position_deg == pytest.approx(270.0)


def test_a_motor_close_to_its_end_stop_presses_the_sensor_there() -> None:
    sim = arm_of()
    arm = sim.others[1]
    found = []
    for goal_deg in (-90 + NEAR_DEG + 1, -90 + NEAR_DEG - 1, -90 + NEAR_DEG + 1):
        commanded(arm).run_to(goal_deg, 100.0, backwards=goal_deg < arm.position_deg)
        sim.advance(200)
        found.append(sim.build_instant().press_flags)
    assert found == [0, LOW, 0]


def test_a_motor_may_begin_at_its_end() -> None:
    robot = replace(ROBOT, extra_motors=(MotorSpec("outA", low_deg=0.0),))
    sim = arm_of(robot)
    sink = sim._sink
    assert isinstance(sink, MemorySink)
    flags = [record[-2] for record in TICK_RECORD.iter_unpack(sink.records())]
    assert (flags[0] & END_FLAGS, sim.build_instant().press_flags) == (
        end_flag(robot, "outA", "low"),
    ) * 2


@pytest.mark.parametrize("chunk", [1, 10, 50])
def test_the_record_of_each_tick_says_which_end_a_motor_is_at(chunk: int) -> None:
    sim = arm_of()
    sink = sim._sink
    assert isinstance(sink, MemorySink)
    told: list[int] = []
    commanded(sim.others[1]).run(-200.0)
    for at in range(0, 150, chunk):
        if at >= 100 > at - chunk:
            commanded(sim.others[1]).run(200.0)
        sim.advance(chunk)
        told.append(sim.build_instant().press_flags)
    flags = [record[-2] & END_FLAGS for record in TICK_RECORD.iter_unpack(sink.records())]
    assert flags[chunk::chunk] == told
    assert flags.count(LOW) == sum(flags) // LOW == 58
