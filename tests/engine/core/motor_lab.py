"""Runs programs under the profile `nbev3devsim` and tells what its motors do in each tick.

`python -m tests.engine.core.motor_lab FOLDER` reads programs from `jobs.json` and writes what becomes of them. Each
runs in a fork, with the runtime, the shim and the genuine library in it as in a real run; that costs a fraction of a
new process.
"""

from __future__ import annotations

from tuisim.engine.runtime import wallclock  # isort: skip - must come first: it keeps the real clock

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from tests.engine.core.memory_sink import MemorySink
from tuisim.base.source import Program
from tuisim.engine.core import motion
from tuisim.engine.core.browser_motor import BrowserMotor
from tuisim.engine.core.drive import EvenGlide
from tuisim.engine.core.profile import NBEV3DEVSIM, NS_PER_S
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import RobotSpec, RunSpec, WorldSpec
from tuisim.engine.core.tick_record import TICK_RECORD
from tuisim.engine.core.tree import dump_run, load_run
from tuisim.engine.mat_cache import FieldFiles
from tuisim.engine.runs.readings import ReadingsWriter
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.run_options import RunOptions
from tuisim.engine.runtime.channel import Channel
from tuisim.engine.runtime.control import RunControl
from tuisim.engine.runtime.output import OutputRecorder
from tuisim.engine.runtime.patches.clock import loop_hook, patch_time
from tuisim.engine.runtime.patches.replacement import replace as put_in_place
from tuisim.engine.runtime.patches.threads import patch_threads
from tuisim.engine.runtime.program import ProgramOutcome, ProgramRunner
from tuisim.engine.runtime.run_config import RunConfig
from tuisim.engine.runtime.scheduler import Scheduler
from tuisim.engine.runtime.session import RunLimits, Session
from tuisim.engine.shim.files.open_files import OpenFiles
from tuisim.engine.shim.install import install

Row = list[float]
Line = tuple[int, float, str]


@dataclass(frozen=True)
class Job:
    """A program and the world it runs in."""

    text: str
    world: WorldSpec
    robot: RobotSpec
    prelude: str = "preloaded"


@dataclass(frozen=True)
class Course:
    """What became of a program."""

    end: str
    end_tick: int
    end_ms: float
    rows: list[Row]
    """A row a tick: x, y, heading, then position, speed register and whether it runs, of both motors."""
    lines: list[Line]
    """Tick, ms and text of what was printed."""


class Watched(BrowserMotor):
    """A motor that notes its speed register, however its ticks are done, and whether it ran before the first."""

    __slots__ = ("ran_first", "registers")

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self.registers: list[float] = [0.0]
        self.ran_first: bool | None = None

    def begin(self) -> None:
        """Note whether it runs, if this is before its first tick."""
        if self.ran_first is None:
            self.ran_first = bool(self.mode)

    def step(self, tick: int, noise_dps: float) -> float:
        self.begin()
        rolled = super().step(tick, noise_dps)
        self.registers.append(self.speed_dps)
        return rolled

    def glide_evenly(self, ticks: int) -> EvenGlide:
        self.begin()
        self.registers += [self.speed_dps] * ticks
        return super().glide_evenly(ticks)

    def _advance_registers(self, ticks: int) -> list[float]:
        self.begin()
        ahead = super()._advance_registers(ticks)
        self.registers += ahead
        return ahead


def rows_of(sim: Simulation) -> list[Row]:
    """Return what a run did."""
    left = sim.left
    right = sim.right
    sink = sim._sink
    assert isinstance(left, Watched) and isinstance(right, Watched) and isinstance(sink, MemorySink)
    left.begin()
    right.begin()
    rows: list[Row] = []
    records = TICK_RECORD.iter_unpack(sink.records())
    for record, left_dps, right_dps in zip(records, left.registers, right.registers, strict=True):
        tick, _, *pose, left_deg, right_deg, _, _, _, flags, _ = record
        # The first record is written before the program begins.
        runs = (
            (flags & 1, flags >> 1 & 1)
            if tick
            else (int(left.ran_first or 0), int(right.ran_first or 0))
        )
        rows.append([*pose, left_deg, left_dps, runs[0], right_deg, right_dps, runs[1]])
    return rows


