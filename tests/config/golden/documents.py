"""Tables of values as users write them: robots, worlds, profiles, obstacles, batches, defaults; mostly right."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from random import Random
from typing import Any

Table = dict[str, Any]

MATS = (
    "Empty_Map",
    "Grey_bands",
    "Grey_and_black",
    "Coloured_bands",
    "Rainbow_bands",
    "Linear_grey",
    "Radial_grey",
    "Radial_red",
    "Loop",
    "Square",
    "Two_shapes",
    "Lollipop",
    "Testcard",
    "Noisy_Lollipop",
    "Line_Following_Test",
    "Junction_Handling_Test",
    "Obstacles_Test",
    "Thruxton_Circuit",
    "Simple_Shapes",
    "Sensor_Diameter_Test",
    "Topo_map",
    "MNIST_Digits",
    "MNIST_Digits_Black",
    "Harvest_Trail",
    "Space_Port",
    "WRO_2018_Regular_Junior",
    "WRO_2019_Regular_Junior",
    "FLL_2018_Into_Orbit",
    "FLL_2019_City_Shaper",
)
ROBOTS = (
    "Default_Robot",
    "Small_Robot",
    "Small_Robot_Wide_Eyes",
    "Sensor_Diameter_Config",
    "Explorer",
)
SETS = ("None", "Central_post", "Square_posts", "Wall")
PROFILES = ("robolab", "nbev3devsim", "ev3")
FITS = ("stretch", "fit", "centre", "corner")
COLORS = (
    "red",
    "BLUE",
    "navy",
    "#0a1b2c",
    "#FFF000",
    "rebeccapurple",
    "lightgrey",
    "darkslategray",
)
PANELS = (
    "output",
    "arrays",
    "chart",
    "instrumentation",
    "noise",
    "settings",
    "positioning",
    "code",
    "world",
    "controls",
)
"""As all these lists: not to be extended, for the cases of a golden file of former code are drawn from them."""
BUTTONS = ("top_left", "bottom_left", "top_right", "bottom_right")
INPUTS = ("in1", "in2", "in3", "in4")
OUTPUTS = ("outA", "outB", "outC", "outD")
WEIGHTS = ("weightless", "light", "medium", "heavy")

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def number(r: Random, low: float, high: float) -> float:
    """Return a number from an interval, often its ends, whole ones and short ones; now and then one beyond it."""
    pick = r.random()
    if pick < 0.004:
        return r.choice([low - 1, high + 1, low - 0.001, high + 0.001])
    if pick < 0.1:
        return r.choice([low, high, float(low), float(high)])
    if pick < 0.15:
        return r.uniform(low, high)
    if pick < 0.6:
        return r.randint(int(low), int(high)) if high - low >= 1 else low
    return min(max(round(r.uniform(low, high), 1), low), high)


def whole(r: Random, low: int, high: int) -> int:
    """As `number`, whole ones only."""
    pick = r.random()
    ends = [low - 1, high + 1] if pick < 0.004 else [low, high]
    return r.choice(ends) if pick < 0.1 else r.randint(low, high)


def some(r: Random, share: float, **parts: Any) -> Table:
    """Return each part with a probability; a part is a value, or a function that makes one."""
    return {
        key: value() if callable(value) else value
        for key, value in parts.items()
        if r.random() < share
    }


def truth(r: Random) -> bool:
    return r.random() < 0.5


def place(r: Random) -> Table:
    return some(r, 0.6, x_mm=lambda: number(r, -500, 500), y_mm=lambda: number(r, -500, 500))


def color_sensor(r: Random, share: float = 0.5) -> Table:
    return place(r) | some(
        r,
        share,
        diameter_mm=lambda: whole(r, 2, 100),
        strategy=lambda: r.choice(["mean", "gaussian", "centre"]),
    )


def ultrasonic(r: Random) -> Table:
    return place(r) | some(
        r,
        0.3,
        angle_deg=lambda: number(r, -360, 360),
        max_range_mm=lambda: number(r, 1, 10_000),
        noise_mm=lambda: number(r, 0, 1000),
        ray_angles_deg=lambda: [number(r, -360, 360) for _ in range(r.randint(1, 4))],
    )


def pen(r: Random, placed: bool) -> Table:
    where = place(r) if placed else {}
    return where | some(
        r,
        0.6,
        color=lambda: r.choice(COLORS),
        width_mm=lambda: number(r, 0.1, 200),
        down=lambda: truth(r),
    )


def _on_port(r: Random, table: Table, port: str) -> None:
    """Put something else on the port of a sensor."""
    usual = {"in1": "ultrasonic", "in2": "left", "in3": "right", "in4": "gyro"}[port]
    if usual in ("left", "right"):
        table.setdefault("color_sensors", {})[usual] = False
    else:
        table[usual] = False
    match r.choice(["touch", "touch", "infrared", "infrareds", "ultrasonics", "eye", "nothing"]):
        case "touch":
            touch = place(r) | {"port": port} | some(r, 0.4, width_mm=lambda: number(r, 1, 500))
            table.setdefault("touch_sensors", {})[f"bumper{port[2]}"] = touch
        case "infrared":
            table["infrared"] = place(r) | {"port": port, "angle_deg": number(r, -360, 360)}
        case "infrareds":
            table.setdefault("infrareds", {})[f"ir_{port}"] = place(r) | {"port": port}
        case "ultrasonics":
            table.setdefault("ultrasonics", {})[f"back{port[2]}"] = ultrasonic(r) | {"port": port}
        case "eye":
            eye = {"x_mm": 1, "y_mm": 2} | color_sensor(r) | {"port": port}
            table.setdefault("color_sensors", {})[f"eye{port[2]}"] = eye


def _motors(r: Random, table: Table) -> None:
    left, right, *free = r.sample(OUTPUTS, 4)
    if r.random() < 0.3:
        table |= {"left_port": left, "right_port": right}
    else:
        free = ["outA", "outD"]
    motors: Table = {}
    for port in free[: r.randint(0, 2)]:
        ends = some(
            r, 0.5, low_deg=lambda: number(r, -1000, -5), high_deg=lambda: number(r, 0, 1000)
        )
        motors[port] = r.choice(["medium", "large", {"kind": "large"} | ends, ends])
        if "touch_sensors" in table and "low_deg" in ends and isinstance(motors[port], dict):
            next(iter(table["touch_sensors"].values())).update(pressed_by=port, pressed_at="low")
    if motors and r.random() < 0.2:
        motors[table.get("left_port", "outB")] = "medium"
    if motors:
        table["motors"] = motors


def robot(r: Random) -> Table:
    """Return the table of a robot file."""
    table = some(
        r,
        0.25,
        base=lambda: r.choice(ROBOTS[:4]),
        name=lambda: r.choice(["Rover", "mein Roboter", "R2"]),
        wheel_diameter_mm=lambda: number(r, 1, 500),
        wheel_spacing_mm=lambda: number(r, 1, 1000),
        wheel_width_mm=lambda: number(r, 1, 200),
        back_mm=lambda: number(r, -1000, 0),
        weight=lambda: r.choice([*WEIGHTS, number(r, 0, 1000)]),
        left_reversed=lambda: truth(r),
        right_reversed=lambda: truth(r),
        gear_ratio=lambda: number(r, 0.01, 100),
    )
    for port in r.sample(INPUTS, r.choice([0, 0, 1, 1, 2])):
        _on_port(r, table, port)
    eyes = table.setdefault("color_sensors", {}) if truth(r) else table.get("color_sensors", {})
    for name in ("left", "right"):
        if name not in eyes and r.random() < 0.5 and "color_sensors" in table:
            eyes[name] = color_sensor(r)
    if "ultrasonic" not in table and r.random() < 0.3:
        table["ultrasonic"] = ultrasonic(r)
    if r.random() < 0.4:
        _motors(r, table)
    if r.random() < 0.3:
        table["pen"] = pen(r, placed=True)
    return {key: value for key, value in table.items() if value != {}} or {"name": "Plain"}


def json_robot(r: Random) -> Table:
    """Return the object that the browser simulator saves."""

    def eye() -> Table:
        return some(
            r,
            0.6,
            x=lambda: number(r, -500, 500),
            y=lambda: number(r, -500, 500),
            diameter=lambda: whole(r, 2, 100),
            enabled=lambda: r.random() < 0.8,
        )

    return some(
        r,
        0.4,
        wheeldiameter=lambda: number(r, 1, 500),
        wheelSpacing=lambda: number(r, 1, 1000),
        back=lambda: number(r, -1000, 0),
        weight=lambda: r.choice([*WEIGHTS, "", None, number(r, 0, 1000)]),
        pen=lambda: some(
            r, 0.5, x=lambda: number(r, -500, 500), y=3, color=lambda: r.choice(COLORS), width=5
        ),
        sensor1=eye,
        sensor2=eye,
        ultrasonic=lambda: some(
            r, 0.5, x=1, y=2.5, angle=lambda: number(r, -360, 360), noise=4, enabled=truth(r)
        ),
        gyro=lambda: {"enabled": truth(r)},
        wheelNoise=lambda: r.choice([None, whole(r, 0, 500)]),
        sensorNoise=lambda: r.choice([None, whole(r, 0, 128)]),
        width=lambda: 3,
        colour=lambda: "green",
    )


def boxes(r: Random) -> list[Table]:
    """Return the list of an obstacles file."""
    return [
        {
            "x_mm": number(r, -10_000, 10_000),
            "y_mm": number(r, 0, 1100),
            "width_mm": number(r, 1, 1000),
            "height_mm": number(r, 0.5, 10_000),
        }
        for _ in range(r.choice([1, 1, 2, 3]))
    ]


def profile(r: Random) -> Table:
    """Return the table of a profile file."""
    costs = (
        "color_read",
        "color_code_read",
        "ultrasonic_read",
        "gyro_read",
        "attribute_read",
        "clock_read",
        "display_update",
    )
    table = some(
        r,
        0.3,
        base=lambda: r.choice(PROFILES),
        name=lambda: r.choice(["slow", "my own"]),
        title=lambda: "as measured",
        tick_hz=lambda: whole(r, 1, 1000),
        motor_law=lambda: r.choice(["brick", "nbev3devsim"]),
        max_speed_dps=lambda: number(r, 1, 100_000),
        reflected_max=lambda: whole(r, 1, 1000),
        ambient_percent=lambda: whole(r, 0, 100),
        ultrasonic_period_ticks=lambda: whole(r, 1, 1000),
    )
    flags = (
        "halfway_heading",
        "solid",
        "mend_library",
        "starts_in_own_folder",
        "halve_position_moves",
    )
    table |= {key: truth(r) for key in flags if r.random() < 0.15}
    for cost in costs:
        if r.random() < 0.2:
            in_ms = truth(r)
            table[f"{cost}_{'ms' if in_ms else 'ns'}"] = (
                number(r, 0, 60) if in_ms else whole(r, 0, 10**8)
            )
    return table or {"title": "plain"}


def world(r: Random, share: float = 0.25, tables: bool = True) -> Table:
    """Return the table of a world file; `tables` tells whether robot, profile and obstacles may be inside it."""
    table = some(
        r,
        share,
        background=lambda: r.choice(MATS[:21]),
        background_fit=lambda: r.choice(FITS),
        seed=lambda: whole(r, 0, 2**63 - 1) if r.random() < 0.1 else r.randint(0, 99),
        walls=lambda: truth(r),
        solid=lambda: truth(r),
        pen_marks=lambda: truth(r),
        rays=lambda: truth(r),
        autorun=lambda: truth(r),
        panels=lambda: r.sample(PANELS, r.randint(0, 3)),
        hidden_panels=lambda: r.sample(PANELS, 1),
        arguments=lambda: r.choice([[], ["5"], ["a b", "-x", "ü"]]),
        start=lambda: some(
            r,
            0.6,
            x_mm=lambda: number(r, -10_000, 10_000),
            y_mm=lambda: number(r, 0, 1143),
            heading_deg=lambda: number(r, -36_000, 36_000),
        ),
        noise=lambda: some(r, 0.6, light=lambda: whole(r, 0, 128), motor=lambda: whole(r, 0, 500)),
        pen=lambda: pen(r, placed=False),
        beacon=lambda: (
            {"x_mm": number(r, -10_000, 10_000), "y_mm": number(r, 0, 1143)}
            | some(r, 0.5, channel=lambda: whole(r, 1, 4))
        ),
        remote=lambda: [remote(r) for _ in range(r.randint(1, 2))],
    )
    table |= some(
        r,
        share,
        robot=lambda: robot(r) if tables and truth(r) else r.choice(ROBOTS),
        profile=lambda: profile(r) if tables and truth(r) else r.choice(PROFILES),
    )
    if r.random() < share:
        table |= {"obstacle": boxes(r)} if tables and truth(r) else {"obstacles": r.choice(SETS)}
    return table


def remote(r: Random) -> Table:
    """Return one press of the remote control."""
    from_s = number(r, 0, 20)
    return {"buttons": r.choice([["beacon"], [r.choice(BUTTONS)], r.sample(BUTTONS, 2)])} | some(
        r, 0.5, from_s=from_s, until_s=from_s + 2.5, channel=lambda: whole(r, 1, 4)
    )


_SIMULATION: Mapping[str, Callable[[Random], Any]] = {
    "background": lambda r: r.choice(MATS[:21]),
    "robot": lambda r: r.choice(ROBOTS),
    "obstacles": lambda r: r.choice(SETS),
    "walls": lambda r: truth(r),
    "sensornoise": lambda r: whole(r, 0, 128),
    "motornoise": lambda r: whole(r, 0, 500),
    "pencolor": lambda r: r.choice(COLORS),
    "profile": lambda r: r.choice(PROFILES),
}
_APP: Mapping[str, Callable[[Random], Any]] = {
    "speed": lambda r: r.choice(["max", 1, 2.5, number(r, 0.01, 1000)]),
    "ultrasound": lambda r: truth(r),
    "quiet": lambda r: truth(r),
    "fps": lambda r: whole(r, 1, 60),
    "colors": lambda r: r.choice(["auto", "truecolor", "256", "16", "8", "none"]),
    "cells": lambda r: r.choice(
        ["auto", "half", "quadrant", "sextant", "octant", "braille", "ascii"]
    ),
    "pixels": lambda r: r.choice(["auto", "kitty", "iterm", "sixel", "none"]),
    "theme": lambda r: r.choice(["textual-dark", "nord"]),
}


def defaults(r: Random, share: float = 0.35) -> Table:
    """Return the table of a `config.toml`."""
    table: Table = {
        "simulation": {key: make(r) for key, make in _SIMULATION.items() if r.random() < share},
        "app": {key: make(r) for key, make in _APP.items() if r.random() < share / 2},
    }
    if r.random() < 0.1:
        table["keys"] = {"run": r.choice(["x", ["x", "f5"]])}
    return {key: value for key, value in table.items() if value}


def toml_value(value: Any) -> str:
    """Return a value in TOML, a table inline."""
    match value:
        case bool():
            return str(value).lower()
        case str():
            return json.dumps(value, ensure_ascii=False)
        case list() | tuple():
            return f"[{', '.join(map(toml_value, value))}]"
        case dict():
            return (
                "{"
                + ", ".join(
                    f"{key_text(key)} = {toml_value(inner)}" for key, inner in value.items()
                )
                + "}"
            )
        case None:
            return '"null"'
        case _:
            return repr(value)


def key_text(key: str) -> str:
    """Return a key in TOML."""
    return key if _BARE.fullmatch(key) else json.dumps(key)


def toml(table: Mapping[str, Any], above: Sequence[str] = ()) -> str:
    """Return a table as a TOML document."""
    lines, below = [], []
    for key, value in table.items():
        path = ".".join(map(key_text, (*above, key)))
        if isinstance(value, dict):
            below.append(f"[{path}]\n{toml(value, (*above, key))}")
        elif isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
            below += [f"[[{path}]]\n{toml(one, (*above, key))}" for one in value]
        else:
            lines.append(f"{key_text(key)} = {toml_value(value)}")
    return "".join(f"{line}\n" for line in lines) + "".join(below)
