"""Plateaus of a long log, found by a process of its own: a search in a thread would hold up every key for a second."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from typing import IO

import numpy as np

from tuisim.errors import LogError
from tuisim.logs.plateaus import Plateau, plateaus
from tuisim.runs.arrays import FloatArray

_PACKAGE_FOLDER = Path(__file__).resolve().parents[3]
_LOOK_S = 0.1
_FIELDS = 6
"""Numbers of a plateau, all of which a float tells exactly."""


def plateaus_aside(values: FloatArray, stopped: Callable[[], bool]) -> list[Plateau]:
    """Return the plateaus of a log, as `plateaus` does, while other threads of this process go on.

    Args:
        values: As for `plateaus`.
        stopped: Asked now and then whether nobody waits for the answer any more.

    Raises:
        LogError: the search was stopped, its process has ended without an answer, or there
            is no room for temporary files.
    """
    try:
        with tempfile.TemporaryFile() as given, tempfile.TemporaryFile() as answer:
            np.asarray(values, np.float64).tofile(given)
            given.seek(0)
            code = _ended(given, answer, stopped)
            if code:
                raise LogError(f"the search for bands has ended without an answer (exit code {code})")
            answer.seek(0)
            found = np.fromfile(answer).reshape(-1, _FIELDS).tolist()
    except OSError as error:
        raise LogError(
            f"no search for bands: {error.strerror or error}", "it needs room for temporary files"
        ) from error
    return [Plateau(int(row[0]), int(row[1]), row[2], row[3], row[4], int(row[5])) for row in found]


def _ended(given: IO[bytes], answer: IO[bytes], stopped: Callable[[], bool]) -> int:
    """Run the process and return its exit code."""
    with subprocess.Popen(
        [sys.executable, "-s", "-P", "-m", __name__],
        stdin=given,
        stdout=answer,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(_PACKAGE_FOLDER)},
    ) as process:
        while True:
            try:
                return process.wait(_LOOK_S)
            except subprocess.TimeoutExpired:
                if stopped():
                    process.kill()
                    raise LogError("the search for bands was stopped") from None


def _answer() -> None:
    """Read values from the standard input and write their plateaus to the standard output, both files."""
    found = plateaus(np.fromfile(sys.stdin.buffer))
    np.array([astuple(plateau) for plateau in found], np.float64).tofile(sys.stdout.buffer)


if __name__ == "__main__":
    _answer()
