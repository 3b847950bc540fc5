"""Functions behind the debugger's keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.actions import time_travel

if TYPE_CHECKING:
    from tuisim.app.workspace import Workspace

TICKS = 10


def next_line(workspace: Workspace) -> None:
    """Step to the next line, over calls."""
    workspace.debugger.step(protocol.LineStep.OVER)


def step_into(workspace: Workspace) -> None:
    """Step to the next line, into calls."""
    workspace.debugger.step(protocol.LineStep.INTO)


def step_out(workspace: Workspace) -> None:
    """Continue until the current function returns."""
    workspace.debugger.step(protocol.LineStep.OUT)


def line_back(workspace: Workspace) -> None:
    """Step back to the line before."""
    workspace.debugger.lines_back(1)


def to_cursor(workspace: Workspace) -> None:
    """Continue until the cursor's line in the code is about to run."""
    if line := _cursor_line(workspace):
        workspace.debugger.run_to(line)


def ten_ticks(workspace: Workspace) -> None:
    """Run ten ticks."""
    timeline = workspace.run_controller.timeline
    if workspace.run_controller.in_past:
        at = timeline.at or 0
        time_travel.to_tick(workspace, at + TICKS if at + TICKS < timeline.newest else None)
    elif workspace.debugger.is_away:
        time_travel.to_now(workspace)
    else:
        workspace.run_controller.debug(protocol.StepTicks(TICKS))


def toggle_break(workspace: Workspace) -> None:
    """Set or remove a breakpoint on the cursor's line in the code."""
    if line := _cursor_line(workspace):
        workspace.debugger.toggle_line(line)


def _cursor_line(workspace: Workspace) -> int:
    """Return the line of the cursor; show the code first if it is hidden."""
    if not workspace.panel_area.shown("code"):
        workspace.panel_area.toggle("code")
        workspace.app.say("The cursor of the code chooses the line: tab leads there")
        return 0
    return workspace.panel_area.code.cursor_line if workspace.panel_area.code else 0


def list_breaks(workspace: Workspace) -> None:
    """Show the dialog of the breakpoints."""
    from tuisim.app.dialogs.breakpoints import BreaksDialog

    workspace.app.push_screen(
        BreaksDialog(workspace.debugger.breaks, workspace.run_controller.spec.robot, workspace.debugger.set_breaks)
    )


def list_watches(workspace: Workspace) -> None:
    """Show the dialog of the watches."""
    from tuisim.app.dialogs.breakpoints import WatchesDialog

    workspace.app.push_screen(WatchesDialog(workspace.debugger.watches, workspace.debugger.set_watches))
