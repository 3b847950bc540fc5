"""The keys of an app: the class of a table's entry, what runs it, and where it is shown: footer, help, command
palette."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, ClassVar, Generic, TypeVar

from rich.console import Console, Group
from rich.style import Style
from rich.table import Table
from rich.text import Text
from textual import events, on
from textual.app import App
from textual.binding import Binding, BindingType
from textual.dom import DOMNode
from textual.keys import format_key
from textual.message import Message
from textual.screen import Screen
from textual.widget import Widget

from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.base.errors import TuisimError
from tuisim.terminal.text_runs import escape_markup
from tuisim.terminal.textual_internals import find_bindings, is_leaving

ACT = "act"
"""Key in the metadata of a Rich style: its value is the id of the action that a click on the text runs."""

KeyWord = tuple[str, str]
"""The display name of a key, and what the key does, in words."""

Host = TypeVar("Host")
Now = TypeVar("Now")


@dataclass
class Act(Message):
    """Posted when the user has clicked a word that stands for an action."""

    action: str


@dataclass(frozen=True, slots=True)
class Action(Generic[Host, Now]):
    """An action that a key runs: its key, its function, and its texts for footer, help and command palette."""

    id: str
    key: str
    """The key that runs the action, in Textual's notation; several keys are separated by commas."""
    title: str
    group: str
    do: Callable[[Host], None]
    why_not: Callable[[Now], str] = lambda _: ""
    """Returns why the key is unavailable now; empty if it is available."""
    footer: str = ""
    """Short label of the action in the footer; empty if the footer does not show the action."""
    shown_key: str = ""
    """Display name of the key for people; empty for the usual display name of `key`."""
    footer_key: str = ""
    """Display name of the keys in the footer, such as `[ ]` for the keys of two actions; empty for that of `key`."""
    words: str = ""
    """Further words by which the command palette finds the action."""
    comes_first: bool = False
    """Whether the app gets the key before the widget with the focus, unless `check_action` of the app refuses it."""

    @property
    def key_label(self) -> str:
        """The display name of the action's key."""
        return self.shown_key or ", ".join(map(label_of_key, self.key.split(",")))


