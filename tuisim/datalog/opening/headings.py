"""Names of columns: none may be empty, and no two the same."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.datalog.opening.notes import Notes


def unique_names(names: Sequence[str], notes: Notes) -> list[str]:
    """Return names by which columns can be told apart; what is called in another way is noted."""
    unique: list[str] = []
    for at, name in enumerate(names, 1):
        wanted, again = name or f"column {at}", 2
        while wanted in unique:
            wanted, again = f"{name or f'column {at}'} ({again})", again + 1
        if name and wanted != name:
            notes.say(f"two columns are called {name!r}: the second is {wanted!r} here")
        unique.append(wanted)
    return unique
