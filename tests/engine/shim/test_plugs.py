"""Programs that ask for parts which their text does not show: they are plugged in, the same in every run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import tuisim
from tests.engine.shim.late_programs import LATE_PROGRAMS, LateProgram
from tests.running import Done, over
from tuisim.commands.rerun import rerun
from tuisim.engine.runs.diff import diff_runs
from tuisim.engine.runs.frames import build_telemetry_columns
from tuisim.engine.runs.handle import RunHandle, RunOptions
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.store import RunStore
from tuisim.logs.export import export_telemetry
from tuisim.programs.plugged_words import list_parts
from tuisim.programs.program_file import find_program, read_program
from tuisim.programs.program_settings import build_program_settings
from tuisim.settings.build import build_run_spec
from tuisim.tasks.execute import execute
from tuisim.tasks.task import Keep, Task

LATE_TOUCH = """\
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
import ev3dev2.sensor.lego as lego
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on_for_seconds(20, 20, 0.5)
touch = getattr(lego, "".join(("Touch", "Sensor")))("in1")
print(touch.is_pressed)
"""
TAKEN = """\
from ev3dev2.sensor import INPUT_1
from ev3dev2.sensor.lego import UltrasonicSensor
import ev3dev2.sensor.lego as lego
far = UltrasonicSensor(INPUT_1)
getattr(lego, "".join(("Touch", "Sensor")))("in1")
"""
OPENED = """\
import ev3dev2.sensor.lego as lego
kinds = ["".join((kind, "Sensor")) for kind in ("Ultrasonic", "Touch")]
for kind in kinds:
    getattr(lego, kind)("in1")
"""
TRIED = """\
from ev3dev2 import DeviceNotFound
import ev3dev2.sensor.lego as lego
def look(kind):
    return getattr(lego, "".join((kind, "Sensor")))("in1")
for kind in ("Touch", "Infra" + "red"):
    try:
        look(kind)
    except DeviceNotFound:
        print("no", kind)
"""
TRIED_WIDELY = """\
import ev3dev2.sensor.lego as lego
kind = "".join(("Touch", "Sensor"))
def look():
    try:
        return getattr(lego, kind)("in1")
    except Exception:
        return None
def main():
    return getattr(lego, kind)("in1").is_pressed
print(look())
try:
    print(main())
except Exception as error:
    print(error)
