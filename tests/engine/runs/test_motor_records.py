"""The file of what drivers know of the motors: written by a run, and read again."""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np
import pytest

from tests.running import Done, Run
from tuisim.base.errors import LogError
from tuisim.engine.runs.frames import compute_column_values
from tuisim.engine.runs.motor_records import read_motor_columns, read_motor_values
from tuisim.engine.runs.records import HEADER_BYTES, MOTORS_FILE

HOLD = """\
from ev3dev2.motor import LargeMotor, OUTPUT_B, SpeedDPS
from time import sleep
motor = LargeMotor(OUTPUT_B)
motor.on_for_degrees(SpeedDPS(700), 360)
sleep(0.5)
"""


@pytest.fixture
def hold(run: Run) -> Callable[..., Done]:
    return lambda **options: run(HOLD, profile="ev3", **options)


def test_the_motor_file_records_the_swing_back_of_a_held_motor(hold: Callable[..., Done]) -> None:
    done = hold()
    ticks = done.run.telemetry.array()["tick"]
    columns = read_motor_columns(done.run.folder, done.run.spec.robot, ticks)
    held = np.flatnonzero(columns["left_state"] == 4)
    assert columns["left_asked_dps"][held[0] - 1] == 700
    assert columns["left_asked_dps"][held].max() == 0
    assert columns["left_measured_dps"][held].min() < -100
    assert not columns["right_measured_dps"].any()
    values = read_motor_values(done.run.folder, done.run.spec, int(held[0]))
    assert len(values) == 2
    assert values[0] == tuple(
        int(columns[f"left_{name}"][held[0]])
        for name in ("asked_dps", "measured_dps", "duty_pc", "state")
    )


def test_the_motor_file_has_a_record_for_each_tick_and_repeats_exactly(
    hold: Callable[..., Done],
) -> None:
    first = hold()
    second = hold()
    path = first.run.folder / MOTORS_FILE
    assert path.stat().st_size == HEADER_BYTES + 16 * first.run.telemetry.count
    assert path.read_bytes() == (second.run.folder / MOTORS_FILE).read_bytes()


def test_a_profile_without_drivers_writes_no_file_of_motors(run: Run) -> None:
    done = run("x = 1\n", profile="robolab")
    assert not (done.run.folder / MOTORS_FILE).exists()
    assert read_motor_values(done.run.folder, done.run.spec, 0) == ()


def test_motor_columns_of_lost_records_are_missing(hold: Callable[..., Done]) -> None:
    done = hold()
    os.truncate(done.run.folder / MOTORS_FILE, HEADER_BYTES + 16 * 5 + 3)
    mat = done.run.field.open_field()
    columns = compute_column_values(
        ["left_duty_pc", "left_holding"], done.run.telemetry.array(), done.run, [], mat
    )
    for values in columns.values():
        assert not np.isnan(values[:5]).any()
        assert np.isnan(values[5:]).all()


def test_a_motor_file_of_another_format_is_refused(hold: Callable[..., Done]) -> None:
    done = hold()
    (done.run.folder / MOTORS_FILE).write_bytes(b"x" * 100)
    with pytest.raises(LogError, match="not a tuisim recording"):
        read_motor_columns(done.run.folder, done.run.spec.robot, done.run.telemetry.array()["tick"])
