"""The kernel's ticks, and the wheels of its timers."""

from __future__ import annotations

import pytest

from tests.cases import for_rows
from tuisim.engine.core.driver.jiffies import Jiffies, round_up

MS = 1_000_000


@for_rows(
    "jiffies, fires_at",
    [(0, 1), (5, 6), (63, 64), (64, 72), (100, 104), (504, 512), (505, 512), (1000, 1024)],
)
def test_long_kernel_timers_fire_late(jiffies: int, fires_at: int) -> None:
    assert Jiffies().find_expiry_ns(0, jiffies) == fires_at * 10 * MS


def test_timers_follow_the_kernels_clock_wherever_the_run_begins_on_it() -> None:
    clock = Jiffies(60, 5000)
    assert [clock.count(ms * MS) for ms in (0, 4, 5, 14, 15)] == [60, 60, 61, 61, 62]
    assert clock.begin_ns(61) == 5 * MS
    # A timer for 100 jiffies ends with the next multiple of 8 above 160.
    assert clock.find_expiry_ns(0, 100) == clock.begin_ns(168) == 1075 * MS


@pytest.mark.parametrize("time_ms, jiffies", [(0, 0), (1, 1), (10, 1), (11, 2), (1000, 100)])
def test_a_time_in_ms_is_rounded_up_to_whole_jiffies(time_ms: int, jiffies: int) -> None:
    assert round_up(time_ms) == jiffies
