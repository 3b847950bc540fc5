"""Parts that only some robots and worlds have: checked when made, kept when written down, deterministic."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from tests.cases import for_rows
from tests.engine.core.memory_sink import MemorySink
from tests.engine.core.motors import commanded
from tuisim.base.errors import ConfigError
from tuisim.engine.core.profile import PROFILES, ROBOLAB
from tuisim.engine.core.remote_spec import BeaconSpec, RemotePress
from tuisim.engine.core.simulation import FurtherMotors, Simulation, Turn, build_simulation
from tuisim.engine.core.spec import (
    InfraredSpec,
    MotorSpec,
    NoiseSpec,
    Obstacle,
    RobotSpec,
    RunSpec,
    TouchSpec,
    UltrasonicSpec,
    WorldSpec,
)
from tuisim.engine.core.tick_record import TICK_RECORD
from tuisim.engine.core.tree import dump_run, load_run

ROBOT = RobotSpec(
    color_sensors=(),
    gyro=None,
    extra_motors=(MotorSpec("outA"), MotorSpec("outD", "large")),
    extra_ultrasonics=(UltrasonicSpec("behind", "in2", angle_deg=180.0),),
    touch_sensors=(TouchSpec(port="in3"),),
    infrared=InfraredSpec(port="in4"),
)
WORLD = WorldSpec(
    beacon=BeaconSpec(900.0, 500.0, 3),
    remote=(RemotePress(("top_left", "top_right"), 1.0, 2.0, 2),),
)
RUN = RunSpec(ROBOT, WORLD, ROBOLAB)

MISTAKES: dict[str, Callable[[], Any]] = {
    "kind of motor": lambda: MotorSpec("outA", "tiny"),
    "motor on a wheel's port": lambda: RobotSpec(extra_motors=(MotorSpec("outB"),)),
    "motor on no port": lambda: RobotSpec(extra_motors=(MotorSpec("outX"),)),
    "two motors on a port": lambda: RobotSpec(extra_motors=(MotorSpec("outA"), MotorSpec("outA"))),
    "low end above the start": lambda: MotorSpec("outA", low_deg=1.0),
    "high end below the start": lambda: MotorSpec("outA", high_deg=-1.0),
    "no room between the ends": lambda: MotorSpec("outA", low_deg=0.0, high_deg=0.0),
    "gear without teeth": lambda: RobotSpec(gear_ratio=0.0),
    "pressed by a wheel": lambda: replace(
        ROBOT, touch_sensors=(TouchSpec(port="in3", pressed_by="outB"),)
    ),
    "pressed by no motor": lambda: RobotSpec(
        ultrasonic=None, touch_sensors=(TouchSpec(pressed_by="outA", pressed_at="high"),)
    ),
    "pressed at no end": lambda: replace(
        ROBOT, touch_sensors=(TouchSpec(port="in3", pressed_by="outA"),)
    ),
    "pressed on no port": lambda: TouchSpec(pressed_by="in2"),
    "pressed in the middle": lambda: TouchSpec(pressed_at="middle"),
    "two sensors on a port": lambda: RobotSpec(touch_sensors=(TouchSpec(port="in2"),)),
    "sensor on no port": lambda: RobotSpec(gyro=None, infrared=InfraredSpec(port="in9")),
    "two sensors of a name": lambda: replace(ROBOT, touch_sensors=(TouchSpec("behind", "in3"),)),
    "sensor far away": lambda: TouchSpec(y_mm=9999.0),
    "no number": lambda: InfraredSpec(x_mm=float("nan")),
    "channel": lambda: BeaconSpec(0.0, 0.0, 5),
    "three buttons": lambda: RemotePress(("top_left", "bottom_left", "top_right")),
    "no button": lambda: RemotePress(()),
    "ends before it begins": lambda: RemotePress(("beacon",), 2.0, 1.0),
}


@for_rows("make", MISTAKES)
def test_impossible_parts_of_a_robot_are_refused(make: Callable[[], Any]) -> None:
    with pytest.raises(ConfigError):
        make()


HOMING = replace(
    ROBOT,
    extra_motors=(MotorSpec("outA", "medium", -90.0), MotorSpec("outD", "large", 0.0, 45.5)),
    touch_sensors=(TouchSpec(port="in3", pressed_by="outD", pressed_at="high"),),
    left_reversed=True,
    gear_ratio=0.5,
)
"""A robot with everything that says how its motors are built in."""


@pytest.mark.parametrize("robot", [ROBOT, HOMING], ids=["further parts", "mechanics"])
def test_a_stored_run_keeps_the_robots_parts(robot: RobotSpec) -> None:
    run = replace(RUN, robot=robot)
    assert load_run(json.loads(json.dumps(dump_run(run)))) == run


def test_default_values_are_left_out_of_a_stored_run() -> None:
    robot = dump_run(RUN)["robot"]
    assert not {"left_reversed", "right_reversed", "gear_ratio"} & robot.keys()
    assert (robot["extra_motors"][0], list(robot["touch_sensors"][0])) == (
        {"port": "outA", "kind": "medium"},
        ["name", "port", "x_mm", "y_mm", "width_mm"],
    )


@pytest.mark.parametrize("chunk", [1, 3, 7, 50, 1000])
def test_further_motors_go_the_same_way_however_the_ticks_are_divided(chunk: int) -> None:
    sim = build_simulation(RUN, MemorySink())
    arm, other = sim.others
    commanded(sim.left).run(300.0)
    commanded(arm).run_to(123.0, 400.0, backwards=False)
    commanded(other).run_until(-200.0, 77)
    ends = []
    while sim.tick < 300:
        sim.changed = False
        sim.advance(min(chunk, 300 - sim.tick), until_change=True)
        if sim.changed:
            ends.append(sim.tick)
    assert (arm.position_deg, arm.mode, other.mode, ends) == (123.0, 0, 0, [55, 77])
    assert (sim.pose.x_mm, sim.pose.heading_deg) == pytest.approx(_alone(), abs=0.0)


def _alone() -> tuple[float, float]:
    """Where the same robot gets to while no further motor runs."""
    sim = build_simulation(RUN, MemorySink())
    commanded(sim.left).run(300.0)
    sim.advance(300)
    return sim.pose.x_mm, sim.pose.heading_deg


@pytest.mark.parametrize("size_mm", [(0.0, 100.0), (100.0, 0.0), (100.0, -1.0)])
def test_an_obstacle_without_width_or_height_is_refused(size_mm: tuple[float, float]) -> None:
    with pytest.raises(ConfigError, match="must be above 0"):
        Obstacle(0.0, 0.0, *size_mm)


@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim"])
def test_recorded_turns_give_a_further_motors_position_at_any_tick(profile: str) -> None:
    sim = build_simulation(replace(RUN, profile=PROFILES[profile]), MemorySink())
    assert isinstance(sim, FurtherMotors)
    told: list[tuple[int, tuple[Turn, ...]]] = [(0, ((0.0, 0.0),) * 2)]
    sim.on_turns = lambda turns: told.append((sim.tick, turns))
    arm, lift = sim.others
    steps: dict[int, Callable[[], None]] = {
        0: lambda: commanded(arm).run(300.0),
        40: lambda: commanded(lift).run_to(-90.0, 100.0, backwards=True),
        60: lambda: commanded(arm).stop(),
        80: lambda: setattr(arm, "position_deg", 5.0),
        90: lambda: commanded(arm).run_until(-50.0, 150),
    }
    for tick in range(300):
        steps.get(tick, lambda: None)()
        sim.advance(1)
        at, turns = told[-1]
        since_s = (sim.tick - at) / sim.spec.profile.tick_hz
        # What was changed between two ticks is told with the next.
        for motor, (position, dps) in zip(sim.others, turns, strict=True):
            assert motor.position_deg == pytest.approx(position + dps * since_s, abs=0.3)
            assert motor.counting_dps == dps
    # Even turning is told once.
    assert len(told) < 100


@pytest.mark.parametrize("kind, limit_dps", [("large", 1050.0), ("medium", 1560.0)])
def test_noise_makes_a_wheel_no_faster_than_its_motor(kind: str, limit_dps: float) -> None:
    robot = RobotSpec(left_motor=kind, right_motor=kind, weight=0.0)
    sink = MemorySink()
    sim = Simulation(RunSpec(robot, WorldSpec(noise=NoiseSpec(0, 100)), ROBOLAB, seed=3), sink)
    for motor in (sim.left, sim.right):
        commanded(motor).run(limit_dps)
    sim.advance(100)
    speeds = [TICK_RECORD.unpack_from(sink.buffer, 64 * (tick + 1))[7] for tick in range(1, 101)]
    assert max(speeds) == limit_dps
