"""Several clients on one home at the same time, with runs removed, tagged and killed under their hands."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from random import Random
from typing import IO

from tests.conftest import ROOT
from tests.proof.client import OVER_FILE, QUICK, ROUND_FILE
from tests.proof.kind import FaultError, Kind
from tests.proof.shared_home import check_home
from tests.running import PATIENCE_S

_SLACK = 10
"""How many times as long as alone a client may take for each that works beside it."""


ROLES: Mapping[str, int] = {
    "app": 2,
    "batch": 1,
    "analyser": 1,
    "remover": 1,
    "rerunner": 1,
    "tagger": 1,
    "killer": 1,
}
"""The number of clients of each role."""
ROUNDS = 4
"""How often each that runs programs does so; the others go on until these have ended."""


@dataclass(frozen=True, slots=True)
class _Started:
    role: str
    place: Path
    log: IO[str]
    process: subprocess.Popen[bytes]

    def said(self) -> str:
        self.log.seek(0)
        return self.log.read()


def _start(role: str, place: Path, home: Path, *words: object) -> _Started:
    place.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TUISIM_HOME": str(home)}
    log = (place / "log").open("w+")
    command = [sys.executable, "-m", "tests.proof.client", role, *map(str, words)]
    return _Started(
        role,
        place,
        log,
        subprocess.Popen(command, cwd=place, env=environment, stdout=log, stderr=log),
    )


@cache
def _alone_s() -> float:
    """Return the seconds that an app takes alone to start, and to run one program."""
    with tempfile.TemporaryDirectory(prefix="tuisim-proof-alone-") as folder:
        start_s = time.monotonic()
        client = _start("app", Path(folder, "app"), Path(folder, "home"), "alone", 1, PATIENCE_S)
        with client.log, client.process:
            if client.process.wait(PATIENCE_S):
                raise FaultError(f"one app alone: {client.said()}")
        return time.monotonic() - start_s


def _rounds(clients: Sequence[_Started]) -> int:
    paths = [client.place / ROUND_FILE for client in clients if client.role not in QUICK]
    return sum(path.stat().st_size for path in paths if path.exists())


def _check_ends(clients: Sequence[_Started], patience_s: float) -> None:
    """Wait until all have ended; a fault is what one prints, and a time without a round of those that run programs."""
    left = list(clients)
    done = -1
    give_up = 0.0
    while left:
        busy = [one for one in left if one.role not in QUICK]
        if not busy:
            (clients[0].place.parent / OVER_FILE).touch()
        if (now_done := _rounds(clients) if busy else done) > done:
            done = now_done
            give_up = time.monotonic() + patience_s
        if time.monotonic() > give_up:
            raise FaultError(
                f"no client has finished a round for {patience_s:.0f} s: {[one.role for one in left]}"
            )
        for client in [one for one in left if one.process.poll() is not None]:
            left.remove(client)
            if client.process.returncode or client.said():
                raise FaultError(
                    f"{client.role}: exit code {client.process.returncode}: {client.said()}"
                )
        time.sleep(0.02)


def _names(random: Random) -> Iterator[str]:
    while True:
        yield str(random.getrandbits(32))


def _check(case: str, folder: Path) -> None:
    home = Path(os.environ["TUISIM_HOME"])
    patience_s = PATIENCE_S + _SLACK * _alone_s() * sum(ROLES.values())
    clients: list[_Started] = []
    with ExitStack() as stack:
        for role, count in ROLES.items():
            for number in range(count):
                words = f"{case} {number}", ROUNDS, patience_s
                clients.append(client := _start(role, folder / f"{role}-{number}", home, *words))
                stack.enter_context(client.log)
                stack.enter_context(client.process)
                stack.callback(client.process.kill)
        _check_ends(clients, patience_s)
    check_home(folder)


CLIENTS = Kind("several clients on one home at the same time", _names, _check)
