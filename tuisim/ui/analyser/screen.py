"""The analyser as a screen: chart above, a pane below, the world beside them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import ClassVar

from rich.style import Style
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.command import Provider
from textual.containers import Horizontal, Vertical
from textual.screen import Screen

from tuisim.errors import TuisimError
from tuisim.ui.analyser.actions import ACTIONS
from tuisim.ui.analyser.beside import Beside
from tuisim.ui.analyser.chart import LogChart
from tuisim.ui.analyser.model import Model
from tuisim.ui.analyser.pane import PaneView
from tuisim.ui.analyser.subject import Subject, Wanted, opening
from tuisim.ui.cellview import LinesView

_KEY, _WORD = Style(color="#ffd75f", bold=True), Style(color="#b8c4d0")
_ALWAYS = ("help", "leave")


def _palette() -> type[Provider]:
    from tuisim.ui.analyser.help import AnalyserActions

    return AnalyserActions


class Analyser(Screen[None]):
    """One log, looked at from all sides.

    Args:
        wanted: What to open.
    """

    DEFAULT_CSS = """
    Analyser { background: #10151c; color: #d8dee6; }
    Analyser #title { height: 1; background: #1c242e; color: #ffffff; }
    Analyser #keys { dock: bottom; height: 1; background: #1c242e; }
    Analyser #log { width: 1fr; }
    """
    COMMANDS: ClassVar[set[type[Provider] | Callable[[], type[Provider]]]] = {_palette}
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding(action.key, f"act('{action.id}')", action.title, show=False) for action in ACTIONS.values()
    ]

    def __init__(self, wanted: Wanted) -> None:
        super().__init__()
        self.wanted = wanted
        self.model: Model | None = None
        self.searched = ""
        self.title_line = LinesView()
        self.title_line.id = "title"
        self.keys = LinesView()
        self.keys.id = "keys"
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
        yield self.keys

    def on_mount(self) -> None:
        """Begin to open the log."""
        self.open(self.wanted)

    def on_resize(self) -> None:
        """Fit the keys to the width."""
        self.call_after_refresh(self._show_keys)

    # Opening

    def open(self, wanted: Wanted) -> None:
        """Open another log; the one that is shown stays until then."""
        self.wanted = wanted
        self._tell("opening …")
        self.run_worker(partial(self._open, wanted), thread=True, group="log", exclusive=True)

    def _open(self, wanted: Wanted) -> None:
        try:
            for subject in opening(wanted):
                if wanted is not self.wanted or not self.is_running:
                    return
                self.app.call_from_thread(self._take, subject)
        except TuisimError as error:
            self.app.call_from_thread(self._failed, wanted, error)

    def _failed(self, wanted: Wanted, error: TuisimError) -> None:
        if wanted is not self.wanted:
            return
        self.complain(error)
        if self.model is None:
            self.dismiss(None)
        else:
            self.wanted = self.model.subject.wanted
            self.update()

    def _take(self, subject: Subject) -> None:
        if subject.wanted is not self.wanted:
            return
        before = self.model
        try:
            self.model = Model(subject)
        except TuisimError as error:
            self.complain(error)
            return
        if before is not None and before.subject.wanted is subject.wanted:
            self.model.take_over(before)
        self.chart.take(self.model)
        self.beside.take(self.model)
        self.update()
        if subject.done:
            for note in subject.log.notes:
                self.say(note)

    # Showing

    def update(self) -> None:
        """Show what has changed, everywhere."""
        model = self.model
        if model is None:
            return
        part = model.subject.part
        self._tell("" if model.subject.done else f"reading {part:.0%} …" if part == part else "reading …")
        self.chart.show(model)
        self.pane.show(model)
        self.beside.show(model)

    def redraw_chart(self) -> None:
        """Draw the chart anew, in another way."""
        if self.model is not None:
            self.chart.take(self.model)

    def lay_out(self, chart: bool, pane: bool) -> None:
        """Show chart, pane, or both."""
        self.chart.display, self.pane.display = chart, pane
        self.call_after_refresh(self.update)

    def choose(self, number: int) -> None:
        """Choose a row of a pane other than the table; the cursor goes where it is about."""
        model, name = self.model, self.pane.name_shown
        if model is None:
            return
        bands, notes = model.bands() if name == "bands" else [], model.notes if name == "notes" else []
        count = len(bands or notes) or len(model.subject.runs if name == "runs" else model.traces.ticked())
        self.pane.chosen = number = min(max(number, 0), max(count - 1, 0))
        if bands:
            model.selected = bands[number].variable
            model.go_to_row((bands[number].first_row + bands[number].last_row) // 2)
            model.go_to_time(model.cursor_s)
        elif notes:
            _, note = notes[number]
            if note.variable in model.traces:
                model.selected = note.variable
            model.go_to_time(note.start_s)
        model.follow_cursor()

    def _tell(self, progress: str) -> None:
        title = self.model.log.title if self.model else " ".join((self.wanted.file, *self.wanted.runs))
        place = ""
        if self.model is not None and self.model.log.rows:
            place = (
                f"row {self.model.row + 1:,} of {self.model.log.rows:,} · {self.model.time_of(self.model.row):.2f} s"
            )
        kind = " · telemetry" if self.wanted.telemetry else ""
        self.title_line.set_lines([[(f" {title}{kind}", Style(bold=True)), (f"   {place}   {progress}", Style())]])

    def _show_keys(self) -> None:
        shown = [action for action in ACTIONS.values() if action.footer]
        left = self.size.width - sum(len(a.label) + len(a.footer) + 3 for a in shown if a.id in _ALWAYS)
        line = []
        for action in shown:
            cells = len(action.label) + len(action.footer) + 3
            if action.id not in _ALWAYS:
                if cells > left:
                    continue
                left -= cells
            line += [(f" {action.label}", _KEY), (f" {action.footer} ", _WORD)]
        self.keys.set_lines([line])

    # What the user does

    def action_act(self, name: str) -> None:
        """Do what a key stands for."""
        ACTIONS[name].do(self)

    def on_log_chart_pointed(self, message: LogChart.Pointed) -> None:
        """Go to a time that was pointed at."""
        if self.model is not None and self.model.log.rows:
            self.model.go_to_time(message.time_s)
            self.update()

    def on_log_chart_ticked(self, message: LogChart.Ticked) -> None:
        """Choose a variable and tick it, or not."""
        if self.model is not None:
            self.model.selected = message.name
            ACTIONS["tick"].do(self)

    def leave(self) -> None:
        """Close the screen."""
        self.dismiss(None)

    def copy(self, text: str, what: str) -> None:
        """Put a text into the clipboard of the user's own terminal."""
        self.app.copy_to_clipboard(text)
        self.say(f"Copied: {what}")

    def say(self, text: str) -> None:
        """Show a short notice."""
        self.notify(text, timeout=3, markup=False)

    def complain(self, error: TuisimError) -> None:
        """Show an error."""
        self.notify(str(error), severity="error", timeout=8, markup=False)
