"""What tests of real runs in real child processes share: a run that is over, and waiting for one that is not."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tuisim.base.source import Program
from tuisim.commands.rerun import rerun, same
from tuisim.engine.protocol import Ended, Message
from tuisim.engine.runs.diff import RunDiff
from tuisim.engine.runs.handle import RunHandle, RunOptions, start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

PATIENCE_S = 120.0
"""How long a test waits before it fails: what never comes must not pass, and what comes late on a busy machine must."""

SIGNALLED = 128
"""A shell reports this much more than the number of the signal that ended a program."""


def told(done: subprocess.CompletedProcess[str]) -> list[str]:
    """Return the lines that a command wrote to stderr, except notes."""
    return [line for line in done.stderr.splitlines() if not line.startswith("note: ")]


@dataclass(frozen=True)
class Done:
    """A run that is over."""

    run: RunHandle
    ended: Ended

    @property
    def lines(self) -> list[str]:
        """What was printed, without error text."""
        return [row.text for row in self.run.output.read_all_rows() if row.stream == 1]

    @property
    def errors(self) -> list[str]:
        """Lines of error text."""
        return [row.text for row in self.run.output.read_all_rows() if row.stream == 2]

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the robot came to stand: x and y in mm, heading in degrees."""
        last = self.run.telemetry.last()
        assert last is not None
        return last.x_mm, last.y_mm, last.heading_deg

    @property
    def recording(self) -> tuple[bytes, ...]:
        """Everything the run recorded."""
        return tuple(
            (self.run.folder / name).read_bytes()
            for name in (
                "telemetry.bin",
                "output.bin",
                "readings.bin",
                "motors.bin",
                "commands.bin",
            )
            if (self.run.folder / name).exists()
        )


Start = Callable[..., RunHandle]
"""The fixture `start`."""

Run = Callable[..., Done]
"""The fixture `run`."""


def over(handle: RunHandle) -> Done:
    """Wait for the end of a run."""
    ended = handle.wait(PATIENCE_S)
    assert ended is not None
    return Done(handle, ended)


def until(run: RunHandle, ready: Callable[[], bool], seen: list[Message] | None = None) -> None:
    """Pump until something holds."""
    give_up = time.monotonic() + PATIENCE_S
    while not ready():
        assert time.monotonic() < give_up, "still not so"
        run.wait_for_event(0.01)
        events = run.pump()
        if seen is not None:
            seen += events


def until_tick(run: RunHandle, tick: int) -> None:
    """Pump until a tick is recorded, or the run is over."""
    until(run, lambda: run.telemetry.count > tick or run.ended is not None)


def run_live_and_headless(
    program: Program, choices: Mapping[str, Any], speed: float = 16.0
) -> tuple[StoredRun, RunDiff]:
    """Run a program live, then again headless; return the first run, and how the second one differs."""
    live = start_run(program, build_run_spec(Settings(choices)), RunOptions(live=True, speed=speed))
    over(live)
    run = RunStore().load_run(live.run_id)
    again = rerun(run, RunStore())
    over(again)
    return run, same(run, RunStore().load_run(again.run_id))


@dataclass(frozen=True)
class AsPython:
    """What Python itself makes of a program."""

    stdout: str
    stderr: str
    exit_code: int
    """As a shell reports it."""


def as_python(text: str, folder: Path) -> AsPython:
    """Run a program by Python itself, as `program.py` in a folder."""
    (folder / "program.py").write_text(text, encoding="utf-8", newline="")
    environment = {
        "PYTHONUTF8": "1",
        "PYTHONHASHSEED": "0",
        "PYTHONIOENCODING": "utf-8:backslashreplace",
    }
    # Without a buffer, which a program that ends at once would lose.
    done = subprocess.run(
        [sys.executable, "-u", "program.py"],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        timeout=PATIENCE_S,
        start_new_session=True,
    )
    out, err = (
        data.decode(errors="replace").removesuffix("\n") for data in (done.stdout, done.stderr)
    )
    return AsPython(
        out, err, done.returncode if done.returncode >= 0 else SIGNALLED - done.returncode
    )
