"""The simulator of a notebook: the world that its cells set, the program, the runs and their log."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tuisim.api import records_of
from tuisim.config import build_run_spec
from tuisim.core.spec import RunSpec
from tuisim.datalog.records import SPEECH, STDERR, STDOUT, OutputRow, line_of
from tuisim.datalog.runfile import StoredRun
from tuisim.datalog.samples import samples_of
from tuisim.datalog.store import RunStore
from tuisim.errors import ConfigError
from tuisim.fields import FieldFiles
from tuisim.host import Program, RunHandle, RunOptions, field_files, start_run
from tuisim.notebook import eds
from tuisim.notebook.showing import Scene, Stage
from tuisim.notebook.words import MagicWords, lasting_after
from tuisim.protocol import Answer
from tuisim.switches import Settings, settings_of

if TYPE_CHECKING:
    import pandas as pd

POLL_S = 0.02
"""How long a printed line may wait before it is in the cell."""

STOP_WAIT_S = 1.0
FOR_THE_NOTEBOOK = ("PY::", "IMG_DATA")
"""What the lines begin with that are meant for the responder."""
_SHOWN = {STDOUT, STDERR, SPEECH}


@dataclass(frozen=True, slots=True)
class _Plan:
    """A cell, checked: what holds from now on."""

    lasting: Mapping[str, Any]
    settings: Settings
    spec: RunSpec
    files: FieldFiles
    program: Program | None


class Lab:
    """A simulated robot that the cells of a notebook share.

    Its world lasts from cell to cell, its log until it is cleared.
    """

    def __init__(self) -> None:
        self.autorun = False
        """Whether a program runs as soon as its cell is there, as with `-R`."""
        self.responder: Callable[[str], object] | None = None
        """In collaborative mode: called with each line that a program prints for the notebook, `PY::` left out."""
        self._lasting: Mapping[str, Any] = {}
        self._program: Program | None = None
        self._runs: list[StoredRun] = []
        self._last: StoredRun | None = None
        self._spec: RunSpec | None = None

    # The log

    @property
    def results_log(self) -> list[StoredRun]:
        """The runs since the log was cleared; `eds` makes frames of them."""
        return list(self._runs)

    def clear_datalog(self) -> None:
        """Forget what was logged; the runs stay in the store."""
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
        return self._spec or build_run_spec(settings_of(self._lasting))

    @property
    def state(self) -> dict[str, Any]:
        """Where the robot is, in mm and degrees, and how the last run ended."""
        record = self._last.telemetry.last() if self._last else None
        pose = record.pose if record else self.spec.world.start
        return {
            "x_mm": pose.x_mm,
            "y_mm": pose.y_mm,
            "heading_deg": pose.heading_deg,
            "left_position_deg": record.left_position_deg if record else 0.0,
            "right_position_deg": record.right_position_deg if record else 0.0,
            "time_s": self._last.end.time_ns / 1e9 if self._last and self._last.end else 0.0,
            "background": self.spec.world.background,
            "profile": self.spec.profile.name,
            "seed": self.spec.seed,
            "state": self._last.state if self._last else "ready",
        }

    @property
    def program_text(self) -> str:
        """The program that `-R` runs, empty if there is none."""
        return self._program.text.removeprefix("\n") if self._program else ""

    # Cells

    def take(self, words: MagicWords, text: str | None, prelude: str) -> None:
        """Do what a cell says; if anything is wrong with it, nothing changes.

        Args:
            words: The magic line.
            text: The program below it, None for none.
            prelude: none, imports or preloaded.

        Raises:
            ConfigError: a mat, robot, value or so is wrong, or there is no program to run.
        """
        plan = self._checked(words, text, prelude)
        runs = plan.settings.autorun or (self.autorun and text is not None)
        if runs and plan.program is None:
            raise ConfigError("there is no program to run", "put one into a cell below %%sim_magic_preloaded", key="-R")
        if plan.spec != self._spec or words.move_back:
            self._last = None
        self._lasting, self._program, self._spec = plan.lasting, plan.program, plan.spec
        stage = Stage(plan.settings)
        if runs:
            self._run(plan, stage, words)
            return
        records = records_of(self._last) if self._last else ()
        output = self._last.output.all_rows() if self._last else ()
        loaded = plan.program.text if plan.program else ""
        state = self._last.state if self._last else "ready: -R runs the program" if loaded else "ready"
        stage.show(Scene(plan.spec, plan.files, loaded, records, output), state)

    def _checked(self, words: MagicWords, text: str | None, prelude: str) -> _Plan:
        lasting = lasting_after(self._lasting, words.settings)
        settings = settings_of(lasting, words.settings)
        spec = build_run_spec(settings)
        program = self._program
        if text is not None:
            # The first line is that of the magic, so that the program's lines count as in the cell.
            program = Program("cell", "\n" + text, settings.preload or prelude)
        return _Plan(lasting, settings, spec, field_files(spec), program)

    def _run(self, plan: _Plan, stage: Stage, words: MagicWords) -> None:
        """Run to the end, or until the kernel is interrupted."""
        assert plan.program is not None
        speed = plan.settings.speed or 0.0
        store = RunStore()
        # Answers are taken in live runs only.
        asks = "input" in plan.program.text
        options = RunOptions(live=speed > 0 or asks, speed=speed, asks_user=asks)
        handle = start_run(plan.program, plan.spec, options, store)
        run = store.load_run(handle.run_id)
        try:
            self._follow(handle, _Screen(plan, stage, run, words.refresh_s), words.collaborative)
        except KeyboardInterrupt:
            # A second one must not leave a child behind; `close` kills it.
            handle.stop()
            handle.wait(STOP_WAIT_S)
        finally:
            handle.close()
            self._last = store.load_run(handle.run_id)
            self._runs.append(self._last)
        _print_rows(handle.output.new_rows())
        end = self._last.end
        if end and end.error and not any(row.stream == STDERR for row in self._last.output.rows()):
            print(end.error.rstrip("\n"), file=sys.stderr)
        what = f": {end.summary}" if end and end.summary else ""
        samples = sum(1 for _ in samples_of(self._last.output.rows()))
        time_s = end.time_ns / 1e9 if end else 0.0
        _Screen(plan, stage, self._last, 0.0).draw(f"{self._last.state}{what} · {time_s:.3f} s · {samples} samples")

    def _follow(self, handle: RunHandle, screen: _Screen, collaborative: bool) -> None:
        while handle.ended is None:
            handle.wait_for_event(POLL_S)
            handle.pump()
            rows = handle.output.new_rows()
            _print_rows(rows)
            if collaborative and self.responder is not None:
                for row in rows:
                    if row.stream == STDOUT and row.text.startswith(FOR_THE_NOTEBOOK):
                        self.responder(row.text.removeprefix(FOR_THE_NOTEBOOK[0]))
            if handle.waiting_for_input is not None:
                handle.send(Answer(_answer(handle.waiting_for_input)))
            screen.draw_now_and_then()


class _Screen:
    """Draws a run while it goes on."""

    def __init__(self, plan: _Plan, stage: Stage, run: StoredRun, refresh_s: float) -> None:
        self._plan, self._stage, self._run, self._refresh_s = plan, stage, run, refresh_s
        self._due = time.monotonic() + refresh_s

    def draw_now_and_then(self) -> None:
        """Draw if the last drawing is old."""
        if time.monotonic() < self._due:
            return
        self.draw(f"running · {self._run.telemetry.count / self._run.spec.profile.tick_hz:.2f} s")
        self._due = time.monotonic() + self._refresh_s

    def draw(self, status: str) -> None:
        """Draw the run as it is now."""
        output = self._run.output.all_rows()
        scene = Scene(self._plan.spec, self._plan.files, self._run.program.text, records_of(self._run), output)
        self._stage.show(scene, status)


def _print_rows(rows: list[OutputRow]) -> None:
    for row in rows:
        if row.stream in _SHOWN:
            print(line_of(row), file=sys.stderr if row.stream == STDERR else sys.stdout)


def _answer(prompt: str) -> str | None:
    """Ask the person at the notebook; None where nobody can answer."""
    from IPython.core.error import StdinNotImplementedError

    try:
        return input(prompt)
    except (EOFError, StdinNotImplementedError):
        return None


roboSim = Lab()  # noqa: N816 - the course's cells call it so
"""The simulator that the magics mean."""
