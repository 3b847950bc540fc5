"""Frame pacing: no new frame while the terminal has not yet shown an older one.

After each frame the terminal is asked for its cursor position; the answer comes when
it has worked through all that was written before. So a slow link shows fewer frames,
never old ones. A link with a long round trip may have several frames on the way.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

TIMEOUT_S = 1.0
"""After this long an answer is given up."""
MAX_MISSED = 3
"""After so many lost answers in a row the terminal is taken not to answer at all."""
MAX_ON_THE_WAY = 3


class Pacer:
    """Says when a frame may be drawn.

    Args:
        fps: Most frames a second.
        asks: Whether the terminal is to be asked at all.
        clock: Seconds that only grow.
    """

    def __init__(self, fps: int, asks: bool = True, clock: Callable[[], float] = time.monotonic) -> None:
        self._gap_s = 1.0 / fps
        self.asks = asks
        self._clock = clock
        self._sent_at: deque[float] = deque()
        self._last_s = -1.0
        self._round_trip_s = 0.0
        self._missed = 0

    def ready(self) -> bool:
        """Whether a frame may be drawn now."""
        now = self._clock()
        while self._sent_at and now - self._sent_at[0] > TIMEOUT_S:
            self._sent_at.popleft()
            self._missed += 1
            if self._missed >= MAX_MISSED:
                self.asks = False
                self._sent_at.clear()
        # The quickest answer of late is the way there and back; what is longer is a backlog.
        allowed = min(MAX_ON_THE_WAY, 1 + int(self._round_trip_s / self._gap_s))
        # A tenth of a gap of grace, or a timer that is a little early would halve the rate.
        return len(self._sent_at) < allowed and now - self._last_s >= 0.9 * self._gap_s

    def drawn(self) -> bool:
        """Note that a frame was drawn; whether the terminal is to be asked now."""
        self._last_s = self._clock()
        if self.asks:
            self._sent_at.append(self._last_s)
        return self.asks

    def answered(self) -> None:
        """Note an answer of the terminal."""
        self._missed = 0
        if self._sent_at:
            took_s = self._clock() - self._sent_at.popleft()
            # Falls at once, rises slowly: a backlog must not pass for a long way.
            self._round_trip_s = min(took_s, self._round_trip_s + 0.004)
