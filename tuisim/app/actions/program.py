"""Keys of the group Program: stop and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.snapshot import speed_label

if TYPE_CHECKING:
    from tuisim.app.app import LabApp

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 16.0, 0.0)
"""Speeds that `[` and `]` step through; 0 is as fast as possible."""


def stop(lab: LabApp) -> None:
    """Stop the program."""
    lab.run_controller.stop()


def _change_speed(lab: LabApp, by: int) -> None:
    speed = lab.run_controller.speed
    at = SPEEDS.index(speed) if speed in SPEEDS else min(range(6), key=lambda i: abs(SPEEDS[i] - speed))
    to = at + by
    if not 0 <= to < len(SPEEDS):
        lab.say(f"Speed is {speed_label(speed)} already: that is the {'slowest' if by < 0 else 'fastest'}")
        return
    lab.run_controller.set_speed(SPEEDS[to])
    lab.situation_changed()


def slower(lab: LabApp) -> None:
    """Go one step down in speed."""
    _change_speed(lab, -1)


def faster(lab: LabApp) -> None:
    """Go one step up in speed."""
    _change_speed(lab, 1)
