"""Programs to measure, and how they are run."""

from __future__ import annotations

from contextlib import AbstractContextManager
from unittest.mock import patch

from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.runs.child import process
from tuisim.runs.handle import RunHandle, RunOptions, start_run
from tuisim.runs.store import RunStore
from tuisim.source import Program

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

MOVES = """\
while True:
    tank_drive.on_for_rotations(50, 50, 1)
    tank_turn.on_for_rotations(-100, 40, 1)
    tank_drive.on_for_seconds(-30, -30, 1)
"""
"""Straight on, on the spot, and back for a time."""


def unpacked_store() -> RunStore:
    """Return the store, without packing runs when they end: that is a child process, too, and would be counted."""
    return RunStore(RunStore().home)


def begin(
    text: str, mat: str = "Grey_bands", profile: str = "robolab", prelude: str = "preloaded", *, options: RunOptions
) -> RunHandle:
    """Start a program, as the headless command or the app does."""
    spec = build_run_spec(Settings(background=mat, profile=profile))
    return start_run(Program("bench.py", text, prelude), spec, options, unpacked_store())


def started_by_itself() -> AbstractContextManager[object]:
    """Start children by themselves in the block, as the first one of a process is started."""
    return patch.object(process, "_fork", lambda *_: None)
