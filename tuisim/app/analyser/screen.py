"""The views of one log on a screen, without its keys: chart above, a pane below, the world beside them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from time import monotonic
from typing import TypeVar

import numpy as np
from rich.style import Style
from textual.app import ComposeResult
from textual.containers import Horizontal, Vertical
from textual.events import Event, Key, Resize
from textual.widget import Widget

from tuisim.analysis.events import CommandRow
from tuisim.analysis.model import RECKONING, AnalysisModel
from tuisim.analysis.source import LogRequest
from tuisim.app import background, design
from tuisim.app.action import ActionHost, KeyFooter
from tuisim.app.analyser.chart import LogChart
from tuisim.app.analyser.panes import PANES, PaneView
from tuisim.app.analyser.preview import PreviewDialog
from tuisim.app.analyser.world import WorldPane
from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.app.dialogs.question import Form, LinePrompt
from tuisim.app.layout.forms import is_tall
from tuisim.base import palette
from tuisim.base.errors import LogError, TuisimError
from tuisim.logs.choices import NO_CHOICES, ReadChoices
from tuisim.logs.derived import list_expression_words
from tuisim.logs.log import Log
from tuisim.logs.reader import read_beginning
from tuisim.logs.table import FAST_ROWS, TableTask
from tuisim.logs.units import drop_run
from tuisim.terminal.cell_view import LinesView

_POLL_S = 1.0
_WIDE_COLS = 120
"""Minimum width of the screen at which a lesson and the world are both shown beside the log."""
_NARROW_COLS = 80
"""In a high screen that is narrower than this, the world is below the log instead of beside it."""
_PATIENCE = 10.0
"""After a growing log was read, the app waits so many times as long as reading took before it reads it again."""

Made = TypeVar("Made")


class LogScreen(ActionHost, ClosesOnce[None]):
    """The screen with the views of one log. The screen is modal, so that the keys of the app below do not work.

    Args:
        request: The log to open.
        beside: A widget for the right edge, such as the lesson that the log is for. In a narrow terminal, it is shown
            in place of the world until the user presses the key of the world.
    """

    DEFAULT_CSS = f"""
    LogScreen {{ background: {design.GROUND}; color: {palette.INK}; }}
    LogScreen #title {{ height: 1; background: {design.BAR}; color: {palette.WHITE}; }}
    LogScreen #log {{ width: 1fr; }}
    LogScreen .beside {{
        width: 34%; min-width: 32; height: 1fr; background: {design.GROUND}; border: round {palette.LINE};
        border-title-color: {palette.SOFT}; border-subtitle-color: {design.SUBTITLE};
    }}
    LogScreen.-tall > Horizontal {{ layout: vertical; }}
    LogScreen.-tall WorldPane, LogScreen.-tall .beside {{ width: 1fr; height: 34%; }}
    LogScreen.-tall #source {{ display: none; }}
    """

    def __init__(self, request: LogRequest, beside: Widget | None = None) -> None:
        super().__init__()
        self.request = request
        self._beside = beside
        self._model: AnalysisModel | None = None
        self.searched = ""
        """The text that the user last searched for; empty for none."""
        self.job: TableTask | None = None
        """The background job that works on the table now; None for none."""
        self._reading = False
        self._began_s = self._next_poll_s = 0.0
        self._stamp: object = None
        """The result of `OpenedLog.stamp` when the log was last read; if it differs now, the log has grown."""
        self._said: tuple[str, ...] = ()
        """Notes about reading the log that the app has already shown, so that it shows none twice."""
        self.title_line = LinesView()
        self.title_line.id = "title"
        self.chart = LogChart()
        self.pane = PaneView(self.complain)
        self.world = WorldPane()
        self.key_footer = KeyFooter()

    def compose(self) -> ComposeResult:
        yield self.title_line
        with Horizontal():
            with Vertical(id="log"):
                yield self.chart
                yield self.pane
            yield self.world
            if self._beside is not None:
                yield self._beside.add_class("beside")
        yield self.key_footer

    def can_take(self, event: Event) -> bool:
        """Return whether the screen can handle an event now; a key that works on the log needs an open log."""
        is_there = self.is_open or not (isinstance(event, Key) and event.key in self._keys_of_log)
        return super().can_take(event) and is_there

    @property
    def _keys_of_log(self) -> set[str]:
        return {
            key
            for action in self.ACTIONS.values()
            if action.why_not(None)
            for key in action.key.split(",")
        }

    def on_resize(self, event: Resize) -> None:
        """Put the world below the log if the screen is high and narrow, as on a phone; else beside the log."""
        self.set_class(is_tall(*event.size) and event.size.width < _NARROW_COLS, "-tall")

    def on_mount(self) -> None:
        self.world.is_on = self._beside is None or self.size.width >= _WIDE_COLS
        self.open(self.request, asks=True)
        self.set_interval(_POLL_S, self.poll)

    # The log

    @property
    def is_open(self) -> bool:
        """Whether a log is open, of which at least the first rows have been read."""
        return self._model is not None

    @property
    def model(self) -> AnalysisModel:
        """The model of the open log; when a growing log is read again, a new model replaces it.

        Raises:
            LogError: no log is open yet.
        """
        if self._model is None:
            raise LogError("no log is open yet")
        return self._model

    def open(self, request: LogRequest, asks: bool = False) -> None:
        """Open another log in the background; until it is read, the current log stays on the screen.

        Args:
            request: The log to open.
            asks: Whether to ask the user how to read the log, if that is in doubt.
        """
        self.request = request
        self._reading, self._began_s = True, monotonic()
        self._show_title("opening …")
        work = partial(self._open, request, asks)
        failed = partial(self._report_failure, request)
        background.run(self, work, lambda _: None, failed, group="log", exclusive=True)

    def _open(self, request: LogRequest, asks: bool) -> None:
        if asks and (log := read_doubtful(request)) is not None:
            background.call(self.app, self._ask_choices, request, log)
            return
        for opened in request.open_pieces():
            if request is not self.request or not self.is_running:
                return
            model = AnalysisModel(opened)
            before = self._model
            if before is not None and before.opened.request is request:
                model.copy_definitions(before)
            # Data for the first chart of a long log is computed here, in the background.
            model.traces.find_span_s()
            background.call(self.app, self.set_model, model)

    def _report_failure(self, request: LogRequest, error: TuisimError) -> None:
        if request is not self.request:
            return
        self._reading = False
        self.complain(error)
        if self._model is None:
            self.dismiss(None)
        else:
            self.request = self._model.opened.request
            self.update()

    def set_model(self, model: AnalysisModel) -> None:
        """Show a log that was read, unless another log was requested meanwhile.

        If the program has printed no samples, open the telemetry instead.
        """
        opened = model.opened
        before = self._model
        if opened.request is not self.request:
            return
        is_first = before is None and not opened.request.telemetry
        if is_first and not model.log.rows and any(run.telemetry.count for run in opened.runs):
            self.say(
                "The program printed no samples: this is the telemetry. {telemetry} shows the printed samples"
            )
            self.open(replace(opened.request, telemetry=True))
            return
        if opened.done:
            now_s = monotonic()
            self._reading = False
            self._next_poll_s = now_s + _PATIENCE * (now_s - self._began_s)
            self._stamp = opened.stamp()
        self._model = model
        if before is not None and before.opened.request is opened.request:
            model.restore(before)
        else:
            self.chart.options.against = None
        self.redraw_chart()
        self.world.set_model(model)
        self.update()
        if before is None:
            self.app.post_message(self.Changed())
        if opened.done and opened.log.notes != self._said:
            self._said = opened.log.notes
            for note in self._said:
                self.say(note)

    def poll(self) -> None:
        """Read the log again if it has grown; to be called often.

        If the last reading took long, the next one comes later.
        """
        model = self._model
        if self.job is not None:
            self._show_title(self._describe_progress())
        if (
            model is None
            or not model.opened.done
            or self._reading
            or monotonic() < self._next_poll_s
        ):
            return
        if model.opened.stamp() != self._stamp:
            self.open(self.request)

    # Display

    def action_act(self, name: str) -> None:
        super().action_act(name)
        self.update()

    def find_situation(self) -> int | None:
        """Return the number of rows of the open log, which decides which keys work; None while no log is open."""
        return None if self._model is None else self._model.log.rows

    def update(self) -> None:
        """Draw the title, the footer, the pane, the chart and the world for the present state of the model."""
        if self._model is None:
            return
        self._show_title(self._describe_progress())
        now = self.find_situation()
        self.key_footer.show(
            [action for action in self.ACTIONS.values() if not action.why_not(now)]
        )
        # The pane comes before the chart, since it finds the bands that the chart shades.
        self.pane.show(self._model)
        self.chart.show(self._model)
        self.world.show(self._model)

    def redraw_chart(self) -> None:
        """Redraw the chart after its options have changed."""
        self.chart.set_model(self.model)

    def lay_out(self, chart: bool, pane: bool) -> None:
        """Show or hide the chart and the pane.

        Args:
            chart: Whether to show the chart.
            pane: Whether to show the pane.
        """
        self.chart.display = chart
        self.pane.display = pane
        self.call_after_refresh(self.update)

    def show_world(self, is_on: bool) -> None:
        """Show or hide the world beside the log; in a narrow terminal, the world replaces the widget `beside`."""
        self.world.display = self.world.is_on = is_on
        if self._beside is not None:
            self._beside.display = not is_on or self.size.width >= _WIDE_COLS
        self.call_after_refresh(self.update)

    def show_pane(self, name: str) -> None:
        """Show a pane, given by its key in `PANES`."""
        self.pane.turn_to(name)
        if not self.pane.display:
            self.lay_out(chart=True, pane=True)

    def _describe_progress(self) -> str:
        opened = self._model.opened if self._model else None
        if opened is None or opened.done:
            return ""
        return f"reading {opened.part:.0%} …" if opened.part == opened.part else "reading …"

    def _show_title(self, progress: str) -> None:
        model = self._model
        position = ""
        title = model.log.title if model else " ".join((self.request.file, *self.request.runs))
        if model is not None and model.log.rows:
            position = f"row {model.row + 1:,} of {model.log.rows:,} · {model.find_time_s(model.row):.2f} s"
        kind = " · telemetry" if self.request.telemetry else ""
        words = "   ".join(word for word in (position, progress, str(self.job or "")) if word)
        self.title_line.set_lines(
            [[(f" {title}{kind}", Style(bold=True)), (f"   {words}", Style())]]
        )

    # Selection

    def choose(self, number: int) -> None:
        """Select a row of the pane and move the cursor to the time of that row; the pane must not be the table.

        Args:
            number: Index of the row, from 0; one outside the pane selects its first or last row.
        """
        model = self.model
        name = self.pane.name_shown
        count = len(PANES[name].rows(model))
        self.pane.chosen = number = min(max(number, 0), max(count - 1, 0))
        if name == "bands" and count:
            band = model.bands()[number]
            model.selected = band.variable
            rows = model.trace.series.rows
            first, last = np.searchsorted(rows, (band.first_row, band.last_row))
            model.go_to_row(int(rows[(first + last) // 2]))
        elif name == "events" and count:
            self.go_to_event(number)
        elif name == "notes" and count:
            _, note = model.notes[number]
            if note.variable in model.traces:
                model.selected = note.variable
            model.go_to_moment(note.start_s)
        model.follow_cursor()

    def go_to_event(self, number: int) -> None:
        """Move the cursor to an event, given by its index in the list of events."""
        model = self.model
        event = model.events.list_events(model.log)[number]
        if not isinstance(event, CommandRow):
            model.selected = event.variable
        model.go_to_row(event.row)
        model.follow_cursor()
        if self.pane.name_shown == "events":
            self.pane.chosen = number

    def on_log_chart_pointed(self, message: LogChart.Pointed) -> None:
        if self.find_situation():
            self.model.go_to_time(message.time_s)
            self.update()

    def on_log_chart_ticked(self, message: LogChart.Ticked) -> None:
        if self.find_situation():
            self.model.selected = message.name
            self.action_act("tick")

    # Dialogs

    def ask(
        self,
        title: str,
        do: Callable[[str], None],
        value: str = "",
        forms: Sequence[Form] = (),
        completes: bool = False,
    ) -> None:
        """Ask for a line of text in a dialog, and call `do` with the line.

        Args:
            title: Title of the dialog.
            do: Applies the line. If it raises a TuisimError, the error is shown, and the user can correct the line.
            value: Initial text.
            forms: The accepted forms; in them, `Colour` is replaced by the name of the selected variable.
            completes: Whether to offer the words of expressions as completions.
        """

        def apply(text: str) -> None:
            do(text)
            self.update()

        name = drop_run(self.model.selected) or "Colour"
        own = [(form.replace("Colour", name), meaning) for form, meaning in forms]
        words = (*list_expression_words(self.model.log), RECKONING) if completes else ()
        self.app.push_screen(LinePrompt(title, apply, value, own, words))

    def ask_choices(self) -> None:
        """Open the dialog that asks how to read the file."""
        request = self.request
        if not request.is_readable_again:
            self.say("You can change only how a file is read, not a run or a pipe")
            return
        self._ask_choices(request, read_beginning(request.file, request.choices))

    def _ask_choices(self, request: LogRequest, log: Log) -> None:
        if request is self.request and not self.is_closed:
            dialog = PreviewDialog(request.file, request.choices, log)
            self.app.push_screen(dialog, self._set_choices)

    def _set_choices(self, choices: ReadChoices | None) -> None:
        """Read the file again with the user's choices; None means that the user has chosen nothing.

        If nothing was chosen and no log is open, close the screen.
        """
        if choices is None:
            if not self.is_open:
                self.dismiss()
            return
        try:
            self.request.remember(choices)
        except OSError as error:
            self.say(f"The choices cannot be saved: {error.strerror or error}")
        self.open(LogRequest(self.request.file, choices=choices))

    def copy(self, text: str, what: str) -> None:
        """Copy a text to the clipboard of the user's terminal, and show a notice.

        Args:
            text: The text.
            what: Name of the text in the notice.
        """
        self.app.copy_to_clipboard(text)
        self.say(f"{what}: sent to the terminal's clipboard. {{export}} writes a file")

    # The following methods work in the background.

    def run_task(
        self, word: str, rows: int, do: Callable[[TableTask], Made], then: Callable[[Made], None]
    ) -> None:
        """Run a function on the log and pass on its result; if newer work begins meanwhile, the result is dropped.

        Args:
            word: Label of the work, shown while it runs.
            rows: Number of rows that the work reads; for many, it runs in the background.
            do: The work; must only read the log.
            then: Called with the result, in the app's thread.

        Raises:
            TuisimError: raised by `do` if it does not run in the background; otherwise the screen shows the error.
        """
        task = TableTask(word)
        if rows <= FAST_ROWS:
            then(do(task))
            return
        self.begin(task)
        background.run(
            self,
            partial(do, task),
            lambda result: self.end(task, partial(then, result)),
            lambda error: self.end(task, partial(self.complain, error)),
            group="work",
        )

    def begin(self, task: TableTask) -> None:
        """Make a task the current background job, and show its label; the result of an older job will be ignored."""
        self.give_up()
        self.job = task
        self.update()

    def end(self, task: TableTask, then: Callable[[], None]) -> None:
        """Call `then` for a finished background job, and update the screen; do nothing if a newer job has started.

        An error that `then` raises is shown.
        """
        if task is self.job:
            self.job = None
            try:
                then()
            except TuisimError as error:
                self.complain(error)
            self.update()

    def give_up(self) -> None:
        """Stop waiting for the current background job: its result will be ignored."""
        if self.job is not None:
            self.job.stopped = True
        self.job = None

    def on_unmount(self) -> None:
        self.give_up()


def read_doubtful(request: LogRequest) -> Log | None:
    """Return the first rows of a file whose format was guessed, for the user to check; None if nothing is in doubt.

    Raises:
        LogError: the file cannot be read, or has no row.
    """
    is_known = request.is_remembered or request.choices != NO_CHOICES
    if is_known or not request.is_readable_again:
        return None
    log = read_beginning(request.file, NO_CHOICES)
    # The lines that a program printed are read in one way only: there is nothing to choose.
    is_guessed = not log.layout.sure or bool(log.form.separator and log.notes)
    return log if is_guessed and not log.metadata else None
