"""The actions of keys: a line of a table of keys, what runs them, and the command palette that offers them by title."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Any, ClassVar, Generic, TypeVar

from textual.binding import Binding, BindingType
from textual.command import CommandList, CommandPalette, DiscoveryHit, Hit, Hits, Provider
from textual.message import Message
from textual.message_pump import MessagePump

from tuisim.app.background import is_leaving
from tuisim.app.dialogs.dialog import ClosesOnce
from tuisim.errors import TuisimError

ACT = "act"
"""Key of the style metadata that names the action of a clickable word."""

KeyWord = tuple[str, str]
"""The display name of a key, and what it does."""

Host = TypeVar("Host")
Now = TypeVar("Now")


class Act(Message):
    """Posted when a word that stands for an action was clicked."""

    def __init__(self, action: str) -> None:
        super().__init__()
        self.action = action


@dataclass(frozen=True, slots=True)
class Action(Generic[Host, Now]):
    """One line of a table of keys."""

    id: str
    key: str
    """In Textual's notation; several keys are separated by commas."""
    title: str
    group: str
    do: Callable[[Host], None]
    why_not: Callable[[Now], str] = lambda _: ""
    """Why the key is unavailable now; empty if it is available."""
    footer: str = ""
    """Short label for the footer; empty leaves the key out of it."""
    shown_key: str = ""
    """Display name of the key, if it differs from that of `key`."""
    footer_key: str = ""
    """Display name in the footer, if that entry stands for two keys."""

    @property
    def key_label(self) -> str:
        """The display name of the key."""
        return self.shown_key or ", ".join(map(_label, self.key.split(",")))


_LABELS = {
    "full_stop": ".",
    "left_square_bracket": "[",
    "right_square_bracket": "]",
    "question_mark": "?",
    "comma": ",",
    "colon": ":",
    "slash": "/",
    "plus": "+",
    "equals_sign": "=",
    "less_than_sign": "<",
    "greater_than_sign": ">",
    "left_parenthesis": "(",
    "right_parenthesis": ")",
    "left": "←",
    "right": "→",
    "up": "↑",
    "down": "↓",
    "pageup": "page up",
    "pagedown": "page down",
}


def _label(key: str) -> str:
    modifier, _, name = key.rpartition("+")
    label = _LABELS.get(name, name)
    return f"⇧{label}" if modifier == "shift" else f"{modifier}+{label}" if modifier else label


def key_bindings(actions: Iterable[Action[Any, Any]]) -> list[BindingType]:
    """Return the bindings of an `ActionHost`."""
    return [Binding(action.key, f"act('{action.id}')", action.title, show=False) for action in actions]


class ActionHost(MessagePump):
    """An app or a screen whose keys are lines of a table; the command palette offers them by title."""

    ACTIONS: ClassVar[Mapping[str, Action[Any, Any]]] = {}
    """The lines by id."""

    def situation(self) -> Any:
        """Return the state that decides which keys are available."""

    def action_target(self) -> Any:
        """Return what the functions behind the keys get."""
        return self

    def action_act(self, name: str) -> None:
        """Run the action of a key, or say why it is unavailable now."""
        if is_leaving(self.app):
            return
        action = self.ACTIONS[name]
        if reason := action.why_not(self.situation()):
            self.say(reason)
            return
        try:
            action.do(self.action_target())
        except TuisimError as error:
            self.complain(error)

    def on_act(self, message: Act) -> None:
        """Run an action whose word in the footer or on a panel was clicked."""
        message.stop()
        self.action_act(message.action)

    def say(self, text: str) -> None:
        """Show a short notice."""
        self.app.notify(text, timeout=3, markup=False)

    def complain(self, error: TuisimError) -> None:
        """Show an error."""
        self.app.notify(str(error), severity="error", timeout=8, markup=False)


class Palette(CommandPalette, ClosesOnce[None]):
    """Textual's command palette, as one of the app's screens that close once."""

    def _action_command_list(self, action: str) -> None:
        # A list that was never shown has no pages and no lines yet.
        if self.query_one(CommandList).size:
            super()._action_command_list(action)


class ActionProvider(Provider):
    """Provides the actions of the screen that the palette opens above, else those of the app."""

    def _offers(self) -> Iterator[tuple[str, Callable[[], None], str]]:
        """Yield the title of each action, a call that runs it, and the text below the title."""
        host = self.screen if isinstance(self.screen, ActionHost) else self.app
        if isinstance(host, ActionHost):
            for action in host.ACTIONS.values():
                yield action.title, partial(host.action_act, action.id), f"{action.group} · key {action.key_label}"

    async def discover(self) -> Hits:
        """Yield every action, before anything is typed."""
        for title, do, text in self._offers():
            yield DiscoveryHit(title, do, help=text)

    async def search(self, query: str) -> Hits:
        """Yield the actions with a matching title."""
        matcher = self.matcher(query)
        for title, do, text in self._offers():
            if (score := matcher.match(title)) > 0:
                yield Hit(score, matcher.highlight(title), do, help=text)
