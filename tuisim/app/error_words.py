"""Errors of programs in as many words as there is room for, the most useful ones first."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tuisim.base.errors import TuisimError
from tuisim.terminal.text_runs import cut

_KIND = re.compile(r"^[\w.]+: ")
"""Pattern of the error's class in front of a message; a short description leaves it out, as it says least."""
_MEANT = re.compile(
    r"'(?P<wrong>\w+)'(?: is not defined\. Did|\. Did|, did) you mean:? (?P<quote>'?)(?P<meant>[\w.]+)(?P=quote)\?"
)
_FORGOTTEN = re.compile(
    r"name '(?P<wrong>\w+)' is not .*[Dd]id you forget (?P<line>to import '\w+'|`[^`]+`)\?"
)
_PARTS = re.compile(r"This robot has: (?P<parts>.*?)\.(?:\s|$)")
_PART = re.compile(r"(\w+) lego-(?:ev3-|nxt-)?([\w-]+)")
_ASKED = re.compile(r"(?P<what>\w+)\((?:ev3-ports:)?(?P<port>\w+)\) is not connected")


def _list_wordings(words: str) -> Iterator[str]:
    """Yield shorter and shorter wordings of an error, each with the remedy if the error names one."""
    yield words
    if (parts := _list_parts(words)) is not None:
        missing = _describe_missing(words)
        yield f"{missing}; the robot has {parts}"
        yield f"{missing}: {parts}"
        yield parts
        yield missing
    elif forgotten := _FORGOTTEN.search(words):
        yield _KIND.sub("", words)
        yield f"no {forgotten['wrong']}: did you forget {forgotten['line']}?"
        yield f"{forgotten['line']}?"
    elif meant := _MEANT.search(words):
        yield _KIND.sub("", words)
        yield f"no {meant['wrong']}: did you mean {meant['meant']}?"
        yield f"did you mean {meant['meant']}?"
        yield f"{meant['meant']}?"
    yield _KIND.sub("", words)


def _describe_missing(words: str) -> str:
    match = _ASKED.search(words)
    return f"no {match['what']} on {match['port']}" if match else "not on this port"


def _list_parts(words: str) -> str | None:
    """Return the part of an error that lists the robot's parts by port, with short names; None if it lists none."""
    match = _PARTS.search(words)
    return None if match is None else _PART.sub(r"\1 \2", match["parts"])


def fit_words(words: str, width: int) -> str:
    """Return the longest wording of an error with at most `width` letters; if all are longer, the shortest one, cut."""
    wordings = list(_list_wordings(words))
    return next(
        (wording for wording in wordings if len(wording) <= width), cut(wordings[-1], width)
    )


def find_remedy(words: str) -> str:
    """Return what the user can do in the app about an error, with ids of actions in braces.

    If the robot lacks parts, this is to choose another robot; for any other error, it is the key that goes to the
    error.
    """
    if (parts := _list_parts(words)) is None:
        return "{went-wrong} goes there"
    return f"{_describe_missing(words)}: {parts}. {{robot}} chooses another robot"


def shorten_error(error: TuisimError) -> str:
    """Return the text of an error about a name that was typed beside a list, without hints that repeat the list."""
    guess, question, _ = error.hint.partition("?")
    if question and guess.startswith("did you mean"):
        return f"{error.message} ({guess}?)"
    return (
        error.message
        if "`tuisim " in error.hint or error.hint.startswith("one of ")
        else str(error)
    )
