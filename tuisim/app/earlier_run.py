"""The earlier run: its robot is drawn beside that of the run in view, and where the two parted can be found."""

from __future__ import annotations

from tuisim.core.geometry import Pose
from tuisim.runs.recorded_run import Recording


def is_comparable(earlier: Recording, later: Recording) -> bool:
    """Return whether the robot of an earlier run may be drawn beside that of a later one: it drove on the same mat."""
    return earlier.newest > 0 and earlier.spec.world.background == later.spec.world.background


def pose_at(run: Recording, time_s: float) -> Pose:
    """Return the pose of a run's robot at a time in seconds; after its end, the last one."""
    tick = round(time_s * run.spec.profile.tick_hz)
    return run.telemetry.record(min(tick, run.newest)).pose


def left_at_s(later: Recording, earlier: Recording) -> float | None:
    """Return the time in seconds at which a run left an earlier one; None if it never did.

    Raises:
        LogError: a recording is damaged.
    """
    from tuisim.runs.diff import parted_at_s

    hz = later.spec.profile.tick_hz, earlier.spec.profile.tick_hz
    return parted_at_s(later.telemetry.array(), earlier.telemetry.array(), hz)
