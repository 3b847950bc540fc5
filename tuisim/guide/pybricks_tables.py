"""Reference tables of Pybricks: how the firmware sets its motors and drive bases."""

from __future__ import annotations

from collections.abc import Callable

from tuisim.engine.core.profile import LEGO_MICROPYTHON, PYBRICKS_4
from tuisim.engine.core.servo.drive_base import compute_base_settings, compute_usual_settings
from tuisim.engine.core.servo.settings import MODELS, ControlSettings, compute_motor_settings
from tuisim.guide.tables import Table, code

_PROFILES = (LEGO_MICROPYTHON, PYBRICKS_4)
_WHEELS = ((55.5, 104), (56, 114), (56, 180), (43.2, 120), (68.8, 150))
"""Diameter and track of usual robots in mm; the first is that of the official driving base."""
_MOTOR_ROWS: tuple[tuple[str, Callable[[ControlSettings], str]], ...] = (
    ("highest speed", lambda one: f"{one.units(one.speed)} deg/s"),
    ("acceleration and deceleration", lambda one: f"{one.units(one.acceleration)} deg/s²"),
    (
        "a move is done within",
        lambda one: (
            f"{one.units(one.position_tolerance)} deg, below {one.units(one.speed_tolerance)} deg/s"
        ),
    ),
    ("stalled", lambda one: f"below {one.units(one.stall_speed)} deg/s for {one.stall_time_ms} ms"),
)


def list_motors() -> Table:
    """Return the settings of a new motor of each kind, under each profile of Pybricks."""
    kinds = [(profile, kind) for profile in _PROFILES for kind in MODELS]
    settings = [compute_motor_settings(profile.motor_law, kind) for profile, kind in kinds]
    columns = ("of a motor", *(f"{kind}, {code(profile.name)}" for profile, kind in kinds))
    return Table(columns, [(name, *map(cell, settings)) for name, cell in _MOTOR_ROWS])


def list_drive_bases() -> Table:
    """Return how a new drive base of usual sizes moves, under each profile of Pybricks."""
    columns = (
        "`wheel_diameter`, `axle_track`",
        *(f"`settings()`, {code(profile.name)}" for profile in _PROFILES),
    )
    rows = []
    for diameter_mm, track_mm in _WHEELS:
        usual = []
        for profile in _PROFILES:
            motor = compute_motor_settings(profile.motor_law, "large")
            usual.append(
                str(
                    compute_usual_settings(
                        profile.motor_law,
                        *compute_base_settings(motor, motor, diameter_mm, track_mm),
                    )[0]
                )
            )
        rows.append((f"{diameter_mm:g} mm, {track_mm:g} mm", *usual))
    return Table(columns, rows)
