"""What a recording shows of its last tick: the values after the program's last commands."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import Run
from tuisim.engine.core.commands.calls import Call, SimulationCommand
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import MotorLaw
from tuisim.engine.core.state import Instant
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runs.tick_changes import apply_commands, find_pen

DRIVE = "import time\ntank_drive.on(30, 30)\ntime.sleep(0.3)\n"
MOTORS = """\
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
from pybricks.tools import wait
left, right = Motor(Port.B), Motor(Port.C)
left.run(300)
right.run(300)
wait(303)
"""
STILL, STOPPING, LAST = "still set to turn", "stopping", "last speeds"
ENDS: dict[str, tuple[str, str, bool, str]] = {
    "not stopped": (DRIVE, "robolab", True, STILL),
    "stopped": (f"{DRIVE}tank_drive.off()", "robolab", False, STOPPING),
    "stopped under nbev3devsim": (f"{DRIVE}tank_drive.off()", "nbev3devsim", False, STOPPING),
    "not stopped under ev3": (DRIVE, "ev3", True, STILL),
    "stopped under ev3": (f"{DRIVE}tank_drive.off()", "ev3", False, STOPPING),
    "one stopped": (f"{DRIVE}tank_drive.left_motor.off()", "robolab", False, STILL),
    "not stopped with Pybricks": (MOTORS, "pybricks4", True, STILL),
    "stopped with Pybricks": (f"{MOTORS}left.stop()\nright.brake()", "pybricks4", True, STOPPING),
    "a move with Pybricks": (
        f"{MOTORS}for motor in (left, right): motor.run_angle(300, 90, wait=False)",
        "pybricks4",
        True,
        LAST,
    ),
}


def open_end(run: Run, text: str, profile: str) -> tuple[Recording, Instant]:
    """Run a program, and return its recording with the instant of the end."""
    prelude = "none" if profile == "pybricks4" else "preloaded"
    done = run(text, profile=profile, prelude=prelude)
    stored = RunStore().load_run(done.run.run_id)
    recording = Recording(stored)
    recording.commands.read_all()
    record = recording.telemetry.last()
    assert record is not None
    return recording, recording.read_instant(record, stored.spec, stored.spec.world.noise)[0]


@cases("text, profile, turns, words", ENDS)
def test_the_end_tells_a_program_that_stops_its_motors_from_one_that_does_not(
    run: Run, text: str, profile: str, turns: bool, words: str
) -> None:
    recording, end = open_end(run, text, profile)
    assert (abs(end.left_speed_dps) > 100) is turns
    assert recording.commands.describe_wheels() == words


@pytest.mark.parametrize("profile", ["robolab", "nbev3devsim", "ev3"])
def test_a_position_that_the_last_line_sets_is_shown(run: Run, profile: str) -> None:
    text = f"{DRIVE}tank_drive.left_motor.position = 7\n"
    _, end = open_end(run, text, profile)
    assert end.left_position_deg == pytest.approx(7, abs=9 * (profile == "ev3"))
    assert end.right_position_deg > 30


def test_a_finished_move_has_no_speed_in_the_tick_of_its_end(run: Run) -> None:
    _, end = open_end(run, "tank_drive.on_for_rotations(30, 30, 0.1)", "robolab")
    assert (end.left_position_deg, end.left_speed_dps) == (36.0, 0.0)


def test_a_finished_turn_has_no_gyro_rate_in_the_tick_of_its_end(run: Run) -> None:
    _, end = open_end(run, "tank_turn.on_for_degrees(100, SpeedPercent(40), 300)", "robolab")
    assert (end.left_speed_dps, end.gyro_rate_dps) == (0.0, 0)


def test_commands_of_a_tick_apply_in_order_and_damaged_ones_do_not() -> None:
    before = Instant(
        3, Pose(0, 0, 90), 10.0, 20.0, 5.0, 6.0, gyro_zero_deg=50.0, scales=(-1.0, 0.5)
    )

    def given(part: int, call: Call, *values: float) -> SimulationCommand:
        return SimulationCommand(0, part, call, (*values, *(0.0,) * (7 - len(values))))

    commands = [
        given(0, Call.SET_MILLI, 4000.0),
        given(1, Call.SET_UP, 1.0, 2.0, 1.0),
        given(1, Call.RENUMBER, 8.0),
        given(1, Call.RENUMBER, float("nan")),
        given(9, Call.SET_COUNT, 8.0),
        given(0, Call.SET_GYRO, 10.0),
        given(0, Call.MOVE_PEN, 1.0),
    ]
    after = apply_commands(before, (True, True), commands, MotorLaw.PYBRICKS)
    assert (after.left_position_deg, after.right_position_deg, after.gyro_deg) == (-2.0, 8.0, 10)
    assert find_pen(commands, is_down=False) and not find_pen([], is_down=False)
    reset = apply_commands(before, (True, True), [given(0, Call.RESET_DRIVER)], MotorLaw.EV3DEV)
    assert (reset.left_position_deg, reset.left_speed_dps) == (0.0, 5.0)