_LABELS = {
    "full_stop": ".",
    "left_square_bracket": "[",
    "right_square_bracket": "]",
    "question_mark": "?",
    "comma": ",",
    "colon": ":",
    "slash": "/",
    "asterisk": "*",
    "number_sign": "#",
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
_WORDS = frozenset(
    {"space", "home", "end", "escape", "enter", "tab", "delete", "backspace", "insert"}
)
"""Keys in Textual's notation that are shown to the user under the same name."""


def label_of_key(key: str) -> str:
    """Return the display name of a key that is given in Textual's notation."""
    modifier, _, name = key.rpartition("+")
    label = _LABELS.get(name) or (name if name in _WORDS else format_key(name))
    if len(label) in (2, 3) and label[0] == "f" and label[1:].isdigit():
        label = label.upper()
    if modifier == "shift":
        return f"⇧{label}"
    if modifier:
        return f"{modifier}+{label}"
    return label


def build_bindings(actions: Iterable[Action[Any, Any]]) -> list[BindingType]:
    """Return the bindings with which Textual runs actions by their keys."""
    return [
        Binding(action.key, _call(action), action.title, priority=action.comes_first)
        for action in actions
    ]


def list_bindings(kind: type[DOMNode]) -> list[Binding]:
    """Return the bindings that a class itself has, without those of its base classes."""
    bindings = kind.__dict__.get("BINDINGS", ())
    return [Binding(*bound) if isinstance(bound, tuple) else bound for bound in bindings]


def _call(action: Action[Any, Any]) -> str:
    return f"act('{action.id}')"


def fill_keys(app: App[Any], text: str) -> str:
    """Return `text` with each action id in braces, such as `{run}`, replaced by the key of that action."""
    return app.fill_keys(text) if isinstance(app, ActionHost) else text


def action_link(app: App[Any], action: str, word: str) -> str:
    """Return markup with the key of an action, given by its id, and a word; a click on either runs the action."""
    key = escape_markup(fill_keys(app, f"{{{action}}}"))
    return f"[@click=app.act('{action}')]{key} {word}[/]"


_ID = re.compile(r"\{([a-z-]+)\}")


class ActionHost(DOMNode):
    """An app or a screen that runs the action of a pressed key; the command palette lists the actions by title."""

    ACTIONS: Mapping[str, Action[Any, Any]] = {}
    """The actions by id."""

    def take_keys(self, actions: Mapping[str, Action[Any, Any]]) -> None:
        """Replace the keys of the actions by other keys.

        Args:
            actions: The table of the same actions with their new keys; nothing else may differ.
        """
        changed = [
            action for name, action in actions.items() if action.key != self.ACTIONS[name].key
        ]
        calls = {_call(action) for action in changed}
        bindings = find_bindings(self).key_to_bindings
        for key, bound in [*bindings.items()]:
            if kept_bindings := [binding for binding in bound if binding.action not in calls]:
                bindings[key] = kept_bindings
            else:
                del bindings[key]
        for action in changed:
            for key in action.key.split(","):
                find_bindings(self).bind(
                    key, _call(action), action.title, priority=action.comes_first
                )
        self.ACTIONS = actions

    def find_situation(self) -> Any:
        """Return the state that decides which actions are available; an action's `why_not` gets it."""

    def action_target(self) -> Any:
        """Return the object that the functions of the actions get as their first argument."""
        return self

    def action_act(self, name: str) -> None:
        if is_leaving(self.app):
            return
        action = self.ACTIONS[name]
        if reason := action.why_not(self.find_situation()):
            self.say(reason)
            return
        try:
            action.do(self.action_target())
        except TuisimError as error:
            self.complain(error)

    def on_act(self, message: Act) -> None:
        message.stop()
        self.action_act(message.action)

    def say(self, text: str) -> None:
        """Show a short notice, for as long as it takes to read the notice."""
        self.app.notify(self.fill_keys(text))

    def fill_keys(self, text: str) -> str:
        """Return `text` with each action id in braces, such as `{run}`, replaced by the key of that action.

        Other words in braces stay as they are.
        """
        return _ID.sub(
            lambda match: (
                self.ACTIONS[match[1]].key_label if match[1] in self.ACTIONS else match[0]
            ),
            text,
        )

    def complain(self, error: TuisimError) -> None:
        """Show an error to the user."""
        self.app.notify(str(error), severity="error", timeout=8)


_ALWAYS = ("palette", "help", "quit", "leave")

FIELD_KEYS: tuple[KeyWord, ...] = (("enter", "apply"), ("esc", "leave"), ("tab", "next"))
"""Keys in the footer while a text field has the focus, which takes all letters itself."""
TYPING_KEYS: tuple[KeyWord, ...] = (
    ("esc", "done"),
    ("^s", "save"),
    ("^r", "run"),
    ("^f", "find"),
    ("tab", "complete"),
    ("^g", "line"),
    ("^z", "undo"),
    ("^p", "all"),
    ("^y", "redo"),
    ("^/", "comment"),
)
"""Keys in the footer while the user types in the program."""

CLICKED_KEYS: tuple[KeyWord, ...] = (("letters", "edit"), ("esc", "keys"), ("^p", "all"))
"""Keys in the footer after a click into the program: the next letter starts typing."""


def find_panel_keys(focused: DOMNode | None) -> tuple[KeyWord, ...]:
    """Return the keys that the footer shows for the focused widget: its constant `FOOTER_KEYS`.

    If the widget has no such constant, use the nearest widget around it that has one. The tuple is empty if there is
    none, or if no widget has the focus.
    """
    around = focused.ancestors_with_self if focused else ()
    return next((node.FOOTER_KEYS for node in around if hasattr(node, "FOOTER_KEYS")), ())


BETWEEN_GROUPS = " │"
_FEWEST = 9
_FEWEST_AT = 80
_COLUMNS_FOR_ONE = 20
"""A footer has at most `_FEWEST` entries at `_FEWEST_AT` columns, and one more for so many further columns."""


def find_max_entries(columns: int) -> int:
    """Return the largest number of entries that the footer may show in a terminal with this number of columns."""
    return _FEWEST + max(0, columns - _FEWEST_AT) // _COLUMNS_FOR_ONE


def fit_actions(
    actions: Sequence[Action[Any, Any]], width: int, max_count: int
) -> list[Action[Any, Any]]:
    """Return the actions for which a footer has room: actions of the same group side by side, help and quit at the end.

    Args:
        actions: The available actions, the most useful first.
        width: Width of the footer in cells.
        max_count: The largest number of actions to return; help and quit are returned in any case.
    """
    always = [action for action in actions if action.id in _ALWAYS]
    left = width - sum(map(_measure_action, always))
    groups: dict[str, list[Action[Any, Any]]] = {}
    for action in actions:
        if (
            not action.footer
            or action.id in _ALWAYS
            or len(always) + sum(map(len, groups.values())) >= max_count
        ):
            continue
        cells = _measure_action(action) + (0 if action.group in groups else len(BETWEEN_GROUPS))
        if cells <= left:
            left -= cells
            groups.setdefault(action.group, []).append(action)
    return [*chain.from_iterable(groups.values()), *always]


def _measure_action(action: Action[Any, Any]) -> int:
    return len(_find_key_label(action)) + len(action.footer) + 2


def _find_key_label(action: Action[Any, Any]) -> str:
    return action.footer_key or action.key_label


class ActionWords(Widget):
    """A widget with clickable words: a click on a word runs the action that the word's style names."""

    ALLOW_SELECT = False

    def on_click(self, event: events.Click) -> None:
        if name := event.style.meta.get(ACT):
            event.stop()
            self.post_message(Act(name))


async def press(screen: Screen[Any], key: str) -> None:
    """Run the action that a key has in the focused widget.

    If this widget has no action for the key, run that of the nearest widget around it that has one. If there is none,
    do nothing.
    """
    for node in (screen.focused or screen).ancestors_with_self:
        if bound := find_bindings(node).key_to_bindings.get(key):
            await screen.app.run_action(bound[0].action, node)
            return


def _find_key(x: int, words: Iterable[KeyWord]) -> str:
    """Return the key of the entry at column `x` of a row of entries; empty if `x` is behind the last one."""
    end = 0
    for key, word in words:
        end += len(key) + len(word) + 2
        if x < end:
            return key
    return ""


_KEYS_OF_FIELDS = {"esc": "escape", "↑": "up"}


class KeyFooter(ActionWords):
    """The bottom row of the screen, with the keys that work now and the state of the run."""

    DEFAULT_CSS = "KeyFooter { dock: bottom; height: 1; }"
    COMPONENT_CLASSES: ClassVar[set[str]] = {"footer--key", "footer--status", "footer--failed"}

    def __init__(self) -> None:
        super().__init__(id="footer")
        self._actions: Sequence[Action[Any, Any]] = ()
        self._status = ""
        self._failed = False
        self._typing: tuple[KeyWord, ...] = ()
        self._of_dialog: tuple[KeyWord, ...] = ()

    def show_dialog(self, keys: tuple[KeyWord, ...]) -> None:
        """Show only the keys of the open dialog; an empty tuple shows the usual keys again."""
        if keys != self._of_dialog:
            self._of_dialog = keys
            self.refresh()

    def find_dialog_key(self, x: int) -> str:
        """Return the display name of the dialog's key at column `x` of the footer; empty if there is none."""
        return _find_key(x, self._of_dialog)

    @on(events.Click)
    async def press_key_of_field(self, event: events.Click) -> None:
        """If a key of the focused text field was clicked in the footer, press that key.

        With a click, the user of a phone can press keys that the phone's keyboard lacks, such as Escape.
        """
        if not self._of_dialog and (label := _find_key(event.x, self._typing)):
            # The click must not reach the app, which would move the focus from the field to the world.
            event.stop()
            await press(self.screen, _KEYS_OF_FIELDS.get(label, label.replace("^", "ctrl+")))

    def show(
        self,
        actions: Sequence[Action[Any, Any]],
        status: str = "",
        typing: tuple[KeyWord, ...] = (),
        failed: bool = False,
    ) -> None:
        """Show the keys that are available.

        Args:
            actions: The available actions, the most useful first.
            status: State of the run, at the right.
            typing: Keys of the text field that has the focus; they come before the actions.
            failed: Whether the run has failed, so that its state is shown as a warning.
        """
        now = actions, status, typing, failed
        if now != (self._actions, self._status, self._typing, self._failed):
            self._actions, self._status, self._typing, self._failed = now
            self.refresh()

    def render(self) -> Text:
        width = self.size.width
        status = f"  {self._status}" if self._status else ""
        key_style = self.get_component_rich_style("footer--key", partial=True)
        line = Text(no_wrap=True, end="")
        max_count = find_max_entries(width)
        for key, word in (self._of_dialog or self._typing)[:max_count]:
            if len(line) + len(key) + len(word) + 2 <= width - len(status):
                line.append(f" {key}", key_style)
                line.append(f" {word}")
        actions = () if self._of_dialog else self._actions
        shown_actions = fit_actions(
            actions, width - len(status) - len(line), max_count - len(self._typing)
        )
        for before, action in zip([None, *shown_actions], shown_actions, strict=False):
            if before and before.group != action.group:
                line.append(BETWEEN_GROUPS, Style(color=palette.LINE))
            meta = Style(meta={ACT: action.id})
            line.append(f" {_find_key_label(action)}", key_style + meta)
            line.append(f" {action.footer}", meta)
        line.append(" " * max(0, width - len(status) - len(line)))
        name = "footer--failed" if self._failed else "footer--status"
        line.append(status, self.get_component_rich_style(name, partial=True))
        return line


COLUMN_CELLS = 50
"""Minimum width in cells of a column of the key table; a narrower table has fewer columns."""


def build_key_table(groups: Mapping[str, Iterable[KeyWord]], width: int) -> Text:
    """Return a table of keys by group, `width` cells wide, in as many columns as fit; a group named "" has no heading.

    The table is one text, not nested tables, which Textual would measure and draw several times.
    """
    rows = [(group, list(keys)) for group, keys in groups.items()]
    count = max(1, min(width // COLUMN_CELLS, len(rows)))
    columns = Table.grid(padding=(0, 2), expand=True)
    for _ in range(count):
        columns.add_column(ratio=1)
    columns.add_row(*map(_build_column, _distribute_groups(rows, count)))
    text = Text(no_wrap=True)
    for segment in Console(width=width, color_system="truecolor").render(columns):
        text.append(segment.text, segment.style)
    text.right_crop(1)
    return text


_Group = tuple[str, list[KeyWord]]


def _distribute_groups(groups: list[_Group], count: int) -> list[list[_Group]]:
    """Return the groups in `count` columns, in their order, so that the longest column is as short as possible."""

    def fill_columns(max_rows: int) -> list[list[_Group]]:
        columns: list[list[_Group]] = [[]]
        left = max_rows
        for name, keys in groups:
            rows = len(keys) + 2
            if rows > left and columns[-1]:
                columns.append([])
                left = max_rows
            columns[-1].append((name, keys))
            left -= rows
        return columns

    lowest = next(max_rows for max_rows in range(1, 10_000) if len(fill_columns(max_rows)) <= count)
    columns = fill_columns(lowest)
    return columns + [[] for _ in range(count - len(columns))]


_KEY_CELLS = 9
"""Minimum width in cells of the key names beside what the keys do, so that most groups of keys are aligned."""


def _build_column(groups: list[_Group]) -> Group:
    tables = []
    for group, keys in groups:
        table = Table.grid(padding=(0, 2))
        table.add_column(justify="right", style="bold", min_width=_KEY_CELLS)
        table.add_column()
        if group:
            table.add_row("", Text(group, f"bold {palette.BLUE}"))
        for key, title in keys:
            table.add_row(Text(key), Text(title))
        table.add_row()
        tables.append(table)
    return Group(*tables)


def group_keys(actions: Iterable[Action[Any, Any]]) -> dict[str, list[KeyWord]]:
    """Return the keys of actions as one list for each group, by the name of the group."""
    groups: dict[str, list[KeyWord]] = {}
    for action in actions:
        groups.setdefault(action.group, []).append((action.key_label, action.title))
    return groups
