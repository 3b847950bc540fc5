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
"""After looking at so many objects in all, no more are searched: a few real seconds."""
_STEPS = 3
_MOST_REACHED = 1_000
"""How far objects are followed from the program's names: number of steps, and of objects in each step."""
_HEAP_TYPE = 1 << 9
"""Flag of a class that is defined in Python: Py_TPFLAGS_HEAPTYPE."""
_NEVER_KEPT = (types.FrameType, types.TracebackType)
"""Types that are never kept alive: each object would keep all that it refers to."""


class _Given(NamedTuple):
    """The number that is printed in place of an address."""

    number: int
    is_same: Callable[[], object]
    """Tells whether the object still exists, so that no other object can have its address."""


class Addresses:
    """Gives each object whose address is printed the next of a fixed sequence, in the order of first appearance.

    Only addresses that Python itself writes are changed, after ` at 0x`, and the identifiers of threads. A number
    that cannot be an address stays as it is. Which memory is used again depends on the machine: so a number stands for
    an object as long as that exists; a later object at the same address gets another number.

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
        """Return texts of one instant with their addresses replaced; replacing them again changes nothing."""
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
        """Return the object at an address; None if there is none that the text before the address can be about."""
        if self._searched > _MAX_SEARCHED:
            return None
        # The collector does not know all objects, and leaves out those that were made before the program.
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
        """Return the objects that the program's names refer to, directly or in a few steps."""
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
        """The addresses of the heap, whose begin the system chooses; empty if the system does not tell."""
        with (
            suppress(OSError, ValueError),
            open("/proc/self/maps", encoding="utf-8", errors="replace") as maps,
        ):
            for row in maps:
                if row.rstrip().endswith("[heap]"):
                    start, end = (int(part, 16) for part in row.split()[0].split("-"))
                    # The heap grows later on.
                    return range(start, max(end, _LOWEST))
        return range(0)


def _is_meant(one: object, before: str) -> bool:
    """Return whether the text before an address can be about this object, not about an earlier one there."""
    kind = type(one)
    # A program's class can have a `__repr__` without the name of the class.
    is_own = kind.__flags__ & _HEAP_TYPE and not str(kind.__module__).startswith("tuisim")
    return bool(is_own) or kind.__name__ in before


def _watch(one: object) -> Callable[[], object]:
    """Return a function that tells whether an object still exists; an object that cannot be watched is kept alive."""
    if one is None:
        return lambda: False
    if isinstance(one, _NEVER_KEPT):
        return lambda: True
    try:
        watched = weakref.ref(one)
    except TypeError:
        return lambda: one is not None
    return lambda: watched() is not None
