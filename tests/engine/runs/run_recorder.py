"""A recorder of runs by hand: what the child is to a run folder, with its writers and the real simulation."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, replace
from typing import Any
from weakref import finalize

from tests.engine.core.motors import commanded
from tuisim.base.source import Program
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import NoiseSpec, RunSpec
from tuisim.engine.protocol import End, Ended
from tuisim.engine.runs.readings import READING_CODES, ReadingsWriter
from tuisim.engine.runs.records import OutputWriter, Stream, TelemetryWriter
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.side_files import ACTIONS_FILE
from tuisim.engine.runs.store import NewRun, RunStore

PROGRAM = Program("log.py", "print('Colour: 100.0')\n", "preloaded", "/somewhere/log.py")


@dataclass
class Recorder:
    """What the child is to a run folder."""

    store: RunStore
    run: NewRun
    spec: RunSpec
    telemetry: TelemetryWriter
    output: OutputWriter
    simulation: Simulation

    def __post_init__(self) -> None:
        # Also of a run that never ends: thousands of tests share one process.
        self._unlock = finalize(self, os.close, self.run.lock_fd)
        self.readings = ReadingsWriter(self.run.folder)

    def drive(self, left_dps: float, right_dps: float, ticks: int, line: int = 0) -> None:
        """Let the wheels turn for some ticks."""
        self.simulation.line = line
        commanded(self.simulation.left).run(left_dps)
        commanded(self.simulation.right).run(right_dps)
        self.simulation.advance(ticks)

    def print(self, text: str, line: int = 0, stream: Stream = Stream.STDOUT) -> None:
        """Write a row of output at the present tick."""
        tick = self.simulation.tick
        self.output.write(text.encode(), tick, self.simulation.compute_due_ns(tick), line, stream)

    def read(self, port: str, mode: str, line: int = 0) -> None:
        """Record that the program reads something at the present tick."""
        time_ns = self.simulation.compute_due_ns(self.simulation.tick)
        self.readings.add(READING_CODES[port, mode], time_ns, line)

    def act(self, kind: str, **fields: Any) -> None:
        """Do and record a user action, which counts from the present tick on."""
        if kind == "set_noise":
            self.simulation.noise = NoiseSpec(**fields)
        self.simulation.actions += 1
        self.simulation.update_record()
        with open(self.run.folder / ACTIONS_FILE, "a", encoding="utf-8") as handle:
            handle.write(json.dumps({"tick": self.simulation.tick, "kind": kind, **fields}) + "\n")

    def end(self, end: End = End.FINISHED, summary: str = "") -> StoredRun:
        """Close the files, record the end and return the run as stored."""
        self.telemetry.close()
        self.output.close()
        self.readings.close()
        tick = self.simulation.tick
        self.store.finish(
            self.run, Ended(end, tick, self.simulation.compute_due_ns(tick), summary=summary)
        )
        self._unlock()
        return self.store.load_run(self.run.id)


def begun(store: RunStore, spec: RunSpec, text: str = PROGRAM.text, **options: Any) -> Recorder:
    """Begin a run in a store."""
    run = store.create_run(replace(PROGRAM, text=text), spec, **options)
    telemetry = TelemetryWriter(run.folder)
    return Recorder(
        store, run, spec, telemetry, OutputWriter(run.folder), Simulation(spec, telemetry)
    )
