"""One of several clients of one home: `python -m tests.proof.client ROLE SEED ROUNDS`; prints what was wrong."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from random import Random

from tests.proof.commands import check_said, said
from tests.proof.kind import FaultError
from tests.running import PATIENCE_S
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.errors import LogError
from tuisim.protocol import Pause, Resume, StepTicks
from tuisim.runs import process
from tuisim.runs.handle import RunOptions, start_run
from tuisim.source import Program

_TEXT = "import time\nfor n in range(30):\n    print('A:', n)\n    time.sleep(0.05)\n"


def _app(random: Random) -> None:
    """Run a program as the app does, pause and step it, look at it while it runs, and read what is stored."""
    options = RunOptions(live=True, speed=random.choice([0.0, 4.0]), start_paused=random.random() < 0.3)
    run = start_run(Program("app.py", _TEXT), build_run_spec(Settings(seed=random.randrange(9))), options)
    try:
        for command in random.sample([Pause(), StepTicks(3), Resume(), Resume()], 4):
            run.send(command)
            run.wait_for_event(0.05)
            run.pump()
            run.output.new_rows()
        run.send(Resume())
        if random.random() < 0.3:
            run.stop()
        if run.wait(PATIENCE_S) is None:
            raise FaultError("a run does not end")
        with suppress(LogError):
            stored = run.stored()
            lines = [row.text for row in stored.output.rows() if row.text.startswith("A:")]
            if lines != [f"A: {n}" for n in range(len(lines))]:
                raise FaultError(f"a run of its own has the lines {lines}")
    finally:
        run.close()


def _batch(random: Random) -> None:
    out = f"batch-{random.getrandbits(32)}.csv"
    Path("batch.py").write_text(_TEXT)
    words = ["batch", "batch.py", "--seeds", "0..2", "--jobs", "1", "--keep", "all", "--out", out]
    check_said(words, codes=(0,))
    if len(Path(out).read_text().splitlines()) != 4:
        raise FaultError(f"a batch wrote {Path(out).read_text()!r}")


def _numbers() -> list[int]:
    found = [one["number"] for one in json.loads(check_said(["runs", "list", "--json"], codes=(0,)).out)]
    if len(set(found)) != len(found):
        raise FaultError(f"two runs have one number: {found}")
    return found


def _analyser(random: Random) -> None:
    for number in random.sample(found := _numbers(), min(3, len(found))):
        words = random.choice(["runs show", "log summary", "log bands", "runs show --json", "log export --out x.csv"])
        command, name, *more = words.split()
        check_said([command, name, str(number), *more])


def _remover(random: Random) -> None:
    if found := _numbers():
        check_said(["runs", random.choice(["rm", "compact"]), str(random.choice(found))])


def _rerunner(random: Random) -> None:
    if found := _numbers():
        check_said(["runs", "rerun", str(random.choice(found))])


ROLES: Mapping[str, Callable[[Random], None]] = {
    "app": _app,
    "batch": _batch,
    "analyser": _analyser,
    "remover": _remover,
    "rerunner": _rerunner,
}


def main(role: str, seed: str, rounds: str) -> int:
    """Do the work of a role so often; return 1 if something was wrong."""
    process.warm_up()
    try:
        for number in range(int(rounds)):
            ROLES[role](Random(f"{role} {seed} {number}"))
    except FaultError as fault:
        print(fault)
        return 1
    return 0


def all_read() -> None:
    """Check that all runs can be read when the clients have gone."""
    for number in _numbers():
        done = said(["runs", "show", str(number), "--json"])
        if done.code:
            raise FaultError(f"run {number} cannot be read: {done.err}")


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
