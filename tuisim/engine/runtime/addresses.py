"""Addresses in what a program prints: real ones differ in every run, these are the same in each."""

from __future__ import annotations

import gc
import re
import sys
import types
import weakref
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cached_property, partial
from typing import Any, NamedTuple

_ADDRESS = re.compile(
    r"(?P<before> at 0x)(?P<hex>[0-9a-f]{5,16})\b"
    # A thread's identifier is an address, too: <Thread(Thread-1, started 139862347318016)>.
    r"|(?P<thread>\([^()]*(?:\([^()]*\))?, (?:started|stopped)(?: daemon)? )(?P<number>[0-9]{5,20})(?=\)>)"
)
_FIRST = 0x7F0000000010
_STEP = 0x10
_LOWEST = 1 << 32 if sys.maxsize > 1 << 32 else 1 << 20
"""Addresses are at least this, except those of the heap."""
_TEXT_BEFORE = 200
"""The name of an object's type is at most this far before its address."""
_MAX_SEARCHED = 20_000_000
"""Objects that are looked at in vain before no more are: a few real seconds."""
_STEPS = 3
_MOST_REACHED = 1_000
"""From the program's names: so many steps, each from at most so many objects."""
_HEAP_TYPE = 1 << 9
"""A class that was made by a program: Py_TPFLAGS_HEAPTYPE."""
_NEVER_KEPT = (types.FrameType, types.TracebackType)
"""To keep one would keep all that it refers to."""


class _Given(NamedTuple):
    """What stands for an address."""

    number: int
    is_same: Callable[[], object]
    """Whether the object is still there, so that no other one can have this address."""


class Addresses:
    """Gives each object whose address is printed the next of a fixed sequence, in the order of first appearance.

    Only the texts are changed that Python itself writes: ` at 0x…`, and the identifiers of threads. A number that
    cannot be an address stays as it is. Which memory is used again depends on the machine: so an address stands for
    the same object only as long as that exists, and for another one afterwards.

    Args:
        names: Returns the program's global names.
    """

    def __init__(self, names: Callable[[], Mapping[str, object]]) -> None:
        self._names = names
        self._given: dict[int, _Given] = {}
        self._threads: dict[str, int] = {}
        self._count = 0
        self._searched = 0

    def stabilize(self, *texts: str) -> tuple[str, ...]:
        """Return texts of one instant with their addresses replaced; doing that again changes nothing."""
        here: dict[int, int] = {}

        def replace(match: re.Match[str]) -> str:
            if match["hex"]:
                before = match.string[max(0, match.start() - _TEXT_BEFORE) : match.start()]
                return f"{match['before']}{self._number_address(int(match['hex'], 16), before, here):x}"
            return match["thread"] + str(self._number_thread(match["thread"], int(match["number"])))

        return tuple(_ADDRESS.sub(replace, text) for text in texts)

    def _number_address(self, real: int, before: str, here: dict[int, int]) -> int:
        if real in here:
            return here[real]
        if self._is_given(real) or (real < _LOWEST and real not in self._heap):
            return real
        known = self._given.get(real)
        if known is None or not known.is_same():
            known = self._given[real] = _Given(
                self._next_number(), _watch(self._find(real, before))
            )
        here[real] = known.number
        return known.number

    def _number_thread(self, text: str, real: int) -> int:
        if self._is_given(real):
            return real
        name = f"{text.rpartition(', ')[0]} {real}"
        if name not in self._threads:
            self._threads[name] = self._next_number()
        return self._threads[name]

    def _next_number(self) -> int:
        self._count += 1
        return _FIRST + (self._count - 1) * _STEP

    def _is_given(self, number: int) -> bool:
        return _FIRST <= number < _FIRST + self._count * _STEP

    def _find(self, real: int, before: str) -> object:
        """Return the object at an address, if there is one of which the text can be; None otherwise."""
        if self._searched > _MAX_SEARCHED:
            return None
        # Not all objects are known to the collector, and those that were made before the program are left out.
        by_age = [partial(gc.get_objects, generation) for generation in range(3)]
        searches: list[Callable[[], list[Any]]] = [*by_age, self._list_reached]
        for search in searches:
            objects = search()
            self._searched += len(objects)
            for index, address in enumerate(map(id, objects)):
                if address == real and _is_meant(objects[index], before):
                    return objects[index]
        return None

    def _list_reached(self) -> list[object]:
        """Return what the program's names refer to, as far as a few steps reach."""
        left_out = (types.ModuleType, type)
        level = [item for item in self._names().values() if not isinstance(item, left_out)]
        objects = level
        for _ in range(_STEPS):
            level = [
                item
                for item in gc.get_referents(*level[:_MOST_REACHED])
                if not isinstance(item, left_out)
            ]
            objects = objects + level
        return objects

    @cached_property
    def _heap(self) -> range:
        """The addresses of the heap, which begins where the system likes; empty where that is unknown."""
        with (
            suppress(OSError, ValueError),
            open("/proc/self/maps", encoding="utf-8", errors="replace") as maps,
        ):
            for row in maps:
                if row.rstrip().endswith("[heap]"):
                    start, end = (int(part, 16) for part in row.split()[0].split("-"))
                    # It grows later on.
                    return range(start, max(end, _LOWEST))
        return range(0)


def _is_meant(one: object, before: str) -> bool:
    """Return whether a text that ends before an address can be about an object, not about one that was there before."""
    kind = type(one)
    # Its own text may name it otherwise.
    is_own = kind.__flags__ & _HEAP_TYPE and not str(kind.__module__).startswith("tuisim")
    return bool(is_own) or kind.__name__ in before


def _watch(one: object) -> Callable[[], object]:
    """Return a function that tells whether an object still exists; such objects as cannot be watched are kept."""
    if one is None:
        return lambda: False
    if isinstance(one, _NEVER_KEPT):
        return lambda: True
    try:
        watched = weakref.ref(one)
    except TypeError:
        return lambda: one is not None
    return lambda: watched() is not None
