"""CPU time of other processes, and their environments."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
SEARCH_PATH = [str(ROOT)]
"""Where processes that are measured look for modules first."""
_DROPPED = (
    "COLORTERM",
    "COLUMNS",
    "LINES",
    "NO_COLOR",
    "PYTHONDONTWRITEBYTECODE",
    "PYTHONPATH",
    "TEXTUAL_COLOR_SYSTEM",
)


def cpu_s(pid: int) -> float:
    """Return the CPU seconds that a living process has used, all its threads together.

    The kernel numbers the CPU clock of a process like this (clock_getcpuclockid in the C
    library); unlike /proc, which counts in hundredths of a second, it is exact.
    """
    return time.clock_gettime(~pid << 3 | 2)


def children_cpu_s() -> float:
    """Return the CPU seconds of all children that have been waited for.

    What a child has forked counts only if the child has waited for it: not a run that the warm process has forked.
    """
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def wait_until_stopped(pid: int) -> None:
    """Wait until a child stands still after a SIGSTOP, or is gone; it can be waited for again."""
    os.waitid(os.P_PID, pid, os.WSTOPPED | os.WEXITED | os.WNOWAIT)


def keep_bytecode() -> None:
    """Let this process and all that it starts keep the modules they have compiled, as for users."""
    sys.dont_write_bytecode = False
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def plain_environment(**more: str) -> dict[str, str]:
    """Return an environment for what tuisim is compared with."""
    return {**{name: value for name, value in os.environ.items() if name not in _DROPPED}, **more}


def app_environment(**more: str) -> dict[str, str]:
    """Return an environment in which `python -m tuisim` is this checkout's."""
    return plain_environment(PYTHONPATH=os.pathsep.join(SEARCH_PATH), **more)


def command_cpu_s(*words: str, environment: Mapping[str, str] | None = None) -> float:
    """Run `python` with some words to its end and return its CPU seconds; the environment is the app's by default."""
    before = children_cpu_s()
    subprocess.run(
        [sys.executable, *words],
        env=app_environment() if environment is None else environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
    return children_cpu_s() - before


COUNTED = """\
import ctypes, os, resource, subprocess, sys
# PR_SET_CHILD_SUBREAPER: this process inherits what others leave, and with it the time of all whose end they saw.
assert not ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)
subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)
while True:
    try:
        os.wait()
    except ChildProcessError:
        break
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(used.ru_maxrss, used.ru_utime + used.ru_stime)
"""
"""Runs a command; prints the memory of its largest process, and the CPU time of all that it has started."""


@dataclass(frozen=True, slots=True)
class Used:
    """What a command has cost, with all processes that it has started."""

    cpu_s: float
    peak_mb: float
    """Of its largest process."""


def command_used(*words: str) -> Used:
    """Run `tuisim` with some words to its end and return what it has cost."""
    # A process counts the memory of the one that has started it, which is a small one here.
    command = [sys.executable, "-I", "-c", COUNTED, sys.executable, "-m", "tuisim", *words]
    done = subprocess.run(
        command, env=app_environment(), capture_output=True, text=True, check=True
    )
    peak_kb, used_s = map(float, done.stdout.split())
    return Used(used_s, peak_kb / 1024)
