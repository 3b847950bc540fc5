"""Drift: robots that are not where their encoders say, against closed forms."""

from __future__ import annotations

from dataclasses import replace
from math import hypot, pi, radians, sqrt
from statistics import fmean, pstdev

import pytest

from tests.cases import for_each
from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.engine.core.drift import (
    JERK_MM,
    compute_light_share,
    draw_bright_side,
    draw_errors,
    find_drift,
)
from tuisim.engine.core.drift_spec import NO_DRIFT, DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    NoiseSpec,
    RobotSpec,
    RunSpec,
    WorldSpec,
)
from tuisim.engine.core.values import list_values

TYPICAL: DriftSpec = list_values(WorldSpec)["drift"].parse_text("typical")
ROBOT = RobotSpec(weight=0.0)
SIDE_MM = 1000.0
MM_PER_DEG = pi * ROBOT.wheel_diameter_mm / 360


def simulation(
    drift: DriftSpec,
    seed: int = 0,
    profile: str = "robolab",
    noise: NoiseSpec = NoiseSpec(),
    solid: bool = False,
) -> Simulation:
    world = WorldSpec(start=Pose(500.0, 500.0, 0.0), drift=drift, noise=noise, solid=solid)
    return Simulation(RunSpec(ROBOT, world, PROFILES[profile], seed), MemorySink())


@pytest.mark.parametrize("name", PROFILES)
def test_drift_of_sensors_applies_only_to_profiles_measured_on_bricks(name: str) -> None:
    spec = RunSpec(ROBOT, WorldSpec(drift=TYPICAL), PROFILES[name])
    drift = find_drift(spec)
    sizes = drift.gyro_scale_pc, drift.echo_bias_mm, drift.light_gain_pc
    assert all(sizes) if spec.profile.motor_law.is_measured else sizes == (0.0, 0.0, 0.0)
    assert (drift.wheel_pc, drift.gyro_dps, drift.light_pc) == (0.5, 0.05, 10.0)
    assert find_drift(spec) == Simulation(spec, MemorySink()).build_instant().drift


def move(sim: Simulation, left_deg: float, right_deg: float, speed_dps: float = 400.0) -> None:
    """Turn both motors by these angles, and wait for them."""
    for motor, way in ((sim.left, left_deg), (sim.right, right_deg)):
        speed = speed_dps if way > 0 else -speed_dps
        commanded(motor).run_to(motor.position_deg + way, speed, way < 0)
    while not (sim.left.resting and sim.right.resting):
        sim.advance(1)


def drive_square(sim: Simulation, clockwise: bool = False) -> Pose:
    """Drive a square that would end where it began, and return the error of the end."""
    turn = ROBOT.wheel_spacing_mm * pi / 4 / MM_PER_DEG * (1 if clockwise else -1)
    for _ in range(4):
        move(sim, SIDE_MM / MM_PER_DEG, SIDE_MM / MM_PER_DEG)
        move(sim, turn, -turn)
    end = sim.pose
    return Pose(end.x_mm - 500, end.y_mm - 500, end.heading_deg - (-360 if clockwise else 360))


def test_without_drift_a_square_ends_where_it_began() -> None:
    error = drive_square(simulation(NO_DRIFT))
    assert hypot(error.x_mm, error.y_mm) < 1e-6
    assert abs(error.heading_deg) < 1e-9


@pytest.mark.parametrize("profile", PROFILES)
def test_wheel_encoders_read_the_same_with_drift(profile: str) -> None:
    seen = []
    for drift in (NO_DRIFT, TYPICAL):
        sim = simulation(drift, seed=3, profile=profile)
        for motor, speed in ((sim.left, 300), (sim.right, 350)):
            if isinstance(motor, ServoMotor):
                motor.run_freely(0, speed * 10)
            else:
                commanded(motor).run(speed)
        sim.advance(150)
        now = sim.build_instant()
        seen.append(
            (
                now.left_position_deg,
                now.right_position_deg,
                now.left_speed_dps,
                now.right_speed_dps,
                now.pose,
            )
        )
    assert seen[0][:4] == seen[1][:4]
    assert seen[0][4] != seen[1][4]


@pytest.mark.parametrize("solid", [False, True])
@pytest.mark.parametrize("noise", [0, 30])
def test_a_drifting_robot_moves_the_same_however_ticks_are_grouped(noise: int, solid: bool) -> None:
    ends = []
    for step in (1, 7, 400):
        sim = simulation(TYPICAL, 5, noise=NoiseSpec(motor=noise), solid=solid)
        commanded(sim.left).run(700)
        commanded(sim.right).run(720)
        done = 0
        while done < 800:
            done += sim.advance(min(step, 800 - done))
        ends.append((sim.pose, sim.drive.gyro_zero_deg, sim.left.position_deg))
    assert ends[0] == ends[1] == ends[2]


def test_a_seed_draws_the_same_errors_and_another_one_others() -> None:
    assert draw_errors(TYPICAL, 1) == draw_errors(replace(TYPICAL), 1) != draw_errors(TYPICAL, 2)


