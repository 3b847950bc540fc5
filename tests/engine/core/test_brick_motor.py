"""Motors of a brick: ramps, ends of moves, and what holds them back."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.engine.core.memory_sink import MemorySink
from tuisim.engine.core.brick_motor import BrickMotor, ramp_speed
from tuisim.engine.core.motors import POSITION, STOPPED
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.spec import MotorSpec, RobotSpec, RunSpec, WorldSpec


@pytest.mark.parametrize(
    "speed, target, step, after",
    [
        (0, 100, 8, 8),
        (96, 100, 8, 100),
        (50, -100, 8, 42),
        (-96, -100, 8, -100),
        (7, 7, 8, 7),
        (0, 100, 0, 100),
    ],
)
def test_a_motors_ramp_changes_the_speed_by_a_step_and_not_beyond_its_target(
    speed: float, target: float, step: float, after: float
) -> None:
    assert ramp_speed(speed, target, step) == after


def arm(weight: float = 0.0) -> tuple[Simulation, BrickMotor]:
    robot = RobotSpec(extra_motors=(MotorSpec("outA"),), weight=weight)
    sim = build_simulation(RunSpec(robot, WorldSpec(), PROFILES["robolab"]), MemorySink())
    motor = sim.others[0]
    assert isinstance(motor, BrickMotor)
    return sim, motor


def test_a_move_backwards_ends_at_its_goal() -> None:
    sim, motor = arm()
    motor.run_to(-45.0, 200.0, backwards=True)
    assert motor.aim_dps == -200.0
    sim.advance(10)
    assert (round(motor.position_deg, 9), motor.moving_dps, motor.mode) == (-20.0, -200.0, POSITION)
    sim.advance(20)
    assert (motor.position_deg, motor.mode) == (-45.0, STOPPED)
    assert motor.resting


@pytest.mark.parametrize("backwards", [False, True])
def test_setting_a_motors_position_beyond_its_goal_does_not_make_it_jump(backwards: bool) -> None:
    sign = -1.0 if backwards else 1.0
    robot = RobotSpec()
    sim = build_simulation(RunSpec(robot, WorldSpec(), PROFILES["robolab"]), MemorySink())
    for motor in sim.motors:
        assert isinstance(motor, BrickMotor)
        motor.run_to(sign * 360.0, 100.0, backwards)
        motor.position_deg = sign * 5000.0
    before = sim.pose
    sim.advance(20)
    assert sim.pose == before
    assert [(motor.position_deg, motor.mode) for motor in sim.motors] == [
        (sign * 5000.0, STOPPED)
    ] * 2


def test_a_motor_run_until_a_tick_stops_at_that_tick() -> None:
    sim, motor = arm()
    motor.run_until(100.0, 7)
    sim.advance(20)
    assert (round(motor.position_deg, 9), motor.mode) == (7.0, STOPPED)


def test_the_gentler_of_two_ramp_limits_of_a_motor_applies() -> None:
    _, motor = arm(weight=0.5)
    by_weight = motor.ramp_step
    assert by_weight > 0
    motor.run(100.0)
    motor.slowest_ramp_dps2 = 100 * by_weight / 2
    assert motor.ramp_step == pytest.approx(by_weight / 2)
    motor.slowest_ramp_dps2 = 100 * by_weight * 2
    assert motor.ramp_step == by_weight


def test_a_wheel_held_back_by_a_wall_has_not_reached_its_goal() -> None:
    _, motor = arm()
    motor.run_to(10.0, 100.0, backwards=False)
    before = motor.state()
    # As at the end of a tick that has reached it.
    motor.stop()
    motor.position_deg = 10.0
    motor.hold_back(before, 10.0, 0.25)
    assert (motor.mode, motor.position_deg, motor.target_dps, motor.blocked_ticks) == (
        POSITION,
        2.5,
        100.0,
        0,
    )
    motor.hold_back(motor.state(), 10.0, 0.0)
    assert motor.blocked_ticks == 1


@pytest.mark.parametrize("approach_dps2", [0.0, 400.0], ids=["at full speed", "slowing down"])
def test_wheels_end_their_moves_alike_however_ticks_are_divided(approach_dps2: float) -> None:
    ends = []
    for step in (1, 7, 400):
        sim = build_simulation(RunSpec(RobotSpec(), WorldSpec(), PROFILES["robolab"]), MemorySink())
        for motor, goal_deg in ((sim.left, -300.0), (sim.right, 333.0)):
            assert isinstance(motor, BrickMotor)
            motor.run_to(goal_deg, 400.0, backwards=goal_deg < 0)
            motor.approach_dps2 = approach_dps2
        for _ in range(400 // step):
            sim.advance(step)
        ends.append((sim.pose, sim.left.position_deg, sim.right.position_deg))
    assert ends[0] == ends[1] == ends[2]
    assert ends[0][1:] == (-300.0, 333.0)


@pytest.mark.parametrize("goal_deg", [60.0, -60.0], ids=["forwards", "backwards"])
def test_a_motor_slows_down_evenly_before_its_goal(goal_deg: float) -> None:
    sim, motor = arm()
    motor.run_to(goal_deg, 200.0, backwards=goal_deg < 0)
    motor.approach_dps2 = 400.0
    speeds = []
    while motor.mode == POSITION:
        sim.advance(1)
        speeds.append(abs(motor.moving_dps))
    drops = [before - after for before, after in pairwise(speeds) if after < before]
    assert motor.position_deg == goal_deg
    assert drops[1:-1] == pytest.approx([4.0] * (len(drops) - 2))
    assert len(drops) == pytest.approx(50, abs=1)


def test_a_motor_slows_down_before_the_end_of_its_time() -> None:
    sim, motor = arm()
    motor.run_until(200.0, 100)
    motor.approach_dps2 = 400.0
    sim.advance(80)
    assert motor.moving_dps == pytest.approx(80.0)
    sim.advance(20)
    assert motor.mode == STOPPED