class Lines:
    """Takes the place of the output file."""

    def __init__(self) -> None:
        self.rows: list[Line] = []

    def write(self, text: bytes, tick: int, time_ns: int, line: int, stream: int) -> None:
        self.rows.append((tick, time_ns / 1e6, text.decode()))

    def close(self) -> None:
        """Nothing is open."""


def carry_out(
    spec: RunSpec, text: str, prelude: str, files: FieldFiles, folder: Path
) -> dict[str, Any]:
    """Run a program to its end, in this process; what it reads is recorded in a folder."""
    program = Program("program.py", text, prelude)
    options = RunOptions(speed=0.0, time_limit_s=60.0, stall_limit_s=0.0)
    config = RunConfig(Path(), program, spec, files, options)
    sim, lines = Simulation(spec, MemorySink()), Lines()
    output = OutputRecorder()
    output.writer = lines  # type: ignore[assignment]
    channel = Channel(*os.pipe())
    steering = RunControl(channel, Path(), False, 0.0, False, ())
    session = Session(sim, files.open_field(), output)
    session.readings = ReadingsWriter(folder)
    session.connect(channel, steering, RunLimits(60 * NS_PER_S), "program.py")
    output.place = lambda: (sim.tick, session.now, 0)
    turn = loop_hook(session, 500, 5_000_000)
    scheduler = Scheduler(session, lambda parked: None)
    patch_time(session)
    # The program's own must be imported again, with locks of the scheduler.
    del sys.modules["threading"]
    patch_threads(scheduler, lambda *ended: runner.hooks.show_end_of_bare_thread(*ended))
    install(session, OpenFiles(), {}, put_in_place, lambda file: False)

    def leave(outcome: ProgramOutcome) -> NoReturn:
        raise SystemExit(outcome.end)

    runner = ProgramRunner(session, output, scheduler, turn, leave)
    runner.prepare(prelude)
    runner.connect(config)
    outcome = runner.run()
    return course_of(outcome, session, lines)


def course_of(outcome: ProgramOutcome, session: Session, lines: Lines) -> dict[str, Any]:
    """Return what became of a program, as data for JSON."""
    sim = session.sim
    return {
        "end": " ".join(filter(None, (outcome.end, outcome.error))),
        "end_tick": sim.tick,
        "end_ms": session.now / 1e6,
        "rows": rows_of(sim),
        "lines": lines.rows,
    }


def courses(jobs: Iterable[Job], folder: Path) -> list[Course]:
    """Run programs; returns what became of each."""
    plain = [
        {
            "text": job.text,
            "prelude": job.prelude,
            "spec": dump_run(RunSpec(job.robot, job.world, NBEV3DEVSIM)),
        }
        for job in jobs
    ]
    (folder / "jobs.json").write_text(json.dumps(plain))
    subprocess.run(
        [sys.executable, "-m", "tests.engine.core.motor_lab", str(folder)], check=True, timeout=120
    )
    found = [json.loads((folder / f"{at}.json").read_text()) for at in range(len(plain))]
    return [Course(**{**one, "lines": [tuple(line) for line in one["lines"]]}) for one in found]


def main(folder: Path) -> None:
    """Run the programs of a folder, each in a fork."""
    vars(motion)["BrowserMotor"] = Watched
    for at, job in enumerate(json.loads((folder / "jobs.json").read_text())):
        spec = load_run(job["spec"])
        files = field_files(spec)
        child = os.fork()
        if not child:
            signal.alarm(60)
            (recording := folder / f"{at}").mkdir()
            done = carry_out(spec, job["text"], job["prelude"], files, recording)
            (folder / f"{at}.json").write_text(json.dumps(done))
            wallclock.exit_process(0)
        os.waitpid(child, 0)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
