"""A program that steers by light, on a mat with nothing to see."""

from __future__ import annotations

from tuisim.engine.core.spec import EMPTY_MAT
from tuisim.engine.protocol import End
from tuisim.tasks.reasons.run_data import RunData

GIVES_LINE = "-b Loop gives it a line (tuisim backgrounds)"
"""The remedy for a program that looks for a line on the plain mat."""
_MIN_READINGS = 20
"""The least number of light readings of a program that looks for something."""
_LOST_LINE = "LineFollowErrorLostLine"
"""What `follow_line` of ev3dev2 raises."""


def describe_blank_mat(data: RunData) -> str:
    """Return a text which says that the mat of a run is plain white, and how to get a line; empty for other mats.

    The text is also empty if the run still goes on or was stopped, if the robot has not moved, or if light sensors do
    not decide what the program does.
    """
    run = data.run
    world = run.spec.world
    is_blank = world.background == EMPTY_MAT and not world.pen_marks
    if not is_blank or run.end is None or run.end.end not in (End.FINISHED, End.RAISED):
        return ""
    last = run.telemetry.last()
    has_moved = last is not None and last.pose != world.start
    has_read = sum(map(len, data.light_ticks.values())) >= _MIN_READINGS
    is_steered = _LOST_LINE in run.end.error or data.decides_by_light
    return f"the mat is plain white: {GIVES_LINE}" if has_moved and has_read and is_steered else ""
