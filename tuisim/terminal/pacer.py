"""Frame pacing and throttling: no new frame before the terminal has shown the last ones."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from math import inf

from textual.timer import Timer
from textual.widget import Widget


class Throttle:
    """Calls a function at most once in a period.

    Args:
        widget: Provides the timers; while it is not mounted, the function is not called.
        period_s: Minimum time between two calls, in wall-clock seconds.
        do: The function.
    """

    def __init__(self, widget: Widget, period_s: float, do: Callable[[], None]) -> None:
        self._widget = widget
        self.period_s = period_s
        self._do = do
        self._last_s = 0.0
        self._timer: Timer | None = None

    def ask(self, at_once: bool = False) -> None:
        """Request a call of the function.

        It is called now if the last call was at least a period ago, else when the period ends.

        Args:
            at_once: Whether to call it now in any case.
        """
        if at_once:
            self.call_now()
            return
        if self._timer is not None or not self._widget.is_attached:
            return
        left_s = self._last_s + self.period_s - time.monotonic()
        if left_s > 0:
            self._timer = self._widget.set_timer(left_s, self.call_now)
        else:
            self.call_now()

    def call_now(self) -> None:
        """Call the function without any delay."""
        if self._timer is not None:
            self._timer.stop()
            self._timer = None
        self._last_s = time.monotonic()
        if self._widget.is_attached:
            self._do()


PATIENCE_S = 1.0
"""The longest time to wait for a terminal's answer, besides the time that the data sent before the query takes."""
SLOWEST_BYTES_S = 4_000.0
"""Assumed bandwidth of the slowest link to a terminal, in bytes per second."""
PROOF_S = 10.0
"""A terminal that has not answered after this time, besides the time for the first paint, is assumed never to answer.
"""
UNPROVEN_GAP_S = 0.5
"""The least time between two frames while the terminal has not yet answered any query."""
PAGE_QUEUED_S = 0.5
"""The link to a browser's page counts as slow only when a frame waits longer than this: a page that is busy drawing
answers late, and glyphs are no less work for it than pixels.
"""
MAX_ON_THE_WAY = 3
_REMEMBERED = 8
"""The most unanswered queries that are remembered; a further one displaces the oldest."""
FULL_BYTES = 3_000
"""While more than this is in transit, no frame is drawn, whatever the latency: a quarter of a second at 128 kbit/s."""
LARGE_BYTES = 1_500
"""After this many bytes without a query the terminal is queried, even if no frame was among them, but a dialog was."""


SLOW_S = 2.0
"""A link on which a frame had to queue counts as slow for this long: twice as long each time this was too short."""
MAX_SLOW_S = 16.0


class Pacer:
    """Decides when a frame may be drawn, and whether the link to the terminal is too slow for fine pictures.

    Args:
        fps: Maximum frames per second.
        asks: Whether to query the terminal, so that its answers show how fast the link is.
        clock: Returns monotonic time in seconds.
        most_queued_s: The link counts as slow when a frame waits longer than this; None for the time between two
            frames.
    """

    def __init__(
        self,
        fps: int,
        asks: bool = True,
        clock: Callable[[], float] = time.monotonic,
        most_queued_s: float | None = None,
    ) -> None:
        self._gap_s = 1.0 / fps
        self._most_queued_s = self._gap_s if most_queued_s is None else most_queued_s
        self.asks = asks
        self._clock = clock
        self._asked: deque[tuple[float, int]] = deque(maxlen=_REMEMBERED)
        """When each unanswered query was sent, and how many bytes were sent between the query before and this one."""
        self._heard_s = 0.0
        """When the last answer arrived, or a query was sent while no other was unanswered; the later of both."""
        self._proof_s: float | None = None
        """When a terminal that has not yet answered is assumed never to answer; None before the first query."""
        self._loose_bytes = 0
        """Bytes sent since the last query."""
        self._frame_is_new = False
        self._last_s = -1.0
        self._round_trip_s = 0.0
        self._allowed = 1
        self._queued_s: float | None = None
        """When a frame was last found to have queued on the link."""
        self._slow_s = SLOW_S
        """Seconds for which the link counts as slow after a frame has queued."""
        self._begun_s = 0.0
        """When the terminal or page that shows the app now first answered; earlier queries waited for it to begin."""
        self.answers = False
        """Whether the terminal has ever answered."""

    @property
    def is_slow(self) -> bool:
        """Whether the link to the terminal is too slow for fine frames, or its speed is not known yet."""
        if not self.asks:
            return False
        now = self._clock()
        if not self.answers:
            return self._proof_s is None or now < self._proof_s
        return self._queued_s is not None and now - self._queued_s < self._slow_s

    @property
    def is_idle(self) -> bool:
        """Whether the terminal has answered all queries, or can take another frame anyway."""
        return not self._asked or self.ready()

    def ready(self) -> bool:
        """Return whether a frame may be drawn now.

        A frame is not drawn too soon after the last one, or while too many bytes are on their way to the terminal.
        """
        now = self._clock()
        # The gap may be a tenth shorter: a timer that fires slightly early would otherwise halve the rate.
        if now - self._last_s < 0.9 * self._gap_s:
            return False
        if not self._asked:
            return True
        if not self.answers:
            return now - self._last_s >= UNPROVEN_GAP_S or (
                self._proof_s is not None and now >= self._proof_s
            )
        way_bytes = sum(size for _, size in self._asked)
        if now - self._heard_s >= PATIENCE_S + way_bytes / SLOWEST_BYTES_S:
            # A terminal that has answered before has lost a query: do not wait for all of them.
            self._asked.clear()
        return not self._asked or (len(self._asked) < self._allowed and way_bytes < FULL_BYTES)

    def drawn(self) -> None:
        """Record that a frame was drawn; `record_painted` records that it was sent."""
        self._last_s = self._clock()
        self._frame_is_new = True

    def record_painted(self, size: int) -> bool:
        """Record that `size` bytes were sent. Return whether the caller must query the terminal now."""
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

    def record_interruption(self) -> None:
        """Record that queries will not be answered any more, because another program or page had the terminal."""
        self._asked.clear()
        self._queued_s = None
        self._begun_s = inf

    def record_answer(self) -> None:
        """Record that the terminal has answered the oldest open query."""
        self._heard_s = self._clock()
        first = not self.answers
        self.answers = True
        if not self._asked:
            return
        asked_s, _ = self._asked.popleft()
        self._begun_s = min(self._begun_s, self._heard_s)
        took_s = self._heard_s - asked_s
        # The estimate falls at once and rises slowly, so that a backlog is not taken for latency.
        self._round_trip_s = took_s if first else min(took_s, self._round_trip_s + 0.001)
        queued_s = took_s - self._round_trip_s
        if queued_s > self._most_queued_s and asked_s >= self._begun_s:
            self._has_queued(self._heard_s)
        if queued_s > 2 * self._gap_s:
            self._allowed = 1
        else:
            # At least two frames are allowed: else an answer just after a frame timer would cost the next frame.
            self._allowed = min(
                self._allowed + 1, MAX_ON_THE_WAY, 2 + int(self._round_trip_s / self._gap_s)
            )

    def _has_queued(self, now: float) -> None:
        rested_s = inf if self._queued_s is None else now - self._queued_s
        if rested_s >= 2 * self._slow_s:
            self._slow_s = SLOW_S
        elif rested_s >= self._slow_s:
            # The link was too slow again as soon as fine frames were drawn: wait longer before the next ones.
            self._slow_s = min(2 * self._slow_s, MAX_SLOW_S)
        self._queued_s = now
