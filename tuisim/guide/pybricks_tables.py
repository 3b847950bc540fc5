"""Reference tables of Pybricks: how the firmware sets its motors and drive bases."""

from __future__ import annotations

from tuisim.engine.core.profile import LEGO_MICROPYTHON, PYBRICKS_4
from tuisim.engine.core.servo.drive_base import compute_new_pace, describe_new_motors
from tuisim.guide.tables import Table, code

_PROFILES = (LEGO_MICROPYTHON, PYBRICKS_4)
_WHEELS = ((55.5, 104), (56, 114), (56, 180), (43.2, 120), (68.8, 150))
"""Wheel diameter and axle track in mm of usual robots; the first robot is the official driving base."""


def list_motors() -> Table:
    """Return the table of a new motor's settings, for each kind of motor and each profile of Pybricks."""
    settings = {
        f"{kind}, {code(profile.name)}": words
        for profile in _PROFILES
        for kind, words in describe_new_motors(profile.motor_law).items()
    }
    names = next(iter(settings.values()))
    rows = [(name, *(words[name] for words in settings.values())) for name in names]
    return Table(("of a motor", *settings), rows)


def list_drive_bases() -> Table:
    """Return the table of how a new drive base of usual sizes moves, in each profile of Pybricks."""
    columns = (
        "`wheel_diameter`, `axle_track`",
        *(f"`settings()`, {code(profile.name)}" for profile in _PROFILES),
    )
    rows = [
        (
            f"{diameter_mm:g} mm, {track_mm:g} mm",
            *(
                str(compute_new_pace(profile.motor_law, diameter_mm, track_mm))
                for profile in _PROFILES
            ),
        )
        for diameter_mm, track_mm in _WHEELS
    ]
    return Table(columns, rows)
