"""Operations of which each call to the system fails once: a clear line, nothing lost, no hang."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from tests.proof.injection import failing_at, numbers_of
from tests.proof.kind import FaultError, Kind, home
from tests.proof.operations import OPERATIONS, check_after, prepared, undisturbed

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


@cache
def _numbers(name: str, call: str) -> list[int]:
    with TemporaryDirectory(prefix="tuisim-proof-count-") as folder, home(Path(folder)):
        place = prepared(Path(folder), "count")
        # Python itself opens, reads and maps hundreds of files.
        return numbers_of(OPERATIONS[name].words, place, call, place if call in ("openat", "read", "mmap") else None)


def _names(random: Random) -> Iterator[str]:
    pairs = [(name, call) for name in OPERATIONS for call in ERRORS]
    for name, call in random.sample(pairs, len(pairs)):
        cases = [f"{name}:{call}:{error}:{number}" for number in _numbers(name, call) for error in ERRORS[call]]
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
