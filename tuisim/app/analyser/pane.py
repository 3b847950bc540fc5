"""The lower half of the analyser, which shows one of the panes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from textual import events
from textual.app import ComposeResult
from textual.widget import Widget

from tuisim.app.analyser.panes import PANES, pane_lines
from tuisim.app.terminal.cell_view import LinesView
from tuisim.errors import counted

if TYPE_CHECKING:
    from tuisim.analysis.model import Model


class PaneView(Widget):
    """Shows a pane, with the titles of all panes above it."""

    ALLOW_SELECT = False
    DEFAULT_CSS = """
    PaneView { height: 1fr; border: round #44505e; border-title-color: #9fb0c3; border-subtitle-color: #87d7af; }
    PaneView > LinesView { width: 1fr; height: 1fr; }
    """

    def __init__(self) -> None:
        super().__init__()
        self.name_shown = "table"
        self.chosen = 0
        """Selected row, in all panes but the table."""
        self._text = LinesView()
        self._model: Model | None = None

    def compose(self) -> ComposeResult:
        """Create the child widgets."""
        yield self._text

    @property
    def lines(self) -> int:
        """The number of visible rows."""
        return max(self._text.size.height - 1, 1)

    def turn_to(self, name: str) -> None:
        """Switch to another pane."""
        self.name_shown, self.chosen = name, 0

    def show(self, model: Model) -> None:
        """Draw the current view of the model."""
        self._model = model
        # Brackets mark the current pane even without colours.
        titles = (f"\\[{pane.title}]" if name == self.name_shown else pane.title for name, pane in PANES.items())
        self.border_title = " ".join(titles)
        self.border_subtitle = _told(model) if self.name_shown == "table" else ""
        width, height = self._text.size
        if width and height and self.display:
            self._text.set_lines(pane_lines(self.name_shown, model, self.chosen, width, height))

    def on_resize(self, event: events.Resize) -> None:
        """Draw for the new size."""
        self.call_after_refresh(self._again)

    def _again(self) -> None:
        if self._model is not None:
            self.show(self._model)


def _told(model: Model) -> str:
    """Return a summary of what the table shows."""
    rows, total = model.rows, model.log.rows
    words = f"{len(rows):,} of {total:,} rows" if len(rows) != total else counted(total, "row")
    conditions = " and ".join(map(str, rows.conditions))
    return f"{words}: {conditions}".replace("[", "\\[") if conditions else words
