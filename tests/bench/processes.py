"""CPU time of other processes."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def cpu_s(pid: int) -> float:
    """Return the CPU seconds that a living process has used, all its threads together.

    The kernel numbers the CPU clock of a process like this (clock_getcpuclockid in the C
    library); unlike /proc, which counts in hundredths of a second, it is exact.
    """
    return time.clock_gettime(~pid << 3 | 2)


def children_cpu_s() -> float:
    """Return the CPU seconds of all children that have been waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def wait_until_stopped(pid: int) -> None:
    """Wait until a child stands still after a SIGSTOP, or is gone; it can be waited for again."""
    os.waitid(os.P_PID, pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)


def app_environment(**more: str) -> dict[str, str]:
    """Return an environment in which `python -m tuisim` is this checkout's."""
    dropped = ("COLORTERM", "COLUMNS", "LINES", "NO_COLOR", "TEXTUAL_COLOR_SYSTEM")
    kept = {name: value for name, value in os.environ.items() if name not in dropped}
    return {**kept, "PYTHONPATH": str(ROOT), **more}


def command_cpu_s(*words: str) -> float:
    """Run `python` with some words to its end and return its CPU seconds."""
    before = children_cpu_s()
    subprocess.run(
        [sys.executable, *words], env=app_environment(), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, check=True
    )
    return children_cpu_s() - before
