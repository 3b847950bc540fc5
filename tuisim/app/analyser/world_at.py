"""The robot's pose and sensor view at the time of a sample, from the recording or from the log."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from tuisim.app.setup.mat import Mat, blank_mat, prepare_mat, prepare_mat_of
from tuisim.app.snapshot import RunPhase, Snapshot, snapshot_of
from tuisim.core.geometry import Pose
from tuisim.core.spec import RunSpec, from_plain
from tuisim.core.state import FLAG_PEN_DOWN, Instant
from tuisim.errors import TuisimError
from tuisim.runs.recording import Recording
from tuisim.runs.views import instant_of

if TYPE_CHECKING:
    from tuisim.analysis.source import OpenedLog
    from tuisim.logs.log import Log
    from tuisim.runs.run_folder import StoredRun

_POSE = ("x_mm", "y_mm", "heading_deg")


class WorldAt:
    """The world of one run, at any time of it.

    Args:
        spec: The run's specification.
        mat: Its mat.
        run: The run, if it is in the store.
        log: The source of the poses otherwise.
    """

    def __init__(self, spec: RunSpec, mat: Mat, run: StoredRun | None, log: Log) -> None:
        self.spec, self.mat = spec, mat
        self._recording = Recording(run) if run is not None else None
        self._log = log
        self.text = run.program.text if run is not None else ""
        """The program, empty if unknown."""

    def at(self, time_s: float, row: int) -> Snapshot:
        """Return the snapshot at a time.

        Args:
            time_s: Simulated time.
            row: The row of the log at that time.
        """
        found = self._recorded(time_s) if self._recording is not None else None
        return found or self._logged(time_s, row)

    def _recorded(self, time_s: float) -> Snapshot | None:
        recording = self._recording
        if recording is None or recording.newest < 0:
            return None
        tick = min(max(round(time_s * self.spec.profile.tick_hz), 0), recording.newest)
        record = recording.telemetry.record(tick)
        instant = instant_of(record, self.spec, recording.noise_at(record))
        field = recording.field_at(tick, self.mat.field) if self.mat.field else None
        pen = bool(record.flags & FLAG_PEN_DOWN)
        return snapshot_of(
            instant, self.spec, field, state=RunPhase.ENDED, end=None, line=record.line, speed=1.0, pen_down=pen
        )

    def _logged(self, time_s: float, row: int) -> Snapshot:
        table = self._log.table
        x_mm, y_mm, heading_deg = (table.column(name)[row].as_py() for name in _POSE)
        pose = Pose(float(x_mm or 0.0), float(y_mm or 0.0), float(heading_deg or 0.0))
        tick = round(time_s * self.spec.profile.tick_hz)
        instant = Instant(tick, pose, noise=self.spec.world.noise, seed=self.spec.seed)
        line = table.column("line")[row].as_py() if "line" in table.column_names else 0
        return snapshot_of(
            instant,
            self.spec,
            self.mat.field,
            state=RunPhase.ENDED,
            end=None,
            line=int(line or 0),
            speed=1.0,
            pen_down=False,
        )


def tells_places(subject: OpenedLog) -> bool:
    """Return whether a log has poses of a robot."""
    if subject.runs:
        return True
    named = set(_POSE) <= set(subject.log.table.column_names)
    return named and _spec_in(subject.log.metadata, 0) is not None


def place_of(subject: OpenedLog, run: int) -> WorldAt | None:
    """Return the world of a run of a log, None if it is unknown. Blocks, long the first time for each mat.

    Args:
        subject: The log.
        run: Which of its runs, from 0.
    """
    if run < len(subject.runs):
        stored = subject.runs[run]
        try:
            mat = prepare_mat_of(stored)
        except TuisimError:
            mat = blank_mat(stored.spec)
        return WorldAt(stored.spec, mat, stored, subject.log)
    if not set(_POSE) <= set(subject.log.table.column_names):
        return None
    spec = _spec_in(subject.log.metadata, run)
    if spec is None:
        return None
    try:
        mat = prepare_mat(spec)
    except TuisimError:
        mat = blank_mat(spec)
    return WorldAt(spec, mat, None, subject.log)


def _spec_in(metadata: Mapping[str, Any], run: int) -> RunSpec | None:
    """Return the specification in the metadata of an export, if any."""
    try:
        entry = metadata["runs"][run]
        return from_plain({key: value for key, value in entry.items() if key not in ("run", "program")})
    except (KeyError, IndexError, TypeError, ValueError, AttributeError, TuisimError):
        return None
