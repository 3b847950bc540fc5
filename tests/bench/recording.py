"""What a recording costs: time while it is written, time to open it and to do it again."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from tests.bench.figures import Figure
from tests.bench.processes import app_environment, children_cpu_s
from tests.bench.references import Ratio, tick_cpu_s
from tests.bench.running import EMPTY, LINE, LOG, MOVES
from tests.bench.sampling import Effort, in_turns, measured
from tests.bench.speed import LOADS
from tuisim.config.build import build_run_spec
from tuisim.config.options import Settings
from tuisim.core.spec import RunSpec
from tuisim.runs.handle import RunOptions, start_run
from tuisim.runs.rerun import rerun, same
from tuisim.runs.run_folder import StoredRun, field_files
from tuisim.runs.store import RunStore
from tuisim.runs.views import OutputView, TelemetryView
from tuisim.source import Program

RUN_S = 600.0
RECORDED, DROPPED = "tuisim.runtime", "tests.bench.dropping"
"""Modules that run a program with and without a recording."""
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
"""Name, program and mat of runs that are opened, and done again."""
NOISES = {"": (0, 0), ", light noise 20": (20, 0), ", motor noise 50": (0, 50), ", both": (20, 50)}


def recording(effort: Effort) -> Iterator[Figure]:
    """Yield all figures of recordings."""
    yield from _cost(effort)
    yield from _reading(effort)


def _cost(effort: Effort) -> Iterator[Figure]:
    for name, load in LOADS.items():
        spec = build_run_spec(Settings({"background": load.mat}))
        run_s = load.simulated_s * effort.simulated
        kept, dropped = (
            partial(_simulating_cpu_s, load.text, spec, run_s, module)
            for module in (RECORDED, DROPPED)
        )
        samples = in_turns(kept, dropped, effort)
        yield Figure(f"recorded, {name}", samples.ratio, "x dropped", most=1.3)


def _simulating_cpu_s(text: str, spec: RunSpec, run_s: float, module: str) -> float:
    """Return the CPU seconds of a run beyond those of an empty program."""
    started_s = _child_cpu_s(EMPTY, spec, run_s, module)
    return measured(
        _child_cpu_s(text, spec, run_s, module) - started_s, "CPU time beyond the start of a run"
    )


def _child_cpu_s(text: str, spec: RunSpec, run_s: float, module: str) -> float:
    program, options = Program("bench.py", text, "preloaded"), RunOptions(time_limit_s=run_s)
    with TemporaryDirectory() as home:
        new = RunStore(Path(home)).new_run(
            program, spec, field_files(spec).to_plain(), options.to_plain()
        )
        pipes = [os.pipe() for _ in range(3)]
        # The ends as the child has them: commands and lifeline to read, events to write.
        ends = (pipes[0][0], pipes[1][1], pipes[2][0], new.lock_fd)
        before = children_cpu_s()
        child = subprocess.Popen(
            [sys.executable, "-s", "-m", module, str(new.folder), *map(str, ends)],
            pass_fds=ends,
            env=app_environment(PYTHONHASHSEED="0"),
        )
        child.wait()
        for end in (new.lock_fd, *(end for pipe in pipes for end in pipe)):
            os.close(end)
    assert child.returncode == 0, child.returncode
    return children_cpu_s() - before


def _reading(effort: Effort) -> Iterator[Figure]:
    for name, (text, mat) in DRIVES.items():
        for words, (light, motor) in NOISES.items():
            values = {"background": mat, "noise.light": light, "noise.motor": motor}
            run = _recorded(text, build_run_spec(Settings(values)))
            samples = in_turns(partial(_opened_cpu_s, run), tick_cpu_s, effort)
            ratio = Ratio(samples.ratio / (100 * RUN_S), "x frozen ticks")
            yield Figure(
                f"opening 10 minutes, {name}{words}",
                1e3 * samples.value,
                "ms CPU",
                most=2,
                ratio=ratio,
            )
            if not light and not motor:
                again_s = median(_again_s(run) for _ in range(effort.repeats))
                yield Figure(f"re-run, {name}", RUN_S / again_s, "sim s / s")


def _recorded(text: str, spec: RunSpec) -> StoredRun:
    """Return a run of RUN_S."""
    store = RunStore()
    handle = start_run(
        Program("bench.py", text, "preloaded"), spec, RunOptions(time_limit_s=RUN_S), store
    )
    handle.wait()
    return store.load_run(handle.run_id)


def _opened_cpu_s(run: StoredRun) -> float:
    start = time.process_time()
    assert len(TelemetryView(run.folder).array()) == run.telemetry.count
    next(OutputView(run.folder).rows(), None)
    return time.process_time() - start


def _again_s(run: StoredRun) -> float:
    """Return how long a re-run takes, start and comparison included."""
    with TemporaryDirectory() as home:
        start = time.perf_counter()
        store = RunStore(Path(home))
        handle = rerun(run, store)
        handle.wait()
        assert same(run, store.load_run(handle.run_id)).same
        return time.perf_counter() - start
