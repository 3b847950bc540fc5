"""Frames: columns, types and values of the samples and of the telemetry."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import replace
from types import FrameType

import pandas as pd
import pytest

from tests.engine.runs.run_recorder import Recorder
from tuisim.base.errors import LogError
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.field import Field
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.sensors import measure_sensors
from tuisim.engine.core.sensors.color import measure_color
from tuisim.engine.core.spec import NoiseSpec, Obstacle, RunSpec, WorldSpec
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.mats import background
from tuisim.engine.runs.frames import SAMPLE_COLUMNS, build_samples_frame, build_telemetry_frame
from tuisim.engine.runs.records import TELEMETRY_FILE
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.sensor_arrays import measure_quiet_color

TELEMETRY_COLUMNS = [
    "time",
    "x_mm",
    "y_mm",
    "heading_deg",
    "left_position_deg",
    "right_position_deg",
    "left_speed_dps",
    "right_speed_dps",
    "left_red",
    "left_green",
    "left_blue",
    "right_red",
    "right_green",
    "right_blue",
    "ultrasonic_mm",
    "gyro_deg",
    "gyro_rate_dps",
    "line",
]
SAMPLE_TYPES = [
    "timedelta64[ns]",
    "str",
    "float64",
    "float64",
    "int64",
    "float64",
    "float64",
    "float64",
    "int64",
]


def test_the_sample_frame_has_variable_time_position_and_line(logged: StoredRun) -> None:
    frame = build_samples_frame([logged])
    assert list(frame.columns) == list(SAMPLE_COLUMNS)
    assert [str(kind) for kind in frame.dtypes] == SAMPLE_TYPES
    assert frame["variable"].tolist() == ["Colour", "Colour", "NA", "Gyro"]
    assert frame["value"].tolist() == [100.0, 86.27450980392157, -3e-05, 5.0]
    assert frame["time"].tolist() == [0.0, 0.1, 12.25, 0.17]
    assert frame["index"].astype("int64").tolist() == [0, 100_000_000, 170_000_000, 170_000_000]
    assert frame["line"].tolist() == [4, 8, 10, 11]
    assert frame["run"].tolist() == [1, 1, 1, 1]
    poses = [logged.telemetry.record(tick).pose for tick in (0, 10, 17, 17)]
    assert frame["x_mm"].tolist() == [pose.x_mm for pose in poses]
    assert frame["y_mm"].tolist() == [pose.y_mm for pose in poses]
    assert frame["heading_deg"].tolist() == [pose.heading_deg for pose in poses]


def test_a_sample_frame_of_several_runs_numbers_them_in_order(
    record: Callable[..., Recorder], spec: RunSpec
) -> None:
    runs = []
    for ticks in (3, 5):
        recorder = record(spec)
        recorder.drive(10, 10, ticks)
        recorder.print("a: 1")
        recorder.drive(10, 10, ticks)
        recorder.print("a: 2")
        runs.append(recorder.end())
    frame = build_samples_frame(reversed(runs))
    assert frame["run"].tolist() == [1, 1, 2, 2]
    assert frame["index"].dt.total_seconds().tolist() == [0, 0.05, 0, 0.03]


@pytest.mark.parametrize("count", [0, 1], ids=["no run", "run without samples"])
def test_a_sample_frame_without_samples_has_the_usual_types(
    record: Callable[..., Recorder], spec: RunSpec, count: int
) -> None:
    frame = build_samples_frame([record(spec).end() for _ in range(count)])
    assert (len(frame), [str(kind) for kind in frame.dtypes]) == (0, SAMPLE_TYPES)


def test_the_pose_of_a_sample_whose_tick_is_lost_is_missing(logged: StoredRun) -> None:
    with open(logged.folder / TELEMETRY_FILE, "r+b") as handle:
        handle.truncate(64 + 12 * 64)
    frame = build_samples_frame([replace(logged, telemetry=type(logged.telemetry)(logged.folder))])
    assert frame["x_mm"].notna().tolist() == [True, True, False, False]


def test_telemetry_has_every_tick(logged: StoredRun, field: Field) -> None:
    frame = build_telemetry_frame(logged, field)
    assert list(frame.columns) == TELEMETRY_COLUMNS
    assert {str(kind) for kind in frame.dtypes} == {"float64", "int64"}
    assert frame["time"].tolist() == [tick / 100 for tick in range(18)]
    assert frame["line"].tolist() == [0] + [6] * 10 + [9] * 7
    assert (frame["x_mm"][0], frame["heading_deg"][0], frame["gyro_deg"][0]) == (5.0, -7.0, 0.0)


def test_the_time_in_telemetry_is_when_the_tick_falls_due(
    record: Callable[..., Recorder], spec: RunSpec, field: Field
) -> None:
    recorder = record(replace(spec, profile=replace(spec.profile, tick_hz=30)))
    recorder.drive(1, 1, 3)
    assert build_telemetry_frame(recorder.end(), field)["time"].tolist() == [
        0.0,
        0.033333334,
        0.066666667,
        0.1,
    ]


def sensors_one_by_one(run: StoredRun, field: Field) -> pd.DataFrame:
    """What the core's own functions say, tick by tick."""
    rows = []
    for tick in range(run.telemetry.count):
        record = run.telemetry.record(tick)
        instant = record.build_instant(run.spec, run.find_noise(record))
        rows.append(measure_sensors(run.spec.robot.sensors, instant, run.spec, field))
    return pd.DataFrame(rows)


