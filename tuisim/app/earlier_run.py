"""The earlier run: its robot is drawn beside that of the run in view."""

from __future__ import annotations

from contextlib import suppress
from itertools import takewhile

from tuisim.core.geometry import Pose
from tuisim.errors import LogError
from tuisim.runs.recorded_run import Recording


def is_comparable(earlier: Recording, later: Recording) -> bool:
    """Return whether the robot of an earlier run may be drawn beside that of a later one: it drove on the same mat."""
    return earlier.newest > 0 and earlier.spec.world.background == later.spec.world.background


def pose_at(run: Recording, time_s: float) -> Pose:
    """Return the pose of a run's robot at a time in seconds; after its end, the last one."""
    tick = round(time_s * run.spec.profile.tick_hz)
    return run.telemetry.record(min(tick, run.newest)).pose


def stored_before(later: Recording) -> Recording | None:
    """Return the last stored run of the same program file on the same mat, before another run; None if there is none.

    Raises:
        LogError: the store cannot be read.
    """
    from tuisim.runs.store import RunStore

    store, path = RunStore(), later.program.path
    if not path:
        return None
    listed = takewhile(lambda info: info.id != later.run_id, store.runs())
    for info in reversed(
        [info for info in listed if info.program == later.program.name and info.ticks]
    ):
        # One that cannot be read is no reason to find none.
        with suppress(LogError):
            run = Recording(store.load_run(info.id))
            if run.program.path == path and is_comparable(run, later):
                return run
    return None
