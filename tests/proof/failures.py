"""Operations of which each call to the system fails once: a clear line, nothing lost, no hang."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random

from tests.proof.injection import failing_at
from tests.proof.kind import FaultError, Kind
from tests.proof.operations import OPERATIONS, check_after, numbers_in, prepared, undisturbed

ERRORS: Mapping[str, tuple[str, ...]] = {
    "write": ("ENOSPC", "EIO", "EINTR"),
    "pwrite64": ("ENOSPC", "EIO"),
    "fsync": ("EIO", "ENOSPC"),
    "rename": ("EACCES", "ENOSPC"),
    "unlink": ("EACCES",),
    "mkdir": ("ENOSPC", "EACCES"),
    "ftruncate": ("ENOSPC", "EIO"),
    "fallocate": ("ENOSPC",),
    "openat": ("EMFILE", "EACCES", "EINTR", "EIO"),
    "read": ("EIO", "EINTR"),
    "pipe2": ("EMFILE",),
    "flock": ("EINTR", "EIO"),
    "mmap": ("ENOMEM",),
}
"""Errors by call."""


_OF_PYTHON = ("openat", "read", "mmap")
"""Python itself opens, reads and maps hundreds of files: only those of an operation count."""


def _names(random: Random) -> Iterator[str]:
    pairs = [(name, call) for name in OPERATIONS for call in ERRORS]
    for name, call in random.sample(pairs, len(pairs)):
        numbers = numbers_in(name, call, only_in_folder=call in _OF_PYTHON)
        cases = [f"{name}:{call}:{error}:{number}" for number in numbers for error in ERRORS[call]]
        yield from random.sample(cases, len(cases))


def _check(case: str, folder: Path) -> None:
    name, call, error, number = case.split(":")
    undisturbed(name)
    place = prepared(folder, "place")
    ended = failing_at(OPERATIONS[name].words, place, call, error, int(number))
    if "ImportError" in ended.err or "ModuleNotFoundError" in ended.err:
        # The call that failed was one of Python's own, which may come in another order.
        return
    if ended.code < 0:
        raise FaultError(f"ended by signal {-ended.code}: {ended.err}")
    if ended.code and not ended.err.strip() and not (call == "write" and error != "EINTR"):
        raise FaultError(f"exit code {ended.code} without a word")
    check_after(name, place, ended)


FAILURES = Kind("commands of which each system call fails once", _names, _check)
