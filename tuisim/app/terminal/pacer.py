"""Frame pacing and throttling: no new frame while the terminal has not shown an older one."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable

from textual.timer import Timer
from textual.widget import Widget


class Throttle:
    """Calls a function at most once a period.

    Args:
        widget: Whose timers are used; while it is not mounted nothing is called.
        period_s: Least time between two calls, in wall-clock seconds.
        do: The function.
    """

    def __init__(self, widget: Widget, period_s: float, do: Callable[[], None]) -> None:
        self._widget = widget
        self._period_s = period_s
        self._do = do
        self._last_s = 0.0
        self._timer: Timer | None = None

    def ask(self) -> None:
        """Call the function now if the last call is a period ago, else as soon as it is."""
        if self._timer is not None or not self._widget.is_attached:
            return
        left_s = self._last_s + self._period_s - time.monotonic()
        if left_s > 0:
            self._timer = self._widget.set_timer(left_s, self.now)
        else:
            self.now()

    def now(self) -> None:
        """Call the function at once."""
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        self._last_s = time.monotonic()
        if self._widget.is_attached:
            self._do()


PATIENCE_S = 1.0
"""An answer takes no longer than this, besides the time for what is on the way before it."""
SLOWEST_BYTES_S = 4_000.0
"""No line is slower."""
PROOF_S = 10.0
"""A terminal that has not answered so long, besides the time for the first paint, is taken to answer never."""
UNPROVEN_GAP_S = 0.5
"""Between two frames while it is not known whether the terminal answers at all."""
MAX_ON_THE_WAY = 3
_REMEMBERED = 8
"""Questions without an answer that are kept in mind."""
FULL_BYTES = 3_000
"""While more than this is on the way there is no further frame, however long the way: a quarter of a second of a line
of 128 kbit/s."""
LARGE_BYTES = 1_500
"""So much is asked about even if it is no frame, such as a dialog."""


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
        self._asked: deque[tuple[float, int]] = deque(maxlen=_REMEMBERED)
        """When each question was sent that has not been answered yet, and the bytes since the one before."""
        self._heard_s = 0.0
        """When there was last an answer, or nothing to wait for."""
        self._proof_s: float | None = None
        """When a terminal that has not answered by then is taken to answer never."""
        self._loose_bytes = 0
        """What was sent since the last question."""
        self._frame_is_new = False
        self._last_s = -1.0
        self._round_trip_s = 0.0
        self._allowed = 1
        self.answers = False
        """Whether the terminal has ever answered."""

    def ready(self) -> bool:
        """Whether a frame may be drawn now."""
        now = self._clock()
        # A tenth of a gap of grace, or a timer that is a little early would halve the rate.
        if now - self._last_s < 0.9 * self._gap_s:
            return False
        if not self._asked:
            return True
        if not self.answers:
            return now - self._last_s >= UNPROVEN_GAP_S or (self._proof_s is not None and now >= self._proof_s)
        way_bytes = sum(size for _, size in self._asked)
        if now - self._heard_s >= PATIENCE_S + way_bytes / SLOWEST_BYTES_S:
            # One that has answered before has lost a question: there is no use in waiting for all of them.
            self._asked.clear()
        return not self._asked or (len(self._asked) < self._allowed and way_bytes < FULL_BYTES)

    def drawn(self) -> None:
        """Note that a frame was drawn; it is on its way once it has been painted."""
        self._last_s = self._clock()
        self._frame_is_new = True

    def painted(self, size: int) -> bool:
        """Note that so many bytes were sent; whether the terminal is to be asked now when it has shown them."""
        self._loose_bytes += size
        if not self.asks or not (self._frame_is_new or self._loose_bytes >= LARGE_BYTES):
            return False
        self._frame_is_new = False
        now = self._clock()
        if not self._asked:
            self._heard_s = now
        if self._proof_s is None:
            self._proof_s = now + PROOF_S + self._loose_bytes / SLOWEST_BYTES_S
        self._asked.append((now, self._loose_bytes))
        self._loose_bytes = 0
        return True

    def answered(self) -> None:
        """Note an answer of the terminal."""
        self._heard_s = self._clock()
        first, self.answers = not self.answers, True
        if not self._asked:
            return
        took_s = self._heard_s - self._asked.popleft()[0]
        # Falls at once, rises slowly: a backlog must not pass for a long way.
        self._round_trip_s = took_s if first else min(took_s, self._round_trip_s + 0.001)
        if took_s > self._round_trip_s + 2 * self._gap_s:
            self._allowed = 1
        else:
            # Two at least, or an answer that comes a moment after a beat would cost the next frame.
            self._allowed = min(self._allowed + 1, MAX_ON_THE_WAY, 2 + int(self._round_trip_s / self._gap_s))
