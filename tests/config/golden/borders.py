"""Each number of a run at the ends of its range and just beyond them, and as what it is not."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tests.config.golden.cases import PROGRAM, Case
from tests.config.golden.documents import Table, toml

SENSOR = {"x_mm": (-500, 500), "y_mm": (-500, 500)}
ROBOT: Mapping[str, tuple[float, float]] = {
    "wheel_diameter_mm": (1, 500),
    "wheel_spacing_mm": (1, 1000),
    "wheel_width_mm": (1, 200),
    "back_mm": (-1000, 0),
    "weight": (0, 1000),
    "gear_ratio": (0.01, 100),
    **{f"pen.{key}": ends for key, ends in SENSOR.items()},
    "pen.width_mm": (0.1, 200),
    **{f"color_sensors.left.{key}": ends for key, ends in SENSOR.items()},
    "color_sensors.right.diameter_mm": (2, 100),
    **{f"ultrasonic.{key}": ends for key, ends in SENSOR.items()},
    "ultrasonic.angle_deg": (-360, 360),
    "ultrasonic.max_range_mm": (1, 10_000),
    "ultrasonic.noise_mm": (0, 1000),
    "motors.outA.low_deg": (-100_000, 0),
    "motors.outA.high_deg": (0, 100_000),
}
EXPLORER: Mapping[str, tuple[float, float]] = {
    **{f"touch_sensors.bumper.{key}": ends for key, ends in SENSOR.items()},
    "touch_sensors.bumper.width_mm": (1, 500),
    **{f"infrared.{key}": ends for key, ends in SENSOR.items()},
    "infrared.angle_deg": (-360, 360),
}
PROFILE: Mapping[str, tuple[float, float]] = {
    "tick_hz": (1, 1000),
    "max_speed_dps": (1, 100_000),
    "reflected_max": (1, 1000),
    "ultrasonic_period_ticks": (1, 1000),
    "ambient_percent": (0, 1_000_000),
    "color_read_ms": (0, 60_000),
    "clock_read_ns": (0, 60_000_000_000),
}
WORLD: Mapping[str, tuple[float, float]] = {
    "start.x_mm": (-10_000, 10_000),
    "start.y_mm": (-10_000, 10_000),
    "start.heading_deg": (-36_000, 36_000),
    "noise.light": (0, 128),
    "noise.motor": (0, 500),
    "pen.width_mm": (0.1, 200),
    "seed": (0, 2**63 - 1),
    "beacon.x_mm": (-10_000, 10_000),
    "beacon.channel": (1, 4),
}
WORDS: Mapping[str, tuple[float, float]] = {
    "-x": (-10_000, 10_000),
    "-y": (-10_000, 10_000),
    "-a": (-36_000, 36_000),
    "-N": (0, 128),
    "-M": (0, 500),
    "--pen-width": (0.1, 200),
    "--seed": (0, 2**63 - 1),
    "--speed": (0.01, 1000),
    "--fps": (1, 60),
}
BOXES: Mapping[str, tuple[float, float]] = {
    "x_mm": (-10_000, 10_000),
    "y_mm": (-10_000, 10_000),
    "width_mm": (0, 10_000),
    "height_mm": (0, 10_000),
}
DEFAULTS: Mapping[str, tuple[float, float]] = {
    "simulation.sensornoise": (0, 128),
    "simulation.motornoise": (0, 500),
    "app.fps": (1, 60),
    "app.speed": (0.01, 1000),
}
CLOSE = 0.001


def _values(ends: tuple[float, float]) -> list[Any]:
    low, high = ends
    return [
        low,
        high,
        float(low),
        float(high),
        low - 1,
        high + 1,
        low - CLOSE,
        high + CLOSE,
        True,
        "12",
        float("nan"),
        [low],
        {"value": low},
    ]


def nested(path: str, value: Any) -> Table:
    """Return the table in which a value stands at a path."""
    key, _, rest = path.partition(".")
    return {key: nested(rest, value) if rest else value}


def border_cases() -> Iterator[Case]:
    """Yield the cases, by the kind of the file that has the number."""
    files: dict[str, str | bytes] = {"p.py": PROGRAM}
    for kind, words, about, base in (
        ("robot", ("run", "p.py", "-r", "t.toml"), ROBOT, {}),
        ("explorer", ("run", "p.py", "-r", "t.toml"), EXPLORER, {"base": "Explorer"}),
        ("profile", ("run", "p.py", "--profile", "t.toml"), PROFILE, {}),
        ("world", ("run", "p.py", "--world", "t.toml"), WORLD, {}),
    ):
        for path, ends in about.items():
            for number, value in enumerate(_values(ends)):
                table = {**base, **nested(path, value)}
                if path.startswith("beacon."):
                    table["beacon"] = {"x_mm": 3, "y_mm": 4, **table["beacon"]}
                text = toml(table)
                yield Case(f"border {kind} {path} {number}", words, {**files, "t.toml": text})
    for path, ends in {**WORLD, **{f"robot.{key}": one for key, one in ROBOT.items()}}.items():
        for number, value in enumerate(_values(ends)[:8]):
            words = ("batch", "p.py", "--set", f"{path}={value!r}")
            yield Case(f"border parameter {path} {number}", words, files)
    for flag, ends in WORDS.items():
        for number, value in enumerate([*_values(ends)[:8], "x", "", "1e3", " 5", "0x10"]):
            yield Case(f"border word {flag} {number}", ("run", "p.py", flag, str(value)), files)
    for key, ends in BOXES.items():
        for number, value in enumerate(_values(ends)):
            box = {"x_mm": 1, "y_mm": 2, "width_mm": 3, "height_mm": 4, key: value}
            text = toml({"obstacle": [box]})
            yield Case(
                f"border box {key} {number}",
                ("run", "p.py", "-o", "t.toml"),
                {**files, "t.toml": text},
            )
    for path, ends in DEFAULTS.items():
        for number, value in enumerate(_values(ends)):
            yield Case(
                f"border default {path} {number}", ("run", "p.py"), files, toml(nested(path, value))
            )
