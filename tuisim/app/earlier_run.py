"""The earlier run: its robot is drawn beside that of the run in view."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from itertools import takewhile

from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.runs.diff import is_repeat
from tuisim.engine.runs.recorded_run import Recording
from tuisim.engine.runs.run_folder import StoredRun


def is_comparable(earlier: Recording, later: Recording) -> bool:
    """Return whether two runs drove on the same mat.

    If they did, the robot of the earlier run can be drawn beside that of the later run.
    """
    return earlier.newest > 0 and earlier.spec.world.background == later.spec.world.background


def find_pose(run: Recording, time_s: float) -> Pose:
    """Return the pose of a run's robot at a simulated time in s; after the end of the run, its last pose."""
    tick = round(time_s * run.spec.profile.tick_hz)
    return run.telemetry.record(min(tick, run.newest)).pose


def find_run_before(later: Recording) -> Recording | None:
    """Return the newest stored run that is older than `later` and had the same program text, arguments and settings.

    The result is None if there is no such run. Only runs of the same program file are compared.

    Raises:
        LogError: the store cannot be read.
    """
    before = map(Recording, _load_runs(later.program, later.run_id))
    return next((run for run in before if is_repeat(later, run)), None)


def find_similar_run(program: Program, spec: RunSpec) -> StoredRun | None:
    """Return the newest stored run of a program file, if it ran the same text with the same specification.

    The result is None if the newest run had another text or specification, if no run is stored, or if it cannot be
    read.
    """
    with suppress(LogError):
        run = next(_load_runs(program, ""), None)
        if run and run.program.text == program.text and run.spec == spec:
            return run
    return None


def _load_runs(program: Program, before: str) -> Iterator[StoredRun]:
    """Yield the stored runs of a program file, the newest first.

    Args:
        program: The program.
        before: Id of a run; only older runs are returned. Empty for all runs.
    """
    from tuisim.engine.runs.store import RunStore

    store = RunStore()
    listed = takewhile(lambda info: info.id != before, store.runs() if program.path else ())
    for info in reversed([info for info in listed if info.program == program.name and info.ticks]):
        # Skip a run that cannot be read.
        with suppress(LogError):
            if (run := store.load_run(info.id)).program.path == program.path:
                yield run
