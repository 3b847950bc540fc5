"""The world beside the log: the robot at the time of the sample, the line that printed it, the pixels seen.

Pose and sensor view come from the recording, or from the log itself.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rich.style import Style
from textual.app import ComposeResult
from textual.containers import Vertical

from tuisim.app import background, design
from tuisim.app.panels import PANELS
from tuisim.app.panels.arrays import Arrays
from tuisim.app.panels.world import WorldView
from tuisim.app.setup.mat import Mat, make_blank_mat, prepare_mat, prepare_stored_mat
from tuisim.app.snapshot import RunPhase, Snapshot
from tuisim.base import palette
from tuisim.base.errors import TuisimError, printable
from tuisim.base.source import source_lines
from tuisim.engine.core.drift import find_drift
from tuisim.engine.core.geometry import Pose
from tuisim.engine.core.spec import RunSpec
from tuisim.engine.core.state import Instant
from tuisim.engine.runs.recorded_run import Recording
from tuisim.terminal.cell_view import LinesView
from tuisim.terminal.text_runs import Run, find_first_row

if TYPE_CHECKING:
    from tuisim.analysis.model import AnalysisModel
    from tuisim.analysis.source import OpenedLog
    from tuisim.engine.core.field import Field
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.logs.log import Log

_POSE = ("x_mm", "y_mm", "heading_deg")
_PLAIN, _DIM = Style(color=palette.INK), Style(color=design.SUBTITLE)
_HERE = Style(color=palette.WHITE, bgcolor=palette.HERE, bold=True)
_BESIDE_COLS = 60
"""In a narrower terminal the world is hidden, and the chart has the whole width, until the user shows the world."""
NO_POSES = "This log has no robot positions"


class RunWorld:
    """Gives snapshots of one run's world at any time of the run.

    Args:
        spec: The specification of the run.
        mat: The mat of the run.
        run: The stored run; None if it is not in the store.
        log: The log that has the poses if the run is not in the store.
    """

    def __init__(self, spec: RunSpec, mat: Mat, run: StoredRun | None, log: Log) -> None:
        self.spec = spec
        self.mat = mat
        self._recording = Recording(run) if run is not None else None
        self._log = log
        self.program = run.program if run is not None else None
        """The program of the run; None if it is unknown."""

    def find_snapshot(self, time_s: float, row: int) -> Snapshot:
        """Return the state of robot and run at a time, taken from the recording of the run.

        If there is no recording, the state is taken from the row of the log.

        Args:
            time_s: Simulated time.
            row: The row of the log at that time.
        """
        snapshot = self._find_recorded(time_s) if self._recording is not None else None
        return snapshot or self._build_logged(time_s, row)

    def _find_recorded(self, time_s: float) -> Snapshot | None:
        recording = self._recording
        if recording is None or recording.newest < 0:
            return None
        tick = min(max(round(time_s * self.spec.profile.tick_hz), 0), recording.newest)
        record = recording.telemetry.record(tick)
        instant = record.build_instant(self.spec, recording.find_noise(record))
        field = recording.find_field(tick, self.mat.field) if self.mat.field else None
        pen = record.is_pen_down
        return self._build_snapshot(instant, field, record.line, pen)

    def _build_logged(self, time_s: float, row: int) -> Snapshot:
        table = self._log.table
        x_mm, y_mm, heading_deg = (table.column(name)[row].as_py() for name in _POSE)
        pose = Pose(float(x_mm or 0.0), float(y_mm or 0.0), float(heading_deg or 0.0))
        tick = round(time_s * self.spec.profile.tick_hz)
        spec = self.spec
        world = spec.world
        instant = Instant(
            tick,
            pose,
            noise=world.noise,
            drift=find_drift(spec),
            profile=spec.profile,
            seed=spec.seed,
        )
        line = table.column("line")[row].as_py() if "line" in table.column_names else 0
        return self._build_snapshot(instant, self.mat.field, int(line or 0), False)

    def _build_snapshot(
        self, instant: Instant, field: Field | None, line: int, pen_down: bool
    ) -> Snapshot:
        return Snapshot(
            RunPhase.ENDED,
            None,
            self.spec,
            field,
            instant,
            line,
            speed=1.0,
            pen_down=pen_down,
            program=self.program,
        )


def has_poses(opened: OpenedLog) -> bool:
    """Return whether a log has poses of a robot."""
    if opened.runs:
        return True
    named = set(_POSE) <= set(opened.log.table.column_names)
    return named and opened.log.find_spec() is not None


def load_world(opened: OpenedLog, run: int) -> RunWorld | None:
    """Return the world of one run of a log; None if the log has no poses of that run.

    If the mat of the run is missing, the world has a blank mat. This blocks, for long when a mat is prepared for the
    first time.

    Args:
        opened: The log.
        run: Index of the run in the log.
    """
    if run < len(opened.runs):
        stored = opened.runs[run]
        try:
            mat = prepare_stored_mat(stored)
        except TuisimError:
            mat = make_blank_mat(stored.spec)
        return RunWorld(stored.spec, mat, stored, opened.log)
    spec = opened.log.find_spec(run)
    if spec is None or not set(_POSE) <= set(opened.log.table.column_names):
        return None
    try:
        mat = prepare_mat(spec)
    except TuisimError:
        mat = make_blank_mat(spec)
    return RunWorld(spec, mat, None, opened.log)


class WorldPane(Vertical):
    """The column beside the log.

    It shows the world, the lines of the program around the one that printed the sample, and what the sensors see.
    """

    DEFAULT_CSS = f"""
    WorldPane {{ width: 34%; min-width: 30; }}
    WorldPane .frame {{ border: round {palette.LINE}; border-title-color: {palette.SOFT}; height: 1fr; }}
    WorldPane .frame > * {{ height: 1fr; width: 1fr; }}
    WorldPane > Arrays {{ height: 13; border: round {palette.LINE}; border-title-color: {palette.SOFT}; }}
    """

    def __init__(self) -> None:
        super().__init__()
        self.is_on = True
        """Whether the user wants to see the world; even then it is hidden if the log has no positions of the robot."""
        # The robot is shown where it was; the mouse cannot move it.
        self._world = WorldView()
        self._world.disabled = True
        self._source = LinesView()
        self._arrays = Arrays()
        self._arrays.border_title = PANELS["arrays"].title
        self._worlds: dict[int, RunWorld | None] = {}
        self._requested: set[int] = set()
        self._model: AnalysisModel | None = None
        self._shown: RunWorld | None = None

    def compose(self) -> ComposeResult:
        for title, view in (("World", self._world), ("Source", self._source)):
            frame = Vertical(view, classes="frame", id=title.lower())
            frame.border_title = title
            yield frame
        yield self._arrays

    def on_resize(self) -> None:
        self._arrays.display = self.size.height >= 34
        self.call_after_refresh(self._show_again)

    def _show_again(self) -> None:
        if self._model is not None:
            self.show(self._model)

    def set_model(self, model: AnalysisModel) -> None:
        """Switch to another log, and hide the pane if that log has no poses of a robot."""
        self._model = model
        self._shown = None
        self._worlds.clear()
        self._requested.clear()
        self.display = (
            self.is_on
            and bool(model.log.rows)
            and has_poses(model.opened)
            and self.screen.size.width >= _BESIDE_COLS
        )
        self.show(model)

    def show(self, model: AnalysisModel) -> None:
        """Show the world at the row of the cursor; the mat of a run is prepared in the background first."""
        self._model = model
        if not model.log.rows or not self.display:
            return
        run = model.find_run(model.row)
        if run not in self._requested:
            self._requested.add(run)
            work = partial(load_world, model.opened, run)
            background.run(self, work, partial(self._show_prepared, model, run), group="worlds")
        world = self._worlds.get(run)
        if world is None:
            note = NO_POSES if run in self._worlds else "Preparing the mat …"
            self._source.set_lines([[(note, _DIM)]])
            return
        snapshot = world.find_snapshot(model.find_time_s(model.row), model.row)
        if world is not self._shown:
            self._shown = world
            self._world.set_mat(world.mat.pixels)
        self._world.show(snapshot)
        if self._arrays.display:
            self._arrays.show(snapshot)
        self._source.set_lines(self._list_lines(world, model.find_printed_line() or snapshot.line))

    def _show_prepared(self, model: AnalysisModel, run: int, world: RunWorld | None) -> None:
        if model is self._model:
            self._worlds[run] = world
            self.show(model)

    def _list_lines(self, world: RunWorld, line: int) -> list[list[Run]]:
        """Return the lines of the program around `line`, from 1; only `line N` if the program's text is unknown."""
        texts = source_lines(world.program.text if world.program else "")
        height, width = self._source.size.height, self._source.size.width
        if not texts or not height:
            return [[(f"line {line}", _PLAIN)]]
        first = find_first_row(line - 1, len(texts), height)
        lines: list[list[Run]] = []
        for number, text in enumerate(texts[first : first + height], first + 1):
            here = number == line
            lines.append(
                [
                    (f"{number:>3} ", _HERE if here else _DIM),
                    (printable(text).ljust(width), _HERE if here else _PLAIN),
                ]
            )
        return lines
