"""Several clients on one home at the same time, with runs removed and compacted under their hands."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random

from tests.conftest import ROOT
from tests.proof.client import all_read
from tests.proof.kind import FaultError, Kind
from tests.running import PATIENCE_S

SCALES: Mapping[str, tuple[Mapping[str, int], int]] = {
    "some": ({"app": 2, "batch": 1, "analyser": 1, "remover": 1, "rerunner": 1}, 5),
    "full": ({"app": 20, "batch": 5, "analyser": 5, "remover": 1}, 300),
}
"""How many clients of each role, and how often each does its work; `full` runs only by its name."""


def _names(random: Random) -> Iterator[str]:
    while True:
        yield f"some:{random.getrandbits(32)}"


def _check(case: str, folder: Path) -> None:
    scale, _, seed = case.partition(":")
    roles, rounds = SCALES[scale]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    clients = []
    for role, count in roles.items():
        for number in range(count):
            place = folder / f"{role}-{number}"
            place.mkdir()
            words = [sys.executable, "-m", "tests.proof.client", role, f"{seed} {number}", str(rounds)]
            log = (place / "log").open("w+")
            clients.append((role, log, subprocess.Popen(words, cwd=place, env=environment, stdout=log, stderr=log)))
    give_up = time.monotonic() + PATIENCE_S * max(1, rounds // 5)
    try:
        for role, log, client in clients:
            code = client.wait(max(0.1, give_up - time.monotonic()))
            log.seek(0)
            if code or (said := log.read()):
                log.seek(0)
                raise FaultError(f"{role}: exit code {code}: {log.read() or said}")
    except subprocess.TimeoutExpired as hung:
        raise FaultError(f"a client hangs: {hung.cmd}") from None
    finally:
        for _, log, client in clients:
            client.kill()
            client.wait()
            log.close()
    all_read()


CLIENTS = Kind("several clients on one home at the same time", _names, _check)
