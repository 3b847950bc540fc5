"""Where something solid stopped the robot, found in the recording."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import pytest

from tests.cases import cases
from tests.engine.core.motors import commanded
from tests.engine.runs.run_recorder import Recorder
from tuisim.app.run_update import describe_contacts
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import NoiseSpec, Obstacle, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.contacts import find_standstill, has_left_field

Record = Callable[..., Recorder]

ROBOT = RobotSpec(weight=0.0)
WALL = WorldSpec(start=Pose(2117.0, 571.5, 0.0), solid=True)
"""The wall is 200 mm before the robot."""
BOX = replace(WALL, start=Pose(500.0, 571.5, 0.0), obstacles=(Obstacle(745.0, 500.0, 50.0, 143.0),))
SPEC = RunSpec(ROBOT, WALL, PROFILES["ev3"])

ON = (400.0, 400.0)
BACK = (-400.0, -400.0)
STOP = None
"""At 400 °/s the robot needs 102.3 ticks to the wall."""

PUSHED = "stood at the wall from 1.05 s on, its wheels pushed for 0.9 s"

Moves = Sequence[tuple[tuple[float, float] | None, int]]


def words(record: Record, spec: RunSpec, moves: Moves) -> str:
    """Return what is said of a run of these speeds, each for some ticks."""
    recorder = record(spec)
    for speeds, ticks in moves:
        if speeds is None:
            commanded(recorder.simulation.left).stop()
            commanded(recorder.simulation.right).stop()
            recorder.simulation.advance(ticks)
        else:
            recorder.drive(*speeds, ticks)
    run = recorder.end()
    return describe_contacts(run.telemetry, run.spec)


SAID: dict[str, tuple[RunSpec, Moves, str]] = {
    "to the end": (SPEC, [(ON, 200)], PUSHED),
    "motors stop there": (SPEC, [(ON, 200), (STOP, 99)], PUSHED),
    "drives away": (
        SPEC,
        [(ON, 200), (STOP, 50), (BACK, 50)],
        "stood at the wall from 1.05 s to 2.50 s, its wheels pushed for 0.9 s",
    ),
    "pushes again where it is": (
        SPEC,
        [(ON, 200), (STOP, 50), (ON, 100)],
        "stood at the wall from 1.05 s on, its wheels pushed for 1.9 s",
    ),
    "comes again": (
        SPEC,
        [(ON, 200), (BACK, 50), (ON, 150)],
        "stood at the wall 2 times, first at 1.05 s, its wheels pushed for 2.0 s in all",
    ),
    "an obstacle": (
        replace(SPEC, world=BOX),
        [(ON, 200)],
        "stood at an obstacle from 1.05 s on, its wheels pushed for 0.9 s",
    ),
    "an obstacle without walls": (
        replace(SPEC, world=replace(BOX, walls=False)),
        [(ON, 200)],
        "stood at an obstacle from 1.05 s on, its wheels pushed for 0.9 s",
    ),
    "in the browser simulator": (
        replace(SPEC, profile=PROFILES["nbev3devsim"]),
        [(ON, 60)],
        "stood at the wall from 1.03 s on, its wheels pushed for 1.0 s",
    ),
    "reversed": (
        replace(SPEC, robot=replace(ROBOT, left_reversed=True)),
        [((-400.0, 400.0), 200)],
        PUSHED,
    ),
    "on a floor": (
        replace(SPEC, world=replace(WALL, floor=True)),
        [(ON, 200)],
        "stood at the wall for 0.9 s; --walls off takes the walls away",
    ),
    "an obstacle on a floor": (
        replace(SPEC, world=replace(BOX, floor=True)),
        [(ON, 200)],
        "stood at an obstacle from 1.05 s on, its wheels pushed for 0.9 s",
    ),
    "too short to stall": (SPEC, [(ON, 110), (STOP, 50)], ""),
    "does not get there": (SPEC, [(ON, 100), (STOP, 50)], ""),
    "speed 0 in the open": (SPEC, [((0.0, 0.0), 100)], ""),
    "nothing is solid": (replace(SPEC, world=replace(WALL, solid=False)), [(ON, 200)], ""),
    "no tick": (SPEC, [], ""),
}


@cases("spec, moves, said", SAID)
def test_a_robot_that_stood_at_the_wall_is_described(
    record: Record, spec: RunSpec, moves: Moves, said: str
) -> None:
    assert words(record, spec, moves) == said


@pytest.mark.parametrize(
    ("walls", "floor", "ticks", "has_left"),
    [(False, True, 200, True), (False, True, 50, False), (False, False, 200, False)],
)
def test_a_robot_leaves_the_field_for_an_open_floor(
    record: Record, walls: bool, floor: bool, ticks: int, has_left: bool
) -> None:
    recorder = record(replace(SPEC, world=replace(WALL, walls=walls, floor=floor)))
    recorder.drive(*ON, ticks)
    run = recorder.end()
    assert has_left_field(run.telemetry, run.spec) == has_left


def test_noise_that_lets_the_wheels_turn_a_little_does_not_hide_that_they_push(
    record: Record,
) -> None:
    recorder = record(replace(SPEC, world=replace(WALL, noise=NoiseSpec(0, 50))))
    recorder.drive(*ON, 400)
    run = recorder.end()
    found = find_standstill(run.telemetry, run.spec)
    assert found is not None
    assert found.since_s == pytest.approx(1.03, abs=0.05)
    assert 1.0 < found.pushed_s < 3.0
