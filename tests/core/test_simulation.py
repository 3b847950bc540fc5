"""Motors and drive: figures of both profiles, and one answer however ticks are grouped."""

import math
from dataclasses import replace

import pytest

from tests.core.memory_sink import MemorySink
from tests.core.motors import commanded
from tuisim.core.geometry import Pose
from tuisim.core.profile import NBEV3DEVSIM, NS_PER_S, ROBOLAB, ProfileSpec
from tuisim.core.simulation import Simulation
from tuisim.core.spec import NoiseSpec, RobotSpec, RunSpec, WorldSpec


def simulation(profile: ProfileSpec, motor_noise: int = 0, weight: float = 6.0) -> Simulation:
    world = WorldSpec(start=Pose(0.0, 0.0, 0.0), noise=NoiseSpec(0, motor_noise))
    return Simulation(RunSpec(RobotSpec(weight=weight), world, profile, seed=5), MemorySink())


@pytest.mark.parametrize("speed", [100.0, 525.0, 1050.0])
@pytest.mark.parametrize("backwards", [False, True], ids=["forwards", "backwards"])
def test_position_moves_end_exactly(speed: float, backwards: bool) -> None:
    sim = simulation(ROBOLAB)
    goal = -360.0 if backwards else 360.0
    for motor in (sim.left, sim.right):
        commanded(motor).run_to(goal, speed, backwards)
    sim.advance(1000, until_change=True)
    assert sim.left.position_deg == goal
    assert abs(sim.pose.x_mm) == pytest.approx(math.pi * 56, abs=1e-9)
    assert sim.left.moving_dps == 0


def test_seed_experiment_is_at_its_place_at_tick_162() -> None:
    sim = simulation(NBEV3DEVSIM)
    sim.place(Pose(150.0, 500.0, 0.0))
    for motor in (sim.left, sim.right):
        commanded(motor).run(525.0)
    sim.advance(162)
    assert sim.pose.x_mm == pytest.approx(1459.50, abs=0.01)


def script(sim: Simulation, step: int) -> bytes:
    """Drive through every kind of command, `step` ticks a call."""

    def advance(ticks: int) -> None:
        while ticks > 0:
            ticks -= sim.advance(min(step, ticks))

    commanded(sim.left).run(300.0)
    commanded(sim.right).run(-420.0)
    advance(50)
    commanded(sim.left).run_until(1000.0, sim.ticks_at(sim.due_ns(sim.tick) + NS_PER_S))
    advance(120)
    commanded(sim.left).run_to(sim.left.position_deg - 500, 400.0, backwards=True)
    commanded(sim.right).run_to(sim.right.position_deg + 333, 250.0, backwards=False)
    advance(90)
    commanded(sim.left).run(0.0)
    advance(40)
    commanded(sim.right).stop()
    advance(17)
    sink = sim._sink
    assert isinstance(sink, MemorySink)
    return sink.records()


@pytest.mark.parametrize("profile", [ROBOLAB, NBEV3DEVSIM], ids=lambda profile: profile.name)
@pytest.mark.parametrize("weight", [0.0, 3.0, 7.3], ids=["weightless", "light", "odd"])
@pytest.mark.parametrize("noise", [0, 50], ids=["quiet", "noisy"])
def test_grouping_of_ticks_does_not_matter(profile: ProfileSpec, weight: float, noise: int) -> None:
    whole = script(simulation(profile, noise, weight), 10_000)
    assert script(simulation(profile, noise, weight), 1) == whole
    assert script(simulation(profile, noise, weight), 7) == whole


def test_tight_loops_agree_with_the_full_tick() -> None:
    class Slow(Simulation):
        def _glide(self, ticks: int) -> None:
            for _ in range(ticks):
                self.tick_once()

    spec = simulation(ROBOLAB).spec
    assert script(Slow(spec, MemorySink()), 10_000) == script(
        Simulation(spec, MemorySink()), 10_000
    )


@pytest.mark.parametrize("profile", [ROBOLAB, NBEV3DEVSIM], ids=lambda profile: profile.name)
def test_braking_down_the_ramp(profile: ProfileSpec) -> None:
    sim = simulation(profile)
    for motor in (sim.left, sim.right):
        commanded(motor).run(525.0)
    sim.advance(profile.tick_hz * 2)
    before = sim.pose.x_mm
    for motor in (sim.left, sim.right):
        commanded(motor).run(0.0)
    sim.advance(profile.tick_hz * 3)
    assert sim.pose.x_mm - before == pytest.approx(76.0, abs=5.0)
    assert sim.left.moving_dps == 0


def test_seeds_give_different_noise_and_the_same_seed_the_same() -> None:
    def end(seed: int) -> float:
        spec = replace(simulation(ROBOLAB, motor_noise=50).spec, seed=seed)
        sim = Simulation(spec, MemorySink())
        commanded(sim.left).run(500.0)
        commanded(sim.right).run(500.0)
        sim.advance(300)
        return sim.pose.y_mm

    assert end(1) == end(1)
    assert end(1) != end(2)


def test_no_gyro_change_when_the_robot_is_lifted() -> None:
    sim = simulation(ROBOLAB)
    sim.place(Pose(10.0, 20.0, -90.0))
    instant = sim.instant()
    assert instant.gyro_zero_deg - instant.pose.heading_deg == 0
