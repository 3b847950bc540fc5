"""System calls of a command that are counted, fail, or kill it, one by one: by `strace`."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.conftest import ROOT
from tests.proof.kind import FaultError
from tests.running import PATIENCE_S

_STRACE = ("strace", "-f", "--seccomp-bpf", "-qq", "-y")
_CALL = re.compile(r"(?P<process>\d+) +(?P<call>\w+)\((?P<rest>.*)")


@dataclass(frozen=True, slots=True)
class Ended:
    """How a command ended."""

    code: int
    """Negative: by this signal."""
    out: str
    err: str


def run(words: Sequence[str], folder: Path, strace: Sequence[str] = ()) -> Ended:
    """Run Python with these words in a folder, under `strace` if it gets words; a fault if it does not end."""
    command = [sys.executable, *words]
    if strace:
        command = [*_STRACE, *strace, *command]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1", "PYTHONHASHSEED": "0"}
    try:
        done = subprocess.run(
            command, cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
            errors="replace", timeout=PATIENCE_S, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired as hung:
        raise FaultError(f"hangs: {hung.stderr!r}") from None
    return Ended(done.returncode, done.stdout, done.stderr)


def numbers_of(words: Sequence[str], folder: Path, calls: str, place: Path | None = None) -> list[int]:
    """Return which calls of the command's first process there are, from 1.

    Args:
        calls: The names of the calls, separated by commas.
        place: Only those that name this folder, or a file in it.
    """
    log = folder / "strace.log"
    ended = run(words, folder, ["-e", f"trace={calls}", "-e", "signal=none", "-o", str(log)])
    if ended.code:
        raise FaultError(f"the calls of {' '.join(words)} cannot be counted: {ended.err}")
    found = [match for line in log.read_text(errors="replace").splitlines() if (match := _CALL.match(line))]
    log.unlink()
    first = [match["rest"] for match in found if match["process"] == found[0]["process"]]
    # The working directory is part of every name.
    rests = [rest.partition(">, ")[2] if rest.startswith("AT_FDCWD") else rest for rest in first]
    return [number for number, rest in enumerate(rests, 1) if place is None or str(place) in rest]


def killed_at(words: Sequence[str], folder: Path, calls: str, number: int) -> Ended:
    """Run a command that is killed as it begins a call."""
    return run(words, folder, ["-e", f"trace={calls}", "-e", f"inject={calls}:signal=KILL:when={number}", *_NOWHERE])


def failing_at(words: Sequence[str], folder: Path, call: str, error: str, number: int) -> Ended:
    """Run a command of which a call fails."""
    return run(words, folder, ["-e", f"trace={call}", "-e", f"inject={call}:error={error}:when={number}", *_NOWHERE])


_NOWHERE = ("-o", os.devnull)
