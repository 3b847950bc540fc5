"""Robots as the browser simulator of the course saved them, with every key that it writes."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import Command
from tuisim.settings.robots import ROBOTS, RobotChoice


def eye(x: float, y: float, diameter: int) -> dict[str, Any]:
    return {"enabled": True, "x": x, "y": y, "diameter": diameter}


LARGE: dict[str, Any] = {
    "wheeldiameter": 56,
    "wheelSpacing": 180,
    "wheelNoise": 0,
    "back": -120,
    "weight": "medium",
    "baseWeight": "medium",
    "sensorNoise": 0,
    "width": 200,
    "height": 165,
    "pen": {"x": 0, "y": 0, "color": "red", "width": 6},
    "sensor1": eye(-20, 30, 20),
    "sensor2": eye(20, 30, 20),
    "gyro": {"enabled": True},
    "ultrasonic": {"enabled": True, "x": 0, "y": 20, "angle": 0, "noise": 0},
}
SMALL: dict[str, Any] = {
    **LARGE,
    "wheeldiameter": 28,
    "wheelSpacing": 90,
    "back": -60,
    "weight": "weightless",
    "baseWeight": "weightless",
    "width": 110,
    "height": 90,
    "sensor1": eye(-10, 15, 10),
    "sensor2": eye(10, 15, 10),
    "ultrasonic": {**LARGE["ultrasonic"], "y": 10},
}
PRESETS = {
    "Default_Robot": LARGE,
    "Small_Robot": SMALL,
    "Small_Robot_Wide_Eyes": {**SMALL, "sensor1": eye(-30, 15, 10), "sensor2": eye(30, 15, 10)},
    "Sensor_Diameter_Config": {**LARGE, "sensor1": eye(-20, 30, 30), "sensor2": eye(20, 30, 10)},
}


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_saved_by_the_old_simulator_equals_the_built_in_one(
    name: str, tmp_path: Path
) -> None:
    file = tmp_path / f"{name}.json"
    file.write_text(json.dumps(PRESETS[name]))
    choice = RobotChoice.load(str(file))
    assert choice.spec == ROBOTS[name]
    assert (choice.motor_noise, choice.light_noise, choice.notes) == (0, 0, ())


def test_unknown_keys_of_a_robot_file_are_noted_once_in_the_shell(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "mine.json").write_text(json.dumps({**LARGE, "owner": "Ann"}))
    (tmp_path / "p.py").write_text("print('ran')")
    done = here("run", "p.py", "-r", "mine.json")
    assert (done.returncode, done.stdout) == (0, "ran\n")
    assert done.stderr.count("ignored unknown keys: owner") == 1
