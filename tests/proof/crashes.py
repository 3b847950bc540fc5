"""Operations that are killed at each write and rename, one by one: the next start reads all that was promised."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from random import Random

from tests.proof.injection import killed_at
from tests.proof.kind import Kind
from tests.proof.operations import OPERATIONS, calls_in, check_after, prepared, spread, undisturbed

CALLS = "write,pwrite64,writev,rename,renameat,renameat2,unlink,unlinkat,fsync,fdatasync,ftruncate,mkdir,mkdirat,link"


def _names(random: Random) -> Iterator[str]:
    return spread(_cases_of, random)


def _cases_of(operation: str) -> Iterator[str]:
    counts = Counter[str]()
    for call in calls_in(operation, CALLS):
        counts[call.name] += 1
        yield f"{operation}:{call.name}:{counts[call.name]}"


def _check(case: str, folder: Path) -> None:
    name, call, number = case.split(":")
    undisturbed(name)
    place = prepared(folder, "place")
    check_after(name, place, killed_at(OPERATIONS[name].words, place, call, int(number)))


CRASHES = Kind("commands that are killed at each write and rename", _names, _check)
