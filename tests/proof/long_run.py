"""`python -m tests.proof.long_run [--hours N] [--minutes N]`: an app that runs a program for a day.

The program drives for ever, at the highest speed, in an app with a chart, in a real terminal. The memory and the
descriptors of both processes and the size of the recording over time are printed as a table.

The recording grows with each tick by design. Of it the app holds the newest part only: its memory must be flat, as all
the rest.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.proof.kind import FaultError, home
from tests.proof.monkey import ROOT, leave
from tests.proof.terminals import Terminal
from tuisim.engine.runs.catalogue import RunInfo
from tuisim.engine.runs.records import (
    HEADER_BYTES,
    TELEMETRY_FILE,
    TELEMETRY_MAGIC,
    read_published_length,
)
from tuisim.engine.runs.store import RunStore, count_bytes

PROGRAM = """\
import time
while True:
    for left, right in ((20, 20), (10, -10)):
        tank_drive.on(left, right)
        time.sleep(2)
        print('Colour:', colorLeft.reflected_light_intensity_pc)
"""
SAMPLES = 48
"""In the simulated time."""
TICK_HZ = 100
"""Of the profile that is used."""
MB = float(1 << 20)
SETTLED = 0.1
"""The share of the simulated time after which everything has been imported, and drawn once."""
FLAT_MB = 20.0
"""What a process may grow after that."""


@dataclass(frozen=True, slots=True)
class Sample:
    """What the processes and the recording take at a time."""

    time: float
    """Seconds since the start."""
    simulated_h: float
    app_mb: float
    """Memory of its own: without pages of files, which the system takes back when it needs them."""
    app_descriptors: float
    program_mb: float
    program_descriptors: float
    recording_mb: float


def published_ticks(folder: Path) -> int:
    """Return the number of ticks that a run has recorded."""
    with (folder / TELEMETRY_FILE).open("rb") as handle:
        return read_published_length(handle.read(HEADER_BYTES), TELEMETRY_MAGIC, str(folder))


def _memory_mb(process: int) -> float:
    """Return the resident memory of a process without pages of files."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return next(float(line.split()[1]) / 1024 for line in lines if line.startswith("RssAnon"))


def _descriptors(process: int) -> int:
    return len(os.listdir(f"/proc/{process}/fd"))


def _children(process: int) -> list[int]:
    lists = Path(f"/proc/{process}/task").glob("*/children")
    return [int(child) for listed in lists for child in listed.read_text().split()]


def _sample(start_s: float, app: int, program: int, run: RunInfo) -> Sample:
    folder = RunStore().folder(run.id)
    ticks = published_ticks(folder)
    return Sample(
        time.monotonic() - start_s,
        ticks / TICK_HZ / 3600,
        _memory_mb(app),
        _descriptors(app),
        _memory_mb(program),
        _descriptors(program),
        count_bytes(folder) / MB,
    )


def samples(hours: float, minutes: float) -> Iterator[Sample]:
    """Run the program in an app until the simulated hours or the minutes are over; yield samples."""
    with TemporaryDirectory(prefix="tuisim-proof-long-") as place, home(Path(place, "home")):
        Path(place, "drives.py").write_text(PROGRAM)
        inherited = {
            name: value for name, value in os.environ.items() if name not in ("COLUMNS", "LINES")
        }
        environment = {
            **inherited,
            "TERM": "xterm-256color",
            "LANG": "C.UTF-8",
            "PYTHONPATH": str(ROOT),
        }
        words = ["drives.py", "-b", "Grey_bands", "-R", "-c", "-D", "--speed", "max"]
        terminal = Terminal(words, Path(place), environment)
        try:
            terminal.until(lambda: b"running" in terminal.written or terminal.is_over, "the run")
            start_s = time.monotonic()
            run = RunStore().find("last")
            program = _children(terminal.job)[0]
            found = _sample(start_s, terminal.job, program, run)
            while found.simulated_h < hours and found.time < minutes * 60:
                yield found
                next_h = found.simulated_h + hours / SAMPLES
                while found.simulated_h < next_h and found.time < minutes * 60:
                    terminal.take(0.02)
                    terminal.written = b""
                    if terminal.is_over or (end := RunStore().load_run(run.id).end):
                        raise FaultError(f"it ended: {terminal.code} {end} after {found}")
                    found = _sample(start_s, terminal.job, program, run)
            yield found
            leave(terminal)
        finally:
            terminal.close()


def grown(found: Sequence[Sample]) -> list[str]:
    """Return what is not flat once everything has settled."""
    first = next(one for one in found if one.simulated_h >= SETTLED * found[-1].simulated_h)
    wrong = []
    for name in ("app_mb", "program_mb"):
        # While what it holds moves to a larger buffer, the app has both.
        if (more := min(getattr(one, name) for one in found[-5:]) - getattr(first, name)) > FLAT_MB:
            wrong.append(f"{name} has grown by {more:.1f} MB")
    for name in ("app_descriptors", "program_descriptors"):
        if (more := getattr(found[-1], name) - getattr(first, name)) > 2:
            wrong.append(f"{name} has grown by {more:g}")
    return wrong


def main(words: Sequence[str]) -> int:
    """Print and draw the samples; return 1 if something grows that must be flat."""
    parser = argparse.ArgumentParser(prog="python -m tests.proof.long_run", description=__doc__)
    parser.add_argument(
        "--hours", type=float, default=24.0, metavar="N", help="simulated (default: 24)"
    )
    parser.add_argument(
        "--minutes", type=float, default=10.0, metavar="N", help="at most (default: 10)"
    )
    arguments = parser.parse_args(words)
    names = [field.name for field in fields(Sample)]
    print(*(f"{name:>19}" for name in names))
    found = []
    for one in samples(arguments.hours, arguments.minutes):
        found.append(one)
        print(*(f"{value:19.2f}" for value in asdict(one).values()), flush=True)
    wrong = grown(found)
    last = found[-1]
    print(
        "; ".join(wrong)
        or f"flat after {SETTLED:.0%} of {last.simulated_h:.1f} simulated hours, {last.time:.1f} s"
    )
    return int(bool(wrong))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
