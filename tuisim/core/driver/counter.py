"""The counter of a motor: half degrees with the times of their changes, and the speed that they make."""

from __future__ import annotations

from itertools import repeat
from math import floor

CLOCK_HZ = 24_000_000
"""The clock of the time stamps."""
MIN_SPAN = CLOCK_HZ * 20 // 1000
"""A speed is measured over at least this time, in ticks of that clock."""
LOOK = CLOCK_HZ // 1000
"""Whether the counter stands is looked up once in this time..."""
IDLE_LOOKS = 51
"""...and noted with the first look more than 50 ms after the last note."""
CAPACITY = 256
"""How many of the last changes are remembered."""
LAST_NOTE = -43 * LOOK
"""When a counter that stood was noted last before the run: the driver has been at work for 400 ms."""
FIRST_NOTE = LAST_NOTE - (CAPACITY - 1) * IDLE_LOOKS * LOOK
STRIDE = 4
"""The driver looks back by this many changes, or twice, three times … as many."""
MAX_STRIDES = 16


class Counter:
    """The counter of one motor, which has stood at 0 for a while."""

    __slots__ = ("_counts", "_depth", "_speed_dps", "_times", "count")

    def __init__(self) -> None:
        self._times = [*range(FIRST_NOTE, LAST_NOTE + 1, IDLE_LOOKS * LOOK)]
        self._counts = [0] * CAPACITY
        self._depth = STRIDE
        """By how many changes the driver looked back for the last speed."""
        self._speed_dps: int | None = 0
        """The speed since the last change; None if it is to be measured anew."""
        self.count = 0

    def record(
        self, begin: float, duration: float, begin_deg: float, end_deg: float, middle: float
    ) -> None:
        """Count while the axle turns in one direction.

        Args:
            begin: When it begins, in ticks of the clock.
            duration: How long it takes, in ticks.
            begin_deg: The axle's angle at the begin.
            end_deg: The axle's angle at the end.
            middle: The part of the way that it turns in the first half of the time; each half is taken as even.
        """
        count, last = floor(2 * end_deg), self.count
        times = self._times
        if count == last:
            self.record_rest(begin + duration)
            return
        way = 2 * (end_deg - begin_deg)
        part, one = 2 * begin_deg, 1
        if count > last:
            part, per_count = (last + 1 - part) / way, 1 / way
        else:
            part, per_count, one = (last - part) / way, -1 / way, -1
        self.record_rest(begin + duration * part)
        counts, second_half = self._counts, 1.0 - middle
        while last != count:
            last += one
            half = part / middle if part <= middle else 1.0 + (part - middle) / second_half
            counts.append(last)
            times.append(int(begin + duration * half / 2))
            part += per_count
        self.count, self._speed_dps = count, None
        if len(times) > 2 * CAPACITY:
            del times[:-CAPACITY], counts[:-CAPACITY]

    def record_rest(self, end: float) -> None:
        """Note that the counter has stood until a time."""
        times = self._times
        look = (times[-1] // LOOK + IDLE_LOOKS) * LOOK
        if look > end:
            return
        looks = range(look, int(end) + 1, IDLE_LOOKS * LOOK)[-CAPACITY:]
        times += looks
        self._counts += repeat(self.count, len(looks))
        self._speed_dps = None
        del times[: -2 * CAPACITY], self._counts[: -2 * CAPACITY]

    def measure_speed_dps(self) -> int:
        """Return the speed that the driver reads."""
        if self._speed_dps is None:
            self._speed_dps = self._measure()
        return self._speed_dps

    def _measure(self) -> int:
        counts, times = self._counts, self._times
        count, time = counts[-1], times[-1]
        depth = self._depth
        turned, span = count - counts[-1 - depth], time - times[-1 - depth]
        # Most often it is the depth of the last time: then no change in between can have been back and forth.
        if span < MIN_SPAN or abs(turned) != depth or time - times[-1 + STRIDE - depth] >= MIN_SPAN:
            for depth in range(STRIDE, STRIDE * MAX_STRIDES + 1, STRIDE):
                turned, span = count - counts[-1 - depth], time - times[-1 - depth]
                if turned == 0:
                    return 0
                if span >= MIN_SPAN:
                    break
            self._depth = depth
        return int(int(turned * CLOCK_HZ / span) / 2) if span else 0
