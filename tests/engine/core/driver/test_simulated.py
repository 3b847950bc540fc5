"""Motors of the driver in the simulation: the same bytes however ticks are divided and whoever looks."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from tests.engine.core.driver.lab import MS, give, renumber
from tests.engine.core.memory_sink import MemorySink
from tuisim.engine.core.driver.motor import STATES, Command
from tuisim.engine.core.driver.plant import LARGE
from tuisim.engine.core.driver.regulator import StopAction
from tuisim.engine.core.driver.simulated import SimulatedMotor, load_wheel
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.simulation import Simulation, build_simulation
from tuisim.engine.core.spec import MotorSpec, NoiseSpec, Obstacle, RobotSpec, RunSpec, WorldSpec

TICK_NS = 10 * MS
ROBOT = RobotSpec(extra_motors=(MotorSpec("outA", "medium", low_deg=-40, high_deg=100),))
WORLD = WorldSpec(
    start=Pose(600, 500, 0),
    solid=True,
    obstacles=(Obstacle(900, 500, 40, 800), Obstacle(300, 100, 300, 60)),
)
NOISY = replace(WORLD, noise=NoiseSpec(motor=20))


class Lab:
    """A robot whose motors get commands."""

    def __init__(self, world: WorldSpec = WORLD, robot: RobotSpec = ROBOT, seed: int = 0) -> None:
        self.sink = MemorySink()
        spec = RunSpec(robot, world, PROFILES["ev3"], seed=seed)
        self.sim: Simulation = build_simulation(spec, self.sink)
        self.motors = [
            motor
            for motor in (self.sim.left, self.sim.right, *self.sim.others)
            if isinstance(motor, SimulatedMotor)
        ]

    def command(self, chance: random.Random) -> None:
        """Give any command, some time after a tick."""
        motor = chance.choice(self.motors)
        now_ns = self.sim.tick * TICK_NS + chance.randrange(TICK_NS)
        command = chance.choice([*Command, Command.RUN_FOREVER, Command.RUN_FOREVER])
        ramp_ms = chance.choice((0, 0, 0, 500))
        give(
            motor,
            now_ns,
            command,
            speed_dps=chance.randrange(-1050, 1051),
            position=chance.randrange(-700, 701),
            duty=chance.randrange(-100, 101),
            time_ms=chance.randrange(3000),
            ramp_up_ms=ramp_ms,
            ramp_down_ms=chance.choice((0, ramp_ms)),
            stop_action=chance.choice([*StopAction]),
        )
        if chance.random() < 0.1:
            renumber(motor, now_ns, chance.randrange(-90, 90))

    def run(self, seed: int, most: int, looks: random.Random | None = None) -> bytes:
        """Give random commands for some seconds, ticks in parts of at most `most`; return what was recorded."""
        chance = random.Random(seed)
        for _ in range(12):
            self.command(chance)
            left = chance.choice((3, 30, 200))
            while left:
                part = min(left, most)
                if looks is not None:
                    for motor in self.motors:
                        motor.run_until(self.sim.tick * TICK_NS + looks.randrange(TICK_NS))
                self.sim.advance(part)
                left -= part
        return self.sink.records()


@pytest.mark.parametrize("world", [WORLD, NOISY], ids=["still", "noisy"])
# In the last one an obstacle pushes a wheel back that its control holds.
@pytest.mark.parametrize("seed", [*range(4), 2333])
def test_records_do_not_depend_on_how_ticks_are_grouped_or_who_reads(
    seed: int, world: WorldSpec
) -> None:
    recorded = Lab(world, seed=seed).run(seed, 1000)
    assert Lab(world, seed=seed).run(seed, 1) == recorded
    assert Lab(world, seed=seed).run(seed, 7, random.Random(seed)) == recorded
    assert Lab(world, seed=seed).run(seed, 1, random.Random(~seed)) == recorded


def test_a_wheels_motor_moves_its_share_of_the_robots_mass() -> None:
    wheel = load_wheel(LARGE, RobotSpec())
    assert wheel.inertia_kg_m2 - LARGE.inertia_kg_m2 == pytest.approx(0.00038, rel=0.01)
    assert wheel.friction_nm - LARGE.friction_nm == pytest.approx(0.006, rel=0.01)
    geared = load_wheel(LARGE, RobotSpec(gear_ratio=2.0))
    assert geared.inertia_kg_m2 - LARGE.inertia_kg_m2 == pytest.approx(0.000095, rel=0.01)


@pytest.mark.parametrize("battery_v, top_dps", [(8.0, 911), (7.2, 818), (9.0, 1028)])
def test_the_battery_of_the_robot_sets_its_highest_speed(battery_v: float, top_dps: float) -> None:
    lab = Lab(replace(WORLD, obstacles=()), replace(ROBOT, battery_v=battery_v))
    give(lab.motors[0], 0, Command.RUN_DIRECT, duty=100)
    give(lab.motors[1], 0, Command.RUN_DIRECT, duty=-100)
    lab.sim.advance(100)
    assert lab.motors[0].speed_dps == pytest.approx(top_dps, rel=0.01)


def test_a_robot_at_a_wall_stalls_and_drives_away() -> None:
    lab = Lab()
    for motor in lab.motors[:2]:
        give(motor, 0, Command.RUN_FOREVER, speed_dps=500)
    lab.sim.advance(300)
    x_mm = lab.sim.pose.x_mm
    assert all(motor.axle.speed_dps == 0.0 for motor in lab.motors)
    assert STATES[lab.motors[0].state_bits] == "running overloaded stalled"
    lab.sim.advance(100)
    assert lab.sim.pose.x_mm == x_mm
    for motor in lab.motors[:2]:
        give(motor, 4000 * MS, Command.RUN_FOREVER, speed_dps=-500)
    lab.sim.advance(100)
    assert lab.sim.pose.x_mm < x_mm - 150
    assert STATES[lab.motors[0].state_bits] == "running"


@pytest.mark.parametrize("speed_dps", [200, 500, 900])
@pytest.mark.parametrize("heading_deg", [0, 10])
def test_a_wheel_at_a_wall_is_stalled_as_late_as_a_blocked_motor(
    speed_dps: int, heading_deg: int
) -> None:
    lab = Lab(replace(WORLD, start=Pose(600, 500, heading_deg)))
    left, right = lab.motors[:2]
    for motor in left, right:
        give(motor, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    while not left.is_barred:
        lab.sim.advance(1)
    contact_tick = lab.sim.tick
    while not left.is_stalled:
        lab.sim.advance(1)
    # 305 ms after the contact, which is up to a tick before.
    assert 29 <= lab.sim.tick - contact_tick <= 32
    lab.sim.advance(10)
    assert left.is_at_rest and right.is_at_rest and lab.sim._count_quiet_ticks(1000) == 1000
    pose = lab.sim.pose
    lab.sim.place(Pose(pose.x_mm - 300, pose.y_mm, heading_deg))
    lab.sim.advance(10)
    assert lab.sim.pose.x_mm > pose.x_mm - 300


def test_an_arm_stops_at_its_end_stop_in_both_directions() -> None:
    lab = Lab()
    arm = lab.motors[2]
    give(arm, 0, Command.RUN_FOREVER, speed_dps=-300)
    lab.sim.advance(100)
    assert arm.position_deg == pytest.approx(-40)
    give(arm, 1000 * MS, Command.RUN_FOREVER, speed_dps=300)
    lab.sim.advance(200)
    assert arm.position_deg == pytest.approx(100)
    assert "stalled" in STATES[arm.state_bits]


@pytest.mark.parametrize("speed_dps", [100, -300, 900])
def test_a_motor_that_runs_evenly_is_within_2_degrees_of_its_steps(speed_dps: int) -> None:
    free = replace(WORLD, solid=False, obstacles=())
    lab = Lab(free)
    give(lab.motors[0], 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    stepped = Lab(free).motors[0]
    stepped.start_clock(lab.motors[0]._jiffies)
    give(stepped, 0, Command.RUN_FOREVER, speed_dps=speed_dps)
    for tick in range(1, 1000):
        lab.sim.advance(1)
        lab.motors[0].run_until(tick * TICK_NS)
        stepped.run_until(tick * TICK_NS)
        assert abs(lab.motors[0].position - stepped.position) <= 2
        assert lab.motors[0].speed_dps == pytest.approx(stepped.speed_dps, abs=2)


def find_gains(lab: Lab, ticks: int) -> list[float]:
    """Return by how much the speeds of released motors rise from tick to tick."""
    gains = []
    for _ in range(ticks):
        before = [abs(motor.axle.speed_dps) for motor in lab.motors]
        lab.sim.advance(1)
        after = [abs(motor.axle.speed_dps) for motor in lab.motors]
        gains += [new - old for new, old in zip(after, before, strict=True) if new > old]
    return gains


def release(lab: Lab, seed: int) -> None:
    """Let every motor coast or brake, at once."""
    for number, motor in enumerate(lab.motors):
        action = StopAction.COAST if (seed + number) % 2 else StopAction.BRAKE
        now_ns = lab.sim.tick * TICK_NS
        # A ramp set before would go on.
        give(motor, now_ns, Command.STOP, ramp_up_ms=0, ramp_down_ms=0, stop_action=action)


@pytest.mark.parametrize("seed", range(4))
def test_a_robot_whose_motors_are_released_only_slows_down(seed: int) -> None:
    lab = Lab(seed=seed)
    lab.run(seed, 1000)
    release(lab, seed)
    assert find_gains(lab, 400) == []
    assert all(motor.is_at_rest for motor in lab.motors)
