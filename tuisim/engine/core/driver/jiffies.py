"""The kernel's ticks of 10 ms, and when its timers fire."""

from __future__ import annotations

from tuisim.base.data_class import dataclass
from tuisim.engine.core.noise import draw_numbers

JIFFY_US = 10_000
NS_PER_US = 1000
STEP_US = 2000
"""Period of the control in a motor's driver, in microseconds."""
LOOK_JIFFIES = 6
"""Interval in jiffies at which a driver checks whether its state has changed."""
FIRST_JIFFIES = 4096
"""The kernel's count of jiffies at the start of a run is drawn, with the run's seed, from 0 up to below this number."""
LEVEL_JIFFIES = 63
"""The kernel's timers that wait for at most this many jiffies fire at an exact jiffy; those for longer fire at coarser
times."""
COARSER = 8
"""A timer that waits longer than a limit is this many times coarser, up to a next limit that is this many times as
long."""


@dataclass(frozen=True, slots=True)
class Jiffies:
    """The clock of the kernel in a run: it counts jiffies of 10 ms, and was already running before the run."""

    first: int = 0
    """How many jiffies the kernel has counted when the run begins."""
    phase_us: int = 0
    """How long the current jiffy has already lasted when the run begins, in microseconds."""
    first_look: int = 2
    """Number of jiffies from the start of the run to the drivers' first check whether a motor's state has changed."""

    def count(self, time_ns: int) -> int:
        """Return how many jiffies the kernel has counted at a time in ns from the start of the run."""
        return self.first + (time_ns // NS_PER_US + self.phase_us) // JIFFY_US

    def begin_ns(self, jiffy: int) -> int:
        """Return when a jiffy begins, in ns from the start of the run."""
        return ((jiffy - self.first) * JIFFY_US - self.phase_us) * NS_PER_US

    def find_expiry_ns(self, now_ns: int, jiffies: int) -> int:
        """Return when a timer fires, in ns, that was set at `now_ns` to wait for a number of jiffies."""
        expiry = self.count(now_ns) + jiffies
        grain = 1
        reach = LEVEL_JIFFIES
        while jiffies > reach:
            grain = grain * COARSER
            reach = reach * COARSER
        return self.begin_ns((expiry // grain + 1) * grain)


def draw_jiffies(seed: int) -> Jiffies:
    """Return the kernel's clock of a run, drawn at random with the run's seed.

    A jiffy always begins at the same time as a step of the motor's control.
    """
    first, phase, look = draw_numbers(seed, 0, "jiffies", 3)
    steps = JIFFY_US // STEP_US
    return Jiffies(
        int(first * FIRST_JIFFIES), int(phase * steps) * STEP_US, 1 + int(look * LOOK_JIFFIES)
    )


def round_up(time_ms: int) -> int:
    """Return how many jiffies a time in milliseconds takes, rounded up."""
    return -(-time_ms * NS_PER_US // JIFFY_US)
