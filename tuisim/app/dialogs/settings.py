"""The settings screen: every setting of `config.toml` with its value, and what it accepts."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.chooser import ChoiceGroup, Chooser
from tuisim.app.dialogs.dialog import Dialog, name_and_title
from tuisim.app.dialogs.question import LinePrompt
from tuisim.base.errors import TuisimError
from tuisim.engine.files import Scalar
from tuisim.settings.user_config import (
    FILE,
    SETTINGS,
    THEME,
    Section,
    Setting,
    UserConfig,
    load_config,
)

Change = Callable[[Setting, Scalar | None], None]
"""Writes a setting and applies it; None for the usual value. Raises TuisimError."""


_NAME_CELLS = 13


def in_words(value: Scalar) -> str:
    """Return a value as the user writes it, without quotes."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def about(one: Setting) -> str:
    """Return what a setting does, and what it accepts unless the help has listed it."""
    listed = all(str(word) in one.help for word in one.value.choices or [one.value.allowed])
    return one.help if listed else f"{one.help} Allowed: {one.value.allowed}."


def typed_value(one: Setting, text: str) -> Scalar:
    """Return what was typed as a value of the file: a number where the setting takes one."""
    if not isinstance(one.default, int | float):
        return text.strip()
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text.strip()


class SettingsScreen(Dialog[None]):
    """The settings; a change is written at once.

    Args:
        change: What writes and applies a setting.
        themes: Makes the dialog of the themes.
    """

    TITLE_TEXT: str = "Settings"
    HINT: str = "Enter changes · Delete resets · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("delete,backspace", "usual", "Back to the default", show=False)
    ]

    def __init__(self, change: Change, themes: Callable[[], Dialog[str]]) -> None:
        super().__init__()
        self._change = change
        self._themes = themes

    def content(self) -> ComposeResult:
        config = load_config()
        yield Static(str(config.path), id="where", markup=False)
        yield OptionList(*self._options(config), markup=False)
        yield Static(id="about", markup=False)
        yield Static(id="message", markup=False)

    def on_mount(self) -> None:
        listed = self.query_one(OptionList)
        # The first line is a heading.
        listed.highlighted = 1
        listed.focus()
        for error in load_config().problems[:1]:
            self._complain(error)

    def _options(self, config: UserConfig) -> list[Option]:
        options = []
        for section in Section:
            lines = [
                Option(_line(one, config), id=path)
                for path, one in SETTINGS.items()
                if one.section is section
            ]
            if lines:
                options += [Option(Text(f"[{section}]", "italic"), disabled=True), *lines]
        return options

    @property
    def _one(self) -> Setting:
        """The selected setting."""
        listed = self.query_one(OptionList)
        name = listed.get_option_at_index(listed.highlighted or 0).id
        return SETTINGS[name or THEME]

    @on(OptionList.OptionHighlighted)
    def _highlighted(self) -> None:
        one = self._one
        parts = [about(one)]
        if one.section is Section.SIMULATION:
            parts.append(
                "For the app and `tuisim run`, but not with a world file, goals or a lesson."
            )
        if not one.is_live:
            parts.append("Applies from the next start on.")
        self.query_one("#about", Static).update(" ".join(parts))

    @on(OptionList.OptionSelected)
    def _edit(self) -> None:
        one, value = self._one, load_config().value(self._one.path)
        if isinstance(value, bool):
            self._choose(one, not value)
            return
        if one.path == THEME:
            self.app.push_screen(self._themes(), self._chosen)
            return
        names = one.value.choices
        if names and not isinstance(one.default, int | float):
            group = ChoiceGroup("", [(name, name, "") for name in map(str, names)])
            self.app.push_screen(Chooser(one.path, [group], in_words(value)), self._chosen)
            return
        self.app.push_screen(
            LinePrompt(one.path, self._typed, in_words(value), text=about(one)), self._entered
        )

    def _chosen(self, name: str | None) -> None:
        if name is not None:
            self._choose(self._one, name)

    def _choose(self, one: Setting, value: Scalar) -> None:
        """Set one of a few values; the usual one needs no line in the file."""
        self._set(one, None if value == one.default else value)

    def _typed(self, text: str) -> None:
        self._change(self._one, typed_value(self._one, text) if text.strip() else None)

    def _entered(self, done: bool | None) -> None:
        if done:
            self._changed(self._one)

    def action_usual(self) -> None:
        self._set(self._one, None)

    def _set(self, one: Setting, value: Scalar | None) -> None:
        try:
            self._change(one, value)
        except TuisimError as error:
            self._complain(error)
        else:
            self._changed(one)

    def _complain(self, error: TuisimError) -> None:
        # The path of the file stands above the list.
        self.say(str(error).removeprefix(f"{load_config().path}: "), wrong=True)

    def _changed(self, one: Setting) -> None:
        config = load_config()
        self.query_one(OptionList).replace_option_prompt(one.path, _line(one, config))
        if config.problems:
            self._complain(config.problems[0])
        else:
            self.say(
                f"Written to {FILE}" + ("" if one.is_live else "; applies from the next start on")
            )


def _line(one: Setting, config: UserConfig) -> Table:
    """Return the line of a setting: its name, its value, and whether that is the user's own."""
    value = in_words(config.value(one.path)) or "–"
    return name_and_title(
        one.name, f"{value}  (yours)" if one.path in config.written else value, _NAME_CELLS
    )
