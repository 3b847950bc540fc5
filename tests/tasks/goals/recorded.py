"""Runs recorded by hand, of a robot whose motors reach their speed at once, and goals that judge them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from tests.engine.runs.run_recorder import Recorder
from tuisim.base.source import Program
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.simulation import Simulation
from tuisim.engine.core.spec import PenSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.protocol import End
from tuisim.engine.runs.records import OutputWriter, Stream, TelemetryWriter
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import NewRun, RunStore
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.spec import Goal

Step = Callable[[Recorder], object]
"""What happens in a run."""

MM_PER_S = 3.141592653589793 * 56
"""How fast the robot drives if both wheels turn by 360 degrees per second."""


def drive(left_dps: float, right_dps: float, seconds: float, line: int = 0) -> Step:
    return lambda recorder: recorder.drive(left_dps, right_dps, round(seconds * 100), line)


def ahead(mm: float, line: int = 0) -> Step:
    """Drive straight on."""
    return drive(360, 360, mm / MM_PER_S, line)


def turn(degrees: float, line: int = 0) -> Step:
    """Turn on the spot, counter-clockwise, with 90 degrees per second."""
    dps = 90 * 180 / 56
    return (
        drive(-dps, dps, degrees / 90, line)
        if degrees > 0
        else drive(dps, -dps, -degrees / 90, line)
    )


def wait(seconds: float, line: int = 0) -> Step:
    return drive(0, 0, seconds, line)


def says(text: str, line: int = 0) -> Step:
    return lambda recorder: recorder.print(text, line)


def reads(line: int = 0, times: int = 1) -> Step:
    """Read the left colour sensor, each time in 10 ms."""

    def read(recorder: Recorder) -> None:
        for _ in range(times):
            recorder.drive(0, 0, 1, line)
            recorder.read("in2", "COL-REFLECT", line)

    return read


def is_told(text: str, line: int = 0) -> Step:
    """Read a line with `input()`."""
    return lambda recorder: recorder.print(text, line, Stream.INPUT)


class Run:
    """A run that is being recorded."""

    def __init__(
        self, store: RunStore, world: WorldSpec, text: str, prelude: str = "preloaded"
    ) -> None:
        spec = RunSpec(RobotSpec(weight=0.0, pen=PenSpec(down=True)), world, ROBOLAB)
        self.new: NewRun = store.create_run(Program("task.py", text, prelude), spec)
        telemetry = TelemetryWriter(self.new.folder)
        simulation = Simulation(spec, telemetry)
        self.recorder = Recorder(
            store, self.new, spec, telemetry, OutputWriter(self.new.folder), simulation
        )

    def do(self, steps: Sequence[Step]) -> None:
        for step in steps:
            step(self.recorder)

    def end(self, end: End = End.FINISHED, summary: str = "") -> StoredRun:
        return self.recorder.end(end, summary)


def goals_of(folder: Path, text: str) -> tuple[Goal, ...]:
    """The goals in the text of a file."""
    path = folder / "task_goals.toml"
    path.write_text(text, encoding="utf-8")
    return GoalsFile.load(path).goals


def world(
    x_mm: float = 500.0, y_mm: float = 500.0, heading_deg: float = 0.0, **more: object
) -> WorldSpec:
    return WorldSpec(start=Pose(x_mm, y_mm, heading_deg), **more)  # type: ignore[arg-type]
