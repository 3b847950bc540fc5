"""Which name of an object was meant by one that it does not have."""

from __future__ import annotations

from collections.abc import Sequence, Set

from tuisim.base.errors import closest

_MAX_NAMES = 3
_MIN_LETTERS = 3
"""A shorter word is a part of too many names."""
_LIKENESS = 0.65
_ON = frozenset({"backward", "drive", "forward", "forwards", "go", "move", "straight"})
"""What a motor does while it is `on`."""


def find_meant_names(wrong: str, names: Set[str]) -> list[str]:
    """Return the public names that may have been meant by a wrong one; the most likely first, none if none is like it.

    Names that begin with the wrong one come before all, then the one that is spelled most like it, then names that
    contain it.
    """
    public = sorted((name for name in names if not name.startswith("_")), key=lambda n: (len(n), n))
    containing = [name for name in public if wrong in name] if len(wrong) >= _MIN_LETTERS else []
    if begun := [name for name in containing if name.startswith(wrong)]:
        return _find_shortest(begun)
    if close := closest(wrong, public, 1, _LIKENESS):
        return close
    return ["on"] if wrong in _ON and "on" in names else _find_shortest(containing)


def _find_shortest(names: Sequence[str]) -> list[str]:
    """Return names in their order, without those that only add something to an earlier one."""
    shortest: list[str] = []
    for name in names:
        if not name.startswith(tuple(shortest)):
            shortest.append(name)
    return shortest[:_MAX_NAMES]
