"""A clock for what a process does with its time, whatever else the machine does."""

from __future__ import annotations

import os
import time
from contextlib import suppress
from pathlib import Path

from tuisim.engine.core.profile import NS_PER_S

_CLOCK_HZ = os.sysconf("SC_CLK_TCK")


class FairClock:
    """A clock that leaves out the time in which a process waits for a processor, because other processes run.

    It runs at least as fast as the process computes: of many threads, some always wait.

    Args:
        pid: The process, which has just been started.
    """

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._started_s = self._looked_s = time.monotonic()
        self._waits_s = self._without_s = 0.0

    def read_s(self) -> float:
        """Return the seconds since the start of the process, without its waits."""
        now_s, waits_s = time.monotonic(), measure_waited_s(self._pid)
        self._without_s += min(max(0.0, waits_s - self._waits_s), now_s - self._looked_s)
        self._waits_s, self._looked_s = waits_s, now_s
        return max(now_s - self._started_s - self._without_s, measure_computed_s(self._pid))


def measure_waited_s(pid: int) -> float:
    """Return the seconds that the threads of a process have waited for a processor, added up.

    0 if the process is gone or the system does not tell. The waits of threads that have ended are missing.
    """
    total_ns = 0
    with suppress(OSError):
        for thread in os.listdir(f"/proc/{pid}/task"):
            # Nanoseconds on a processor, and in the queue: Documentation/scheduler/sched-stats.rst of Linux.
            with suppress(OSError, ValueError, IndexError):
                total_ns += int(
                    Path(f"/proc/{pid}/task/{thread}/schedstat").read_bytes().split()[1]
                )
    return total_ns / NS_PER_S


def measure_computed_s(pid: int) -> float:
    """Return the seconds that a process has spent on processors; 0 if it is gone or the system does not tell."""
    try:
        # The name, in parentheses, may contain anything. Then the state, and 10 more: proc_pid_stat(5).
        fields = Path(f"/proc/{pid}/stat").read_bytes().rpartition(b")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _CLOCK_HZ
    except (OSError, ValueError, IndexError):
        return 0.0
