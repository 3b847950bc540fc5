"""A question with a few answers, each a key and a word to click on."""

from __future__ import annotations

from collections.abc import Sequence

from textual import events
from textual.app import ComposeResult
from textual.widgets import Static

from tuisim.ui.screens.dialog import Dialog

Answer = tuple[str, str]
"""A key, and what it does. The key is the answer."""


class Question(Dialog[str]):
    """Gives the key of the answer, None if it was left by Escape.

    Args:
        title: What it is about.
        text: What is asked.
        answers: The first is also given by Enter.
        escape: What Escape does.
    """

    def __init__(self, title: str, text: str, answers: Sequence[Answer], escape: str = "decides later") -> None:
        super().__init__()
        self.HINT = f"Escape {escape}"
        self.TITLE_TEXT = title.replace("[", "\\[")
        self._text = text
        self._answers = answers

    def content(self) -> ComposeResult:
        """The question, and its answers."""
        yield Static(self._text, markup=False)
        yield Static()
        words = (f"[@click=screen.answer('{key}')]  {key}  {does}  [/]" for key, does in self._answers)
        yield Static("   ".join(words), classes="link")

    def on_key(self, event: events.Key) -> None:
        """Take an answer."""
        key = self._answers[0][0] if event.key == "enter" else event.key
        if key in dict(self._answers):
            event.stop()
            self.action_answer(key)

    def action_answer(self, key: str) -> None:
        """Give an answer."""
        self.dismiss(key)
