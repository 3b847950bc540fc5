"""The simulator of a notebook: the world that its cells set, the program, the runs and their log.

Code that runs and draws is imported by the first cell that needs it, so that loading the extension is fast.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tuisim.errors import ConfigError
from tuisim.notebook import eds

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.charts.world_image import PenTrace
    from tuisim.config.mat_cache import FieldFiles
    from tuisim.config.options import Settings
    from tuisim.core.spec import RunSpec
    from tuisim.notebook.display import Scene, Stage
    from tuisim.notebook.magic_line import MagicWords
    from tuisim.runs.run_folder import StoredRun
    from tuisim.source import Program


@dataclass(frozen=True, slots=True)
class _Plan:
    """The validated settings of a cell."""

    persistent: Mapping[str, Any]
    settings: Settings
    spec: RunSpec
    files: FieldFiles
    program: Program | None


class Lab:
    """The simulated robot shared by the cells of a notebook.

    Its world lasts from cell to cell, its log until it is cleared.
    """

    def __init__(self) -> None:
        self.autorun = False
        """Whether executing a program cell also runs its program, as with `-R`."""
        self.responder: Callable[[str], object] | None = None
        """In collaborative mode: called with each line that a program prints for the notebook, without `PY::`.

        A return value other than None is an answer; `pyState()` in the program returns all of them.
        """
        self._persistent: Mapping[str, Any] = {}
        self._program: Program | None = None
        self._runs: list[StoredRun] = []
        self._last: StoredRun | None = None
        self._spec: RunSpec | None = None
        self._traces: tuple[PenTrace, ...] = ()
        """Pen traces on the mat, until it is cleared or replaced."""

    @property
    def pyresponder(self) -> Callable[[str], object] | None:
        """Alias of `responder`, for the old simulator's name."""
        return self.responder

    @pyresponder.setter
    def pyresponder(self, responder: Callable[[str], object] | None) -> None:
        self.responder = responder

    # The log

    @property
    def results_log(self) -> list[StoredRun]:
        """The runs since the log was cleared; `eds` converts them to frames."""
        return list(self._runs)

    def clear_datalog(self) -> None:
        """Discard the log; the runs stay in the store."""
        self._runs.clear()

    def data(self) -> pd.DataFrame:
        """Return the samples of all runs since the log was cleared."""
        return eds.get_dataframe_from_datalog(self._runs)

    def image_data(self) -> pd.DataFrame:
        """Return the pixel arrays that were logged since the log was cleared."""
        return eds.get_image_data_from_datalog(self._runs)

    # The world

    @property
    def spec(self) -> RunSpec:
        """Robot, world, profile and seed as the cells have set them."""
        from tuisim.config.build import build_run_spec
        from tuisim.config.options import settings_of

        return self._spec or build_run_spec(settings_of(self._persistent))

    @property
    def state(self) -> dict[str, Any]:
        """The robot's pose in mm and degrees, and the end of the last run."""
        record = self._last.telemetry.last() if self._last else None
        pose = record.pose if record else self.spec.world.start
        return {
            "x_mm": pose.x_mm,
            "y_mm": pose.y_mm,
            "heading_deg": pose.heading_deg,
            "left_position_deg": record.left_position_deg if record else 0.0,
            "right_position_deg": record.right_position_deg if record else 0.0,
            "time_s": self._last.time_s if self._last else 0.0,
            "background": self.spec.world.background,
            "profile": self.spec.profile.name,
            "seed": self.spec.seed,
            "state": self._last.state.value if self._last else "ready",
        }

    @property
    def program_text(self) -> str:
        """The program that `-R` runs, empty if there is none."""
        return self._program.text.removeprefix("\n") if self._program else ""

    # Cells

    def apply(self, words: MagicWords, text: str | None, prelude: str) -> None:
        """Apply a cell's magic; on an error nothing changes.

        Args:
            text: The program below it, None for none.
            prelude: none, imports or preloaded.

        Raises:
            ConfigError: a mat, robot or value is invalid, or there is no program to run.
        """
        from tuisim.notebook.display import Stage

        plan = self._checked(words, text, prelude)
        runs = plan.settings.autorun or (self.autorun and text is not None)
        if runs and plan.program is None:
            raise ConfigError("there is no program to run", "write one in a cell below %%sim_magic_preloaded", key="-R")
        if words.collaborative and not (self.responder is None or callable(self.responder)):
            raise ConfigError(f"must be a function, got {self.responder!r}", key="roboSim.responder")
        if plan.spec != self._spec or words.move_back:
            self._last = None
        before = self._spec.world if self._spec else plan.spec.world
        same_mat = (before.background, before.background_fit) == (
            plan.spec.world.background, plan.spec.world.background_fit)  # fmt: skip
        self._traces = self._traces if same_mat and not plan.settings.clear_trace else ()
        self._persistent, self._program, self._spec = plan.persistent, plan.program, plan.spec
        stage = Stage(plan.settings)
        if runs:
            self._run(plan, stage, words)
        else:
            scene, status = self._scene(plan)
            stage.show(scene, f"nothing is running · {status}" if words.stop else status)

    def _checked(self, words: MagicWords, text: str | None, prelude: str) -> _Plan:
        from tuisim.config.build import build_run_spec
        from tuisim.config.options import settings_of
        from tuisim.config.robots import choose_robot
        from tuisim.notebook.magic_line import persistent_after
        from tuisim.runs.run_folder import field_files
        from tuisim.source import Program

        if isinstance(robot := words.settings.get("robot"), str):
            for note in choose_robot(robot, "-r").notes:
                print(f"tuisim: note: {note}", file=sys.stderr)
        persistent = persistent_after(self._persistent, words.settings)
        settings = settings_of(persistent, words.settings)
        spec = build_run_spec(settings)
        program = self._program
        if text is not None:
            # The first line is that of the magic, so that line numbers are those of the cell.
            program = Program("cell", "\n" + text, settings.preload or prelude)
        return _Plan(persistent, settings, spec, field_files(spec), program)

    def _run(self, plan: _Plan, stage: Stage, words: MagicWords) -> None:
        from tuisim.charts.world_image import pen_trace
        from tuisim.notebook.cell_run import CellRun, run_cell

        assert plan.program is not None
        responder = self.responder if words.collaborative else None
        cell = CellRun(
            plan.program, plan.spec, plan.files, plan.settings.speed or 0.0, words.refresh_s, self._traces, responder,
            plan.settings.quiet,
        )  # fmt: skip

        def note(run: StoredRun) -> None:
            # The run is in the log from its start, for a responder, which may have started runs itself.
            places = [at for at, known in enumerate(self._runs) if known.id == run.id] or [len(self._runs)]
            self._last, self._runs[places[0] : places[0] + 1] = run, [run]

        try:
            run_cell(cell, stage, note)
        finally:
            # Also after a responder's error has ended the run.
            if self._last is not None:
                self._traces = (*self._traces, pen_trace(self._last.spec, self._last.telemetry.array()))

    def _scene(self, plan: _Plan) -> tuple[Scene, str]:
        """Return the scene while nothing runs, and its status line."""
        from tuisim.notebook.cell_run import end_text
        from tuisim.notebook.display import Scene, start_record
        from tuisim.runs.records import TEXT_STREAMS, line_of
        from tuisim.runs.samples import samples_of

        text, start = plan.program.text if plan.program else "", start_record(plan.spec)
        if self._last is None:
            return Scene(plan.spec, plan.files, text, start, self._traces, printed=()), (
                "ready: -R runs the program" if text else "ready")  # fmt: skip
        rows = self._last.output.all_rows()
        printed = [line_of(row) for row in rows if row.stream in TEXT_STREAMS]
        last, samples = self._last.telemetry.last() or start, list(samples_of(rows))
        return Scene(plan.spec, plan.files, text, last, self._traces, samples, printed), end_text(self._last)


roboSim = Lab()  # noqa: N816 - the course's cells call it so
"""The simulator used by the magics."""
