"""A kind of attempt to break tuisim, and what one attempt gives."""

from __future__ import annotations

import faulthandler
import os
import signal
import tempfile
import traceback
from collections.abc import Callable, Iterator
from contextlib import chdir, contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from types import FrameType

from tests.running import PATIENCE_S


class FaultError(Exception):
    """Something that must hold did not."""


class TooLongError(Exception):
    """A case did not end."""


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


def fault_of(kind: Kind, name: str) -> str:
    """Run a case in a folder and a home of its own; return what was wrong, empty if nothing was."""

    def too_long(number: int, frame: FrameType | None) -> None:
        raise TooLongError(f"has not ended after {kind.limit_s:g} s of CPU")

    temporary = tempfile.TemporaryDirectory(prefix="tuisim-proof-", ignore_cleanup_errors=True)
    with temporary as folder, chdir(folder), home(Path(folder, "home")):
        before = signal.signal(signal.SIGPROF, too_long)
        signal.setitimer(signal.ITIMER_PROF, kind.limit_s)
        try:
            kind.check(name, Path(folder))
        except FaultError as fault:
            return str(fault)
        # Whatever a case did not expect is a fault, too.
        except Exception:
            return traceback.format_exc()
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            signal.signal(signal.SIGPROF, before)
    return ""


def watch_over() -> None:
    """Print where this process is if it dies of a signal."""
    faulthandler.enable()
