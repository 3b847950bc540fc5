"""One timeline for everything that is shown: the run at hand, and the instant of it that is looked at."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tuisim.runs.brick_state import BrickState, face_after

if TYPE_CHECKING:
    from tuisim.runs.recording import Recording
    from tuisim.runs.views import TickRecord

ACTION, BREAK = "action", "break"
"""What is marked besides what the output gives: the user did something; the run met a breakpoint."""

FASTEST = 16.0
"""Times real time that a recorded stretch is played at when the speed is as fast as possible."""


class Timeline:
    """The run at hand and the cursor in its time."""

    def __init__(self) -> None:
        self.recording: Recording | None = None
        """The run at work, the last one, or one from the store; None before the first."""
        self.at: int | None = None
        """Tick that is looked at, None for now."""
        self.breaks: list[int] = []
        """Ticks at which the run was held by a breakpoint."""
        self._played_s: float | None = None
        """Simulated time reached while the recording is played, None while it stands."""
        self._wall_s = 0.0
        self._face_numbers: list[int] = []
        self._face = BrickState()
        """What was shown after the rows of those numbers."""

    def take(self, recording: Recording | None) -> None:
        """Turn to another run, and to its newest instant."""
        self.recording = recording
        self._face_numbers, self._face = [], BrickState()
        self.breaks.clear()
        self.go(None)

    # What is the case

    @property
    def newest(self) -> int:
        """Tick of the newest record, -1 if there is none."""
        return self.recording.newest if self.recording else -1

    @property
    def tick_hz(self) -> int:
        """Ticks a second."""
        return self.recording.spec.profile.tick_hz if self.recording else 1

    @property
    def time_s(self) -> float:
        """Simulated time that is looked at."""
        return max(0, self.newest if self.at is None else self.at) / self.tick_hz

    @property
    def playing(self) -> bool:
        """Whether the recording is being played forward."""
        return self._played_s is not None

    def record(self) -> TickRecord | None:
        """Return the record that is looked at, None for now."""
        if self.at is None or self.recording is None:
            return None
        return self.recording.telemetry.record(self.at)

    def face(self) -> BrickState:
        """Return what the brick shows at the instant that is looked at."""
        if self.recording is None:
            return BrickState()
        numbers = self.recording.rows.face_numbers(self.newest if self.at is None else self.at)
        if numbers != self._face_numbers:
            self._face_numbers = numbers
            self._face = face_after(BrickState(), [self.recording.rows.row(number) for number in numbers])
        return self._face

    def marks(self) -> list[tuple[int, str]]:
        """Return the ticks that stand out, with what they stand for."""
        if self.recording is None:
            return []
        done = [(action.tick, ACTION) for action in self.recording.actions()]
        return [*self.recording.rows.marks, *done, *((tick, BREAK) for tick in self.breaks)]

    # Going about in time

    def go(self, tick: int | None) -> None:
        """Look at a tick, at the first one if it is before that; None, the newest and all beyond are now."""
        self._played_s = None
        self.at = None if tick is None or tick >= self.newest or self.newest <= 0 else max(0, tick)

    def step(self, ticks: int) -> None:
        """Look at an instant so many ticks later, or earlier."""
        self.go((self.newest if self.at is None else self.at) + ticks)

    def play(self, wall_s: float) -> None:
        """Begin to play the recording from the instant that is looked at."""
        if self.at is not None:
            self._played_s, self._wall_s = self.at / self.tick_hz, wall_s

    def stand(self) -> None:
        """Stop playing."""
        self._played_s = None

    def beat(self, wall_s: float, speed: float) -> bool:
        """Go on playing; whether the newest instant has just been reached.

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
