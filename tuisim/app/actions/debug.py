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
    lab.debugging.step(protocol.LineStep.OVER)


def step_into(lab: LabApp) -> None:
    """Step to the next line, into calls."""
    lab.debugging.step(protocol.LineStep.INTO)


def step_out(lab: LabApp) -> None:
    """Continue until the current function returns."""
    lab.debugging.step(protocol.LineStep.OUT)


def line_back(lab: LabApp) -> None:
    """Step back to the line before."""
    lab.debugging.lines_back(1)


def to_cursor(lab: LabApp) -> None:
    """Continue until the cursor's line in the code is about to run."""
    if line := _cursor_line(lab):
        lab.debugging.run_to(line)


def ten_ticks(lab: LabApp) -> None:
    """Run ten ticks."""
    timeline = lab.bridge.timeline
    if lab.bridge.in_past:
        at = timeline.at or 0
        time_travel.to_tick(lab, at + TICKS if at + TICKS < timeline.newest else None)
    elif lab.debugging.is_away:
        time_travel.to_now(lab)
    else:
        lab.bridge.debug(protocol.StepTicks(TICKS))


def toggle_break(lab: LabApp) -> None:
    """Set or remove a breakpoint on the cursor's line in the code."""
    if line := _cursor_line(lab):
        lab.debugging.toggle_line(line)


def _cursor_line(lab: LabApp) -> int:
    """Return the line of the cursor; show the code first if it is hidden."""
    if not lab.desk.shown("code"):
        lab.desk.toggle("code")
        lab.say("The cursor of the code chooses the line: tab leads there")
        return 0
    return lab.desk.code.cursor_line if lab.desk.code else 0


def list_breaks(lab: LabApp) -> None:
    """Show the dialog of the breakpoints."""
    from tuisim.app.dialogs.breakpoints import BreaksDialog

    lab.push_screen(BreaksDialog(lab.debugging.breaks, lab.bridge.spec.robot, lab.debugging.set_breaks))


def list_watches(lab: LabApp) -> None:
    """Show the dialog of the watches."""
    from tuisim.app.dialogs.breakpoints import WatchesDialog

    lab.push_screen(WatchesDialog(lab.debugging.watches, lab.debugging.set_watches))
