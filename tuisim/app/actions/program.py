"""Keys of the group Program: run, stop and speed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.app.actions.time_travel import propose_branch
from tuisim.app.snapshot import speed_label

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 16.0, 0.0)
"""Speeds that `[` and `]` step through; 0 is as fast as possible."""


def run(workspace: Workspace) -> None:
    """Start the program; in the past, ask whether to start from that instant."""
    if workspace.run_controller.in_past:
        propose_branch(workspace, None, restart=True)
    else:
        workspace.app.start_run()


def stop(workspace: Workspace) -> None:
    """Stop the program."""
    workspace.run_controller.stop()


def _change_speed(workspace: Workspace, by: int) -> None:
    speed = workspace.run_controller.speed
    at = SPEEDS.index(speed) if speed in SPEEDS else min(range(6), key=lambda i: abs(SPEEDS[i] - speed))
    to = at + by
    if not 0 <= to < len(SPEEDS):
        workspace.app.say(f"Speed is {speed_label(speed)} already: that is the {'slowest' if by < 0 else 'fastest'}")
        return
    workspace.run_controller.set_speed(SPEEDS[to])
    workspace.app.situation_changed()


def slower(workspace: Workspace) -> None:
    """Go one step down in speed."""
    _change_speed(workspace, -1)


def faster(workspace: Workspace) -> None:
    """Go one step up in speed."""
    _change_speed(workspace, 1)
