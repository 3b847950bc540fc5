"""Searches what a run printed for the regular expressions of goals, within a limit of processor time.

Python's own search can take years for a careless expression such as `(a+)+$`, and nothing in the process can stop it.
Where the form of an expression and the lengths of the texts show that this cannot be, it is searched for here; else in
a process of its own, which the system ends.
"""

from __future__ import annotations

import errno
import json
import math
import re
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterable
from contextlib import suppress
from re import _constants as op  # type: ignore[attr-defined]
from re import _parser  # type: ignore[attr-defined]
from typing import Any

from tuisim.errors import LogError

Search = Callable[[str], bool]
"""Whether an expression is found in a text.

Raises:
    SlowPatternError: that cannot be said in time.
"""

LIMIT_S = 2
"""Processor time for one expression and everything that a run printed, in whole seconds."""
_MOST_STEPS = 20_000_000
"""So many at most are made in this process: at worst a second, nearly always a thousandth of that."""
_SEARCHES = """
import json, os, re, resource, sys, time
pattern, texts, limit_s = json.load(sys.stdin)
# What was used up to here does not count.
end_s = limit_s + int(time.process_time()) + 1
resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
resource.setrlimit(resource.RLIMIT_CPU, (end_s, end_s + 1))
search = re.compile(pattern).search
for text in texts:
    os.write(1, b"1" if search(text) else b"0")
"""
"""Reads an expression, texts and the limit; writes a digit for each text as soon as it is known."""


class SlowPatternError(Exception):
    """A regular expression of a goal cannot be searched for in time."""

    def __init__(self, pattern: str) -> None:
        super().__init__(
            f"The regular expression {pattern!r} takes more than {LIMIT_S} s of processor time for what was printed; "
            "that is a fault of the task"
        )


def search_in(pattern: str, texts: Iterable[str]) -> Search:
    """Return the search for an expression in the given texts, and in no others.

    Args:
        pattern: A regular expression.
        texts: What is searched. Those behind one that takes too long are not.

    Raises:
        LogError: this machine cannot search.
    """
    different = list(dict.fromkeys(texts))
    if _steps(pattern, different) <= _MOST_STEPS:
        search = re.compile(pattern).search
        return lambda text: search(text) is not None
    found = _searched(pattern, different)

    def known(text: str) -> bool:
        if text not in found:
            raise SlowPatternError(pattern)
        return found[text]

    return known


def _searched(pattern: str, texts: list[str]) -> dict[str, bool]:
    """Return in which texts an expression is found, as far as a process of its own can tell in time.

    Raises:
        LogError: there can be no such process, or something else has ended it.
    """
    given = json.dumps([pattern, texts, LIMIT_S]).encode()
    command = [sys.executable, "-I", "-S", "-c", _SEARCHES]
    try:
        done = subprocess.run(
            command, input=given, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False
        )
    except OSError as error:
        raise _of_the_machine(error.strerror or str(error)) from OSError(errno.ENOMEM, str(error))
    if done.returncode not in (0, -signal.SIGXCPU):
        why = "the process that searches was ended"
        raise _of_the_machine(why) from OSError(errno.ENOMEM, why)
    return {text: digit == ord("1") for text, digit in zip(texts, done.stdout, strict=False)}


def _of_the_machine(why: str) -> LogError:
    """Return the error if this machine cannot search. Its cause must be one of the machine, none of the recording."""
    return LogError(f"what was printed cannot be searched: {why}")


def _steps(pattern: str, texts: list[str]) -> float:
    """Return how many steps a search of all texts may take at most."""
    with suppress(re.error, RecursionError, OverflowError):
        parsed = _parser.parse(pattern)
        lengths = Counter(map(len, texts))
        return sum(
            count * (length + 1) * _ways(parsed, length) for length, count in lengths.items()
        )
    return math.inf


def _ways(parsed: Any, length: int) -> float:
    """Return in how many ways an expression can be tried at one place of a text, at most."""
    ways = 1.0
    for kind, value in parsed:
        ways *= _ways_of(kind, value, length)
    return ways


def _ways_of(kind: object, value: Any, length: int) -> float:
    match kind:
        case op.BRANCH:
            return sum(_ways(one, length) for one in value[1])
        case op.SUBPATTERN:
            return _ways(value[3], length)
        case op.ATOMIC_GROUP:
            return _ways(value, length)
        case op.ASSERT | op.ASSERT_NOT:
            return _ways(value[1], length)
        case op.GROUPREF_EXISTS:
            return sum(_ways(one, length) for one in value[1:] if one is not None)
        case op.GROUPREF:
            return length + 1.0
        case op.MAX_REPEAT | op.MIN_REPEAT | op.POSSESSIVE_REPEAT:
            least, most = int(value[0]), min(int(value[1]), length + int(value[0]))
            inner = _ways(value[2], length)
            # A repetition of what can be tried in two ways has twice as many with each time.
            with suppress(OverflowError):
                return (most - least + 1.0) * inner**most
            return math.inf
    return 1.0
