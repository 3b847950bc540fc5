"""What a movie shows: the panels, the part of a run, and the instants at which its frames are taken."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import replace
from enum import StrEnum

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, LogError
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import Unended
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.samples import list_samples
from tuisim.engine.runs.views import TickRecord

END_MS = 1000
"""Additional time of the last frame, so that the end of a looping movie can be seen."""

_STEP_MS = 10
"""GIF counts time in hundredths of a second."""


class ClipPanel(StrEnum):
    """A panel that a movie's frames can have."""

    WORLD = "world"
    CHART = "chart"
    ARRAYS = "arrays"


@dataclass(frozen=True, slots=True)
class Shot:
    """One frame of a movie: the simulated time that it shows, and how long it is shown."""

    time_s: float
    """Simulated time that the frame shows."""
    duration_ms: int
    """How long the frame is shown."""


def plan_shots(start_s: float, stop_s: float, speed: float, fps: float) -> tuple[Shot, ...]:
    """Return the frames of a movie; the first shows the start and the last the end of a range of simulated time.

    Args:
        start_s, stop_s: The range in s; the start is not after the end.
        speed: Simulated seconds per second of the movie.
        fps: Frames per second of the movie.
    """
    count = count_shots(start_s, stop_s, speed, fps)
    # Every time is rounded from the start of the clip, so that the errors do not add up.
    begins_ms = [round(number * 1000 / fps / _STEP_MS) * _STEP_MS for number in range(count + 1)]
    begins_ms[-1] += END_MS
    times_s = [min(start_s + number * speed / fps, stop_s) for number in range(count - 1)] + [
        stop_s
    ]
    return tuple(
        Shot(time_s, begins_ms[number + 1] - begins_ms[number])
        for number, time_s in enumerate(times_s)
    )


def count_shots(start_s: float, stop_s: float, speed: float, fps: float) -> int:
    """Return the number of frames of a movie, for the arguments of `plan_shots`."""
    return math.ceil((stop_s - start_s) * fps / speed - 1e-9) + 1


@dataclass(frozen=True, slots=True)
class ClipMoment:
    """The state of a run at one instant: its record, and the newest printed value of each variable."""

    time_s: float
    tick: int
    record: TickRecord
    values: tuple[tuple[str, float], ...]
    """The newest value of each variable that was printed up to then, by name."""


class ClipRun:
    """A recorded run that can be read at any instant.

    Args:
        run: The run.

    Raises:
        LogError: the run is still going on, nothing of it was recorded, or its recording is damaged.
    """

    def __init__(self, run: StoredRun) -> None:
        if run.state is Unended.RUNNING:
            raise LogError(
                f"run {run.number} is still running",
                "wait until it ends, or stop it",
                file=str(run.folder),
            )
        if not run.telemetry.count:
            why = "; ".join(run.notes)
            raise LogError(f"run {run.number} has no recorded tick", why, file=str(run.folder))
        self.run = run
        self.telemetry = run.telemetry.array()
        self._hz = run.spec.profile.tick_hz
        self.samples = [
            replace(sample, time_s=sample.time_ns / NS_PER_S)
            for sample in list_samples(run.output.rows())
        ]
        """What was printed, at the simulated times of the prints."""
        self._values: dict[str, tuple[list[int], list[float]]] = {}
        for sample in self.samples:
            ticks, values = self._values.setdefault(sample.name, ([], []))
            ticks.append(sample.tick)
            values.append(sample.value)

    @property
    def end_s(self) -> float:
        """The simulated time of the run's last tick, in s."""
        return (len(self.telemetry) - 1) / self._hz

    def clip_span_s(self, start_s: float | None, stop_s: float | None) -> tuple[float, float]:
        """Return the start and the end of a range of the run in simulated s; None is the run's own start or end.

        Raises:
            ConfigError: the range is empty, or not in the run.
        """
        low = 0.0 if start_s is None else start_s
        high = self.end_s if stop_s is None else min(stop_s, self.end_s)
        known = f"run {self.run.number} lasts from 0 s to {self.end_s:g} s"
        # This condition is true for NaN, too.
        if not 0 <= low <= high or (low == high and (start_s, stop_s) != (None, None)):
            requested = low, self.end_s if stop_s is None else stop_s
            raise ConfigError(
                f"nothing to show from {requested[0]:g} s to {requested[1]:g} s",
                known,
                key="--from, --to",
            )
        return low, high

    def read_moment(self, time_s: float) -> ClipMoment:
        """Return the state of the run at a simulated time in s, which must be within the run."""
        # As a float, a time such as 0.29 s is slightly less than 29 hundredths.
        tick = min(math.floor(time_s * self._hz + 1e-6), len(self.telemetry) - 1)
        values = []
        for name, (ticks, numbers) in self._values.items():
            if count := bisect_right(ticks, tick):
                values.append((name, numbers[count - 1]))
        return ClipMoment(time_s, tick, self.run.telemetry.record(tick), tuple(values))
