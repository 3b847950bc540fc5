"""A program that steers by light, on a mat with nothing to see."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tuisim.engine.core.spec import EMPTY_MAT
from tuisim.engine.protocol import End
from tuisim.engine.runs.readings import MODES_BY_KIND, read_readings
from tuisim.programs.facts import read_facts
from tuisim.tasks.reasons.waited_words import GIVES_LINE

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun

_MIN_READINGS = 20
"""The least number of light readings of a program that looks for something."""
_LOST_LINE = "LineFollowErrorLostLine"
"""What `follow_line` of ev3dev2 raises."""
_MAX_LINES = 64
"""The most reading lines of a program that are analysed."""


def describe_blank_mat(run: StoredRun) -> str:
    """Return as text that the mat of a run is plain white, and how to get a line.

    The result is empty unless the run has ended by itself, the robot has moved, and the program decided by light.
    """
    world = run.spec.world
    is_blank = world.background == EMPTY_MAT and not world.pen_marks
    if not is_blank or run.end is None or run.end.end not in (End.FINISHED, End.RAISED):
        return ""
    last = run.telemetry.last()
    if last is None or last.pose == world.start:
        return ""
    rows = read_readings(run.folder).find(MODES_BY_KIND["color"])
    if len(rows) < _MIN_READINGS:
        return ""
    lines = np.unique(rows["line"])[:_MAX_LINES].tolist()
    facts = read_facts(run.program)
    if _LOST_LINE not in run.end.error and not any(
        facts.find_question(line).decides for line in lines
    ):
        return ""
    return f"the mat is plain white: {GIVES_LINE}"
