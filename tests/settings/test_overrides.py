"""Single keys of world and robot files as settings of a run."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.engine.core.drift_spec import DriftSpec
from tuisim.engine.core.spec import RunSpec
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.overrides import resolve_keys
from tuisim.settings.robots import RobotChoice

HERE = Path("set")


def spec_with(values: dict[str, Any], **chosen: Any) -> RunSpec:
    return build_run_spec(Settings.merge(chosen, resolve_keys(values, Settings(chosen), HERE)))


@for_rows(
    "values, read, expected",
    {
        "noise": ({"noise.motor": 20}, lambda spec: spec.world.noise.motor, 20),
        "start pose": ({"start.x_mm": 300}, lambda spec: spec.world.start.x_mm, 300),
        "mat": ({"background": "Lollipop"}, lambda spec: spec.world.background, "Lollipop"),
        "profile": ({"profile": "ev3"}, lambda spec: spec.profile.name, "ev3"),
        "cost": ({"profile.color_read_ms": 7}, lambda spec: spec.profile.color_read_ns, 7_000_000),
        "seed": ({"seed": 9}, lambda spec: spec.seed, 9),
        "robot": ({"robot": "Small_Robot"}, lambda spec: spec.robot.wheel_diameter_mm, 28.0),
        "key of the robot": ({"robot.weight": "heavy"}, lambda spec: spec.robot.weight, 9.0),
        "key of a sensor": (
            {"robot.color_sensors.left.diameter_mm": 30},
            lambda spec: spec.robot.color_sensors[0].diameter_mm,
            30,
        ),
        "a robot and its key": (
            {"robot": "Small_Robot", "robot.weight": 3},
            lambda spec: (spec.robot.wheel_diameter_mm, spec.robot.weight),
            (28.0, 3.0),
        ),
        "floor": ({"floor": True}, lambda spec: spec.world.floor, True),
        "walls": ({"walls": False}, lambda spec: spec.world.walls, False),
    },
)
def test_a_batchs_key_changes_its_setting(
    values: dict[str, Any], read: Any, expected: object
) -> None:
    assert read(spec_with(values)) == expected


def test_a_key_of_the_robot_leaves_the_rest_of_the_chosen_robot() -> None:
    robot = RobotChoice.load("Explorer")
    changed = spec_with({"robot.wheel_diameter_mm": 60}, robot=robot).robot
    assert (changed.wheel_diameter_mm, changed.touch_sensors) == (60.0, robot.spec.touch_sensors)


def test_a_key_of_drift_leaves_the_rest_of_the_chosen_drift() -> None:
    typical = DriftSpec(0.5, 1.0, 1.0, 1.0, 3.0, 0.05, 2.0, 14.0, 100.0, 10.0, 5.0)
    assert spec_with({"drift": "typical"}).world.drift == typical
    assert spec_with({"drift.slip_pc": 7}, drift=typical).world.drift == replace(
        typical, slip_pc=7.0
    )
    assert spec_with({"drift.slip_pc": 7}).world.drift == DriftSpec(slip_pc=7.0)


def test_a_key_of_the_profile_leaves_the_rest_of_the_chosen_profile() -> None:
    profile = spec_with({"profile.color_read_ms": 60}, profile="nbev3devsim").profile
    assert (profile.tick_hz, profile.color_read_ns) == (30, 60_000_000)


def test_changing_a_robots_key_leaves_sensors_where_the_mat_puts_them() -> None:
    mat = "Radial_grey"
    usual = spec_with({}, background=mat).robot
    changed = spec_with({"robot.weight": 3}, background=mat).robot
    assert [sensor.x_mm for sensor in changed.color_sensors] == [
        sensor.x_mm for sensor in usual.color_sensors
    ]


@pytest.mark.parametrize("value, expected", [(5, ("5",)), ("5 'two words'", ("5", "two words"))])
def test_arguments_given_as_one_text_are_split_as_in_a_shell(
    value: object, expected: tuple[str, ...]
) -> None:
    assert resolve_keys({"arguments": value}, Settings(), HERE)["arguments"] == expected


@for_rows(
    "values, words",
    {
        "misspelt": ({"noise.motr": 1}, r"^set: noise.motr: no such key .did you mean motor"),
        "misspelt table": ({"nois.motor": 1}, r"^set: nois: no such key .did you mean noise"),
        "robot": ({"robot.wheel_diametr_mm": 1}, r"wheel_diametr_mm: .*wheel_diameter_mm"),
        "too large": (
            {"noise.motor": 501},
            r"^set: noise.motor: must be a whole number from 0 to 500",
        ),
        "no such mat": ({"background": "Lollipo"}, r"^set: background: no such mat .*Lollipop"),
        "not part of a run": ({"program": "x.py"}, r"^set: program: cannot be varied"),
        "misspelt drift": (
            {"drift.gyro": 1},
            r"^set: drift.gyro: no such key .did you mean gyro_dps",
        ),
        "a value and a table": ({"noise": 1, "noise.motor": 2}, r"noise.motor: is inside noise"),
        "a table and a value": (
            {"noise.motor": 2, "noise": 1},
            r"^set: noise: is given as a whole",
        ),
        "an open quote": ({"arguments": "'a"}, r"^set: arguments: cannot be split"),
    },
)
def test_wrong_keys_of_varied_settings_are_explained(values: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        resolve_keys(values, Settings(), HERE)
