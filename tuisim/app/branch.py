"""Branches from a past instant: the run is repeated up to there, and continues live.

The user's actions until then are repeated too, each at its tick, so that the state at the branch is bit-identical.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.engine import protocol
from tuisim.engine.core.spec import NoiseSpec
from tuisim.engine.protocol import UserAction

if TYPE_CHECKING:
    from tuisim.base.source import Program
    from tuisim.engine.runs.recorded_run import Recording

BRANCH_TAG = "branch-of-"
"""Prefix of the tag of a branch; the number of the run that it branched off from follows, or that run's id."""

_WORLD_FIELDS = (
    "x_mm",
    "y_mm",
    "heading_deg",
    "left_position_deg",
    "right_position_deg",
    "left_speed_dps",
    "right_speed_dps",
    "gyro_zero_deg",
    "flags",
    "actions",
)
"""Fields of a tick record that show whether the worlds of two runs differ; inserted lines do not change them."""


@dataclass(frozen=True, slots=True)
class Branch:
    """A run that repeats a former run up to an instant, and then differs by a user action or an edited program."""

    of: Recording
    tick: int
    program: Program
    then: protocol.Message | None
    """The user action that the branch adds at the instant at which it departs from the former run; None for none."""
    goes_on: bool
    """Whether the branch continues at the instant up to which it repeats the former run; else it pauses there."""

    @property
    def time_s(self) -> float:
        """The simulated time in s of the instant up to which the branch repeats the former run."""
        return self.tick / self.of.spec.profile.tick_hz

    @property
    def edited(self) -> bool:
        """Whether the text of the branch's program differs from the text in the former run."""
        return (self.program.text, self.program.prelude) != (
            self.of.program.text,
            self.of.program.prelude,
        )

    @property
    def title(self) -> str:
        """The branch in words, for messages, such as `branch of run 12 at 3.50 s`."""
        return f"branch of {self.of.name} at {self.time_s:.2f} s"

    @property
    def tags(self) -> tuple[str, str]:
        """The tags of the branch's run: the run from which it branched off, and the time, such as `at-3.50s`."""
        return f"{BRANCH_TAG}{self.of.number or self.of.run_id}", f"at-{self.time_s:.2f}s"

    @property
    def noise(self) -> NoiseSpec:
        """The noise in the branch after the instant at which it leaves the former run.

        This is the noise that the user sets at that instant. If the user sets none, it is the noise of the former run
        at that instant.
        """
        if isinstance(self.then, protocol.SetNoise):
            return NoiseSpec(self.then.light, self.then.motor)
        return self.of.find_noise(self.of.telemetry.record(self.tick))

    def script(self) -> tuple[UserAction, ...]:
        """Return the user actions that the branch repeats: those of the former run up to the instant of the branch."""
        return tuple(action for action in self.of.actions() if action.tick <= self.tick)

    @property
    def runs(self) -> Program:
        """The program that the branch runs: the present text, with the former run's arguments."""
        return replace(
            self.of.program,
            name=self.program.name,
            text=self.program.text,
            prelude=self.program.prelude,
        )


def find_first_difference(before: Recording, now: Recording, tick: int) -> int | None:
    """Return the first tick, up to `tick`, at which the worlds of two runs differ; None if they do not differ.

    If a run has ended before they differ, the result is the first tick that this run does not have.
    """
    old, new = (run.telemetry.array()[: tick + 1] for run in (before, now))
    both = min(len(old), len(new))
    differs = np.zeros(both, bool)
    for name in _WORLD_FIELDS:
        differs |= old[name][:both] != new[name][:both]
    if differs.any():
        return int(np.argmax(differs))
    return both if both <= tick else None


def build_branch_message(branch: Branch, now: Recording) -> str:
    """Return the notice that a run is a branch.

    If the two runs differ even before the instant of the branch, the notice also gives the time of the first
    difference.
    """
    differs = find_first_difference(branch.of, now, branch.tick)
    words = f"This is a {branch.title}" + (", of the edited program" if branch.edited else "")
    if differs is None:
        return words
    hz = now.spec.profile.tick_hz
    if branch.edited:
        return f"{words}: it differs from {differs / hz:.2f} s on"
    return f"{words}, but the program is not deterministic: it differs from {differs / hz:.2f} s on"


def action_words(action: protocol.Message | None) -> str:
    """Return a user action as the end of a sentence, such as ` with the pen down`; empty for no action."""
    match action:
        case protocol.SetPose(x_mm=x, y_mm=y, heading_deg=heading):
            return f" with the robot at x {x:z.0f}, y {y:z.0f}, {heading:z.0f}°"
        case protocol.SetNoise(light=light, motor=motor):
            return f" with noise {light} in the light and {motor} in the motors"
        case protocol.SetPen(down=down):
            return f" with the pen {'down' if down else 'up'}"
        case _:
            return ""
