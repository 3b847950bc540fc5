"""Questions with a few answers, each with a key and a clickable word."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, ClassVar

from textual import events
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import Static

from tuisim.app.dialogs.dialog import Dialog

if TYPE_CHECKING:
    from tuisim.app.branch import Branch

Answer = tuple[str, str]
"""A key, and what it does. The key is the result."""


class Question(Dialog[str]):
    """Returns the key of the answer, None on Escape.

    Args:
        title: The subject.
        text: The question.
        answers: Enter gives the first one.
        escape: Text of what Escape does.
    """

    def __init__(self, title: str, text: str, answers: Sequence[Answer], escape: str = "decides later") -> None:
        super().__init__()
        self.HINT = f"Escape {escape}"
        self.TITLE_TEXT = title.replace("[", "\\[")
        self._text = text
        self._answers = answers

    def content(self) -> ComposeResult:
        """Return the question and its answers."""
        yield Static(self._text, markup=False)
        yield Static()
        words = (f"[@click=screen.answer('{key}')]  {key}  {does}  [/]" for key, does in self._answers)
        yield Static("   ".join(words), classes="link")

    def on_key(self, event: events.Key) -> None:
        """Handle the key of an answer."""
        key = self._answers[0][0] if event.key == "enter" else event.key
        if key in dict(self._answers):
            event.stop()
            self.action_answer(key)

    def action_answer(self, key: str) -> None:
        """Return an answer."""
        self.dismiss(key)


BRANCH, RESTART = "branch", "restart"


class BranchQuestion(Dialog[str]):
    """Returns `BRANCH`, `RESTART` or None.

    Args:
        branch: The proposed branch.
        change: What differs there, in words, or empty.
        in_run: Whether the former run is still live, and ends with this.
        restart: Whether to offer a run from the start.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y,enter", "branch", "Branch", show=False),
        Binding("r", "restart", "From the start", show=False),
        Binding("n", "leave", "Stay", show=False),
    ]

    def __init__(self, branch: Branch, change: str, in_run: bool, restart: bool) -> None:
        super().__init__()
        self.TITLE_TEXT = f"Branch from {branch.time_s:.2f} s?"
        self.HINT = "y branches · r runs from the start · n stays" if restart else "y branches · n stays"
        self._restart = restart
        program = "The edited program" if branch.edited else "The program"
        again = "run from its start to there" if branch.edited else "run again to there"
        ends = f" {branch.of.name.capitalize()} ends here, and is kept." if in_run else ""
        then = "continues from there" if branch.goes_on else "pauses there"
        self._text = f"{program} is {again}, with all that you did until then, and {then}{change}.{ends}"

    def content(self) -> ComposeResult:
        """Return what would happen, and the answers."""
        yield Static(self._text, markup=False)
        answers = ["[@click=screen.branch]  y  Branch  [/]", "[@click=screen.leave]  n  Stay  [/]"]
        if self._restart:
            answers.insert(1, "[@click=screen.restart]  r  Run from the start  [/]")
        yield Static("   ".join(answers))

    def action_branch(self) -> None:
        """Return `BRANCH`."""
        self.dismiss(BRANCH)

    def action_restart(self) -> None:
        """Return `RESTART`, if that is offered."""
        if self._restart:
            self.dismiss(RESTART)


class LeaveQuestion(Dialog[bool]):
    """Returns True if the user wants to quit nevertheless."""

    TITLE_TEXT: str = "Quit?"
    HINT: str = "y quits · n goes on"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("y,q,enter", "yes", "Quit", show=False),
        Binding("n", "leave", "Stay", show=False),
    ]

    def content(self) -> ComposeResult:
        """The question."""
        yield Static("A program is running. What it has logged so far is kept.", markup=False)
        yield Static("[@click=screen.yes]  y  Stop it and quit  [/]   [@click=screen.leave]  n  Stay  [/]")

    def action_yes(self) -> None:
        """Quit."""
        self.dismiss(True)
