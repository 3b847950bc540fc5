"""The counter of a motor: it counts half degrees, stores when the count changed, and gives the speed."""

from __future__ import annotations

from itertools import repeat
from math import floor

CLOCK_HZ = 24_000_000
"""Frequency of the clock of the time stamps, in ticks per second."""
HALF_CLOCK_HZ = CLOCK_HZ // 2
TICKS_PER_NS = CLOCK_HZ / 1_000_000_000
MIN_SPAN = CLOCK_HZ * 20 // 1000
"""The driver measures a speed over at least 20 ms; this is that time in ticks of the clock of the time stamps."""
LOOK = CLOCK_HZ // 1000
"""Interval at which the driver checks whether the count stands still, in ticks of the clock: 1 ms."""
IDLE_LOOKS = 51
"""While the count stands still, the driver notes this at every 51st check: the first one more than 50 ms after its last
note."""
MIN_IDLE = 50.0 * LOOK
LAST_NOTE = -43 * LOOK
"""Time of the driver's last note before the run that the count stands still, in ticks of the clock from the run's
start."""
STRIDE = 4
"""To measure a speed, the driver looks back by this many changes of the count, or by a multiple of this number."""
MAX_DEPTH = 16 * STRIDE
KEPT_SPAN = CLOCK_HZ * 50 // 1000
"""After an even motion the counter records the changes of this last time, in ticks of the clock: no speed needs older
ones."""
KEPT_COUNTS = 3 * STRIDE
"""After an even motion the counter records at least this many changes of the count, however slow the axle is."""
CAPACITY = 2 * MAX_DEPTH
"""Number of the last changes of the count that the counter keeps when it removes the older ones."""
MAX_CHANGES = 2 * CAPACITY
FIRST_NOTE = LAST_NOTE - (CAPACITY - 1) * IDLE_LOOKS * LOOK


