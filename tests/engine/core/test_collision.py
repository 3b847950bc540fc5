"""Solid things: whatever the robot is told, its outline stays out of them."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.engine.core.collision import Solids
from tuisim.engine.core.geometry import Pose, world_point
from tuisim.engine.core.outline import build_outline
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import (
    FIELD_HEIGHT_MM,
    FIELD_WIDTH_MM,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    WorldSpec,
)

ALLOWED_MM = 0.01


def simulation(
    world: WorldSpec, robot: RobotSpec | None = None, profile: str = "robolab"
) -> Simulation:
    return Simulation(RunSpec(robot or RobotSpec(), world, PROFILES[profile]), MemorySink())


def overlap_mm(sim: Simulation) -> float:
    """How deep the outline is in anything solid, by projecting on every edge's normal (independent of the code)."""
    corners = [world_point(sim.pose, x, y) for x, y in build_outline(sim.spec.robot).corners_mm]
    deepest = max(
        max(-x, x - FIELD_WIDTH_MM, -y, y - FIELD_HEIGHT_MM) if sim.spec.world.walls else -math.inf
        for x, y in corners
    )
    heading = math.radians(sim.pose.heading_deg)
    axes = [
        (1.0, 0.0),
        (0.0, 1.0),
        (math.cos(heading), math.sin(heading)),
        (-math.sin(heading), math.cos(heading)),
    ]
    for o in sim.spec.world.obstacles:
        box = [(o.x_mm + i * o.width_mm, o.y_mm + j * o.height_mm) for i in (0, 1) for j in (0, 1)]
        depth = math.inf
        for ax, ay in axes:
            one = [x * ax + y * ay for x, y in corners]
            two = [x * ax + y * ay for x, y in box]
            depth = min(depth, max(one) - min(two), max(two) - min(one))
        deepest = max(deepest, depth)
    return deepest


def test_a_turn_beside_a_wall_pushes_the_robot_off_it() -> None:
    robot = RobotSpec()
    solids = Solids(WorldSpec(solid=True), robot)
    corners = build_outline(robot).corners_mm
    apart_mm = 1.0 - min(y for _, y in corners)
    deep_mm = -min(world_point(Pose(0, apart_mm, 20), *corner)[1] for corner in corners)
    assert deep_mm > 0
    # Its right side is beside the wall.
    poses = {
        (1, 0): (apart_mm, 500.0, -90.0),
        (-1, 0): (FIELD_WIDTH_MM - apart_mm, 500.0, 90.0),
        (0, 1): (1000.0, apart_mm, 0.0),
        (0, -1): (1000.0, FIELD_HEIGHT_MM - apart_mm, 180.0),
    }
    for (x, y), pose in poses.items():
        part, aside_mm = solids.find_leeway(pose, 0.0, 20.0)
        assert part == 1.0
        assert aside_mm == pytest.approx((deep_mm * x, deep_mm * y), abs=0.001)


@pytest.mark.parametrize("speed", [100.0, 525.0, 1050.0])
@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim"])
def test_a_wall_stops_the_robot_where_its_front_touches(speed: float, profile: str) -> None:
    sim = simulation(WorldSpec(start=Pose(1800.0, 571.0, 0.0), solid=True), profile=profile)
    for motor in (sim.left, sim.right):
        commanded(motor).run(speed)
    sim.advance(sim.spec.profile.tick_hz * 30)
    assert sim.pose.x_mm + 45 == pytest.approx(FIELD_WIDTH_MM, abs=0.001)
    assert sim.left.blocked_ticks >= sim.stall_ticks


def test_a_thin_post_is_not_passed_at_full_speed() -> None:
    world = WorldSpec(
        start=Pose(300.0, 571.0, 0.0), obstacles=(Obstacle(1000.0, 570.0, 0.5, 0.5),), solid=True
    )
    sim = simulation(world, profile="nbev3devsim")
    for motor in (sim.left, sim.right):
        commanded(motor).run(1050.0)
    sim.advance(300)
    assert sim.pose.x_mm + 45 == pytest.approx(1000.0, abs=0.001)


def test_a_blocked_move_to_a_position_goes_on_once_the_way_is_clear() -> None:
    sim = simulation(WorldSpec(start=Pose(2200.0, 571.0, 0.0), solid=True))
    for motor in (sim.left, sim.right):
        commanded(motor).run_to(720.0, 500.0, backwards=False)
    sim.advance(400)
    assert sim.left.mode != 0
    sim.place(Pose(500.0, 571.0, 0.0))
    sim.advance(400)
    assert sim.left.mode == 0
    assert sim.left.position_deg == 720.0


SIZES = st.floats(0.5, 400.0)
OBSTACLE = st.builds(Obstacle, st.floats(0, 2300), st.floats(0, 1100), SIZES, SIZES)
ROBOT = st.builds(
    RobotSpec,
    wheel_diameter_mm=st.floats(10, 120),
    wheel_spacing_mm=st.floats(30, 300),
    back_mm=st.floats(-250, -1),
    weight=st.sampled_from([0.0, 3.0, 6.0]),
)
SPEED = st.floats(-1050, 1050)
MOVE = st.tuples(
    st.sampled_from(["forever", "timed", "position", "stop"]), SPEED, SPEED, st.integers(1, 150)
)
CASE = {
    "robot": ROBOT,
    "obstacles": st.lists(OBSTACLE, max_size=6),
    "x": st.floats(0, 2362),
    "y": st.floats(0, 1143),
    "heading": st.floats(-360, 360),
    "moves": st.lists(MOVE, min_size=1, max_size=6),
    "profile": st.sampled_from(["robolab", "nbev3devsim"]),
}


def drive(sim: Simulation, moves: list[tuple[str, float, float, int]]) -> float:
    """Carry out moves a tick at a time; return the deepest overlap seen."""
    deepest = overlap_mm(sim)
    for kind, left, right, ticks in moves:
        for motor, speed in ((sim.left, left), (sim.right, right)):
            match kind:
                case "forever":
                    commanded(motor).run(float(int(speed)))
                case "timed":
                    commanded(motor).run_until(float(int(speed)), sim.tick + ticks // 2)
                case "position":
                    commanded(motor).run_to(motor.position_deg + speed, 400.0, speed < 0)
                case _:
                    commanded(motor).stop()
        for _ in range(ticks):
            sim.advance(1)
            deepest = max(deepest, overlap_mm(sim))
    return deepest


def check_case(
    robot: RobotSpec,
    obstacles: list[Obstacle],
    x: float,
    y: float,
    heading: float,
    moves: list[tuple[str, float, float, int]],
    profile: str,
) -> None:
    world = WorldSpec(obstacles=tuple(obstacles), start=Pose(x, y, heading), solid=True)
    sim = simulation(world, robot, profile)
    assume(overlap_mm(sim) <= 0)
    assert drive(sim, moves) <= ALLOWED_MM
    for motor in (sim.left, sim.right):
        commanded(motor).stop()
    resting = sim.pose
    sim.advance(50)
    assert sim.pose == resting


QUIET = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much]


@pytest.mark.slow
@settings(max_examples=500, deadline=None, suppress_health_check=QUIET)
@given(**CASE)
def test_the_robots_outline_never_enters_a_solid_in_hundreds_of_cases(**case: Any) -> None:
    check_case(**case)


def test_motor_noise_does_not_push_the_robot_through_a_wall() -> None:
    world = WorldSpec(start=Pose(2000.0, 571.0, 30.0), noise=NoiseSpec(0, 300), solid=True)
    sim = simulation(world)
    assert drive(sim, [("forever", 900.0, 880.0, 600)]) <= ALLOWED_MM
