"""Columns of motors: they have the values that the program reads, whichever way it counts."""

from __future__ import annotations

from pathlib import Path

import pytest

import tuisim
from tests.cases import cases
from tuisim.engine.runs.samples import list_samples
from tuisim.logs.derived import build_reckoned_series
from tuisim.logs.export import export_telemetry
from tuisim.logs.reader import build_telemetry_log, open_log

INVERSED = """\
import time
from ev3dev2.motor import LargeMotor, OUTPUT_B, OUTPUT_C
left, right = LargeMotor(OUTPUT_B), LargeMotor(OUTPUT_C)
left.on(30)
right.on(20)
for number in range(30):
    time.sleep(0.05)
    if number in (10, 20):
        left.polarity = "normal" if number > 10 else "inversed"
        time.sleep(0.05)
    print("left:", left.position)
    print("right:", right.position)
"""
COUNTERCLOCKWISE = """\
from pybricks.hubs import PrimeHub
from pybricks.pupdevices import Motor
from pybricks.parameters import Direction, Port
from pybricks.tools import wait
left, right = Motor(Port.A, Direction.COUNTERCLOCKWISE), Motor(Port.B, gears=[12, 36])
left.run(300)
right.run(100)
for number in range(30):
    wait(50)
    print("left:", left.angle())
    print("right:", right.angle())
"""
PROGRAMS = {
    "polarity, course": (INVERSED, "robolab"),
    "polarity, driver": (INVERSED, "ev3"),
    "direction and gears": (COUNTERCLOCKWISE, "pybricks4"),
}


@cases("text, profile", PROGRAMS)
def test_motor_columns_have_the_values_that_the_program_reads(text: str, profile: str) -> None:
    run = tuisim.simulate(text, profile=profile, preload="none")
    columns = run.telemetry
    samples = list_samples(run.stored.output.rows())
    assert len(samples) == 60
    for sample in samples:
        position_deg = columns[f"{sample.name}_position_deg"][sample.tick]
        assert position_deg == pytest.approx(sample.value, abs=8)
    last_row = columns.iloc[-1]
    assert last_row["left_speed_dps"] > 0
    if profile == "ev3":
        assert last_row["left_measured_dps"] > 0
        halfway = columns.iloc[80]
        assert max(halfway["left_measured_dps"], halfway["left_duty_pc"]) < 0


@cases("text, profile", PROGRAMS)
def test_dead_reckoning_from_reversed_or_geared_motors_has_no_error(
    text: str, profile: str, tmp_path: Path
) -> None:
    stored = tuisim.simulate(text, profile=profile, preload="none").stored
    path = tmp_path / "run.csv"
    export_telemetry(stored, path)
    logs = build_telemetry_log(stored), open_log(path)
    errors_mm = [build_reckoned_series(log)[-1].values.tolist() for log in logs]
    assert errors_mm[0] == errors_mm[1]
    assert max(errors_mm[0]) < 5
