"""The analyser as a screen: chart above, a pane below, the world beside them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from rich.style import Style
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal, Vertical

from tuisim.analysis.model import Model
from tuisim.analysis.source import LogRequest, opening
from tuisim.analysis.table import TableTask
from tuisim.app.analyser.actions import crossings
from tuisim.app.analyser.actions.table import ACTIONS
from tuisim.app.analyser.background import Finder
from tuisim.app.analyser.chart import LogChart
from tuisim.app.analyser.columns import ask_if_unsure
from tuisim.app.analyser.pane import PaneView
from tuisim.app.analyser.panes import pane_frame
from tuisim.app.analyser.world_pane import Beside
from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.app.keys.action import ActionHost, key_bindings
from tuisim.app.keys.footer import KeyFooter
from tuisim.app.terminal.cell_view import LinesView
from tuisim.errors import LogError, TuisimError

if TYPE_CHECKING:
    import pandas as pd

_LOOK_S = 1.0
_PATIENCE = 10.0
"""The pause between two readings of a growing log, as a multiple of the last reading time."""


class Analyser(ActionHost, ClosesOnce[None]):
    """The views of one log. Modal, so that no key of the app below it works here.

    Args:
        wanted: What to open.
    """

    DEFAULT_CSS = """
    Analyser { background: #10151c; color: #d8dee6; }
    Analyser #title { height: 1; background: #1c242e; color: #ffffff; }
    Analyser #log { width: 1fr; }
    """
    ACTIONS = ACTIONS
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+p", "app.command_palette", "Command palette", show=False),
        *key_bindings(ACTIONS.values()),
    ]

    def __init__(self, wanted: LogRequest) -> None:
        super().__init__()
        self.wanted = wanted
        self.model: Model | None = None
        self.searched = ""
        self.job: TableTask | None = None
        """The current background job."""
        self.finder = Finder(self)
        self._reading = False
        self._began_s = self._next_look_s = 0.0
        self._stamp: object = None
        """Length of the log when it was last read."""
        self.title_line = LinesView()
        self.title_line.id = "title"
        self.key_footer = KeyFooter()
        self.chart = LogChart()
        self.pane = PaneView()
        self.beside = Beside()

    def compose(self) -> ComposeResult:
        """Title, log and world, keys."""
        yield self.title_line
        with Horizontal():
            with Vertical(id="log"):
                yield self.chart
                yield self.pane
            yield self.beside
        yield self.key_footer

    def on_mount(self) -> None:
        """Start to open the log."""
        self.open(self.wanted)
        self.set_interval(_LOOK_S, self.look_again)

    # Opening

    def open(self, wanted: LogRequest) -> None:
        """Open another log in the background; the current one stays until then."""
        self.wanted = wanted
        self._reading, self._began_s = True, monotonic()
        self._tell("opening …")
        self.run_worker(partial(self._open, wanted), thread=True, group="log", exclusive=True)

    def _open(self, wanted: LogRequest) -> None:
        try:
            for subject in opening(wanted):
                if wanted is not self.wanted or not self.is_running:
                    return
                model, before = Model(subject), self.model
                if before is not None and before.subject.wanted is wanted:
                    model.define_as(before)
                # Data for the first chart of a long log is computed here, in the background.
                model.traces.span_s()
                self.app.call_from_thread(self.take, model)
        except TuisimError as error:
            self.app.call_from_thread(self._failed, wanted, error)

    def _failed(self, wanted: LogRequest, error: TuisimError) -> None:
        if wanted is not self.wanted:
            return
        self._reading = False
        self.complain(error)
        if self.model is None:
            self.dismiss(None)
        else:
            self.wanted = self.model.subject.wanted
            self.update()

    def take(self, model: Model) -> None:
        """Show the log that was read, unless another one was requested since."""
        subject, before = model.subject, self.model
        if subject.wanted is not self.wanted:
            return
        if subject.done:
            now_s = monotonic()
            self._reading, self._next_look_s = False, now_s + _PATIENCE * (now_s - self._began_s)
            self._stamp = subject.stamp()
        self.model = model
        if before is not None and before.subject.wanted is subject.wanted:
            self.model.take_over(before)
        else:
            self.chart.look.against = None
        self.chart.take(self.model)
        self.beside.take(self.model)
        self.update()
        if before is None:
            ask_if_unsure(self)
        if subject.done and (before is None or before.subject.log.notes != subject.log.notes):
            for note in subject.log.notes:
                self.say(note)

    def look_again(self) -> None:
        """Read on when the log has grown; the longer a reading takes, the less often."""
        model = self.model
        if self.job is not None:
            self._tell(self._progress())
        if model is None or not model.subject.done or self._reading or monotonic() < self._next_look_s:
            return
        if model.subject.stamp() != self._stamp:
            self.open(self.wanted)

    # Display

    def update(self) -> None:
        """Update the views that have changed."""
        model = self.model
        if model is None:
            return
        self._tell(self._progress())
        now = self.situation()
        self.key_footer.show([action for action in ACTIONS.values() if not action.why_not(now)])
        self.finder.look(model, self.pane.name_shown)
        self.chart.show(model)
        self.pane.show(model)
        self.beside.show(model)

    def at_hand(self) -> Model:
        """Return the current model: a growing log may have another one than when a question was asked.

        Raises:
            LogError: there is none yet.
        """
        if self.model is None:
            raise LogError("there is no log yet")
        return self.model

    def begin(self, task: TableTask) -> None:
        """Show the name of a background job; results of older jobs are ignored."""
        self.give_up()
        self.job = task
        self.update()

    def end(self, task: TableTask, then: Callable[[], None]) -> None:
        """Handle the result of a job, unless a newer job has started."""
        if task is self.job:
            self.job = None
            try:
                then()
            except TuisimError as error:
                self.complain(error)
            self.update()

    def give_up(self) -> None:
        """Ignore the result of the current job."""
        if self.job is not None:
            self.job.stopped = True
        self.job = None

    def on_unmount(self) -> None:
        """Ignore the results of running jobs."""
        self.give_up()

    def redraw_chart(self) -> None:
        """Redraw the chart after its options have changed."""
        if self.model is not None:
            self.chart.take(self.model)

    def lay_out(self, chart: bool, pane: bool) -> None:
        """Show chart, pane, or both."""
        self.chart.display, self.pane.display = chart, pane
        self.call_after_refresh(self.update)

    def choose(self, number: int) -> None:
        """Select a row of a pane other than the table; the cursor goes to its time."""
        model, name = self.model, self.pane.name_shown
        if model is None:
            return
        bands, notes = model.bands() if name == "bands" else [], model.notes if name == "notes" else []
        events = model.events.found(model.log) if name == "events" else []
        count = len(bands or notes or events) or len(model.subject.runs if name == "runs" else model.traces.ticked())
        self.pane.chosen = number = min(max(number, 0), max(count - 1, 0))
        if bands:
            model.selected = bands[number].variable
            rows = model.trace.series.rows
            first, last = np.searchsorted(rows, (bands[number].first_row, bands[number].last_row))
            model.go_to_row(int(rows[(first + last) // 2]))
        elif events:
            crossings.go_to(self, number)
        elif notes:
            _, note = notes[number]
            if note.variable in model.traces:
                model.selected = note.variable
            model.go_to_moment(note.start_s)
        model.follow_cursor()

    def _progress(self) -> str:
        """Return how much of the log has been read."""
        subject = self.model.subject if self.model else None
        if subject is None or subject.done:
            return ""
        return f"reading {subject.part:.0%} …" if subject.part == subject.part else "reading …"

    def _tell(self, progress: str) -> None:
        title = self.model.log.title if self.model else " ".join((self.wanted.file, *self.wanted.runs))
        place = ""
        if self.model is not None and self.model.log.rows:
            place = (
                f"row {self.model.row + 1:,} of {self.model.log.rows:,} · {self.model.time_of(self.model.row):.2f} s"
            )
        kind = " · telemetry" if self.wanted.telemetry else ""
        told = "   ".join(word for word in (place, progress, str(self.job or "")) if word)
        self.title_line.set_lines([[(f" {title}{kind}", Style(bold=True)), (f"   {told}", Style())]])

    # User actions

    def situation(self) -> int:
        """Return the number of rows."""
        return self.model.log.rows if self.model else 0

    def on_log_chart_pointed(self, message: LogChart.Pointed) -> None:
        """Go to a time that was clicked."""
        if self.model is not None and self.model.log.rows:
            self.model.go_to_time(message.time_s)
            self.update()

    def on_log_chart_ticked(self, message: LogChart.Ticked) -> None:
        """Select a variable, and toggle it."""
        if self.model is not None:
            self.model.selected = message.name
            self.action_act("tick")

    def leave(self) -> None:
        """Close the screen."""
        self.dismiss(None)

    def copy(self, text: str, what: str) -> None:
        """Copy a text to the clipboard of the user's terminal."""
        self.app.copy_to_clipboard(text)
        self.say(f"Copied: {what}")

    def export(self, path: Path, pane: str) -> None:
        """Write the rows of a pane to a file; of the table, only the columns shown.

        Raises:
            ExportError: the file cannot be written.
        """
        from tuisim.logs.export import check_target

        if self.model is not None:
            target = check_target(path)
            frame = None if pane == "table" else pane_frame(pane, self.model)
            self.run_worker(partial(self._write, self.model, frame, target), thread=True, group="export")

    def _write(self, model: Model, frame: pd.DataFrame | None, target: Path) -> None:
        """Write a frame, or the rows of the table."""
        from tuisim.logs.export import LOG_FORMAT, export_frame, export_log

        try:
            if frame is None:
                export_log(model.log, model.rows.shown(), target)
            else:
                export_frame(frame, target, {"format": LOG_FORMAT, "table": "pane", "columns": list(frame.columns)})
        except TuisimError as error:
            self.app.call_from_thread(self.complain, error)
        else:
            self.app.call_from_thread(self.say, f"The rows as shown are in {target}")
