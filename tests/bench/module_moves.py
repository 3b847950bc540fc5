"""How often the code of tuisim goes from one module to another: a measure of what is worked out again and again."""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass
from types import FrameType

PACKAGE = "tuisim."
BODY = "<module>"


@dataclass(frozen=True, slots=True)
class Walk:
    """What was counted."""

    calls: int
    """Calls of functions of tuisim; a generator that goes on is called, too."""
    entered: dict[str, int]
    """How often each module was entered: called from another module of tuisim, or from outside."""

    @property
    def moves(self) -> int:
        """Changes of module."""
        return sum(self.entered.values())


class MoveCounter:
    """Counts calls and changes of module in one thread; what the import of a module executes is left out."""

    def __init__(self) -> None:
        self._calls = self._importing = 0
        self._entered: Counter[str] = Counter()

    def start(self) -> None:
        """Count from now on."""
        sys.setprofile(self._profile)

    def stop(self) -> Walk:
        """Count no more; return what was counted."""
        sys.setprofile(None)
        return Walk(self._calls, dict(self._entered))

    def _profile(self, frame: FrameType, event: str, arg: object) -> None:
        if event not in ("call", "return"):
            return
        if frame.f_code.co_name == BODY:
            self._importing += 1 if event == "call" else -1
        elif event == "call" and self._importing <= 0:
            self._count(frame)

    def _count(self, frame: FrameType) -> None:
        name = frame.f_globals.get("__name__", "")
        if name.startswith(PACKAGE):
            self._calls += 1
            if name != _find_caller(frame):
                self._entered[name] += 1


def _find_caller(frame: FrameType) -> str:
    """Return the module of tuisim that has called a function, itself or through others; empty if none has."""
    before = frame.f_back
    while before is not None:
        name: str = before.f_globals.get("__name__", "")
        if name.startswith(PACKAGE):
            return name
        before = before.f_back
    return ""
