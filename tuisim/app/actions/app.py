"""Keys of the app: help, redraw, suspend, quit."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace


_START = (
    "Press o and open an example, then R: the robot runs it. S stops, space pauses. b lays out another mat; "
    "drag the robot with the mouse or nudge it with the arrows, and the sensors follow. What a program prints as "
    "a name, a colon and a number, such as Colour: 86.3, goes into the log and the chart; e writes the log to a "
    "file."
)
_NUDGES = (
    ("← ↑ → ↓", "Move the robot 10 mm"),
    ("shift + arrow", "Move the robot 1 mm"),
    ("a f", "Turn the robot 5° to the left, to the right; also ctrl + ← →"),
)
"""The ten keys that move or turn the robot, in three rows."""
_EVERYWHERE = (("ctrl+p", "Command palette"), ("tab", "Next panel or field"), ("Escape", "Leave a field"))


def show_help(workspace: Workspace) -> None:
    """Show every key of the app, of the editor, and those that work everywhere."""
    from tuisim.app.editor.area import EDITOR_KEYS
    from tuisim.app.keys.help import KeyHelp, key_groups

    groups = key_groups(action for action in workspace.app.ACTIONS.values() if not action.id.startswith("nudge-"))
    groups["Robot"] += _NUDGES
    workspace.app.push_screen(KeyHelp("Help", _START, {**groups, "In the code": EDITOR_KEYS, "": _EVERYWHERE}))


def redraw(workspace: Workspace) -> None:
    """Redraw the whole screen."""
    workspace.app.action_redraw()


def suspend(workspace: Workspace) -> None:
    """Suspend the app as a shell job; a live run is paused first."""
    workspace.app.action_suspend_process()


def leave(workspace: Workspace) -> None:
    """Quit; with unsaved changes or a running program, ask first."""
    workspace.document.when_safe(lambda: _leave(workspace))


def _leave(workspace: Workspace) -> None:
    if not workspace.run_controller.in_run:
        workspace.app.exit()
        return
    from tuisim.app.dialogs.question import LeaveQuestion

    workspace.app.push_screen(LeaveQuestion(), lambda yes: workspace.app.exit() if yes else None)
