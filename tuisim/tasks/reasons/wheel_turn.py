"""Where a robot turned by another angle than its program says, because the wheels turned by that angle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.engine.runs.arrays import find_spans
from tuisim.programs.facts import WheelTurn, read_facts

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun

_MIN_SHARE = 0.95
"""Wheels that turned less were stopped by something else."""
_ROUND_DEG = 45.0
"""Robots are turned by its multiples."""
_NEAR_DEG = 3.0
"""A turn that is so near to a multiple is meant."""


@dataclass(frozen=True, slots=True)
class MistakenTurn:
    """A turn of the wheels by an angle that was probably meant for the robot."""

    tick: int
    """When the turn began."""
    line: int
    text: str
    """What it did, a sentence that begins small and has no full stop."""


def find_mistaken_turn(run: StoredRun) -> MistakenTurn | None:
    """Return the first turn on the spot in which the wheels, but not the robot, turned by the angle in the program.

    Args:
        run: The run.
    """
    turns = [_measure(run, turn) for turn in read_facts(run.program).wheel_turns]
    return min((turn for turn in turns if turn), key=lambda turn: turn.tick, default=None)


def _measure(run: StoredRun, turn: WheelTurn) -> MistakenTurn | None:
    """Return how far a call turned the robot when it ran first; None if this angle seems to be intended."""
    records = run.telemetry.array()
    lines = records["line"]
    is_on = (lines >= turn.first_line) & (lines <= turn.last_line)
    spans = find_spans(is_on).tolist()
    if not spans:
        return None
    first, end = spans[0]
    span = records[max(0, first - 1) : end]
    wheels = [span[f"{side}_position_deg"] for side in ("left", "right")]
    left_deg, right_deg = (float(positions[-1] - positions[0]) for positions in wheels)
    wheel_deg = abs(left_deg - right_deg) / 2
    steps_deg = (np.diff(span["heading_deg"]) + 180) % 360 - 180
    # Two numbers may be speeds, or the steering of a curve and a speed.
    is_on_the_spot = abs(left_deg + right_deg) <= (1 - _MIN_SHARE) * wheel_deg
    if not is_on_the_spot or wheel_deg < turn.angle_deg * _MIN_SHARE:
        return None
    # The line may have run several times in a row: scale to one turn.
    robot_deg = abs(float(steps_deg.sum())) / wheel_deg * turn.angle_deg
    off_deg = abs(robot_deg - round(robot_deg / _ROUND_DEG) * _ROUND_DEG)
    if robot_deg < 1 or (robot_deg > _ROUND_DEG / 2 and off_deg <= _NEAR_DEG):
        return None
    needed_deg = turn.angle_deg**2 / robot_deg
    counted = "rotations" if turn.method.endswith("rotations") else "degrees"
    needed = f"{needed_deg / 360:.2f}" if counted == "rotations" else f"{needed_deg:.0f}"
    text = (
        f"this line turned the robot by {robot_deg:.0f}°: {turn.method} counts {counted} of the "
        f"wheels; {needed} turn the robot by {turn.angle_deg:.0f}° (tuisim guide motion-and-drift)"
    )
    return MistakenTurn(first, turn.first_line, text)
