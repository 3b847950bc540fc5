"""Robots as the browser simulator of the course saved them, with every key that it writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import Command
from tuisim.config.robots import ROBOTS, choose_robot
from tuisim.core.spec import ColorSensorSpec, PenSpec, UltrasonicSpec


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
def test_a_preset_that_was_saved_there_is_the_one_here(name: str, tmp_path: Path) -> None:
    file = tmp_path / f"{name}.json"
    file.write_text(json.dumps(PRESETS[name]))
    choice = choose_robot(str(file))
    assert choice.spec == ROBOTS[name]
    assert (choice.motor_noise, choice.light_noise, choice.notes) == (0, 0, ())


DEFAULT, TINY = ROBOTS["Default_Robot"], ROBOTS["Small_Robot"]
SAVED: Mapping[str, tuple[dict[str, Any], dict[str, Any], tuple[int, int]]] = {
    # What was saved, how it differs from the preset, motor and light noise.
    "larger wheels": ({**LARGE, "wheeldiameter": 81.6}, {"wheel_diameter_mm": 81.6}, (0, 0)),
    "narrow and long": (
        {**LARGE, "wheelSpacing": 120, "back": -200, "height": 245},
        {"wheel_spacing_mm": 120.0, "back_mm": -200.0},
        (0, 0),
    ),
    "light": ({**LARGE, "weight": "light", "baseWeight": "light"}, {"weight": 3.0}, (0, 0)),
    "heavy": ({**LARGE, "weight": "heavy", "baseWeight": "heavy"}, {"weight": 9.0}, (0, 0)),
    "weightless for now": ({**LARGE, "weight": "weightless"}, {"weight": 0.0}, (0, 0)),
    "a weight of its own": ({**LARGE, "weight": 4.5, "baseWeight": 4.5}, {"weight": 4.5}, (0, 0)),
    "noisy": ({**LARGE, "wheelNoise": 120, "sensorNoise": 40}, {}, (120, 40)),
    "another pen": (
        {**LARGE, "pen": {"x": 5, "y": -20, "color": "green", "width": 12}},
        {"pen": PenSpec(5.0, -20.0, "green", 12.0)},
        (0, 0),
    ),
    "looks back": (
        {**LARGE, "ultrasonic": {"enabled": True, "x": 10, "y": -40, "angle": 180, "noise": 15}},
        {"ultrasonic": UltrasonicSpec(x_mm=10.0, y_mm=-40.0, angle_deg=180.0, noise_mm=15.0)},
        (0, 0),
    ),
    "eyes of its own": (
        {**LARGE, "sensor1": eye(-42.5, 60, 14), "sensor2": eye(33, -12, 8)},
        {
            "color_sensors": (
                ColorSensorSpec("left", "in2", -42.5, 60.0, 14),
                ColorSensorSpec("right", "in3", 33.0, -12.0, 8),
            )
        },
        (0, 0),
    ),
}


@pytest.mark.parametrize("name", SAVED)
def test_a_saved_robot_is_read(name: str, tmp_path: Path) -> None:
    saved, differs, noises = SAVED[name]
    (tmp_path / "mine.json").write_text(json.dumps(saved))
    choice = choose_robot(str(tmp_path / "mine.json"))
    assert choice.spec == replace(DEFAULT, name="mine", **differs)
    assert ((choice.motor_noise, choice.light_noise), choice.notes) == (noises, ())


def test_unknown_keys_are_noted_once_in_the_shell(here: Command, tmp_path: Path) -> None:
    (tmp_path / "mine.json").write_text(json.dumps({**LARGE, "owner": "Ann"}))
    (tmp_path / "p.py").write_text("print('ran')")
    done = here("run", "p.py", "-r", "mine.json")
    assert (done.returncode, done.stdout) == (0, "ran\n")
    assert done.stderr.count("ignored unknown keys: owner") == 1
