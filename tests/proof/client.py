"""One of several clients of one home: `python -m tests.proof.client ROLE SEED ROUNDS PATIENCE`.

It prints what was wrong.
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from random import Random
from typing import Any

from tests.proof.commands import check_said
from tests.proof.kind import FaultError
from tests.proof.shared_home import (
    MADE,
    PROGRAM,
    REMOVED,
    TAGGED,
    check_readable,
    check_recording,
    folder_of,
    is_complete,
    listed,
    note,
)
from tuisim.base.errors import LogError
from tuisim.base.source import Program
from tuisim.engine.protocol import End, Pause, Resume, StepTicks, Unended
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

ROUND_FILE = "rounds"
"""Gets a line for each round."""
OVER_FILE = "over"
"""Beside the folders of the clients: made when those that run programs have ended."""
QUICK = ("analyser", "remover", "tagger")
"""The roles that run no program: they go on until the others have ended."""
_VICTIM = "victim"
_LONG = PROGRAM + "time.sleep(3600)\n"


class Client:
    """A client in its own folder, the working directory.

    Args:
        random: The random numbers of a round.
        patience_s: How long it waits for something that must come.
    """

    def __init__(self, random: Random, patience_s: float) -> None:
        self._random = random
        self._patience_s = patience_s

    def app(self) -> None:
        """Run a program as the app does, pause and step it, look at it while it runs, and read what is stored."""
        random = self._random
        options = RunOptions(
            live=True, speed=random.choice([0.0, 1.0, 4.0]), start_paused=random.random() < 0.3
        )
        run = start_run(
            Program("app.py", PROGRAM),
            build_run_spec(Settings({"seed": random.randrange(9)})),
            options,
        )
        try:
            note(MADE, run.run_id, run.number)
            was_held = False
            for command in random.sample([Pause(), StepTicks(3), Resume(), Resume()], 4):
                run.send(command)
                run.wait_for_event(0.05)
                run.pump()
                run.output.read_new_rows()
                # From its first line to its end its process holds the lock of the folder.
                was_held = was_held or (run.started and run.ended is None and run.folder.is_dir())
            run.send(Resume())
            if stops := random.random() < 0.3:
                run.stop()
            ended = run.wait(self._patience_s)
            if ended is None:
                raise FaultError("a run does not end")
            if was_held and not stops and ended.end is not End.FINISHED:
                raise FaultError(f"a run that nobody stopped ended {ended}")
            check_recording(run.run_id)
        finally:
            run.close()

    def batch(self) -> None:
        """Run a program with several seeds, and keep the runs."""
        out = f"batch-{self._random.getrandbits(32)}.csv"
        Path("batch.py").write_text(PROGRAM)
        words = [
            "batch",
            "batch.py",
            "--seeds",
            "0..2",
            "--jobs",
            "1",
            "--keep",
            "all",
            "--out",
            out,
        ]
        check_said(words, codes=(0,))
        if len(Path(out).read_text().splitlines()) != 4:
            raise FaultError(f"a batch wrote {Path(out).read_text()!r}")

    def analyser(self) -> None:
        """Read runs in several ways."""
        found = listed()
        for row in self._random.sample(found, min(3, len(found))):
            check_recording(row["id"])
            words = self._random.choice(
                ["runs show", "runs show --json", "log summary", "log bands", "log export"]
            )
            more = ["--out", "x.csv"] if words == "log export" else []
            # A run without samples has nothing to analyse.
            if words.startswith("log ") and not row["samples"]:
                continue
            command, name, *options = words.split()
            check_readable([command, name, row["id"], *options, *more], row["id"])

    def _chosen(self) -> dict[str, Any] | None:
        """Return a run, often one that is running; None if there is none."""
        found = listed()
        running = [row for row in found if row["end"] == Unended.RUNNING]
        some = running if running and self._random.random() < 0.7 else found
        return self._random.choice(some) if some else None

    def remover(self) -> None:
        """Remove a run, which is refused while it runs, and only then."""
        if (row := self._chosen()) is None:
            return
        # Of those that are over most stay, for the others to read.
        if row["end"] != Unended.RUNNING and self._random.random() > 0.1:
            return
        run_id = row["id"]
        was_there = is_complete(run_id)
        done = check_said(["runs", "rm", run_id])
        if done.code:
            is_wrong = row["end"] != Unended.RUNNING or "is still running" not in done.err
            if "cannot be removed" in done.err or (is_wrong and was_there and is_complete(run_id)):
                raise FaultError(f"tuisim runs rm {run_id}, listed as {row['end']}: {done.err}")
        elif folder_of(run_id).exists():
            raise FaultError(f"run {run_id} is removed, but its folder is there")
        else:
            note(REMOVED, run_id)

    def rerunner(self) -> None:
        """Run a run again."""
        if row := self._chosen():
            check_said(["runs", "rerun", row["id"]])

    def tagger(self) -> None:
        """Tag a run, which may end at that time."""
        if (row := self._chosen()) is None:
            return
        run_id = row["id"]
        tag = f"t{self._random.getrandbits(32)}"
        was_there = is_complete(run_id)
        try:
            RunStore().tag(run_id, [tag])
            note(TAGGED, run_id, tag)
        except LogError as error:
            if was_there and is_complete(run_id):
                raise FaultError(f"run {run_id} cannot be tagged: {error}") from error

    def killer(self) -> None:
        """Kill an app with its run, which must end, and must not be taken for a running one for ever."""
        words = [
            sys.executable,
            "-m",
            __spec__.name,
            _VICTIM,
            "",
            "1",
            str(self._patience_s),
        ]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as victim:
            assert victim.stdout is not None
            run_id = victim.stdout.readline().strip()
            victim.kill()
        if not run_id:
            raise FaultError("a run has not started")
        give_up = time.monotonic() + self._patience_s
        while [row for row in listed() if row["id"] == run_id and row["end"] == Unended.RUNNING]:
            if time.monotonic() > give_up:
                raise FaultError(f"run {run_id} is still running, but its app was killed")
            time.sleep(0.05)
        check_recording(run_id)

    def victim(self) -> None:
        """Start a run, print its id as soon as its program runs, and wait to be killed."""
        run: RunHandle = start_run(
            Program("victim.py", _LONG), build_run_spec(Settings()), RunOptions(live=True)
        )
        while not run.output.read_new_rows():
            run.wait_for_event(0.05)
            if [event for event in run.pump() if run.ended is not None]:
                raise FaultError(f"a run that nobody stopped ended {run.ended}")
        print(run.run_id, flush=True)
        run.wait(self._patience_s)


ROLES: Mapping[str, Callable[[Client], None]] = {
    "app": Client.app,
    "batch": Client.batch,
    "analyser": Client.analyser,
    "remover": Client.remover,
    "rerunner": Client.rerunner,
    "tagger": Client.tagger,
    "killer": Client.killer,
    _VICTIM: Client.victim,
}


def _is_over(role: str, done: int, rounds: int) -> bool:
    return Path("..", OVER_FILE).exists() if role in QUICK else done >= rounds


def main(role: str, seed: str, rounds: str, patience_s: str) -> int:
    """Do the work of a role until it is over; return 1 if something was wrong."""
    process.start_warm_process()
    done = 0
    try:
        while not _is_over(role, done, int(rounds)):
            random = Random(f"{role} {seed} {done}")
            ROLES[role](Client(random, float(patience_s)))
            note(ROUND_FILE, done := done + 1)
            if role in QUICK:
                time.sleep(random.random() / 20)
    except FaultError as fault:
        print(fault)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
