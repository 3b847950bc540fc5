"""The timeline that all panels share: the current run, and the instant of it in view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.runs.brick_state import BrickState, face_after
from tuisim.runs.records import Mark

if TYPE_CHECKING:
    from tuisim.runs.recording import Recording
    from tuisim.runs.views import TickRecord

FASTEST = 16.0
"""Playback speed, relative to real time, when the speed is as fast as possible."""


class Timeline:
    """The current run and the cursor in its time."""

    def __init__(self) -> None:
        self.recording: Recording | None = None
        """The live run, the last one, or a stored one; None before the first."""
        self.at: int | None = None
        """Tick in view, None for now."""
        self.breaks: list[int] = []
        """Ticks at which the run was paused by a breakpoint."""
        self._played_s: float | None = None
        """Simulated time that playback has reached, None while it is stopped."""
        self._wall_s = 0.0
        self._face_numbers: list[int] = []
        self._face = BrickState()
        """What the brick showed after output rows, by row number."""

    def switch_to(self, recording: Recording | None) -> None:
        """Switch to another run, at its newest instant."""
        self.recording = recording
        self._face_numbers, self._face = [], BrickState()
        self.breaks.clear()
        self.go(None)

    # State

    @property
    def newest(self) -> int:
        """Tick of the newest record, -1 if there is none."""
        return self.recording.newest if self.recording else -1

    @property
    def tick_hz(self) -> int:
        """Ticks per second."""
        return self.recording.spec.profile.tick_hz if self.recording else 1

    @property
    def time_s(self) -> float:
        """Simulated time in view."""
        return max(0, self.newest if self.at is None else self.at) / self.tick_hz

    @property
    def playing(self) -> bool:
        """Whether the recording is being played."""
        return self._played_s is not None

    def record(self) -> TickRecord | None:
        """Return the record in view, None for now."""
        if self.at is None or self.recording is None:
            return None
        return self.recording.telemetry.record(self.at)

    def face(self) -> BrickState:
        """Return what the brick shows at the instant in view."""
        if self.recording is None:
            return BrickState()
        numbers = self.recording.rows.face_numbers(self.newest if self.at is None else self.at)
        if numbers != self._face_numbers:
            self._face_numbers = numbers
            self._face = face_after(BrickState(), [self.recording.rows.row(number) for number in numbers])
        return self._face

    def marks(self) -> list[tuple[int, Mark]]:
        """Return the marked ticks, with the kind of each marker."""
        if self.recording is None:
            return []
        done = [(action.tick, Mark.ACTION) for action in self.recording.actions()]
        return [*self.recording.rows.marks, *done, *((tick, Mark.BREAK) for tick in self.breaks)]

    # Navigation

    def go(self, tick: int | None) -> None:
        """Go to a tick, clamped to the first one; None and ticks beyond the newest mean now."""
        self._played_s = None
        self.at = None if tick is None or tick >= self.newest or self.newest <= 0 else max(0, tick)

    def step(self, ticks: int) -> None:
        """Go forward by a number of ticks; negative goes back."""
        self.go((self.newest if self.at is None else self.at) + ticks)

    def play(self, wall_s: float) -> None:
        """Start to play the recording from the instant in view."""
        if self.at is not None:
            self._played_s, self._wall_s = self.at / self.tick_hz, wall_s

    def stop_playback(self) -> None:
        """Stop playback."""
        self._played_s = None

    def beat(self, wall_s: float, speed: float) -> bool:
        """Continue playback. Return whether the newest instant has just been reached.

        Args:
            wall_s: Seconds that only grow.
            speed: 1.0 real time, 0 as fast as possible.
        """
        if self._played_s is None:
            return False
        self._played_s += (wall_s - self._wall_s) * (speed or FASTEST)
        self._wall_s = wall_s
        tick = int(self._played_s * self.tick_hz + 1e-6)
        if tick >= self.newest:
            self.go(None)
            return True
        self.at = tick
        return False