def test_errors_of_wheels_have_the_spread_that_is_asked_for() -> None:
    drift = DriftSpec(wheel_pc=1.0, spacing_pc=2.0, gyro_dps=0.1)
    drawn = [draw_errors(drift, seed) for seed in range(2000)]
    for values, spread in (
        ([one.left - 1 for one in drawn], 0.01),
        ([one.right - 1 for one in drawn], 0.01),
        ([one.spacing - 1 for one in drawn], 0.02),
        ([one.gyro_dps for one in drawn], 0.1),
    ):
        assert abs(fmean(values)) < 4 * spread / sqrt(2000)
        assert pstdev(values) == pytest.approx(spread, rel=0.06)


def test_wrong_sizes_turn_a_square_as_far_as_the_closed_form_says() -> None:
    for seed in range(5):
        drift = DriftSpec(wheel_pc=1.0, spacing_pc=1.0)
        drawn = draw_errors(drift, seed)
        error = drive_square(simulation(drift, seed))
        sides = 4 * SIDE_MM * (drawn.right - drawn.left) / (ROBOT.wheel_spacing_mm * drawn.spacing)
        turns = 2 * pi * ((drawn.left + drawn.right) / 2 / drawn.spacing - 1)
        assert radians(error.heading_deg) == pytest.approx(sides + turns, abs=1e-9)


def test_wheel_slip_shortens_turns_by_its_percent_with_the_expected_spread() -> None:
    ways = []
    for seed in range(200):
        sim = simulation(DriftSpec(turn_slip_pc=2.0), seed)
        move(sim, -300.0, 300.0)
        ways.append(sim.pose.heading_deg)
    turned_mm = 300 * MM_PER_DEG
    full = 2 * turned_mm / ROBOT.wheel_spacing_mm
    spread = sqrt(2 * 0.02 * turned_mm * JERK_MM) / ROBOT.wheel_spacing_mm
    assert radians(fmean(ways)) == pytest.approx(full * 0.98, abs=4 * spread / sqrt(200))
    assert radians(pstdev(ways)) == pytest.approx(spread, rel=0.2)


def test_slip_grows_with_acceleration_and_steady_wheels_do_not_slip() -> None:
    lost_mm: dict[float, float] = {}
    for weight in (3.0, 9.0):
        robot = RobotSpec(weight=weight)
        world = WorldSpec(start=Pose(0.0, 500.0, 0.0), drift=DriftSpec(slip_pc=5.0))
        found = []
        for seed in range(40):
            sim = Simulation(RunSpec(robot, world, PROFILES["robolab"], seed), MemorySink())
            commanded(sim.left).run(500)
            commanded(sim.right).run(500)
            sim.advance(20)
            found.append(
                (sim.left.position_deg + sim.right.position_deg) / 2 * MM_PER_DEG - sim.pose.x_mm
            )
            sim.advance(180)
            heading_deg = sim.pose.heading_deg
            tail = sim.pose
            sim.advance(100)
            assert sim.pose.heading_deg == heading_deg
            assert hypot(sim.pose.x_mm - tail.x_mm, sim.pose.y_mm - tail.y_mm) == pytest.approx(
                500 * MM_PER_DEG
            )
        lost_mm[weight] = fmean(found)
    # The share that is lost and the way in these ticks both grow with the acceleration.
    assert lost_mm[3.0] == pytest.approx(9 * lost_mm[9.0], rel=0.3)


def test_backlash_loses_its_angle_at_each_reversal() -> None:
    sim = simulation(DriftSpec(backlash_deg=10.0))
    for _ in range(3):
        move(sim, 360.0, 360.0)
        move(sim, -360.0, -360.0)
    # At first the motor is in the middle of its play.
    assert sim.pose.x_mm == pytest.approx(500 + 5 * MM_PER_DEG)
    move(sim, 8.0, 8.0)
    assert sim.pose.x_mm == pytest.approx(500 + 5 * MM_PER_DEG)
    move(sim, 92.0, 92.0)
    assert sim.pose.x_mm == pytest.approx(500 + 95 * MM_PER_DEG)


def test_the_gyro_drifts_while_the_robot_stands_and_begins_anew_at_its_reset() -> None:
    drift = DriftSpec(gyro_dps=0.5)
    sim = simulation(drift, 1)
    sim.advance(20_000)
    expected = draw_errors(drift, 1).gyro_dps * 200
    assert abs(expected) > 5
    assert sim.build_instant().gyro_deg == pytest.approx(expected, abs=0.51)
    sim.reset_gyro()
    assert sim.build_instant().gyro_deg == 0


@for_each(seed=range(4))
def test_with_drift_the_light_decreases_from_one_side_of_the_field_to_the_other(seed: int) -> None:
    drift = DriftSpec(light_pc=20.0)
    corners = [
        compute_light_share(x, y, drift, seed)
        for x in (0, FIELD_WIDTH_MM)
        for y in (0, FIELD_HEIGHT_MM)
    ]
    assert max(corners) == pytest.approx(1.0)
    assert min(corners) == pytest.approx(0.8)
    across, up = draw_bright_side(drift, seed)
    assert compute_light_share(1181 + 100 * across, 571.5 + 100 * up, drift, seed) > 0.9
