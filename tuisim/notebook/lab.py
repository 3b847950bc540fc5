"""The simulator of a notebook: the world that its cells set, the program, the runs and their log.

Code that runs and draws is imported by the first cell that needs it, so that loading the extension is fast.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.protocol import Wheels
from tuisim.notebook import eds, old_formats
from tuisim.notebook.image_log import ImageLog
from tuisim.notebook.live_robot import LiveRobot

if TYPE_CHECKING:
    import pandas as pd

    from tuisim.base.source import Program
    from tuisim.engine.core.spec import RunSpec
    from tuisim.engine.mat_cache import FieldFiles
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.notebook.app_view import AppView, CellState
    from tuisim.notebook.cell_run import Listener
    from tuisim.notebook.display import Scene, Stage
    from tuisim.notebook.image_log import LoggedArray
    from tuisim.pictures.scene.pen import Piece
    from tuisim.settings.command_line import Arguments
    from tuisim.settings.options import Settings


@dataclass(frozen=True, slots=True)
class _CellPlan:
    """The settings, world and program that a cell results in, checked before anything is changed."""

    persistent: Mapping[str, Any]
    settings: Settings
    spec: RunSpec
    files: FieldFiles
    program: Program | None


class Lab:
    """The simulated robot that the cells of a notebook share.

    Its world lasts from cell to cell, its log until the log is cleared.
    """

    def __init__(self) -> None:
        self.autorun = False
        """Whether executing a program cell also runs its program, as with `-R`."""
        self.live_image_handler: Callable[[int], object] | None = None
        """The old simulator's: called with the number of records after each pixel array that a program logs.

        A true answer is treated like one of `pyresponder`.
        """
        self._responder: Callable[[str], object] | None = None
        self._in_texts = False
        """Whether the responder is a `pyresponder`."""
        self._images = ImageLog()
        self._wheels = Wheels()
        """Of the last run."""
        self._persistent: Mapping[str, Any] = {}
        self._program: Program | None = None
        self._presses: tuple[str, ...] = ()
        """The presses by hand while the program runs, from the program's cell."""
        self._runs: list[StoredRun] = []
        self._last: StoredRun | None = None
        self._spec: RunSpec | None = None
        self._live = LiveRobot(self.find_state)
        self._said: Mapping[str, Any] = {}
        """The settings of the cells, by path, that the app takes over."""
        self._followed: list[str] = []
        """The ids of runs in the app that had not ended when the log was last read."""
        self._traces: tuple[Piece, ...] = ()
        """Pen traces on the mat, until it is cleared or replaced."""

    @property
    def responder(self) -> Callable[[str], object] | None:
        """The function that is called with each line that a program prints for the notebook, without `PY::` in front.

        A return value other than None is an answer; `pyState()` in the program returns all answers. None for no
        function. Setting it removes a `pyresponder`.
        """
        return None if self._in_texts else self._responder

    @responder.setter
    def responder(self, responder: Callable[[str], object] | None) -> None:
        self._responder = responder
        self._in_texts = False

    @property
    def pyresponder(self) -> Callable[[str], object] | None:
        """The function that is called as in the old simulator: with whole lines that begin with `PY::` or `IMG_DATA::`.

        Its answers are shown below a heading; of answers that begin with `JSON::`, the program gets the JSON. None for
        no function. Setting it removes a `responder`.
        """
        return self._responder if self._in_texts else None

    @pyresponder.setter
    def pyresponder(self, responder: Callable[[str], object] | None) -> None:
        self._responder = responder
        self._in_texts = True

    # The log

    @property
    def results_log(self) -> list[StoredRun]:
        """The runs since the log was cleared; `eds` converts them to frames."""
        self._catch_up()
        return list(self._runs)

    def clear_datalog(self) -> None:
        """Discard the log; the runs stay in the store."""
        self._catch_up()
        self._followed.clear()
        self._runs.clear()
        self._images.clear()

    def data(self) -> pd.DataFrame:
        """Return the samples of all runs since the log was cleared, as a frame; see `eds`."""
        return eds.get_dataframe_from_datalog(self.results_log)

    def images(self) -> pd.DataFrame:
        """Return the pixel arrays that were logged since the log was cleared, as a frame.

        Its columns are those of `eds.get_image_data_from_datalog`.
        """
        return eds.image_frame(self._images.list_arrays(self.results_log))

    def logged_arrays(self) -> list[list[LoggedArray]]:
        """Return the pixel arrays in `raw_image_data`, one list for each run."""
        return [
            [array for array in of_run if not array.sent]
            for of_run in self._images.list_arrays(self.results_log)
        ]

    # The log under the old simulator's names

    @property
    def raw_image_data(self) -> list[str]:
        """The logged pixel arrays, each as a text `SIDE r,g,b,a,… CLOCK`, with the clock in 1/30 s."""
        return [
            old_formats.record_text(array) for of_run in self.logged_arrays() for array in of_run
        ]

    def image_data(
        self, datatype: str = "dataframe", mode: str = "rgb"
    ) -> pd.DataFrame | list[str]:
        """Return the logged pixel arrays as a frame of texts, or as `raw_image_data`.

        Args:
            datatype: `dataframe` or `raw`.
            mode: Which numbers the frame has, as in `process_raw_image_data`.

        Raises:
            ConfigError: there is no such type or mode.
        """
        if datatype not in ("dataframe", "raw"):
            raise ConfigError(f"no such type {datatype!r}", "dataframe, raw", key="datatype")
        return (
            self.raw_image_data
            if datatype == "raw"
            else old_formats.build_image_frame(self.raw_image_data, mode)
        )

    process_raw_image_data = staticmethod(old_formats.process_raw_image_data)

    def robot_state(self) -> dict[str, Any]:
        """Return the old simulator's dictionary of the robot's state, see `old_formats.build_robot_state`."""
        from tuisim.engine.runs.run_folder import field_files
        from tuisim.notebook.display import start_record

        self._catch_up()
        run = self._last
        record = run.telemetry.last() if run else None
        if run is None or record is None:
            spec = self.spec
            field = field_files(spec).open_field(has_floor=spec.world.is_open)
            highest_deg = spec.world.start.heading_deg
            return old_formats.build_robot_state(
                spec, start_record(spec), spec.world.noise, field, highest_deg, self._wheels
            )
        highest_deg = float(run.telemetry.array()["heading_deg"].max())
        return old_formats.build_robot_state(
            run.spec, record, run.find_noise(record), run.open_mat(), highest_deg, self._wheels
        )

    # The world

    @property
    def spec(self) -> RunSpec:
        """The robot, world, profile and seed that the cells have set."""
        from tuisim.settings.build import build_run_spec
        from tuisim.settings.options import Settings

        return self._spec or build_run_spec(Settings.merge(self._persistent))

    @property
    def state(self) -> dict[str, Any]:
        """A dictionary with the robot's pose in mm and degrees, and the world and the end of the last run.

        Before the first run, the pose is the start, and `state` is `ready`.
        """
        self._catch_up()
        # The last run may be one of the app, whose user can change settings: its settings are shown, not the cells'.
        spec = self._last.spec if self._last else self.spec
        record = self._last.telemetry.last() if self._last else None
        pose = record.pose if record else spec.world.start
        return {
            "x_mm": pose.x_mm,
            "y_mm": pose.y_mm,
            "heading_deg": pose.heading_deg,
            "left_position_deg": record.left_position_deg if record else 0.0,
            "right_position_deg": record.right_position_deg if record else 0.0,
            "time_s": self._last.time_s if self._last else 0.0,
            "background": spec.world.background,
            "profile": spec.profile.name,
            "seed": spec.seed,
            "state": self._last.state.value if self._last else "ready",
        }

    @property
    def program_text(self) -> str:
        """The program that `-R` runs, empty if there is none."""
        return self._program.text.removeprefix("\n") if self._program else ""

    # Cells

    def apply(self, words: Arguments, text: str | None, prelude: str) -> None:
        """Carry out the magic of a cell; after an error the world and the program are as before.

        Args:
            words: The words of the magic, parsed.
            text: The program below the magic, None for none.
            prelude: Which names are defined for the program before its first line, as the magic says: `none`, `imports`
                (those of the library) or `preloaded` (also motors and sensors).

        Raises:
            ConfigError: a mat, robot or value is invalid, or there is no program to run.
        """
        plan = self._plan_cell(words, text, prelude)
        runs = plan.settings["autorun"] or (self.autorun and text is not None)
        if runs and plan.program is None:
            raise ConfigError(
                "there is no program to run",
                "write one in a cell below %%sim_magic_preloaded",
                key="-R",
            )
        listener = self._build_listener(words.collaborative)
        if plan.spec != self._spec or words.move_back:
            self._last, self._wheels = None, Wheels()
        before = self._spec.world if self._spec else plan.spec.world
        same_mat = (before.background, before.background_fit) == (
            plan.spec.world.background,
            plan.spec.world.background_fit,
        )
        self._traces = self._traces if same_mat and not plan.settings["clear_trace"] else ()
        self._persistent = plan.persistent
        self._program = plan.program
        self._spec = plan.spec
        self._said = _select_given(plan, words)
        if text is not None:
            self._presses = plan.settings["press"]
        self._show(plan, words, listener, runs=runs)

    def _show(self, plan: _CellPlan, words: Arguments, listener: Listener, *, runs: bool) -> None:
        """Run the program of a cell or, if `runs` is false, only show its world.

        This happens in the app if a page shows the app now, else in the cell.
        """
        from tuisim.notebook.display import Stage

        stage = Stage(plan.settings, self._build_captions(words, plan))
        view = self._live.find_shown()
        if view is not None and listener.answers:
            print(
                "tuisim: note: a program that uses a function in the notebook runs here; the app shows its run",
                file=sys.stderr,
            )
            view = None
        elif view is not None:
            view.take_cell(
                self._said,
                plan.program,
                home=words.move_back,
                runs=runs,
                speed=plan.settings["speed"],
            )
        if runs:
            self._run(plan, stage, words, listener, view)
        else:
            scene, status = self._build_scene(plan)
            stage.show(scene, f"nothing is running · {status}" if words.stop else status)
        if view is None and self._live.view is not None:
            self._live.view.show_state()

    def find_state(self) -> CellState:
        """Return the state after the last cell, for an app that starts or that did not show the last cell."""
        from tuisim.notebook.app_view import CellState

        last = self._last
        is_shown = (
            last is not None
            and last.end is not None
            and self._program is not None
            and self._program.text == last.program.text
        )
        return CellState(self._said, self._program, last.id if last and is_shown else "")

    def _plan_cell(self, words: Arguments, text: str | None, prelude: str) -> _CellPlan:
        from tuisim.base.source import Program
        from tuisim.engine.runs.run_folder import field_files
        from tuisim.programs.program_file import ProgramSource
        from tuisim.programs.program_settings import build_program_settings
        from tuisim.settings.build import build_run_spec, list_ineffective
        from tuisim.settings.magic_line import update_persistent
        from tuisim.settings.options import Settings
        from tuisim.settings.robots import RobotChoice

        if isinstance(robot := words.settings.get("robot"), str):
            for note in RobotChoice.load(robot, "-r").notes:
                print(f"tuisim: note: {note}", file=sys.stderr)
        persistent = update_persistent(self._persistent, words.settings)
        program = self._program
        if text is not None:
            # An empty line replaces that of the magic, so that line numbers are those of the cell.
            preload = str(words.settings.get("preload", prelude))
            program = Program("cell", "\n" + text, preload)
        layers = persistent, {"press": self._presses if text is None else ()}, words.settings
        settings = Settings.merge(*layers)
        if program is not None:
            source = ProgramSource(program, has_magic=True)
            # A magic line sets the world for later cells, so it need not fit the program above, which has run already.
            insists = text is not None or settings["autorun"]
            effective = build_program_settings(source, *layers, insists=insists)
            settings = effective.settings
            program = replace(program, shown_ports=effective.decided.shown_ports)
            if text is not None and effective.decided.note:
                print(f"tuisim: note: {effective.decided.note}", file=sys.stderr)
        spec = build_run_spec(settings)
        for remark in list_ineffective(spec):
            print(f"tuisim: note: {remark}", file=sys.stderr)
        return _CellPlan(persistent, settings, spec, field_files(spec), program)

    def _build_listener(self, collaborative: bool) -> Listener:
        from tuisim.notebook.cell_run import Listener

        name = "pyresponder" if self._in_texts else "responder"
        responder = self._responder if collaborative else None
        handler = self.live_image_handler
        for key, function in ((name, responder), ("live_image_handler", handler)):
            if not (function is None or callable(function)):
                raise ConfigError(f"must be a function, got {function!r}", key=f"roboSim.{key}")

        def call_handler() -> object:
            return handler(sum(map(len, self.logged_arrays()))) if handler is not None else None

        return Listener(responder, self._in_texts, None if handler is None else call_handler)

    def _build_captions(self, words: Arguments, plan: _CellPlan) -> dict[str, dict[str, Any]]:
        """Return what a cell displays below its picture, as bundles of MIME data by name.

        A cell without a picture only displays the offer of the app, and only if its magic requests the app.
        """
        app_words = words.app if words.app is not None and not words.app.off else None
        if words.app is not None:
            self._live.turn(on=app_words is not None)
        if app_words is None and "world" in plan.settings["panels_off"]:
            return {}
        return self._live.build_captions(plan.spec.world.background, app_words)

    def _catch_up(self) -> None:
        """Add the runs that the user has started in the app to the log, as far as they are recorded."""
        if self._live.view is None:
            return
        while not self._live.view.begun.empty():
            self._followed.append(self._live.view.begun.get())
        if self._followed:
            from tuisim.engine.runs.store import RunStore

            for run in map(RunStore().load_run, tuple(self._followed)):
                known = [stored.id for stored in self._runs]
                index = known.index(run.id) if run.id in known else len(known)
                self._last, self._runs[index : index + 1] = run, [run]
                self._images.mark_incomplete(run)
                if run.end is not None:
                    self._followed.remove(run.id)

    def _run(
        self,
        plan: _CellPlan,
        stage: Stage,
        words: Arguments,
        listener: Listener,
        view: AppView | None,
    ) -> None:
        from tuisim.notebook.cell_run import CellRun, run_cell
        from tuisim.pictures.scene.pen import Piece

        assert plan.program is not None
        cell = CellRun(
            plan.program,
            plan.spec,
            plan.files,
            plan.settings["speed"] or 0.0,
            plan.settings["press"],
            words.refresh_s,
            self._traces,
            listener,
            self._images,
            plan.settings["quiet"],
        )

        def note(run: StoredRun, wheels: Wheels) -> None:
            self._wheels = wheels
            # The run is in the log from its start, so that a responder can read it. A responder may start runs, too, so
            # this run need not be the last one in the log.
            places = [index for index, stored in enumerate(self._runs) if stored.id == run.id]
            if not places:
                self._images.begin(run)
                places = [len(self._runs)]
            self._last, self._runs[places[0] : places[0] + 1] = run, [run]

        try:
            run_cell(cell, stage, note, view)
        finally:
            # The trace is kept even if a responder's error has ended the run.
            if self._last is not None:
                self._traces = (
                    *self._traces,
                    Piece.from_run(self._last.spec, self._last.telemetry.array()),
                )

    def _build_scene(self, plan: _CellPlan) -> tuple[Scene, str]:
        """Return the scene and the status line to show while no program runs."""
        from tuisim.engine.runs.samples import list_samples
        from tuisim.notebook.cell_output import format_row
        from tuisim.notebook.cell_run import describe_end
        from tuisim.notebook.display import Scene, start_record

        program = plan.program
        start = start_record(plan.spec)
        ready = "ready: -R runs the program" if program and program.text else "ready"
        if self._last is None:
            return Scene(plan.spec, plan.files, program, start, self._traces, printed=()), ready
        is_other = program is not None and program.text != self._last.program.text
        spec = plan.spec
        files = plan.files
        if self._last.first_spec != spec:
            spec = self._last.spec
            files = self._last.find_mat_files()
        rows = self._last.output.read_all_rows()
        printed = [format_row(row) for row in rows if row.is_text]
        last = self._last.telemetry.last() or start
        samples = list_samples(rows)
        status = ready if is_other else describe_end(self._last)
        scene = Scene(spec, files, program, last, self._traces, samples, printed, self._last)
        return scene, status


def _select_given(plan: _CellPlan, words: Arguments) -> Mapping[str, Any]:
    """Return the settings, by path, that cells have set and that the app is to use as well."""
    from tuisim.settings.options import Settings

    presses = {"press": plan.settings["press"]}
    values = Settings.merge(plan.persistent, words.settings, presses).given
    return {path: value for path, value in values.items() if path not in ("autorun", "speed")}


roboSim = Lab()  # noqa: N816 - the course's cells call it so
"""The simulator used by the magics."""
