"""The contract of every line of `SENSORS`: a sensor that is in the table is known wherever sensors matter."""

from __future__ import annotations

import json
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.engine.runtime.debugging import Driver
from tuisim.app.setup.fields import find
from tuisim.app.setup.next_run import plan_spec
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.sensors import SENSORS, SensorKind, build_mounted_sensor
from tuisim.engine.core.spec import MOUNTS, Mount, RobotSpec, RunSpec, SensorSpec, WorldSpec
from tuisim.engine.core.tree import dump_run, load_run
from tuisim.engine.protocol import Resume
from tuisim.engine.runs.frames import MOTION_COLUMNS, build_telemetry_frame
from tuisim.engine.runs.handle import RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.engine.shim.sensors import DEVICES
from tuisim.settings.robots import RobotChoice, save_robot

each_kind = cases("kind", SENSORS)
each_mount = pytest.mark.parametrize("mount", MOUNTS, ids=lambda mount: mount.field)

NONE: dict[str, Any] = {mount.field: () if mount.many else None for mount in MOUNTS}
READS_ALL = """
import time
from ev3dev2.sensor import Sensor
time.sleep(0.02)
sensor = Sensor()
print(sensor.driver_name)
for mode in sensor.modes:
    sensor.mode = mode
    print(mode, [sensor.value(n) for n in range(sensor.num_values)])
print('done')
"""


def sensor_of(mount: Mount) -> Any:
    """A sensor that may stand there, as it comes."""
    usual = RobotSpec().list_sensors(mount)
    return usual[0] if usual else mount.spec()


def robot_with(mount: Mount, *sensors: SensorSpec) -> RobotSpec:
    """A robot with no other sensors than these."""
    return RobotSpec(**{**NONE, mount.field: sensors if mount.many else sensors[0]})


def mount_of(kind: SensorKind) -> Mount:
    return next(mount for mount in MOUNTS if mount.spec is kind.spec)


def run_of(robot: RobotSpec) -> RunSpec:
    return RunSpec(robot, WorldSpec("Grey_bands", start=Pose(325.0, 500.0, 0.0)), ROBOLAB)


def test_every_kind_has_a_place_on_the_robot_and_a_device() -> None:
    kinds = {kind.spec for kind in SENSORS.values()}
    assert len(kinds) == len(SENSORS)
    assert {mount.spec for mount in MOUNTS} == kinds == set(DEVICES)
    assert len({mount.key for mount in MOUNTS}) == len(MOUNTS)
    assert {mount.field for mount in MOUNTS} <= {field.name for field in fields(RobotSpec)}


@each_mount
def test_a_stored_run_keeps_each_sensor_of_its_robot(mount: Mount) -> None:
    run = run_of(robot_with(mount, sensor_of(mount)))
    assert load_run(json.loads(json.dumps(dump_run(run)))) == run


@each_mount
def test_a_robot_file_stores_each_sensor_and_can_leave_it_out(mount: Mount, tmp_path: Path) -> None:
    sensor = sensor_of(mount)
    moved = {
        field.name: getattr(sensor, field.name) + 1.0
        for field in fields(sensor)
        if field.type == "float"
    }
    robot = robot_with(mount, replace(sensor, **moved))
    save_robot(robot, tmp_path / "robot.toml")
    assert RobotChoice.load(str(tmp_path / "robot.toml")).spec == robot
    word = f"[{mount.key}]\n{sensor.name} = false" if mount.many else f"{mount.key} = false"
    (tmp_path / "less.toml").write_text(f"{word}\n")
    left = RobotChoice.load(str(tmp_path / "less.toml")).spec.list_sensors(mount)
    assert sensor.name not in [other.name for other in left]


@each_mount
def test_the_settings_form_has_a_field_for_each_number_of_a_sensor(mount: Mount) -> None:
    sensor = sensor_of(mount)
    plan = plan_spec(run_of(robot_with(mount, sensor)))
    for field in fields(sensor):
        edit = find(plan, f"{sensor.name}.{field.name}")
        if field.name == "port" or field.type == "float":
            assert edit is not None, field.name
        if edit is not None and field.type == "float":
            changed = edit.write(plan, str(getattr(sensor, field.name) + 1.0))
            (after,) = changed.spec.robot.list_sensors(mount)
            assert getattr(after, field.name) == getattr(sensor, field.name) + 1.0


@cache
def read_out(kind: SensorKind) -> StoredRun:
    """A run that reads all that a sensor has, and was held when its first quantity was met."""
    mount = mount_of(kind)
    sensor = sensor_of(mount)
    spec = run_of(robot_with(mount, sensor))
    met = f"{kind.names(sensor)[0]} > -1000"
    handle = start_run(
        Program("reads.py", READS_ALL, "none"),
        spec,
        RunOptions(live=True, speed=0.0, breaks=(met,)),
    )
    try:
        driver = Driver(handle)
        assert driver.paused().detail == met
        assert driver.finish(Resume()).end == "finished"
    finally:
        handle.close()
    return RunStore().load_run(handle.run_id)


@each_kind
def test_a_program_can_read_each_kind_of_sensor_in_every_mode(kind: SensorKind) -> None:
    run = read_out(kind)
    lines = [row.text for row in run.output.read_all_rows()]
    assert (lines[0], lines[-1]) == (kind.driver_name, "done")
    assert len(lines) > 2


@each_kind
def test_each_kind_of_sensor_is_in_the_telemetry_as_measured(kind: SensorKind) -> None:
    run = read_out(kind)
    (sensor,) = run.spec.robot.sensors
    names = kind.names(sensor)
    frame = build_telemetry_frame(run)
    assert set(frame.columns) >= {"time", *MOTION_COLUMNS, *names, "line"}
    assert all(name.startswith(f"{sensor.name}_") for name in names)
    last = run.telemetry.last()
    assert last is not None
    measured = kind.measure(
        sensor, last.build_instant(run.spec, run.spec.world.noise), run.spec, run.open_mat()
    )
    assert frame.iloc[-1][list(names)].tolist() == list(measured)


@each_kind
def test_the_panels_show_each_kind_of_sensor(kind: SensorKind) -> None:
    run = read_out(kind)
    last = run.telemetry.last()
    assert last is not None
    instant = last.build_instant(run.spec, run.spec.world.noise)
    field = run.open_mat()
    (sensor,) = run.spec.robot.sensors
    now = Snapshot(
        RunPhase.ENDED, None, run.spec, field, instant, line=0, speed=1.0, pen_down=False
    )
    if mount_of(kind).standard:
        shown: dict[str, object] = {
            "color": now.colors,
            "ultrasonic": now.ultrasonic_mm,
            "gyro": now.spec.robot.gyro,
        }
        assert shown[next(name for name, one in SENSORS.items() if one is kind)]
    else:
        assert set(now.further) == set(kind.names(sensor))


def test_the_kind_of_a_sensor_is_found_by_its_spec() -> None:
    sensors = [sensor_of(mount) for mount in MOUNTS]
    assert [build_mounted_sensor(sensor).kind.spec for sensor in sensors] == [
        mount.spec for mount in MOUNTS
    ]
