"""The code of programs that are run again and again, compiled before their processes are forked."""

from __future__ import annotations

import signal
import sys
import types
import warnings

from tuisim.base.source import Program
from tuisim.engine.runtime import wallclock
from tuisim.engine.runtime.loader import compile_program

MAX_KNOWN = 8
MAX_CHARACTERS = 1 << 16
MAX_CPU_S = 1.0
"""A program that takes longer to compile ends this process; its runs are then started by themselves."""
SPARE_FRAMES = 100
"""A program is compiled with this many frames less, so that the process of a run can compile it, too."""


class KnownPrograms:
    """Compiles a program when it is run for the second time.

    The first time, the process of the run compiles it; so it does whenever there is an error or a warning to report.
    """

    def __init__(self) -> None:
        self._seen: set[tuple[str, str, bool]] = set()
        self._codes: dict[tuple[str, str, bool], types.CodeType | None] = {}

    def code(self, program: Program, drops_annotations: bool) -> types.CodeType | None:
        """Return the code of a program that is about to be run; None if the process of the run has to compile it."""
        key = program.text, program.file, drops_annotations
        if len(program.text) > MAX_CHARACTERS:
            return None
        if key not in self._seen:
            if len(self._seen) >= MAX_KNOWN:
                self._seen.clear()
                self._codes.clear()
            self._seen.add(key)
            return None
        if key not in self._codes:
            self._codes[key] = _compile(*key)
        return self._codes[key]


def _compile(text: str, file: str, drops_annotations: bool) -> types.CodeType | None:
    before = sys.getrecursionlimit()
    sys.setrecursionlimit(before - SPARE_FRAMES)
    wallclock.set_timer(signal.ITIMER_VIRTUAL, MAX_CPU_S)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return compile_program(text, file, drops_annotations)
    except Exception:  # whatever it is, it is told by the program's own process
        return None
    finally:
        wallclock.set_timer(signal.ITIMER_VIRTUAL, 0.0)
        sys.setrecursionlimit(before)
