"""What tests of real runs in real child processes share: a run that is over, and waiting for one that is not."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass

from tuisim.protocol import Ended, Message
from tuisim.runs.handle import RunHandle

PATIENCE_S = 120.0
"""How long a test waits before it fails: what never comes must not pass, and what comes late on a busy machine must."""


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
        return [row.text for row in self.run.output.all_rows() if row.stream == 1]

    @property
    def errors(self) -> list[str]:
        """Lines of error text."""
        return [row.text for row in self.run.output.all_rows() if row.stream == 2]

    @property
    def pose(self) -> tuple[float, float, float]:
        """Where the robot came to stand: x and y in mm, heading in degrees."""
        last = self.run.telemetry.last()
        assert last is not None
        return last.x_mm, last.y_mm, last.heading_deg

    @property
    def recording(self) -> tuple[bytes, ...]:
        """Everything the run recorded."""
        return tuple((self.run.folder / name).read_bytes() for name in ("telemetry.bin", "output.bin"))


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
        assert time.monotonic() < give_up, "it never came"
        run.wait_for_event(0.01)
        events = run.pump()
        if seen is not None:
            seen += events


def until_tick(run: RunHandle, tick: int) -> None:
    """Pump until a tick is recorded, or the run is over."""
    until(run, lambda: run.telemetry.count > tick or run.ended is not None)
