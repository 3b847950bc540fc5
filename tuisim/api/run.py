"""A run as scripts and notebooks see it."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from io import BytesIO
from math import nan
from typing import TYPE_CHECKING

from tuisim.base.data_class import dataclass
from tuisim.engine.core.geometry import Pose
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import load_run as load_stored_run

if TYPE_CHECKING:
    from pathlib import Path

    import pandas as pd
    from PIL.Image import Image

    from tuisim.engine.core.commands.calls import SimulationCommand


@dataclass(frozen=True, slots=True)
class Run:
    """A finished run: how it ended, what it recorded, and its picture.

    A notebook shows the run's picture, its end and its samples. Two objects for the same stored run are equal.
    """

    stored: StoredRun
    """The run in the run store, with its specification and its recordings."""
    note: str = ""
    """What the source of the program has decided about robot and profile, in words; empty for nothing."""

    def __repr__(self) -> str:
        return repr(self.stored)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Run) and self.stored.id == other.stored.id

    def __hash__(self) -> int:
        return hash(self.stored.id)

    def _repr_html_(self) -> str:
        """Return the HTML with which a notebook shows the run: picture, end, error and samples."""
        png = BytesIO()
        self.picture().save(png, "PNG")
        picture = f'<img src="data:image/png;base64,{b64encode(png.getvalue()).decode()}">'
        error = f"<pre>{escape(self.error)}</pre>" if self.error else ""
        samples = self.samples
        table = samples.to_html(max_rows=10, index=False) if len(samples) else ""
        return f"{picture}<p>{escape(repr(self))}</p>{error}{table}"

    @property
    def number(self) -> int:
        """The run's number in the run store, for `load_run`; 0 in the metrics of an experiment."""
        return self.stored.number

    @property
    def state(self) -> str:
        """How the run ended: `finished`, `raised`, `stopped`, `time_limit` …"""
        return self.stored.state.value

    @property
    def error(self) -> str:
        """The program's traceback; empty if there is none."""
        return self.stored.end.error if self.stored.end else ""

    @property
    def time_s(self) -> float:
        """Duration of the run in simulated seconds."""
        return self.stored.time_s

    @property
    def pose(self) -> Pose:
        """Where the robot is at the end: `x_mm`, `y_mm`, and `heading_deg`, counter-clockwise from +x."""
        last = self.stored.telemetry.last()
        return last.pose if last else self.stored.spec.world.start

    @property
    def output(self) -> str:
        """The program's output on stdout."""
        return "".join(
            row.text + "\n" for row in self.stored.output.rows() if row.stream == Stream.STDOUT
        )

    @property
    def samples(self) -> pd.DataFrame:
        """One row for each printed `NAME: number`.

        Columns: `index` (timedelta since the first sample), `variable`, `value`, `time` (s, simulated), `run`, `x_mm`,
        `y_mm`, `heading_deg`, `line`.
        """
        from tuisim.engine.runs.frames import build_samples_frame

        return build_samples_frame([self.stored])

    @property
    def telemetry(self) -> pd.DataFrame:
        """One row for each tick: `time` in s, lengths in mm, angles in degrees, and the state of each sensor and motor.

        Raises:
            LogError: the recording is damaged, or the mat no longer exists.
        """
        from tuisim.engine.runs.frames import build_telemetry_frame

        return build_telemetry_frame(self.stored)

    @property
    def commands(self) -> tuple[SimulationCommand, ...]:
        """The calls of the program to motors, gyro and pen, each `(time_ns, part, call, values)`, for `Lab.step`.

        Raises:
            LogError: the commands were not recorded, or their record is damaged.
        """
        return self.stored.read_commands()

    def judge(self, goals: str | Path) -> pd.DataFrame:
        """Judge the run by a goals file, which is also a world for `simulate`; return one row for each goal.

        Columns: `goal`, `state` (`met`, `missed`, `open`, `unknown`), `points`, `time` in s when it was
        decided, `reason`, `line`.

        Raises:
            ConfigError: the goals are wrong.
            LogError: the recording is damaged, or the mat no longer exists.
        """
        import pandas as pd

        from tuisim.tasks.goals.files import GoalsFile
        from tuisim.tasks.goals.judge import judge
        from tuisim.tasks.goals.judgement import GoalState

        return pd.DataFrame(
            {
                "goal": each.goal.name,
                "state": each.state.value,
                "points": each.goal.points if each.state is GoalState.MET else 0.0,
                "time": each.event.time_s if each.event else nan,
                "reason": each.reason,
                "line": each.line,
            }
            for each in judge(GoalsFile.load(goals).goals, self.stored)
        )

    def picture(self) -> Image:
        """Return the world at the end of the run as a Pillow image, with the pen's trace.

        `info["extent_mm"]` of the image has its left, right, lower and upper edge in mm.
        """
        from tuisim.pictures.scene.pictures import draw_end

        return draw_end(self.stored)


def load_run(name: int | str | Path) -> Run:
    """Return a stored run.

    Args:
        name: Its number, its id, the path of its folder, or `last`.

    Raises:
        LogError: there is no such run, or it is damaged.
    """
    return Run(load_stored_run(name))


def runs() -> pd.DataFrame:
    """Return the stored runs, one row for each, from the oldest on.

    Columns: `number`, `id`, `created` (UTC), `program`, `background`, `profile`, `seed`, `end`, `ticks`, `time_s`,
    `samples`, `summary`, `tags`. This blocks until the store has been looked through.

    Raises:
        LogError: the store cannot be read.
    """
    from dataclasses import asdict

    import pandas as pd

    from tuisim.engine.runs.catalogue import RunInfo
    from tuisim.engine.runs.store import RunStore

    return pd.DataFrame(map(asdict, RunStore().runs()), columns=[*RunInfo.__dataclass_fields__])
