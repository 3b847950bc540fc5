"""The output panel: prints, speech and answers of a run, and the field for `input()`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.message import Message
from textual.widgets import Input, Static

from tuisim.app.panels.output_lines import Log, plain
from tuisim.app.snapshot import Snapshot
from tuisim.runs.records import OutputRow, Stream


class Answer(Input):
    """The field that answers `input()`."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("ctrl+d", "end_of_file", "End of file", show=False, priority=True),
    ]

    class EndOfFile(Message):
        """Posted when the user sends end of file instead of an answer."""

    def action_end_of_file(self) -> None:
        """Send end of file."""
        self.post_message(self.EndOfFile())


class Output(Vertical):
    """The output panel."""

    TITLE: ClassVar[str] = "Output"

    class Answered(Message):
        """Posted when the user has answered `input()`; None is end of file."""

        def __init__(self, text: str | None) -> None:
            super().__init__()
            self.text = text

    def __init__(self) -> None:
        super().__init__()
        self.border_title = self.TITLE
        self._log = Log()
        self._past_log = Log()
        """The output up to a past instant, shown instead of the whole output."""
        self._past_log.display = False
        self.asking = False
        """Whether the field for `input()` is shown."""

    def compose(self) -> ComposeResult:
        """Create the child widgets."""
        yield self._log
        yield self._past_log

    def clear(self) -> None:
        """Remove every line."""
        self._log.clear()

    def look_back(self, rows: Sequence[OutputRow] | None, before: int = 0) -> None:
        """Show the output up to a past instant: its last rows, after `before` others.

        None shows the whole output again.
        """
        self._log.display, self._past_log.display = rows is None, rows is not None
        if rows is not None:
            self._past_log.clear()
            self._past_log.add(rows, before)

    def add(self, rows: Sequence[OutputRow], skipped: int = 0) -> None:
        """Append rows; `skipped` rows before them are only counted."""
        self._log.add(rows, skipped)

    def note(self, text: str) -> None:
        """Append a line of the app itself."""
        self._log.add([OutputRow(text, 0, 0, 0, Stream.NOTE)])

    def ask(self, prompt: str) -> None:
        """Show the field for an answer, with the program's prompt before it."""
        self.asking = True
        words = plain(prompt).strip() or "The program waits for input"
        answer = Answer(placeholder="Enter sends, ctrl+d ends", compact=True)
        self.mount(Static(words, classes="prompt", markup=False), answer)
        answer.focus()

    def stop_asking(self) -> None:
        """Remove the field."""
        self.asking = False
        self.query(".prompt, Answer").remove()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self._answer(event.value)

    @on(Answer.EndOfFile)
    def _end_of_file(self, event: Answer.EndOfFile) -> None:
        event.stop()
        self._answer(None)

    def _answer(self, text: str | None) -> None:
        # The field is removed when the run reports that it no longer waits.
        self.post_message(self.Answered(text))

    def show(self, snapshot: Snapshot) -> None:
        """Do nothing: rows arrive through `add`."""
