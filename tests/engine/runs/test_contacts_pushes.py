"""Where something solid pushed a turning robot aside, found in the recording."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tests.cases import cases
from tests.engine.runs.run_recorder import Recorder
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.core.spec import NoiseSpec, Obstacle, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.contacts import find_push

WORLD = WorldSpec(start=Pose(82.0, 500.0, 180.0), solid=True)
"""A corner meets the wall in a quarter turn to the right."""
SPEC = RunSpec(RobotSpec(weight=0.0), WORLD, PROFILES["ev3"])
OPEN = replace(WORLD, start=Pose(500.0, 500.0, 180.0))
BOX = replace(OPEN, obstacles=(Obstacle(318.0, 400.0, 100.0, 200.0),))
"""An obstacle in place of the wall."""
SLIPS = DriftSpec(wheel_pc=1.0, spacing_pc=2.0, slip_pc=2.0, turn_slip_pc=3.0, backlash_deg=6.0)
PUSHED = "was pushed 28 mm aside by the wall while it turned, from 0.39 s to 1.03 s"

Speeds = tuple[float, float]
TURN: Speeds = (210.0, -210.0)

SAID: dict[str, tuple[RunSpec, Speeds, str]] = {
    "turns on the spot": (SPEC, TURN, PUSHED),
    "reversed": (
        replace(SPEC, robot=replace(SPEC.robot, left_reversed=True)),
        (-210.0, -210.0),
        PUSHED,
    ),
    "an obstacle": (
        replace(SPEC, world=BOX),
        TURN,
        "was pushed 28 mm aside by an obstacle while it turned, from 0.39 s to 1.03 s",
    ),
    "in the open": (replace(SPEC, world=OPEN), TURN, ""),
    "errors of wheels in the open": (
        replace(SPEC, world=replace(OPEN, noise=NoiseSpec(0, 50), drift=SLIPS)),
        TURN,
        "",
    ),
    "drives at the wall": (SPEC, (400.0, 400.0), ""),
    "drives along the wall": (
        replace(SPEC, world=replace(WORLD, start=Pose(61.0, 500.0, 90.0))),
        (400.0, 400.0),
        "",
    ),
    "no walls": (replace(SPEC, world=replace(WORLD, walls=False)), TURN, ""),
    "nothing is solid": (replace(SPEC, world=replace(WORLD, solid=False)), TURN, ""),
}


@cases("spec, speeds, said", SAID)
def test_a_turn_that_a_wall_pushed_aside_is_described_and_a_free_one_not(
    record: Callable[..., Recorder], spec: RunSpec, speeds: Speeds, said: str
) -> None:
    recorder = record(spec)
    recorder.drive(*speeds, 120)
    run = recorder.end()
    push = find_push(run.telemetry, run.spec)
    assert (push.words if push else "") == said


def test_slipping_wheels_do_not_hide_that_a_wall_pushed_the_robot(
    record: Callable[..., Recorder],
) -> None:
    recorder = record(replace(SPEC, world=replace(WORLD, drift=SLIPS)))
    recorder.drive(*TURN, 120)
    run = recorder.end()
    push = find_push(run.telemetry, run.spec)
    assert push is not None
    assert 20 < push.aside_mm < 36


def test_a_hand_that_moves_a_turning_robot_to_the_wall_is_no_push(
    record: Callable[..., Recorder],
) -> None:
    recorder = record(replace(SPEC, world=OPEN))
    recorder.drive(*TURN, 20)
    recorder.simulation.place(Pose(82.0, 500.0, 180.0))
    recorder.drive(-210.0, 210.0, 5)
    run = recorder.end()
    assert find_push(run.telemetry, run.spec) is None
