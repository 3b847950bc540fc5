"""System calls of a command that are counted, fail, or kill it, one by one: by `strace`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from tests.conftest import ROOT
from tests.proof.kind import FaultError
from tests.running import PATIENCE_S

_STRACE = ("strace", "-qq", "-y")
_AND_CHILDREN = ("-f", "--seccomp-bpf")
_CALL = re.compile(r"(?P<process>\d+) +(?P<call>\w+)\((?P<rest>.*)")


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended."""

    code: int
    """Negative: by this signal."""
    out: str
    err: str
    is_impossible: bool = False
    """Whether a call has failed that never does: a read from a pipe."""


def temporary_folder(folder: Path) -> Path:
    """Return the folder for temporary files of the commands in a folder, beside it."""
    place = folder.with_name(f"{folder.name}-tmp")
    place.mkdir(exist_ok=True)
    return place


def run(words: Sequence[str], folder: Path, strace: Sequence[str] = ()) -> Ended:
    """Run Python with these words in a folder, under `strace` if it gets words; a fault if it does not end."""
    command = [sys.executable, *words]
    if strace:
        command = [*_STRACE, *strace, *command]
    environment = {
        **os.environ,
        "PYTHONPATH": str(ROOT),
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONHASHSEED": "0",
        "TMPDIR": str(temporary_folder(folder)),
    }
    try:
        done = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=PATIENCE_S,
            check=False,
        )
    except subprocess.TimeoutExpired as hung:
        raise FaultError(f"hangs: {hung.stderr!r}") from None
    return Ended(done.returncode, done.stdout, done.stderr)


@dataclass(frozen=True, slots=True)
class Call:
    """A system call."""

    name: str
    is_in_folder: bool
    """Whether it names the folder in which the command runs, or a file in it."""


def calls_of(words: Sequence[str], folder: Path, names: str) -> list[Call]:
    """Return the calls of the command's first process with these names, which are separated by commas, in order."""
    log = folder / "strace.log"
    ended = run(
        words, folder, [*_AND_CHILDREN, "-e", f"trace={names}", "-e", "signal=none", "-o", str(log)]
    )
    if ended.code:
        raise FaultError(f"the calls of {' '.join(words)} cannot be counted: {ended.err}")
    found = [
        match
        for line in log.read_text(errors="replace").splitlines()
        if (match := _CALL.match(line))
    ]
    log.unlink()
    return [
        Call(match["call"], str(folder) in _without_working_directory(match["rest"]))
        for match in found
        if match["process"] == found[0]["process"]
    ]


def _without_working_directory(rest: str) -> str:
    """Return the arguments of a call without the working directory, which is part of every name."""
    return rest.partition(">, ")[2] if rest.startswith("AT_FDCWD") else rest


def killed_at(words: Sequence[str], folder: Path, call: str, number: int) -> Ended:
    """Run a command that is killed as it begins the call of this number among those of its name.

    Its children are not: a program that is killed is another matter, which its run tells.
    """
    which = ["-e", f"trace={call}", "-e", f"inject={call}:signal=KILL:when={number}"]
    return run(words, folder, [*which, *_NOWHERE])


def failing_at(
    words: Sequence[str],
    folder: Path,
    call: str,
    error: str,
    number: int,
    *,
    in_children: bool = True,
) -> Ended:
    """Run a command of which a call fails: in each process, or in the first one only, the one of this number."""
    which = ["-e", f"trace={call}", "-e", f"inject={call}:error={error}:when={number}"]
    with tempfile.NamedTemporaryFile("r", errors="replace") as log:
        ended = run(
            words, folder, [*(_AND_CHILDREN if in_children else ()), *which, "-o", log.name]
        )
        failed = [line for line in log if line.rstrip().endswith("(INJECTED)")]
    # A call that waits, as only one on a pipe does, stands on two lines, and the second does not name it.
    of_pipes = (" EIO " in line and ("<pipe:[" in line or " resumed>" in line) for line in failed)
    return replace(ended, is_impossible=any(of_pipes))


_NOWHERE = ("-o", os.devnull)
