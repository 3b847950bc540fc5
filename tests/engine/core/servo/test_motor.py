"""Servo motors in the simulation: the same to the last bit however ticks are divided, with and without obstacles."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from tests.cases import for_each
from tests.engine.core.memory_sink import MemorySink
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.motors import STOPPED, TIMED
from tuisim.engine.core.profile import PROFILES, ProfileSpec
from tuisim.engine.core.servo.control import Ending
from tuisim.engine.core.servo.drive_base import DriveBase
from tuisim.engine.core.servo.motor import ServoMotor
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import Obstacle, RobotSpec, RunSpec, WorldSpec

PROFILE = PROFILES["lego-micropython"]
WORLD = WorldSpec(start=Pose(600, 500, 0), solid=True)
WALLED = replace(WORLD, obstacles=(Obstacle(900, 500, 40, 800),))


class Robot:
    """A robot in a world, whose drive base and motors get commands."""

    def __init__(self, world: WorldSpec, profile: ProfileSpec = PROFILE) -> None:
        self.sink = MemorySink()
        self.sim = Simulation(RunSpec(RobotSpec(), world, profile), self.sink)
        left, right = self.sim.left, self.sim.right
        assert isinstance(left, ServoMotor) and isinstance(right, ServoMotor)
        self.motors = left, right
        self.base = DriveBase(left, right, 56, 120, lambda: 0.0)

    @property
    def now_us(self) -> int:
        return self.sim.tick * 10_000

    def command(self, chance: random.Random) -> None:
        """Give any command, some milliseconds after a tick."""
        now_us = self.now_us + chance.randrange(10) * 1000
        motor = chance.choice(self.motors)
        match chance.randrange(9):
            case 0:
                self.base.move(now_us, chance.randrange(-300, 301), chance.choice((0, 0, 90, -37)))
            case 1:
                self.base.drive(now_us, chance.randrange(-200, 201), chance.randrange(-90, 91))
            case 2:
                self.base.stop(now_us, chance.choice((None, 0, 4000)))
            case _:
                self.base.stop(now_us, None)
                self._command_motor(now_us, motor, chance)

    def _command_motor(self, now_us: int, motor: ServoMotor, chance: random.Random) -> None:
        match chance.randrange(6):
            case 0 | 1:
                settings = motor.control.settings
                rate = chance.randrange(-1600, 1601)
                if chance.random() < 0.5:
                    motor.control.run(
                        now_us, motor.measure_start, rate, settings.acceleration, 700_000
                    )
                else:
                    motor.control.run(now_us, motor.measure_start, rate, settings.acceleration)
                motor.follow(ending=chance.choice((Ending.COAST, Ending.BRAKE, Ending.HOLD)))
            case 2:
                motor.control.hold(now_us, chance.randrange(-500_000, 500_000))
                motor.follow()
            case 3:
                motor.run_freely(now_us, chance.choice((None, 0, -9000, 6000)))
            case 4:
                target = chance.randrange(-900, 900)
                rate = chance.randrange(50, 2000)
                relative = chance.random() < 0.5
                settings = motor.control.settings
                motor.control.move_to_position(
                    now_us,
                    motor.measure_start,
                    target,
                    rate,
                    settings.acceleration,
                    relative=relative,
                )
                motor.follow(ending=chance.choice((Ending.COAST, Ending.BRAKE, Ending.HOLD)))
            case _:
                motor.set_position(now_us, chance.randrange(-90_000, 90_000))


@for_each(world=[WORLD, WALLED], seed=range(8))
def test_motor_records_do_not_depend_on_how_ticks_are_grouped(world: WorldSpec, seed: int) -> None:
    records = []
    for at_once in (True, False):
        robot = Robot(world, PROFILES["pybricks4" if seed % 2 else "lego-micropython"])
        chance = random.Random(seed)
        for _ in range(25):
            robot.command(chance)
            ticks = chance.choice((1, 2, 7, 60, 150))
            if at_once:
                robot.sim.advance(ticks)
            else:
                for _ in range(ticks):
                    robot.sim.tick_once()
        records.append(robot.sink.records())
    assert records[0] == records[1]


def test_a_drive_base_released_from_holding_has_speed_0() -> None:
    robot = Robot(WORLD)
    robot.base.drive(robot.now_us, 300, 0)
    robot.sim.advance(100)
    robot.base.move(robot.now_us, 0, 0)
    robot.base.stop(robot.now_us, None)
    assert robot.base.find_rates(robot.now_us) == (0, 0)


def test_a_robot_blocked_at_a_wall_can_drive_back() -> None:
    robot = Robot(WALLED)
    robot.base.drive(robot.now_us, 200, 0)
    while not robot.motors[0].blocked_ticks:
        robot.sim.tick_once()
    at_mm = robot.sim.drive.x_mm
    # The move turns round: the way out of the motion before leads into the wall.
    robot.base.move(robot.now_us, -100, 0)
    robot.sim.advance(300)
    assert robot.sim.drive.x_mm == pytest.approx(at_mm - 100, abs=10)
    assert robot.base.done(robot.now_us)


@pytest.mark.parametrize("ending", [Ending.COAST, Ending.BRAKE, Ending.HOLD])
def test_a_motion_for_a_time_ends_at_a_wall(ending: Ending) -> None:
    robot = Robot(WALLED)
    for motor in robot.motors:
        motor.control.run(robot.now_us, motor.measure_start, 1000, 3200, 4_000_000)
        motor.follow(ending=ending)
    robot.sim.advance(399)
    assert [motor.mode for motor in robot.motors] == [TIMED, TIMED]
    robot.sim.advance(2)
    at_deg = robot.motors[0].position_deg
    assert [motor.mode for motor in robot.motors] == [STOPPED, STOPPED]
    assert all((motor.guide is None) == (ending is not Ending.HOLD) for motor in robot.motors)
    # It holds where it is, and does not push on when the way is free.
    robot.sim.place(Pose(300, 500, 0))
    robot.sim.advance(50)
    assert (robot.motors[0].position_deg, robot.sim.drive.x_mm) == (at_deg, 300)


@pytest.mark.parametrize(
    ("profile", "seed", "given"),
    [
        (
            "lego-micropython",
            5,
            "81661 58561 12843 25295 27879 56967 22434 27362 163 46 0 0 66 74402575 78795859 83041 79727",
        ),
        (
            "pybricks4",
            3,
            "40386 143490 8479 70415 26229 44778 17551 23630 141 69 0 1 196 181567406 135570460 58965 50991",
        ),
    ],
)
def test_random_commands_move_motors_as_recorded(profile: str, seed: int, given: str) -> None:
    robot = Robot(WALLED, PROFILES[profile])
    chance = random.Random(seed)
    rows = []
    for _ in range(150):
        robot.command(chance)
        robot.sim.advance(chance.choice((1, 2, 7, 60, 150)))
        left, right = robot.motors
        pose = robot.sim.pose
        soon_us = robot.now_us + 3000
        rows.append(
            (
                *(pose.x_mm, pose.y_mm, pose.heading_deg, left.position_deg, right.position_deg),
                *(left.counts_per_s, left.moving_dps, left.aim_dps, left.mode),
                *(left.resting, left.control.stalled, robot.base.stalled, left.blocked_ticks),
                *(*robot.base.find_millis(soon_us), *robot.base.find_rates(soon_us)),
            )
        )
    sums = [sum(map(abs, values)) for values in zip(*rows, strict=True)]
    assert sums == pytest.approx(list(map(int, given.split())), abs=0.6)
