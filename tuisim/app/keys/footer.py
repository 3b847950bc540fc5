"""The footer: as many available keys as fit, and the state of the run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from rich.style import Style
from rich.text import Text
from textual import events
from textual.widget import Widget

from tuisim.app.keys.action import ACT, Act, Action, KeyWord

_ALWAYS = ("help", "quit", "leave")

FIELD_KEYS: tuple[KeyWord, ...] = (("⏎", "apply"), ("esc", "leave"), ("tab", "next"))
"""Keys of a text field, where letters are not keys."""
TYPING_KEYS: tuple[KeyWord, ...] = (
    ("esc", "done"), ("^s", "save"), ("^r", "run"), ("^f", "find"), ("^g", "line"), ("^z", "undo"), ("^y", "redo"),
    ("^/", "comment"),
)  # fmt: skip
"""Keys while the user types in the program."""


def fitting(actions: Sequence[Action[Any, Any]], width: int) -> list[Action[Any, Any]]:
    """Return the actions that fit a footer, the keys for help and for leaving before any other.

    Args:
        actions: The available ones, the most useful first.
        width: Cells.
    """
    always = [action for action in actions if action.id in _ALWAYS]
    left = width - sum(map(_cells, always))
    chosen = []
    for action in actions:
        if action.footer and action not in always and _cells(action) <= left:
            left -= _cells(action)
            chosen.append(action)
    return chosen + always


def _cells(action: Action[Any, Any]) -> int:
    return len(_key(action)) + len(action.footer) + 2


def _key(action: Action[Any, Any]) -> str:
    return action.footer_key or action.key_label


class KeyFooter(Widget):
    """The bottom row of the screen."""

    DEFAULT_CSS = "KeyFooter { dock: bottom; height: 1; }"
    ALLOW_SELECT = False
    COMPONENT_CLASSES: ClassVar[set[str]] = {"footer--key", "footer--status", "footer--failed", "footer--off"}

    def __init__(self) -> None:
        super().__init__(id="footer")
        self._actions: Sequence[Action[Any, Any]] = ()
        self._status = ""
        self._failed = False
        self._off: frozenset[str] = frozenset()
        self._typing: tuple[KeyWord, ...] = ()

    def show(
        self,
        actions: Sequence[Action[Any, Any]],
        status: str = "",
        off: frozenset[str] = frozenset(),
        typing: tuple[KeyWord, ...] = (),
        failed: bool = False,
    ) -> None:
        """Show the keys that are available.

        Args:
            actions: The available actions, the most useful first.
            status: State of the run, at the right.
            off: Ids of the actions whose keys are shown as switched off.
            typing: Keys of the text field that has the focus, where letters are not keys.
            failed: Whether the run has failed, so that its state is shown as a warning.
        """
        now = actions, status, off, typing, failed
        if now != (self._actions, self._status, self._off, self._typing, self._failed):
            self._actions, self._status, self._off, self._typing, self._failed = now
            self.refresh()

    def render(self) -> Text:
        """Return the content."""
        width = self.size.width
        status = f" {self._status} " if self._status else ""
        key_style = self.get_component_rich_style("footer--key", partial=True)
        line = Text(no_wrap=True, end="")
        for key, word in self._typing:
            if len(line) + len(key) + len(word) + 2 <= width - len(status):
                line.append(f" {key}", key_style)
                line.append(f" {word}")
        for action in [] if self._typing else fitting(self._actions, width - len(status)):
            meta = Style(meta={ACT: action.id})
            line.append(f" {_key(action)}", key_style + meta)
            line.append(f" {action.footer}", self._word_style(action) + meta)
        line.append(" " * max(0, width - len(status) - len(line)))
        name = "footer--failed" if self._failed else "footer--status"
        line.append(status, self.get_component_rich_style(name, partial=True))
        return line

    def on_click(self, event: events.Click) -> None:
        """Run the action that was clicked."""
        if name := event.style.meta.get(ACT):
            event.stop()
            self.post_message(Act(name))

    def _word_style(self, action: Action[Any, Any]) -> Style:
        return self.get_component_rich_style("footer--off", partial=True) if action.id in self._off else Style()
