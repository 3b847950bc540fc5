"""What the keys of debugging do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim import protocol
from tuisim.app.actions import time_travel

if TYPE_CHECKING:
    from tuisim.app.app import LabApp

TICKS = 10


def next_line(lab: LabApp) -> None:
    """On to the next line."""
    lab.debugging.step("over")


def step_into(lab: LabApp) -> None:
    """On to the next line, also of a function that is called."""
    lab.debugging.step("into")


def step_out(lab: LabApp) -> None:
    """On until this function is left."""
    lab.debugging.step("out")


def line_back(lab: LabApp) -> None:
    """Back to the line before."""
    lab.debugging.lines_back(1)


def to_cursor(lab: LabApp) -> None:
    """On until the line of the cursor in the code is about to run."""
    if line := _cursor_line(lab):
        lab.debugging.run_to(line)


def ten_ticks(lab: LabApp) -> None:
    """Ten ticks on."""
    timeline = lab.bridge.timeline
    if lab.bridge.in_past:
        at = timeline.at or 0
        time_travel.to_tick(lab, at + TICKS if at + TICKS < timeline.newest else None)
    elif lab.debugging.is_away:
        time_travel.to_now(lab)
    else:
        lab.bridge.debug(protocol.StepTicks(TICKS))


def toggle_break(lab: LabApp) -> None:
    """Put a breakpoint on the line of the cursor in the code, or take it away."""
    if line := _cursor_line(lab):
        lab.debugging.toggle_line(line)


def _cursor_line(lab: LabApp) -> int:
    """The line of the cursor; shows the code first if it is hidden."""
    if not lab.desk.shown("code"):
        lab.desk.toggle("code")
        lab.say("The cursor of the code chooses the line: tab leads there")
        return 0
    return lab.desk.code.cursor_line if lab.desk.code else 0


def list_breaks(lab: LabApp) -> None:
    """List the breakpoints."""
    from tuisim.app.dialogs.breakpoints import BreaksDialog

    lab.push_screen(BreaksDialog(lab.debugging.breaks, lab.bridge.spec.robot, lab.debugging.set_breaks))


def list_watches(lab: LabApp) -> None:
    """List the watches."""
    from tuisim.app.dialogs.breakpoints import WatchesDialog

    lab.push_screen(WatchesDialog(lab.debugging.watches, lab.debugging.set_watches))
