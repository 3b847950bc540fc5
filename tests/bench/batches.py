"""What a batch costs a run, and how soon the robot moves after `R`."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles

from tests.bench.figures import Figure
from tests.bench.processes import command_used
from tests.bench.references import Ratio, forks, start_wall_s, starts, usual
from tests.bench.running import begin, started_by_itself
from tests.bench.sampling import Effort, measured
from tuisim.engine.runs.child import process
from tuisim.engine.runs.handle import RunOptions

PROGRAM = """\
tank_drive.on(20, 20)
import time
for _ in range(45):
    print('Colour: ' + str(colorLeft.reflected_light_intensity_pc))
    time.sleep(0.1)
tank_drive.off()
time.sleep(0.3)
"""
"""Five simulated seconds with 45 samples."""
MOVES = "tank_drive.on(50, 50)\nimport time\ntime.sleep(1)\n"
STARTS = 20
MOST = 1.4
MOST_NOISY = 1.8
"""Of the CPU time of `python -c pass`: what a run costs with all that is started for it."""
NOISE = ("--set", "noise.light=10", "--set", "noise.motor=20")


def batches(effort: Effort) -> Iterator[Figure]:
    """Yield what the runs of whole commands cost, the memory of their processes, and the time until a run has moved."""
    few, many = (300, 1000) if effort.repeats < 5 else (1000, 10_000)
    runs = (
        (few, 1, (), None),
        (few, 2, (), None),
        (many, 2, (), MOST),
        (many, 2, NOISE, MOST_NOISY),
    )
    for count, jobs, words, most in runs:
        done = _command(round(count * effort.simulated), jobs, words)
        name = f"{count:,} runs, {jobs} jobs{', noise' if words else ''}"
        yield Figure(
            name,
            done.runs_s,
            "runs / s",
            ratio=Ratio(done.runs_s * usual(start_wall_s), "x python -c pass"),
        )
        yield Figure(
            f"CPU of all processes a run, {name}",
            done.cpu_s * 1e3,
            "ms CPU",
            most=most,
            ratio=starts(done.cpu_s),
        )
        yield Figure(f"memory of the largest process, {name}", done.peak_mb, "MB", most=150)
    for name, keeps_warm in (("started by itself", False), ("forked", True)):
        found = [_until_moved_s(keeps_warm) for _ in range(STARTS)]
        for which, took_s, goal in (
            ("median", median(found), 30.0),
            ("p90", quantiles(found, n=10)[-1], None),
        ):
            most = goal if keeps_warm else None
            yield Figure(
                f"until the robot has moved, {name}, {which}",
                took_s * 1e3,
                "ms",
                most=most,
                ratio=forks(took_s),
            )


@dataclass(frozen=True, slots=True)
class Batch:
    """What a batch has cost."""

    runs_s: float
    """Runs a second."""
    cpu_s: float
    """CPU seconds of all processes a run."""
    peak_mb: float
    """Of its largest process."""


def _command(count: int, jobs: int, more: Sequence[str] = ()) -> Batch:
    """Run `tuisim batch` from start to end."""
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "program.py")
        table = Path(folder, "rows.csv")
        program.write_text(f"# %%sim_magic_preloaded -b Grey_bands\n{PROGRAM}")
        words = [
            "batch",
            program,
            "--seeds",
            f"0..{count - 1}",
            "--jobs",
            jobs,
            "--out",
            table,
            *more,
        ]
        begun = time.perf_counter()
        used = command_used(*map(str, words))
        elapsed_s = time.perf_counter() - begun
        assert len(table.read_text().splitlines()) == count + 1
    return Batch(count / elapsed_s, measured(used.cpu_s) / count, used.peak_mb)


def _until_moved_s(keeps_warm: bool) -> float:
    """Return the real seconds from the start of a run until its first tick that differs from the start."""
    process.start_warm_process()
    begun = time.perf_counter()
    with nullcontext() if keeps_warm else started_by_itself():
        handle = begin(MOVES, options=RunOptions(live=True))
    try:
        start = None
        while True:
            handle.wait_for_event(0.001)
            handle.pump()
            last = handle.telemetry.last()
            if last is not None:
                start = start or last.pose
                if last.pose != start:
                    return time.perf_counter() - begun
    finally:
        handle.close()
