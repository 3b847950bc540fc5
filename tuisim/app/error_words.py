"""What matters of an error of a program, in the room that there is."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tuisim.base.errors import TuisimError
from tuisim.terminal.text_runs import cut

_KIND = re.compile(r"^[\w.]+: ")
"""The class of an error, which says less than its message."""
_MEANT = re.compile(
    r"'(?P<wrong>\w+)'(?: is not defined\. Did|\. Did|, did) you mean:? (?P<quote>'?)(?P<meant>[\w.]+)(?P=quote)\?"
)
_PARTS = re.compile(r"This robot has: (?P<parts>.*?)\.(?:\s|$)")
_PART = re.compile(r"(\w+) lego-(?:ev3-|nxt-)?([\w-]+)")
_ASKED = re.compile(r"(?P<what>\w+)\((?:ev3-ports:)?(?P<port>\w+)\) is not connected")


def _tellings(words: str) -> Iterator[str]:
    """Yield an error in fewer and fewer words; each says what to do about it, if the error does."""
    yield words
    if (parts := _parts(words)) is not None:
        missing = _missing(words)
        yield f"{missing}; the robot has {parts}"
        yield f"{missing}: {parts}"
        yield parts
        yield missing
    elif meant := _MEANT.search(words):
        yield _KIND.sub("", words)
        yield f"no {meant['wrong']}: did you mean {meant['meant']}?"
        yield f"did you mean {meant['meant']}?"
        yield f"{meant['meant']}?"
    yield _KIND.sub("", words)


def _missing(words: str) -> str:
    asked = _ASKED.search(words)
    return f"no {asked['what']} on {asked['port']}" if asked else "not on this port"


def _parts(words: str) -> str | None:
    """Return what the robot has on its ports, with short names; None if an error does not say it."""
    found = _PARTS.search(words)
    return None if found is None else _PART.sub(r"\1 \2", found["parts"])


def fitting(words: str, width: int) -> str:
    """Return an error in at most so many letters: what matters of it, whole if there is room."""
    told = list(_tellings(words))
    return next((one for one in told if len(one) <= width), cut(told[-1], width))


def remedy(words: str) -> str:
    """Return what to do in the app about an error, with ids of actions in braces.

    Which name was meant is told by the error itself.
    """
    if (parts := _parts(words)) is None:
        return "{went-wrong} goes to where it went wrong"
    return f"{_missing(words)}: {parts}. {{robot}} chooses another robot"


def in_a_list(error: TuisimError) -> str:
    """Return an error about what was typed into a list: without the names that are in the list, or a shell command."""
    guess, asked, _ = error.hint.partition("?")
    if asked and guess.startswith("did you mean"):
        return f"{error.message} ({guess}?)"
    return (
        error.message
        if "`tuisim " in error.hint or error.hint.startswith("one of ")
        else str(error)
    )
