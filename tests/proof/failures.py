"""Operations of which each call to the system fails once: a clear line, nothing lost, no hang."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random

from tests.proof.injection import failing_at
from tests.proof.kind import FaultError, Kind
from tests.proof.operations import OPERATIONS, calls_in, check_after, prepared, spread, undisturbed

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
    return spread(_cases_of, random)


def _cases_of(operation: str) -> Iterator[str]:
    found = calls_in(operation, ",".join(ERRORS))
    for call, errors in ERRORS.items():
        same = [one for one in found if one.name == call]
        numbers = [
            number
            for number, one in enumerate(same, 1)
            if one.is_in_folder or call not in _OF_PYTHON
        ]
        yield from (
            f"{operation}:{call}:{error}:{number}" for number in numbers for error in errors
        )


def _check(case: str, folder: Path) -> None:
    name, call, error, number = case.split(":")
    undisturbed(name)
    place = prepared(folder, "place")
    # The processes of a batch write to pipes only, which have room and no errors; a lost message is waited for.
    in_children = not (call == "write" and OPERATIONS[name].again)
    ended = failing_at(
        OPERATIONS[name].words, place, call, error, int(number), in_children=in_children
    )
    if "ImportError" in ended.err or "ModuleNotFoundError" in ended.err:
        # The call that failed was one of Python's own, which may come in another order.
        return
    if call == "read" and ended.is_impossible:
        # Calls are numbered; when processes start in another order, it is another one.
        return
    if ended.code < 0:
        raise FaultError(f"ended by signal {-ended.code}: {ended.err}")
    # Only where the call was one that writes to the terminal, or to the pipe of a run, which has no errors.
    if call != "write" and any(
        sign in ended.err + ended.out for sign in ("tuisim: cannot write:", "lost sys.")
    ):
        raise FaultError(
            f"an error that nobody handled, and that names no file: {ended.err}{ended.out}"
        )
    # A batch prints why runs have failed as a result.
    if (
        ended.code
        and not (ended.err + ended.out).strip()
        and not (call == "write" and error != "EINTR")
    ):
        raise FaultError(f"exit code {ended.code} without a word")
    check_after(name, place, ended)


FAILURES = Kind("commands of which each system call fails once", _names, _check)