"""
LISTED = """\
from ev3dev2.sensor import Sensor, list_sensors
print(sorted(sensor.driver_name for sensor in list_sensors()))
print(Sensor("in2").driver_name)
"""


def run_program(
    folder: Path, text: str, robot: str | None = None, of_many: bool = False, **options: Any
) -> Done:
    """Run a program from its file, as `tuisim run` does."""
    path = folder / "late.py"
    path.write_text(text, "utf-8")
    source = read_program(find_program(str(path)))
    found = build_program_settings(source, {} if robot is None else {"robot": robot})
    program = found.apply(source.program)
    spec = build_run_spec(found.settings)
    program = program.add_surroundings()
    how = RunOptions(time_limit_s=60.0, **options)
    return over(RunHandle(program, spec, field_files(spec), how, RunStore(), of_many=of_many))


def test_a_sensor_is_plugged_in_when_the_program_asks_for_it(home: Path, tmp_path: Path) -> None:
    done = run_program(tmp_path, LATE_TOUCH)
    assert (done.ended.end, done.lines) == ("finished", ["0"])
    (part,) = done.run.plugged
    assert (part.port, part.part, part.line, part.role) == ("in1", "TouchSensor", 5, "")
    stored = done.run.stored()
    assert stored.plugged == (part,)
    assert stored.first_spec.robot.ultrasonic is not None
    assert stored.spec.robot.ultrasonic is None
    assert [sensor.port for sensor in stored.spec.robot.touch_sensors] == ["in1"]


@pytest.mark.parametrize("text", [TAKEN, OPENED])
def test_a_sensor_asked_for_on_a_used_port_is_not_plugged_in(
    home: Path, tmp_path: Path, text: str
) -> None:
    done = run_program(tmp_path, text)
    assert done.run.plugged == []
    assert "DeviceNotFound: TouchSensor(in1) is not connected" in done.errors[-1]


def test_a_robot_chosen_by_name_gets_no_parts_plugged_in(home: Path, tmp_path: Path) -> None:
    done = run_program(tmp_path, LATE_TOUCH, robot="Default_Robot")
    assert done.run.plugged == []
    assert "DeviceNotFound" in done.errors[-1]


FOUR_WHEELS = """\
from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_B, OUTPUT_C, OUTPUT_D
front, rear = MoveTank(OUTPUT_A, OUTPUT_D), MoveTank(OUTPUT_B, OUTPUT_C)
front.on_for_rotations(30, 30, 1, block=False)
rear.on_for_rotations(30, 30, 1)
"""


def test_of_two_pairs_in_the_text_the_one_that_was_chosen_drives(
    home: Path, tmp_path: Path
) -> None:
    done = run_program(tmp_path, FOUR_WHEELS)
    assert (done.run.plugged, done.pose[0] - 1181 > 170) == ([], True)


def test_trying_for_a_part_inside_try_plugs_in_nothing(home: Path, tmp_path: Path) -> None:
    done = run_program(tmp_path, TRIED)
    assert (done.lines, done.run.plugged) == (["no Touch", "no Infrared"], [])


def test_a_handler_around_the_whole_program_is_no_trial(home: Path, tmp_path: Path) -> None:
    done = run_program(tmp_path, TRIED_WIDELY)
    assert done.lines == ["None", "0"]
    assert [part.line for part in done.run.plugged] == [9]


def test_listing_motors_or_sensors_plugs_in_nothing(home: Path, tmp_path: Path) -> None:
    done = run_program(tmp_path, LISTED)
    assert done.lines == [
        "['lego-ev3-color', 'lego-ev3-color', 'lego-ev3-gyro', 'lego-ev3-us']",
        "lego-ev3-color",
    ]
    assert done.run.plugged == []


def options(late: LateProgram) -> RunOptions:
    return RunOptions(time_limit_s=60.0, answers=late.answers)


def read_columns(done: Done) -> dict[str, list[float]]:
    """Return everything that telemetry exports."""
    return {
        name: values.tolist() for name, values in build_telemetry_columns(done.run.stored()).items()
    }


@pytest.mark.parametrize("late", LATE_PROGRAMS.values(), ids=LATE_PROGRAMS)
def test_a_program_that_asks_for_parts_late_runs_with_them_plugged_in(
    home: Path, tmp_path: Path, late: LateProgram
) -> None:
    done = run_program(tmp_path, late.text, answers=late.answers)
    assert (done.errors, tuple(sorted(done.lines))) == ([], tuple(sorted(late.prints)))
    assert list_parts(done.run.plugged) == late.parts


@pytest.mark.slow_cases("after a menu", "wheels too late")
@pytest.mark.parametrize("name", ["late, after driving", "wheels too late", "after a menu"])
def test_a_program_that_asks_for_parts_late_runs_the_same_in_every_way(
    home: Path, tmp_path: Path, name: str
) -> None:
    late = LATE_PROGRAMS[name]
    done = run_program(tmp_path, late.text, answers=late.answers)
    live = run_program(tmp_path, late.text, answers=late.answers, live=True, speed=16.0)
    again = over(rerun(done.run.stored(), RunStore(tmp_path / "again")))
    many = run_program(tmp_path, late.text, answers=late.answers, of_many=True)
    task = Task(0, done.run.program, done.run.first_spec, options(late), keep=Keep.ALL)
    row = execute(task, tmp_path)
    batch = RunStore().load_run(row.run_id)
    assert live.recording == again.recording == many.recording == done.recording
    assert diff_runs(done.run.stored(), batch).same
    assert (row.plugged, batch.plugged) == (late.parts, tuple(done.run.plugged))
    assert live.run.plugged == again.run.plugged == many.run.plugged == done.run.plugged
    assert read_columns(live) == read_columns(again) == read_columns(many) == read_columns(done)


def test_telemetry_exports_have_columns_also_of_parts_plugged_in_late(
    home: Path, tmp_path: Path
) -> None:
    late = LATE_PROGRAMS["late, after driving"]
    done = run_program(tmp_path, late.text)
    run = done.run.stored()
    target = tmp_path / "ticks.csv"
    export_telemetry(run, str(target))
    head, *rows = target.read_text("utf-8").splitlines()
    duty = head.split(",").index("motor_a_duty_pc")
    (part,) = run.plugged
    before = [row.split(",")[duty] for row in rows[: part.tick + 1]]
    assert {*before} == {"0.0"}
    assert any(row.split(",")[duty] != "0.0" for row in rows)


def test_simulate_names_the_parts_that_were_plugged_in(home: Path) -> None:
    late = LATE_PROGRAMS["by getattr"]
    assert f"plugged in {late.parts}" in tuisim.simulate(late.text).note


@pytest.mark.slow
def test_a_batch_that_varies_the_robot_names_it(home: Path, tmp_path: Path) -> None:
    late = LATE_PROGRAMS["by getattr"]
    path = tmp_path / "late.py"
    path.write_text(late.text, "utf-8")
    with pytest.warns(UserWarning, match="1 of 1 run raised"):
        named = tuisim.experiment(path, seeds=[0], parameters={"robot": ["Default_Robot"]}).loc[0]
    free = tuisim.experiment(path, seeds=[0]).loc[0]
    assert (named["end"], "plugged" in named) == ("raised", False)
    assert (free["end"], free["plugged"]) == ("finished", late.parts)
