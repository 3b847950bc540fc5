"""A kind of attempt to break tuisim, and what one attempt gives."""

from __future__ import annotations

import faulthandler
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from multiprocessing.util import Finalize
from pathlib import Path
from random import Random
from types import FrameType

from tests.running import PATIENCE_S


class FaultError(Exception):
    """Something that must hold did not."""


class TooLongError(Exception):
    """A case did not end."""


class TooLargeError(Exception):
    """A case took too much memory."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A way to break tuisim, as cases with names: a case does the same each time it is run."""

    about: str
    names: Callable[[Random], Iterator[str]]
    """Yields the names of cases, as drawn by a generator of random numbers: all there are, or without an end."""
    check: Callable[[str, Path], None]
    """Runs the case of a name in an empty folder; raises an exception for a fault."""
    limit_s: float = PATIENCE_S
    """CPU seconds of this process after which a case hangs; what a case waits for has limits of its own."""


@contextmanager
def home(folder: Path) -> Iterator[None]:
    """Let a folder be the home of tuisim."""
    was = os.environ.get("TUISIM_HOME")
    os.environ["TUISIM_HOME"] = str(folder)
    try:
        yield
    finally:
        os.environ.pop("TUISIM_HOME")
        if was is not None:
            os.environ["TUISIM_HOME"] = was


def temporary_sample(name: str) -> Path:
    """Return a new folder for the cases of this process; it is removed when the process ends."""
    folder = Path(tempfile.mkdtemp(prefix=f"tuisim-proof-{name}-"))
    # A process of a pool calls nothing that is registered for its exit but this.
    Finalize(None, shutil.rmtree, (folder,), exitpriority=0)
    return folder


MOST_GROWTH_MB = 4096
"""What the memory of this process may grow by during a case: the system would end it later, and not say where."""
LOOK_S = 0.5
"""CPU seconds between two looks at a case."""
GRACE_S = 10.0
"""CPU seconds for a case to end once it was told to; then it is told again: what tells it may have been caught."""


class _Watch:
    """Ends a case that hangs or grows, by an exception wherever it is.

    Args:
        limit_s: CPU seconds of this process after which it hangs.
    """

    def __init__(self, limit_s: float) -> None:
        self._limit_s, self._look_s = limit_s, min(LOOK_S, limit_s)
        self._end_s, self._most_mb = time.process_time() + limit_s, _resident_mb() + MOST_GROWTH_MB
        self.found = ""
        """Why the case had to end, and where each thread was then."""

    def start(self) -> None:
        """Look at the case from now on; only in the main thread."""
        self._before = signal.signal(signal.SIGPROF, self._look)
        signal.setitimer(signal.ITIMER_PROF, self._look_s, self._look_s)

    def stop(self) -> None:
        """Look no more."""
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, self._before)

    def _look(self, number: int, frame: FrameType | None) -> None:
        is_large = _resident_mb() > self._most_mb
        now_s = time.process_time()
        if not is_large and now_s < self._end_s:
            return
        self._end_s = now_s + GRACE_S
        self._most_mb = self._most_mb * 2
        error: Exception = TooLongError(f"has not ended after {self._limit_s:g} s of CPU")
        if is_large:
            error = TooLargeError(f"has grown by more than {MOST_GROWTH_MB} MB")
        if not self.found:
            stacks = (
                "".join(traceback.format_stack(one)) for one in sys._current_frames().values()
            )
            self.found = "\n".join((str(error), *stacks))
        raise error


def _too_long(_number: int, _frame: FrameType | None) -> None:
    raise TooLongError(f"has not ended after {PATIENCE_S:g} s")


@contextmanager
def in_time() -> Iterator[None]:
    """End what blocks, and so uses no processor, by an exception; only in the main thread."""
    before = signal.signal(signal.SIGALRM, _too_long)
    signal.setitimer(signal.ITIMER_REAL, PATIENCE_S, PATIENCE_S)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def _resident_mb() -> float:
    """Return the memory that this process has in use."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / (1 << 20)


def fault_of(kind: Kind, name: str) -> str:
    """Run a case in a folder and a home of its own; return what was wrong, empty if nothing was."""
    temporary = tempfile.TemporaryDirectory(prefix="tuisim-proof-", ignore_cleanup_errors=True)
    fault = ""
    with temporary as folder, chdir(folder), home(Path(folder, "home")):
        watch = _Watch(kind.limit_s)
        watch.start()
        try:
            kind.check(name, Path(folder))
        except FaultError as error:
            fault = str(error)
        # Whatever a case did not expect is a fault, too.
        except Exception:
            fault = traceback.format_exc()
        finally:
            watch.stop()
    return "\n".join(filter(None, (fault, watch.found)))


def watch_over() -> None:
    """Print where this process is if it dies of a signal."""
    faulthandler.enable()
