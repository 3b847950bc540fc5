"""The pane beside the log: the world at the time of the sample, the line that printed it, the pixels seen."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from rich.style import Style
from textual.app import ComposeResult
from textual.containers import Vertical

from tuisim.app.analyser.world_at import WorldAt, place_of, tells_places
from tuisim.app.panels.arrays import Arrays
from tuisim.app.panels.world import WorldView
from tuisim.app.terminal.cell_view import LinesView
from tuisim.charts.text_runs import Run
from tuisim.errors import printable
from tuisim.source import source_lines

if TYPE_CHECKING:
    from tuisim.analysis.model import Model

_PLAIN, _DIM = Style(color="#d8dee6"), Style(color="#7f8fa1")
_HERE = Style(color="#ffffff", bgcolor="#263545", bold=True)
NO_PLACE = "This log does not say where the robot was"


class Beside(Vertical):
    """The column at the right."""

    DEFAULT_CSS = """
    Beside { width: 34%; min-width: 30; }
    Beside .frame { border: round #44505e; border-title-color: #9fb0c3; height: 1fr; }
    Beside .frame > * { height: 1fr; width: 1fr; }
    Beside > Arrays { height: 13; border: round #44505e; border-title-color: #9fb0c3; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.wanted = True
        """Whether to show it if there is something to show."""
        # The robot is shown where it was; the mouse cannot move it.
        self._world = WorldView(lambda pose, done: None, lambda boxes, index: None)
        self._world.disabled = True
        self._source = LinesView()
        self._arrays = Arrays()
        self._places: dict[int, WorldAt | None] = {}
        self._asked: set[int] = set()
        self._model: Model | None = None
        self._laid: WorldAt | None = None

    def compose(self) -> ComposeResult:
        """Create the child widgets."""
        for title, view in (("World", self._world), ("Source", self._source)):
            frame = Vertical(view, classes="frame")
            frame.border_title = title
            yield frame
        yield self._arrays

    def on_resize(self) -> None:
        """Hide the pixels if there is little room."""
        self._arrays.display = self.size.height >= 34
        self.call_after_refresh(self.show_again)

    def show_again(self) -> None:
        """Redraw what was shown last."""
        if self._model is not None:
            self.show(self._model)

    def take(self, model: Model) -> None:
        """Switch to another log."""
        self._model, self._laid = model, None
        self._places.clear()
        self._asked.clear()
        self.display = self.wanted and tells_places(model.subject)
        self.show(model)

    def show(self, model: Model) -> None:
        """Show the row of the cursor."""
        self._model = model
        if not model.log.rows or not self.display:
            return
        run = model.run_of(model.row)
        if run not in self._asked:
            self._asked.add(run)
            self.run_worker(partial(self._prepare, model, run), thread=True, group="places")
        place = self._places.get(run)
        if place is None:
            note = NO_PLACE if run in self._places else "The mat is being prepared …"
            self._source.set_lines([[(note, _DIM)]])
            return
        snapshot = place.at(model.time_of(model.row), model.row)
        if place is not self._laid:
            self._laid = place
            self._world.set_mat(place.mat.pixels)
        self._world.show(snapshot)
        if self._arrays.display:
            self._arrays.show(snapshot)
        self._source.set_lines(self._lines(place, model.printed_line() or snapshot.line))

    def _prepare(self, model: Model, run: int) -> None:
        place = place_of(model.subject, run)
        self.app.call_from_thread(self._prepared, model, run, place)

    def _prepared(self, model: Model, run: int, place: WorldAt | None) -> None:
        if model is self._model:
            self._places[run] = place
            self.show(model)

    def _lines(self, place: WorldAt, line: int) -> list[list[Run]]:
        """Return the program around a line, with that line in the middle."""
        texts = source_lines(place.text)
        height, width = self._source.size.height, self._source.size.width
        if not texts or not height:
            return [[(f"line {line}", _PLAIN)]]
        first = min(max(line - 1 - height // 2, 0), max(len(texts) - height, 0))
        shown: list[list[Run]] = []
        for number, text in enumerate(texts[first : first + height], first + 1):
            here = number == line
            shown.append(
                [(f"{number:>3} ", _HERE if here else _DIM), (printable(text).ljust(width), _HERE if here else _PLAIN)]
            )
        return shown
