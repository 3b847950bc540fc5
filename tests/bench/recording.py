"""What a recording costs: time while it is written, bytes when it is packed, time to open it and to do it again."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from tests.bench.figures import Effort, Figure
from tests.bench.processes import children_cpu_s
from tests.bench.references import loop_speed, loop_time
from tests.bench.running import EMPTY, LINE, LOG, MOVES, unpacked_store
from tests.bench.speed import LOADS
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.core.spec import RunSpec
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.rerun import rerun, same
from tuisim.runs.run_folder import StoredRun, field_files
from tuisim.runs.store import RunStore, compact_run
from tuisim.runs.views import OutputView, TelemetryView
from tuisim.source import Program

RUN_S = 600.0
COST_RUN_S = 1800.0
"""Long enough for the start of a process to be little of it."""
STRAIGHT = "import time\ntank_drive.on(SpeedPercent(20.3), SpeedPercent(20.3))\nwhile True:\n    time.sleep(1)\n"
CURVES = """\
import random, time
while True:
    tank_drive.on(SpeedPercent(random.uniform(-50, 50)), SpeedPercent(random.uniform(-50, 50)))
    time.sleep(random.random())
"""
PRINTING_LINE = LINE + "    print('Left:', left)\n    print('Right:', right)\n"
DRIVES = {
    "straight": (STRAIGHT, "Grey_bands"),
    "log": (LOG, "Grey_bands"),
    "curves": (CURVES, "Grey_bands"),
    "line follower": (LINE, "Two_shapes"),
    "line follower, printing": (PRINTING_LINE, "Two_shapes"),
    "moves": (MOVES, "Grey_bands"),
}
"""Name, program and mat of runs that are packed."""
NOISES = {"": (0, 0), ", light noise 20": (20, 0), ", motor noise 50": (0, 50), ", both": (20, 50)}


def recording(effort: Effort) -> Iterator[Figure]:
    """Yield all figures of recordings."""
    yield from _cost(effort)
    yield from _packing(effort)


def _cost(effort: Effort) -> Iterator[Figure]:
    kept_start, dropped_start = _both_cpu_s(EMPTY, "Grey_bands", effort.repeats)
    for name, load in LOADS.items():
        kept, dropped = _both_cpu_s(load.text, load.mat, effort.repeats)
        kept, dropped = kept - kept_start, dropped - dropped_start
        yield Figure(
            f"speed, {name}, recorded", COST_RUN_S / kept, "sim s / CPU s", ratio=loop_speed(COST_RUN_S / kept)
        )
        yield Figure(
            f"speed, {name}, dropped", COST_RUN_S / dropped, "sim s / CPU s", ratio=loop_speed(COST_RUN_S / dropped)
        )
        yield Figure(f"recording costs, {name}", 100 * (1 - dropped / kept), "%", most=15)


def _both_cpu_s(text: str, mat: str, repeats: int) -> tuple[float, float]:
    """Return the CPU seconds of runs that are recorded, and of others that are not; turn by turn."""
    spec = build_run_spec(Settings(background=mat))
    pairs = [
        (_child_cpu_s(text, spec, "tuisim.runtime"), _child_cpu_s(text, spec, "tests.bench.dropping"))
        for _ in range(repeats)
    ]
    return median(kept for kept, _ in pairs), median(dropped for _, dropped in pairs)


def _child_cpu_s(text: str, spec: RunSpec, module: str) -> float:
    program, options = Program("bench.py", text, "preloaded"), RunOptions(time_limit_s=COST_RUN_S)
    with TemporaryDirectory() as home:
        new = RunStore(Path(home)).new_run(program, spec, field_files(spec).to_plain(), options.to_plain())
        pipes = [os.pipe() for _ in range(3)]
        # The ends as the child has them: commands and lifeline to read, events to write.
        ends = (pipes[0][0], pipes[1][1], pipes[2][0], new.lock_fd)
        before = children_cpu_s()
        child = subprocess.Popen(
            [sys.executable, "-s", "-m", module, str(new.folder), *map(str, ends)],
            pass_fds=ends,
            env={**os.environ, "PYTHONHASHSEED": "0"},
        )
        child.wait()
        for end in (new.lock_fd, *(end for pipe in pipes for end in pipe)):
            os.close(end)
    assert child.returncode == 0, child.returncode
    return children_cpu_s() - before


def _packing(effort: Effort) -> Iterator[Figure]:
    for name, (text, mat) in DRIVES.items():
        for words, (light, motor) in NOISES.items():
            run = _recorded(text, build_run_spec(Settings(background=mat, light_noise=light, motor_noise=motor)))
            start = time.perf_counter()
            _, size = compact_run(run)
            took_s = time.perf_counter() - start
            yield Figure(f"packed, {name}{words}", size / run.telemetry.count, "bytes a tick", most=36)
            opened_s = median(_opened_s(run) for _ in range(effort.repeats))
            yield Figure(
                f"opening 10 minutes, {name}{words}", 1e3 * opened_s, "ms", most=4, ratio=loop_time(opened_s, RUN_S)
            )
            if not light and not motor:
                yield Figure(f"packing 10 minutes, {name}", 1e3 * took_s, "ms", ratio=loop_time(took_s, RUN_S))
                again_s = median(_again_s(run) for _ in range(effort.repeats))
                yield Figure(f"re-run, {name}", RUN_S / again_s, "sim s / s")


def _recorded(text: str, spec: RunSpec) -> StoredRun:
    """Return a run that has not been packed yet."""
    store = unpacked_store()
    handle = start_run(Program("bench.py", text, "preloaded"), spec, RunOptions(time_limit_s=RUN_S), store)
    handle.wait()
    return store.load_run(handle.run_id)


def _opened_s(run: StoredRun) -> float:
    start = time.perf_counter()
    assert len(TelemetryView(run.folder).array()) == run.telemetry.count
    next(OutputView(run.folder).rows(), None)
    return time.perf_counter() - start


def _again_s(run: StoredRun) -> float:
    """Return how long a re-run takes, start and comparison included."""
    with TemporaryDirectory() as home:
        start = time.perf_counter()
        store = RunStore(Path(home))
        handle = rerun(run, store)
        handle.wait()
        assert same(run, store.load_run(handle.run_id)).same
        return time.perf_counter() - start