def test_sensor_columns_of_telemetry_equal_the_simulations_to_the_last_bit(
    record: Callable[..., Recorder], spec: RunSpec, field: Field
) -> None:
    drift = DriftSpec(wheel_pc=1, gyro_dps=1, echo_loss_pc=90, light_pc=30)
    world = replace(
        spec.world, obstacles=(Obstacle(300, 900, 50, 300),), noise=NoiseSpec(0, 80), drift=drift
    )
    recorder = record(replace(spec, world=world))
    recorder.drive(400, 310, 60)
    recorder.drive(-200, 300, 60)
    run = recorder.end()
    expected = sensors_one_by_one(run, field)
    frame = build_telemetry_frame(run, field)
    pd.testing.assert_frame_equal(frame[expected.columns], expected, check_exact=True)
    assert frame["left_red"].nunique() > 20


def test_a_frame_of_more_ticks_takes_no_more_calls(
    record: Callable[..., Recorder], spec: RunSpec, field: Field
) -> None:
    def calls(ticks: int) -> int:
        recorder = record(
            replace(spec, world=replace(spec.world, obstacles=(Obstacle(300, 900, 50, 300),)))
        )
        recorder.drive(400, 310, ticks)
        run = recorder.end()
        counted = 0

        def count(frame: FrameType, event: str, _: object) -> None:
            nonlocal counted
            counted += event == "call" and frame.f_globals.get("__name__", "").startswith("tuisim.")

        sys.setprofile(count)
        try:
            build_telemetry_frame(run, field)
        finally:
            sys.setprofile(None)
        return counted

    calls(5)
    assert calls(200) == calls(20)


def test_sensor_columns_follow_noise_that_the_user_changes(
    record: Callable[..., Recorder], spec: RunSpec, field: Field
) -> None:
    recorder = record(spec)
    recorder.drive(300, 310, 5)
    recorder.act("set_noise", light=40, motor=0)
    recorder.drive(300, 310, 5)
    recorder.act("set_noise", light=0, motor=0)
    recorder.drive(300, 310, 5)
    run = recorder.end()
    expected = sensors_one_by_one(run, field)
    frame = build_telemetry_frame(run, field)
    pd.testing.assert_frame_equal(frame[expected.columns], expected, check_exact=True)
    quiet = pd.DataFrame(
        measure_quiet_color(run.telemetry.array(), run.spec.robot.color_sensors[0], run.spec, field)
    )
    differs = (quiet != frame[quiet.columns]).any(axis=1)
    assert differs.tolist() == [False] * 5 + [True] * 5 + [False] * 6


def test_telemetry_of_a_robot_without_some_sensors_lacks_their_columns(
    record: Callable[..., Recorder], spec: RunSpec, field: Field
) -> None:
    robot = replace(
        spec.robot, ultrasonic=None, gyro=None, color_sensors=spec.robot.color_sensors[1:]
    )
    run = record(replace(spec, robot=robot)).end()
    assert list(build_telemetry_frame(run, field).columns[8:]) == [
        "right_red",
        "right_green",
        "right_blue",
        "line",
    ]


def test_run_without_telemetry_gives_an_empty_frame(logged: StoredRun, field: Field) -> None:
    (logged.folder / TELEMETRY_FILE).unlink()
    run = replace(logged, telemetry=type(logged.telemetry)(logged.folder))
    frame = build_telemetry_frame(run, field)
    assert (len(frame), list(frame.columns)) == (0, TELEMETRY_COLUMNS)


# The mat of a stored run


def mat_spec(spec: RunSpec) -> RunSpec:
    return replace(spec, world=WorldSpec(background="Grey_bands", start=Pose(500.0, 500.0, 0.0)))


@pytest.fixture(scope="module")
def grey() -> FieldFiles:
    """A real mat, prepared."""
    return FieldFiles.prepare(background("Grey_bands").image, [20])


def test_telemetry_opens_the_prepared_mat_that_the_run_recorded(
    record: Callable[..., Recorder],
    spec: RunSpec,
    grey: FieldFiles,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = record(mat_spec(spec), field=grey.to_plain()).end()
    monkeypatch.setenv("TUISIM_ASSETS", "/nowhere")
    assert math.isclose(build_telemetry_frame(run)["left_red"][0], reading_at(run, grey))


def reading_at(run: StoredRun, files: FieldFiles) -> float:
    record = run.telemetry.record(0)
    instant = record.build_instant(run.spec, NoiseSpec())
    return measure_color(run.spec.robot.color_sensors[0], instant, files.open_field()).red


@pytest.mark.quick_cases("never said")
@pytest.mark.parametrize("known", [True, False], ids=["dropped from the cache", "never said"])
def test_telemetry_prepares_the_mat_again_if_its_cache_is_gone(
    record: Callable[..., Recorder], spec: RunSpec, grey: FieldFiles, known: bool
) -> None:
    lost = replace(grey, pixels=grey.pixels.parent.parent / "gone" / grey.pixels.name)
    run = record(mat_spec(spec), field=lost.to_plain() if known else None).end()
    assert build_telemetry_frame(run)["left_red"][0] == reading_at(run, grey)


def test_mat_that_has_changed_is_not_taken_for_the_old_one(
    record: Callable[..., Recorder], spec: RunSpec, grey: FieldFiles
) -> None:
    other = replace(grey, pixels=grey.pixels.with_name("other.rgb"))
    run = record(mat_spec(spec), field=other.to_plain()).end()
    with pytest.raises(LogError, match="Grey_bands has changed since the run"):
        build_telemetry_frame(run)


def test_mat_that_is_gone_is_named(record: Callable[..., Recorder], spec: RunSpec) -> None:
    run = record(replace(spec, world=replace(spec.world, background="Blank_sheet"))).end()
    with pytest.raises(LogError, match="Blank_sheet"):
        build_telemetry_frame(run)
