"""A run that is worked out again takes the place of what its process has recorded."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tests.cases import cases
from tests.running import Run
from tuisim.base.errors import LogError
from tuisim.engine.protocol import SetButtons, UserAction
from tuisim.engine.runs import replay as replay_module
from tuisim.engine.runs.records import COMMANDS_FILE, HEADER_BYTES, TELEMETRY_FILE
from tuisim.engine.runs.replay import replay_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore

INSIDE = """\
import builtins, time
from ev3dev2.motor import *
cells = builtins.__loop_turn__.__closure__
session = next(c.cell_contents for c in cells if hasattr(c.cell_contents, "steering"))
MoveTank(OUTPUT_B, OUTPUT_C).on_for_seconds(30, 30, 0.5)
"""
"""Drives for half a second, and has hold of the session."""

Stored = Callable[..., StoredRun]


@pytest.fixture
def stored(run: Run) -> Stored:
    """`stored(text, …)`: run a program to its end, and return it as it is stored."""

    def finish(text: str, **how: object) -> StoredRun:
        done = run(INSIDE + text, prelude="none", **how)
        return RunStore().load_run(done.run.folder)

    return finish


PLACED = {
    "by the simulation": "session.sim.drive.x_mm = 1400.0",
    "by an action": (
        "from tuisim.engine.protocol import SetPose\n"
        "session.steering.apply(session, SetPose(1400.0, 500.0, 0.0))"
    ),
    "by a motor": "session.sim.left.position_deg = 5000.0",
    "by faster motors": "session.sim.left.run(9000.0)",
    "without friction": "session.sim.left.axle.speed_dps = 5000.0",
}


@cases("text", PLACED)
def test_a_replay_corrects_a_recording_changed_without_any_command(
    stored: Stored, text: str
) -> None:
    profile = "ev3" if "axle" in text else "robolab"
    told = stored(text + "\ntime.sleep(0.2)\n", profile=profile)
    honest = stored("\ntime.sleep(0.2)\n", profile=profile)
    ticks = len(told.telemetry.array())
    replayed, parted = replay_run(told, ())
    assert 0.4 < float(parted.removesuffix(" s")) < 0.8
    assert replayed.actions == ()
    assert len(replayed.telemetry.array()) == ticks
    common = min(ticks, len(honest.telemetry.array()))
    for name in ("x_mm", "left_position_deg", "actions"):
        ours, theirs = (run.telemetry.array()[name][:common] for run in (replayed, honest))
        assert np.array_equal(ours, theirs)
    again = RunStore().load_run(told.folder)
    assert replay_run(again, ())[1] == ""


def test_what_a_process_of_the_program_writes_into_the_replay_is_not_judged(
    stored: Stored, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = stored(PLACED["by the simulation"] + "\ntime.sleep(0.2)\n")
    real = replay_module._replace_files

    def replace_and_change(*parts: Any) -> None:
        real(*parts)
        with (run.folder / TELEMETRY_FILE).open("r+b") as file:
            file.seek(HEADER_BYTES + 64 * 30 + 8)
            file.write(b"\0" * 8)

    monkeypatch.setattr(replay_module, "_replace_files", replace_and_change)
    with pytest.raises(LogError, match="was changed after its end"):
        replay_run(run, ())


@pytest.mark.parametrize("profile", ["robolab", "ev3", "nbev3devsim"])
def test_replaying_an_honest_run_changes_nothing(stored: Stored, profile: str) -> None:
    actions: Sequence[UserAction] = (UserAction(10, SetButtons(("left",))),)
    run = stored("time.sleep(0.3)\n", profile=profile, actions=actions)
    assert replay_run(run, actions) == (run, "")


def test_a_replay_removes_a_user_action_forged_by_the_program(stored: Stored) -> None:
    run = stored(
        "session.steering._write_down(3, __import__('tuisim.engine.protocol', fromlist=['*']).SetPen(True))\n"
    )
    assert len(run.actions) == 1
    replayed, parted = replay_run(run, ())
    assert parted and replayed.actions == ()
    assert RunStore().load_run(run.folder).actions == ()


def test_a_replay_refuses_missing_or_surplus_command_records(stored: Stored) -> None:
    run = stored("")
    (run.folder / COMMANDS_FILE).rename(run.folder / "elsewhere")
    with pytest.raises(LogError, match="no record of what the program did"):
        replay_run(run, ())
    shutil.copy(run.folder / "elsewhere", run.folder / COMMANDS_FILE)
    with (run.folder / COMMANDS_FILE).open("r+b") as file:
        file.seek(16)
        file.write(b"\xff\xff")
    with pytest.raises(LogError, match=r"gave more than \d+ commands"):
        replay_run(run, ())


def test_a_replay_refuses_parts_that_differ_from_those_reported(stored: Stored) -> None:
    run = stored("")
    told = replace(run.spec, robot=replace(run.spec.robot, gyro=None))
    with pytest.raises(LogError, match="parts differ from those that the program has reported"):
        replay_run(replace(run, spec=told), ())
