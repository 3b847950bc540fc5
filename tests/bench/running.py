"""Programs to measure, and how they are run."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import AbstractContextManager
from types import MappingProxyType
from unittest.mock import patch

from tests.bench.processes import children_cpu_s
from tests.bench.sampling import measured
from tuisim.base.source import Program
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

EMPTY = "pass\n"

LOG = """\
import time
speed = 10
while True:
    tank_drive.on(SpeedPercent(speed), SpeedPercent(speed))
    for reading in range(150):
        sensor_val = colorLeft.reflected_light_intensity_pc
        print('Colour: ' + str(sensor_val))
        time.sleep(0.1)
    speed = -speed
"""
"""Forwards and back, a reading and a printed line every 0.11 s."""

LINE = """\
while True:
    left = colorLeft.reflected_light_intensity
    right = colorRight.reflected_light_intensity
    turn = (left + right) / 255 - 1
    tank_drive.on(SpeedPercent(20 + 20 * turn), SpeedPercent(20 - 20 * turn))
"""
"""With the edge of a broad line between the sensors, nothing in the loop but reading and steering."""

TWIN = """\
from {imports}
while True:
    turn = (left.{reading} + right.{reading}) / 100 - 1
    {drive}
"""
TWINS = {
    "ev3": TWIN.format(
        imports="ev3dev2.motor import MoveTank\nfrom ev3dev2.sensor.lego import ColorSensor\n"
        "base, left, right = MoveTank('outB', 'outC'), ColorSensor('in2'), ColorSensor('in3')",
        reading="reflected_light_intensity",
        drive="base.on(20 + 20 * turn, 20 - 20 * turn)",
    ),
    "lego-micropython": TWIN.format(
        imports="pybricks.ev3devices import ColorSensor, Motor\nfrom pybricks.parameters import Port\n"
        "from pybricks.robotics import DriveBase\n"
        "base = DriveBase(Motor(Port.B), Motor(Port.C), 56, 180)\n"
        "left, right = ColorSensor(Port.S2), ColorSensor(Port.S3)",
        reading="reflection()",
        drive="base.drive(100, 65 * turn)",
    ),
}
"""The line follower for each library, by the profile."""

MOVES = """\
while True:
    tank_drive.on_for_rotations(50, 50, 1)
    tank_turn.on_for_rotations(-100, 40, 1)
    tank_drive.on_for_seconds(-30, -30, 1)
"""
"""Straight on, on the spot, and back for a time."""


def spec_of(
    mat: str = "Grey_bands",
    profile: str = "robolab",
    values: Mapping[str, int] = MappingProxyType({}),
) -> RunSpec:
    """Return what a program is run with; further values by their path."""
    return build_run_spec(Settings({"background": mat, "profile": profile, **values}))


def begin(
    text: str,
    mat: str = "Grey_bands",
    profile: str = "robolab",
    prelude: str = "preloaded",
    *,
    options: RunOptions,
) -> RunHandle:
    """Start a program, as the headless command or the app does."""
    return start_run(Program("bench.py", text, prelude), spec_of(mat, profile), options)


def started_by_itself() -> AbstractContextManager[object]:
    """Start children by themselves in the block, as the first one of a process is started.

    Then they are children of this process, and their CPU time is known when they have ended.
    """
    return patch.object(process, "_fork", lambda *_: None)


def run_cpu_s(text: str, spec: RunSpec, options: RunOptions, prelude: str = "preloaded") -> float:
    """Run a program to its end, or to the limit of simulated time; return the CPU seconds of its process."""
    with started_by_itself():
        before = children_cpu_s()
        handle = start_run(Program("bench.py", text, prelude), spec, options)
        ended = handle.wait()
    assert ended is not None and ended.end in ("time_limit", "finished"), ended
    return measured(children_cpu_s() - before, "CPU time of a run")


def simulating_cpu_s(
    text: str, spec: RunSpec, options: RunOptions, prelude: str = "preloaded"
) -> float:
    """Return the CPU seconds that a run takes beyond those of an empty program, which runs first."""
    started_s = run_cpu_s(EMPTY, spec, RunOptions(), prelude)
    return measured(
        run_cpu_s(text, spec, options, prelude) - started_s, "CPU time beyond the start of a run"
    )