class Counter:
    """The counter of one motor: its count of half degrees, and the times of the last changes.

    At the start of a run the axle has been at rest at 0 for a while.
    """

    __slots__ = ("_depth", "_earlier", "_speed_dps", "_straight", "_times", "count")

    def __init__(self) -> None:
        self._times: list[int] = [*range(FIRST_NOTE, LAST_NOTE + 1, IDLE_LOOKS * LOOK)]
        self._straight = 0
        """Number of the last changes of the count that all went in one direction; negative if the count fell."""
        self._earlier = [0] * CAPACITY
        """The count after each change before the last `_straight` ones, whose counts follow from the present count."""
        self._depth = STRIDE
        """Number of changes of the count over which the driver measured the last speed."""
        self._speed_dps: int | None = 0
        """The speed measured at the last change; None if it must be measured again."""
        self.count = 0

    def record(
        self, begin: float, duration: float, begin_deg: float, end_deg: float, middle: float
    ) -> None:
        """Record the changes of the count while the axle turns in one direction.

        Args:
            begin: When the turn begins, in ticks of the clock.
            duration: How long the turn takes, in ticks of the clock.
            begin_deg: The axle's angle at the begin.
            end_deg: The axle's angle at the end.
            middle: Share of the turn, 0 … 1, that falls in the first half of the time; the speed in each half is
                constant.
        """
        count = floor(2.0 * end_deg)
        last = self.count
        times = self._times
        end = begin + duration
        way = 2.0 * (end_deg - begin_deg)
        if end - times[-1] > MIN_IDLE:
            edge = last + (count > last)
            part = 1.0 if count == last else (edge - 2 * begin_deg) / way
            self.record_rest(begin + duration * part)
        if count == last:
            return
        if count > last:
            part = (last + 1 - 2.0 * begin_deg) / way
            per_count = 1.0 / way
            direction = 1
        else:
            part = (last - 2.0 * begin_deg) / way
            per_count = -1.0 / way
            direction = -1
        if self._straight * direction < 0:
            self._end_straight()
        self._straight += count - last
        half_time = 0.5 * duration
        first_half, second_half = half_time / middle, half_time / (1.0 - middle)
        while last != count:
            last += direction
            times.append(
                floor(
                    begin + part * first_half
                    if part <= middle
                    else end - (1.0 - part) * second_half
                )
            )
            part += per_count
        self.count = count
        self._speed_dps = None
        if len(times) > MAX_CHANGES:
            del times[:-CAPACITY]

    def _end_straight(self) -> None:
        """Add the last changes, which all went in one direction, to the list of earlier changes.

        It is called before the first change in the other direction.
        """
        straight = max(-CAPACITY, min(self._straight, CAPACITY))
        direction = 1 if straight > 0 else -1
        self._earlier += range(self.count - straight + direction, self.count + direction, direction)
        self._straight = 0
        del self._earlier[:-CAPACITY]

    def record_rest(self, end: float) -> None:
        """Record that the count has not changed until `end`, in ticks of the clock."""
        times = self._times
        if end - times[-1] < MIN_IDLE:
            return
        look = (times[-1] // LOOK + IDLE_LOOKS) * LOOK
        if look > end:
            return
        looks = range(look, int(end) + 1, IDLE_LOOKS * LOOK)[-CAPACITY:]
        self._end_straight()
        times += looks
        self._earlier += repeat(self.count, len(looks))
        self._speed_dps = None
        del times[:-MAX_CHANGES]

    def take_back(self, angle_deg: float) -> None:
        """Remove the newest changes of the count beyond the angle at which an obstacle stopped the axle.

        Changes before the last change of direction stay.
        """
        taken = self.count - floor(2 * angle_deg)
        if taken * self._straight <= 0:
            return
        taken = min(taken, self._straight, key=abs)
        del self._times[-abs(taken) :]
        self.count -= taken
        self._straight -= taken
        self._speed_dps = None

    def is_straight(self, speed_dps: float) -> bool:
        """Return whether all changes from which the driver measures a speed went in the direction of `speed_dps`."""
        return (self._straight if speed_dps > 0 else -self._straight) >= self._depth + STRIDE

    def find_time(self, back: int) -> int:
        """Return the time of the change that is `back` changes before the last one, in ticks of the clock."""
        return self._times[-1 - back]

    def add_straight(self, count: int, times: list[int]) -> None:
        """Add several changes in the same direction as the last ones.

        Args:
            count: The count after these changes.
            times: Times of the newest of these changes in ticks of the clock; older changes no longer affect the speed.
        """
        if not times:
            return
        self._straight += count - self.count
        self._times += times
        self.count = count
        self._speed_dps = None
        del self._times[:-MAX_CHANGES]

    def add_evenly(self, time: float, angle_deg: float, speed_dps: float) -> None:
        """Add the changes of the count of an axle that has turned at a constant speed.

        It must have done so for at least as long as the driver looks back to measure a speed.

        Args:
            time: Now, in ticks of the clock.
            angle_deg: The axle's angle now.
            speed_dps: The axle's speed, not 0.
        """
        count = floor(2 * angle_deg)
        per_count = CLOCK_HZ / (2 * speed_dps)
        edge, direction = (count, -1) if speed_dps > 0 else (count + 1, 1)
        oldest = max(KEPT_COUNTS, int(KEPT_SPAN / abs(per_count)))
        times = [
            int(time - (2 * angle_deg - edge - direction * back) * per_count)
            for back in range(oldest, -1, -1)
        ]
        self.add_straight(count, times)

    def measure_speed_dps(self) -> int:
        """Return the speed that the driver computes from the last changes, in whole degrees per second."""
        speed_dps = self._speed_dps
        if speed_dps is not None:
            return speed_dps
        times = self._times
        depth = self._depth
        straight = self._straight
        time = times[-1]
        # The search starts at the last depth, because most often the depth stays the same or changes by one step.
        while depth > STRIDE and time - times[STRIDE - 1 - depth] >= MIN_SPAN:
            depth -= STRIDE
        while (span := time - times[-1 - depth]) < MIN_SPAN and depth < MAX_DEPTH:
            depth += STRIDE
        self._depth = depth
        if -depth < straight < depth:
            turned, span = self._search(time)
        else:
            turned = depth if straight > 0 else -depth
        if not span:
            speed_dps = 0
        elif turned > 0:
            speed_dps = turned * HALF_CLOCK_HZ // span
        else:
            speed_dps = -(-turned * HALF_CLOCK_HZ // span)
        self._speed_dps = speed_dps
        return speed_dps

    def _search(self, time: int) -> tuple[int, int]:
        """Return a change of the count and the time that it took: the driver computes the speed from them.

        The driver looks back over more and more changes, until they took at least `MIN_SPAN`. If an earlier count
        equals the present one, it looks no further, and the result is 0 and 1: the motor has not moved.

        Args:
            time: Now, in ticks of the clock.

        Returns:
            The change in half degrees, and the time in ticks of the clock.
        """
        turned = span = 0
        straight = self._straight
        for depth in range(STRIDE, MAX_DEPTH + 1, STRIDE):
            earlier = depth - abs(straight)
            if earlier < 0:
                turned = depth if straight > 0 else -depth
            else:
                turned = self.count - self._earlier[-1 - earlier]
            if turned == 0:
                return 0, 1
            span = time - self._times[-1 - depth]
            if span >= MIN_SPAN:
                break
        return turned, span
