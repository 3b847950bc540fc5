"""Addresses in what a program prints: real ones differ in every run, these are the same in each."""

from __future__ import annotations

import re
import sys
from contextlib import suppress
from functools import cached_property

_ADDRESS = re.compile(
    r"(?P<before> at 0x)(?P<hex>[0-9a-f]{5,16})\b"
    # A thread's identifier is an address, too: <Thread(Thread-1, started 139862347318016)>.
    r"|(?P<thread>, (?:started|stopped)(?: daemon)? )(?P<number>[0-9]{5,20})(?=\)>)"
)
_FIRST, _STEP = 0x7F0000000010, 0x10
_LOWEST = 1 << 32 if sys.maxsize > 1 << 32 else 1 << 20
"""Addresses are at least this, except those of the heap."""


class Addresses:
    """Gives each address that is printed the next of a fixed sequence, in the order of their first appearance.

    Only the texts are changed that Python itself writes: ` at 0x…`, and the identifiers of threads. A number that
    cannot be an address stays as it is.
    """

    def __init__(self) -> None:
        self._given: dict[int, int] = {}

    def stable(self, text: str) -> str:
        """Return a text with its addresses replaced; doing that again changes nothing."""
        if " at 0x" not in text and ", st" not in text:
            return text
        return _ADDRESS.sub(self._replace, text)

    def _replace(self, match: re.Match[str]) -> str:
        if match["hex"]:
            return f"{match['before']}{self._of(int(match['hex'], 16)):x}"
        return f"{match['thread']}{self._of(int(match['number']))}"

    def _of(self, real: int) -> int:
        if real in self._given:
            return self._given[real]
        following = _FIRST + len(self._given) * _STEP
        if _FIRST <= real < following or (real < _LOWEST and real not in self._heap):
            return real
        self._given[real] = following
        return following

    @cached_property
    def _heap(self) -> range:
        """The addresses of the heap, which begins where the system likes; empty where that is unknown."""
        with suppress(OSError, ValueError), open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
            for row in maps:
                if row.rstrip().endswith("[heap]"):
                    start, end = (int(part, 16) for part in row.split()[0].split("-"))
                    # It grows later on.
                    return range(start, max(end, _LOWEST))
        return range(0)
