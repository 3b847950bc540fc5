"""Functions behind the debugger's keys."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.actions import time_travel

if TYPE_CHECKING:
    from tuisim.app.app import LabApp

TICKS = 10


def next_line(lab: LabApp) -> None:
    """Step to the next line, over calls."""
    lab.debugger.step(protocol.LineStep.OVER)


def step_into(lab: LabApp) -> None:
    """Step to the next line, into calls."""
    lab.debugger.step(protocol.LineStep.INTO)


def step_out(lab: LabApp) -> None:
    """Continue until the current function returns."""
    lab.debugger.step(protocol.LineStep.OUT)


def line_back(lab: LabApp) -> None:
    """Step back to the line before."""
    lab.debugger.lines_back(1)


def to_cursor(lab: LabApp) -> None:
    """Continue until the cursor's line in the code is about to run."""
    if line := _cursor_line(lab):
        lab.debugger.run_to(line)


def ten_ticks(lab: LabApp) -> None:
    """Run ten ticks."""
    timeline = lab.run_controller.timeline
    if lab.run_controller.in_past:
        at = timeline.at or 0
        time_travel.to_tick(lab, at + TICKS if at + TICKS < timeline.newest else None)
    elif lab.debugger.is_away:
        time_travel.to_now(lab)
    else:
        lab.run_controller.debug(protocol.StepTicks(TICKS))


def toggle_break(lab: LabApp) -> None:
    """Set or remove a breakpoint on the cursor's line in the code."""
    if line := _cursor_line(lab):
        lab.debugger.toggle_line(line)


def _cursor_line(lab: LabApp) -> int:
    """Return the line of the cursor; show the code first if it is hidden."""
    if not lab.panel_area.shown("code"):
        lab.panel_area.toggle("code")
        lab.say("The cursor of the code chooses the line: tab leads there")
        return 0
    return lab.panel_area.code.cursor_line if lab.panel_area.code else 0


def list_breaks(lab: LabApp) -> None:
    """Show the dialog of the breakpoints."""
    from tuisim.app.dialogs.breakpoints import BreaksDialog

    lab.push_screen(BreaksDialog(lab.debugger.breaks, lab.run_controller.spec.robot, lab.debugger.set_breaks))


def list_watches(lab: LabApp) -> None:
    """Show the dialog of the watches."""
    from tuisim.app.dialogs.breakpoints import WatchesDialog

    lab.push_screen(WatchesDialog(lab.debugger.watches, lab.debugger.set_watches))
