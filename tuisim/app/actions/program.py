"""Keys of the groups Program and Debugging: run, stop, pause and speed; steps, breakpoints and watches."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.actions.time_travel import propose_branch, refresh
from tuisim.app.snapshot import RunPhase, speed_label

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


def pause(workspace: Workspace) -> None:
    """Pause or continue: playback in the past, the program at the newest instant."""
    timeline = workspace.run_controller.timeline
    if timeline.playing:
        timeline.stop_playback()
        refresh(workspace)
    elif workspace.run_controller.in_past:
        timeline.play(time.monotonic())
        refresh(workspace)
    elif workspace.run_controller.state == RunPhase.PAUSED:
        workspace.run_controller.resume()
    else:
        workspace.run_controller.pause()


def change_speed(workspace: Workspace, by: int) -> None:
    """Go to a higher or lower speed, by a number of steps."""
    speed = workspace.run_controller.speed
    at = SPEEDS.index(speed) if speed in SPEEDS else min(range(6), key=lambda i: abs(SPEEDS[i] - speed))
    to = at + by
    if not 0 <= to < len(SPEEDS):
        workspace.app.say(f"The speed is already {speed_label(speed)}, the {'slowest' if by < 0 else 'fastest'}")
        return
    workspace.run_controller.set_speed(SPEEDS[to])
    workspace.app.situation_changed()


def step(workspace: Workspace, how: protocol.LineStep) -> None:
    """Step to the next line: over calls, into calls, or out of the current function."""
    workspace.debugger.step(how)


def line_back(workspace: Workspace) -> None:
    """Step back to the line before."""
    workspace.debugger.lines_back(1)


def to_cursor(workspace: Workspace) -> None:
    """Continue until the cursor's line in the code is about to run."""
    if line := _cursor_line(workspace):
        workspace.debugger.run_to(line)


def toggle_break(workspace: Workspace) -> None:
    """Set or remove a breakpoint on the line that is shown as current, or on the cursor's if the code has the focus."""
    code = workspace.panel_area.code
    current = workspace.debugger.current_line
    if current and not (code and code.is_read):
        workspace.debugger.toggle_line(current, "the current one")
    elif code and code.is_read:
        workspace.debugger.toggle_line(code.cursor_line, "where the cursor is")
    else:
        _go_to_code(workspace)


def _cursor_line(workspace: Workspace) -> int:
    """Return the line of the cursor; show the code first if it is hidden."""
    area = workspace.panel_area
    if area.shown("code"):
        return area.code.cursor_line if area.code else 0
    _go_to_code(workspace)
    return 0


def _go_to_code(workspace: Workspace) -> None:
    """Give the code the focus, so that the user can choose a line."""
    area = workspace.panel_area
    if not area.shown("code"):
        area.toggle("code")
    workspace.app.call_after_refresh(area.attend, "code")
    workspace.app.say("The cursor in the code sets the line: the arrow keys move it")


def list_breaks(workspace: Workspace) -> None:
    """Show the dialog of the breakpoints."""
    from tuisim.app.dialogs.entries import BreaksDialog

    workspace.app.push_screen(
        BreaksDialog(workspace.debugger.breaks, workspace.run_controller.spec.robot, workspace.debugger.set_breaks)
    )


def list_watches(workspace: Workspace) -> None:
    """Show the dialog of the watches."""
    from tuisim.app.dialogs.entries import WatchesDialog

    workspace.app.push_screen(
        WatchesDialog(workspace.debugger.watches, workspace.run_controller.spec.robot, workspace.debugger.set_watches)
    )
