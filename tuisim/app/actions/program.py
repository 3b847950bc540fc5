"""Keys of the groups Program and Debugging: run, stop, pause and speed; steps, breakpoints and watches."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from tuisim.app.actions.time_travel import propose_branch
from tuisim.app.snapshot import RunPhase, speed_label
from tuisim.engine import protocol

if TYPE_CHECKING:
    from tuisim.app.actions import ActionContext

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0, 16.0, 0.0)
"""Speeds that `[` and `]` step through, as multiples of real time; 0 is as fast as possible."""


def run(context: ActionContext) -> None:
    """Start the program; if it is paused, start it again from its beginning.

    If a past instant is in view, ask whether to start a branch at that instant, or the program from its beginning.
    """
    if context.runs.in_past:
        propose_branch(context, None, restart=True)
    elif context.runs.state is RunPhase.PAUSED:
        if context.document.apply():
            context.runs.close()
            context.app.run_changed()
            context.app.start_run()
    else:
        context.app.start_run()


def pause(context: ActionContext) -> None:
    """Pause the program if it runs; else continue it.

    While a past instant is in view, start or stop the playback of the past instead.
    """
    timeline = context.runs.timeline
    if timeline.playing:
        timeline.stop_playback()
        context.app.draw(force=True)
    elif context.runs.in_past:
        timeline.play(time.monotonic())
        context.app.draw(force=True)
    elif context.runs.state == RunPhase.PAUSED:
        context.runs.send(protocol.Resume())
    else:
        context.runs.pause()


def change_speed(context: ActionContext, by: int) -> None:
    """Change the speed of the run by a number of steps in `SPEEDS`; a negative number makes the run slower."""
    speed = context.runs.speed
    index = (
        SPEEDS.index(speed)
        if speed in SPEEDS
        else min(range(6), key=lambda i: abs(SPEEDS[i] - speed))
    )
    new_index = index + by
    if not 0 <= new_index < len(SPEEDS):
        context.app.say(
            f"The speed is already {speed_label(speed)}, the {'slowest' if by < 0 else 'fastest'}"
        )
        return
    context.runs.has_chosen_speed = True
    context.runs.set_speed(SPEEDS[new_index])
    context.app.handle_situation_change()


def run_to_cursor(context: ActionContext) -> None:
    """Continue the program until it is about to execute the line of the cursor in the code."""
    if line := _find_cursor_line(context):
        context.debugger.run_to(line)


def toggle_break(context: ActionContext) -> None:
    """Set a breakpoint or, if there is one, remove it.

    Its line is that of the cursor if the code has the focus, else the current line. Without a current line, give the
    code the focus, so that the user can choose a line.
    """
    code = context.panels.code
    current = context.debugger.current_line
    if current and not (code and code.is_read):
        context.debugger.toggle_line(current, "the current one")
    elif code and code.is_read:
        context.debugger.toggle_line(code.cursor_line, "where the cursor is")
    else:
        _go_to_code(context)


def _find_cursor_line(context: ActionContext) -> int:
    """Return the line of the cursor in the code; if the code panel is hidden, show it and return 0."""
    area = context.panels
    if area.is_shown("code"):
        return area.code.cursor_line if area.code else 0
    _go_to_code(context)
    return 0


def _go_to_code(context: ActionContext) -> None:
    """Give the code the focus, so that the user can choose a line."""
    area = context.panels
    if not area.is_shown("code"):
        area.toggle("code")
    context.app.call_after_refresh(area.focus_opened, "code")
    context.app.say("The cursor in the code sets the line: the arrow keys move it")


def list_breaks(context: ActionContext) -> None:
    """Open the dialog of the breakpoints."""
    from tuisim.app.dialogs.entries import BreaksDialog

    context.app.push_screen(
        BreaksDialog(
            context.debugger.breaks,
            context.runs.spec,
            context.debugger.set_breaks,
            context.debugger.lines,
        )
    )


def list_watches(context: ActionContext) -> None:
    """Open the dialog of the watches."""
    from tuisim.app.dialogs.entries import WatchesDialog

    context.app.push_screen(
        WatchesDialog(context.debugger.watches, context.runs.spec, context.debugger.set_watches)
    )
