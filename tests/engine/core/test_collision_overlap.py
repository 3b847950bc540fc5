"""A robot that starts inside a solid thing: it gets no deeper, and it can leave."""

from __future__ import annotations

import math

import pytest
from _pytest.mark.structures import ParameterSet
from hypothesis import HealthCheck, Phase, assume, given, settings
from hypothesis import strategies as st

from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded, run
from tests.engine.core.test_collision import overlap_mm, simulation
from tuisim.engine import mats
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.motors import FOREVER
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import NoiseSpec, Obstacle, WorldSpec

CLEAR_MM = 0.001
LOOK_TICKS = 5

MOTIONS = {
    "forwards": (400.0, 400.0),
    "backwards": (-400.0, -400.0),
    "left on the spot": (-300.0, 300.0),
    "right on the spot": (300.0, -300.0),
    "back on a bend": (-200.0, -350.0),
    "round one wheel": (0.0, 300.0),
}


def slow(*values: object) -> ParameterSet:
    """A row that is another kind of one that is tested anyway."""
    return pytest.param(*values, marks=pytest.mark.slow)


def told(sim: Simulation, left_dps: float, right_dps: float, ticks: int) -> float:
    """Drive, and return the deepest overlap on the way."""
    for motor, dps in ((sim.left, left_dps), (sim.right, right_dps)):
        run(sim, motor, dps)
    deepest = -math.inf
    for _ in range(ticks // LOOK_TICKS):
        sim.advance(LOOK_TICKS)
        deepest = max(deepest, overlap_mm(sim))
    return deepest


def leaves(sim: Simulation) -> bool:
    """Try to drive clear of everything, both ways, and again after turns."""
    for _ in range(8):
        for way in (500.0, -500.0):
            told(sim, way, way, 150)
            if overlap_mm(sim) <= CLEAR_MM:
                return True
        told(sim, -300.0, 300.0, 55)
    return False


@pytest.mark.quick_cases("open-*")
@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize(
    "profile", ["robolab", *(slow(profile) for profile in PROFILES if profile != "robolab")]
)
@pytest.mark.parametrize(
    "walls, solid",
    [(False, False), slow(False, True), slow(True, False), (True, True)],
    ids=["open", "solid", "open with walls", "solid with walls"],
)
def test_a_robot_drives_on_from_the_start_of_any_mat(
    motion: str, profile: str, walls: bool, solid: bool
) -> None:
    for name, mat in mats.catalogue().items():
        sim = simulation(
            WorldSpec(name, mat.obstacles, walls, solid, start=mat.start), profile=profile
        )
        first_mm = overlap_mm(sim)
        deepest_mm = told(sim, *MOTIONS[motion], 120)
        if solid:
            assert deepest_mm <= max(first_mm, 0.0) + CLEAR_MM, name
            assert leaves(sim), name
        if motion == "forwards" or not solid:
            assert sim.left.mode == FOREVER and sim.pose != mat.start, name


FLANK, CORNER, NOSE, TAIL = (
    Pose(900.0, 60.0, 0.0),
    Pose(40.0, 30.0, 135.0),
    Pose(2350.0, 600.0, 20.0),
    Pose(5, 600, 0),
)
AROUND = Obstacle(700.0, 300.0, 900.0, 500.0)
POST = Obstacle(1000.0, 560.0, 20.0, 20.0)
PLACES = {
    "along a wall": (FLANK, ()),
    "in a corner": (CORNER, ()),
    "front in a wall": (NOSE, ()),
    "back in a wall": (TAIL, ()),
    "beyond a wall": (Pose(-300.0, 600.0, 70.0), ()),
    "in the middle of a box": (Pose(1150.0, 550.0, 33.0), (AROUND,)),
    "on a post": (Pose(1010.0, 570.0, 10.0), (POST,)),
    "along a box": (Pose(1150.0, 240.0, 0.0), (AROUND,)),
}


@pytest.mark.quick_cases(
    *("on a post-*-0", "on a post-forwards-100"),
    *("along a box-forwards-100", "in the middle of a box-back on a bend-100"),
)
@pytest.mark.parametrize("noise", [0, 100])
@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("place", PLACES)
def test_a_robot_put_into_something_gets_no_deeper_and_can_leave(
    place: str, motion: str, noise: int
) -> None:
    start, boxes = PLACES[place]
    sim = simulation(WorldSpec(obstacles=boxes, solid=True, start=start, noise=NoiseSpec(0, noise)))
    first_mm = overlap_mm(sim)
    assert told(sim, *MOTIONS[motion], 200) <= first_mm + CLEAR_MM
    assert leaves(sim)


def test_driving_deeper_into_a_wall_stalls_the_motors() -> None:
    sim = simulation(WorldSpec(solid=True))
    told(sim, *MOTIONS["backwards"], 100)
    assert sim.left.blocked_ticks >= sim.stall_ticks
    assert sim.pose == Pose(100.0, 800.0, 0.0)


def test_other_walls_stop_a_robot_that_is_inside_one() -> None:
    sim = simulation(WorldSpec(solid=True, start=Pose(900.0, 60.0, 0.0)))
    told(sim, 900.0, 900.0, 500)
    assert sim.pose.x_mm + 45 == pytest.approx(2362, abs=CLEAR_MM)


@pytest.mark.parametrize("place", PLACES)
def test_a_robot_inside_an_obstacle_moves_the_same_however_ticks_are_grouped(place: str) -> None:
    def records(step: int) -> bytes:
        start, boxes = PLACES[place]
        sim = simulation(WorldSpec(obstacles=boxes, solid=True, start=start))
        for left, right in MOTIONS.values():
            commanded(sim.left).run(left)
            commanded(sim.right).run(right)
            for _ in range(90 // step):
                sim.advance(step)
        assert isinstance(sim._sink, MemorySink)
        return sim._sink.records()

    assert records(1) == records(9) == records(90)


def test_driving_back_beside_a_corner_ends_at_the_box() -> None:
    boxes = (Obstacle(812.27, 928.6, 357.01, 147.12),)
    sim = simulation(WorldSpec(obstacles=boxes, solid=True, start=Pose(1000.0, 760.0, -150.0)))
    assert told(sim, -400.0, -400.0, 400) <= CLEAR_MM


SPEED = st.floats(-1050, 1050)


@settings(
    max_examples=120,
    deadline=None,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)
@given(
    box=st.builds(
        Obstacle,
        st.floats(320, 1600),
        st.floats(320, 500),
        st.floats(0.5, 400.0),
        st.floats(0.5, 300.0),
    ),
    x=st.floats(-50, 2400),
    y=st.floats(-50, 1200),
    heading=st.one_of(st.floats(-360, 360), st.sampled_from([0.0, 90.0, 180.0, 45.0])),
    moves=st.lists(st.tuples(SPEED, SPEED), min_size=1, max_size=4),
    profile=st.sampled_from(sorted(PROFILES)),
)
@pytest.mark.slow
def test_no_motion_leads_deeper_into_what_the_robot_was_put_into(
    box: Obstacle,
    x: float,
    y: float,
    heading: float,
    moves: list[tuple[float, float]],
    profile: str,
) -> None:
    sim = simulation(
        WorldSpec(obstacles=(box,), solid=True, start=Pose(x, y, heading)), profile=profile
    )
    first_mm = overlap_mm(sim)
    assume(first_mm > 0)
    for left, right in moves:
        assert told(sim, float(int(left)), float(int(right)), 100) <= first_mm + CLEAR_MM
    assert leaves(sim)
