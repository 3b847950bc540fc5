"""Runs and what was seen of them: what users do with them, headless, and what must hold after each step."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from tests.proof.commands import check_said
from tests.proof.kind import FaultError
from tests.proof.operations import prepared
from tests.running import PATIENCE_S
from tuisim.base.source import Program
from tuisim.commands.rerun import rerun, same
from tuisim.engine.core.tick_record import TICK_FIELDS, TICK_RECORD
from tuisim.engine.protocol import (
    Message,
    Pause,
)
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.records import OutputRow
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings


def _actions(record: bytes) -> int:
    """Return the number of user actions that a record counts."""
    return int(TICK_RECORD.unpack(record)[[name for name, _ in TICK_FIELDS].index("actions")])


@dataclass(frozen=True)
class Seen:
    """What was seen of a recording."""

    ticks: bytes
    rows: list[OutputRow]

    @staticmethod
    def of(run: RunHandle | StoredRun) -> Seen:
        """Look at a run now."""
        ticks = run.telemetry.array().tobytes()
        return Seen(ticks, run.output.read_all_rows())

    def check_grown(self, now: Seen, name: str, is_live: bool = False) -> None:
        """Raise a fault if something that was seen is gone or different."""
        size = TICK_RECORD.size
        last = len(self.ticks) - size
        was = self.ticks[-size:]
        last_now = now.ticks[last : last + size]
        # The newest record is written again when the user does something, and counts it.
        is_same = was == last_now or (is_live and _actions(was) != _actions(last_now))
        if now.ticks[: max(last, 0)] != self.ticks[:-size] or (self.ticks and not is_same):
            raise FaultError(
                f"{name}: {len(self.ticks)} bytes of ticks that were seen are not those of {len(now.ticks)}"
            )
        if now.rows[: len(self.rows)] != self.rows:
            raise FaultError(
                f"{name}: rows that were seen have changed: {self.rows[-3:]} of {len(self.rows)}"
            )


class RunModel:
    """What must hold of the runs of one home.

    Args:
        folder: An empty folder.
    """

    def __init__(self, folder: Path) -> None:
        process.start_warm_process()
        self.outer = folder
        self.folder = prepared(folder, "place")
        self.files = {path.name for path in self.folder.iterdir()}
        """The names of the files that may be there."""
        self.store = RunStore()
        self.live: dict[str, RunHandle] = {}
        self.seen: dict[str, Seen] = {}
        self.done: list[str] = []
        for info in self.store.runs():
            self.seen[info.id] = Seen.of(self.store.load_run(info.id))

    # Choices

    def one_live(self, random: Random) -> RunHandle | None:
        """Return a run that has not ended, if there is one."""
        return random.choice(list(self.live.values())) if self.live else None

    def one_paused(self, random: Random) -> RunHandle | None:
        """Return a run that is paused now, if there is one or can be."""
        run = self.one_live(random)
        if run is None or run.waiting_for_input is not None:
            return None
        if not run.paused:
            run.send(Pause())
            self.pump(run, lambda: run.paused or run.waiting_for_input is not None)
        return run if run.paused else None

    def one_stored(self, random: Random) -> StoredRun | None:
        """Return a run that has ended, if there is one."""
        ended = [one for one in self.seen if one not in self.live]
        return self.store.load_run(random.choice(ended)) if ended else None

    # Runs

    def start(self, program: Program, settings: Settings, options: RunOptions) -> RunHandle:
        """Start a run."""
        run = start_run(program, build_run_spec(settings), options)
        return self.follow(run)

    def follow(self, run: RunHandle) -> RunHandle:
        """Take up a run that was started."""
        self.live[run.run_id] = run
        self.seen[run.run_id] = Seen(b"", [])
        self.pump(run, lambda: run.started)
        return run

    def pump(self, run: RunHandle, ready: Callable[[], bool]) -> list[Message]:
        """Pump until something is so, or the run is over; return the events."""
        give_up = time.monotonic() + PATIENCE_S
        events: list[Message] = []
        while not ready() and run.ended is None:
            if time.monotonic() > give_up:
                raise FaultError(
                    f"run {run.number}: what was waited for never came, only {events[-3:]}"
                )
            run.wait_for_event(0.01)
            events += run.pump()
        return events

    def ask(self, run: RunHandle, wanted: type[Message], command: Message) -> list[Message]:
        """Send a command and wait for the event that answers it, or the end."""
        events: list[Message] = []
        run.send(command)
        give_up = time.monotonic() + PATIENCE_S
        while not any(isinstance(event, wanted) for event in events) and run.ended is None:
            if time.monotonic() > give_up:
                raise FaultError(f"run {run.number}: {command} was never answered")
            run.wait_for_event(0.01)
            events += run.pump()
        return events

    # What must hold

    def check_all(self) -> None:
        """Raise a fault if a recording has changed other than by growing, or a file lies where none belongs."""
        was_live = set(self.live)
        for run_id, run in list(self.live.items()):
            if run.ended is None:
                run.pump()
            if run.ended is not None:
                del self.live[run_id]
                if run.unstored:
                    raise FaultError(f"run {run.number} is not stored: {run.unstored}")
        for run_id, before in self.seen.items():
            now = Seen.of(self.live.get(run_id) or self.store.load_run(run_id))
            before.check_grown(now, run_id, run_id in was_live)
            self.seen[run_id] = now
        listed = {info.id for info in self.store.runs()}
        if listed != set(self.seen):
            raise FaultError(f"listed are {sorted(listed)}, but there must be {sorted(self.seen)}")
        if strange := {path.name for path in self.folder.iterdir()} - self.files:
            raise FaultError(f"files that nobody named: {strange}")
        if strange := {path.name for path in self.outer.iterdir()} - {"place"}:
            raise FaultError(f"files outside: {strange}")

    @staticmethod
    def check_replay(run: StoredRun) -> None:
        """Raise a fault if a run that has ended is not the same when it is run again."""
        with again(run) as other:
            if other.wait(PATIENCE_S) is None:
                # A run that went on for hours of simulated time is compared as far as its rerun has come.
                other.kill()
                other.wait(PATIENCE_S)
                found = same(other.stored(), run)
            else:
                found = same(run, other.stored())
        if not found.same:
            raise FaultError(
                f"run {run.number} ({run.state}) and its rerun differ: {found.tick or found.output}"
            )

    def end(self) -> None:
        """Stop all runs, and run them again."""
        own = list(self.live)
        for run in self.live.values():
            run.stop()
            if run.wait(PATIENCE_S) is None:
                raise FaultError(f"run {run.number} does not stop")
        self.check_all()
        for run_id in own:
            self.check_replay(self.store.load_run(run_id))
        check_said(["runs", "--json"], (0,))

    def close(self) -> None:
        """Leave no process behind."""
        for run in self.live.values():
            run.close()


@contextmanager
def again(run: StoredRun, **options: Any) -> Iterator[RunHandle]:
    """Run a stored run again, unlisted."""
    with TemporaryDirectory(prefix="tuisim-proof-again-") as folder:
        other = rerun(run, RunStore(Path(folder)), **options)
        try:
            yield other
        finally:
            other.close()
