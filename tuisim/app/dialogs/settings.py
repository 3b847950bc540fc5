"""The settings screen: every setting of `config.toml` with its value, and what it accepts."""

from __future__ import annotations

from collections.abc import Callable
from typing import ClassVar

from rich.table import Table
from rich.text import Text
from textual import on
from textual.app import ComposeResult
from textual.binding import BindingType
from textual.widgets import OptionList, Static
from textual.widgets.option_list import Option

from tuisim.app.dialogs.chooser import ChoiceGroup, Chooser
from tuisim.app.dialogs.dialog import Dialog, name_and_title
from tuisim.app.dialogs.question import LinePrompt
from tuisim.base.errors import TuisimError
from tuisim.engine.files import Scalar
from tuisim.settings.user_config import FILE, SETTINGS, THEME, Section, Setting, UserConfig

Change = Callable[[Setting, Scalar | None], None]
"""Writes a setting to `config.toml` and applies it; None restores the setting's default. Raises TuisimError."""


_NAME_CELLS = 13


def format_value(value: Scalar) -> str:
    """Return the value of a setting as the user types it, without quotes."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def describe_setting(setting: Setting) -> str:
    """Return the help of a setting, followed by its allowed values if the help does not list them."""
    listed = all(
        str(word) in setting.help for word in setting.value.choices or [setting.value.allowed]
    )
    return setting.help if listed else f"{setting.help} Allowed: {setting.value.allowed}."


def parse_value(setting: Setting, text: str) -> Scalar:
    """Return the value that a typed text stands for.

    This is a number if the setting takes numbers and the text is one. Otherwise, the text is returned unchanged.
    """
    if not isinstance(setting.default, int | float):
        return text.strip()
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            continue
    return text.strip()


class SettingsScreen(Dialog[None]):
    """The dialog with the settings; it writes each change to the file when the user makes it.

    Args:
        change: Called with a setting and its new value, None for the default; writes and applies it.
        themes: Returns a new dialog of the themes.
    """

    TITLE_TEXT: str = "Settings"
    HINT: str = "Enter changes · Delete resets · Escape closes"
    BINDINGS: ClassVar[list[BindingType]] = [("delete,backspace", "usual", "Back to the default")]

    def __init__(self, change: Change, themes: Callable[[], Dialog[str]]) -> None:
        super().__init__()
        self._change = change
        self._themes = themes

    def compose_content(self) -> ComposeResult:
        config = UserConfig.load()
        yield Static(str(config.path), id="where", markup=False)
        yield OptionList(*self._build_options(config), markup=False)
        yield Static(id="about", markup=False)
        yield Static(id="message", markup=False)

    def on_mount(self) -> None:
        listed = self.query_one(OptionList)
        # The first line is a heading, which cannot be chosen.
        listed.highlighted = 1
        listed.focus()
        for error in UserConfig.load().problems[:1]:
            self._report_error(error)

    def _build_options(self, config: UserConfig) -> list[Option]:
        options = []
        for section in Section:
            lines = [
                Option(_build_line(setting, config), id=path)
                for path, setting in SETTINGS.items()
                if setting.section is section
            ]
            if lines:
                options += [Option(Text(f"[{section}]", "italic"), disabled=True), *lines]
        return options

    @property
    def _selected_setting(self) -> Setting:
        """The setting that is selected in the list."""
        listed = self.query_one(OptionList)
        name = listed.get_option_at_index(listed.highlighted or 0).id
        return SETTINGS[name or THEME]

    @on(OptionList.OptionHighlighted)
    def _explain_selected(self) -> None:
        setting = self._selected_setting
        parts = [describe_setting(setting)]
        if setting.section is Section.SIMULATION:
            parts.append(
                "For the app and `tuisim run`, but not with a world file, goals or a lesson."
            )
        if not setting.is_live:
            parts.append("Applies from the next start on.")
        self.query_one("#about", Static).update(" ".join(parts))

    @on(OptionList.OptionSelected)
    def _edit(self) -> None:
        setting = self._selected_setting
        value = UserConfig.load().value(self._selected_setting.path)
        if isinstance(value, bool):
            self._choose(setting, not value)
            return
        if setting.path == THEME:
            self.app.push_screen(self._themes(), self._handle_choice)
            return
        names = setting.value.choices
        if names and not isinstance(setting.default, int | float):
            group = ChoiceGroup("", [(name, name, "") for name in map(str, names)])
            self.app.push_screen(
                Chooser(setting.path, [group], format_value(value)), self._handle_choice
            )
            return
        self.app.push_screen(
            LinePrompt(
                setting.path, self._write_typed, format_value(value), text=describe_setting(setting)
            ),
            self._handle_closing,
        )

    def _handle_choice(self, name: str | None) -> None:
        if name is not None:
            self._choose(self._selected_setting, name)

    def _choose(self, setting: Setting, value: Scalar) -> None:
        """Set a setting to one of its few values; for the default value, remove its line from the file."""
        self._set(setting, None if value == setting.default else value)

    def _write_typed(self, text: str) -> None:
        self._change(
            self._selected_setting,
            parse_value(self._selected_setting, text) if text.strip() else None,
        )

    def _handle_closing(self, done: bool | None) -> None:
        if done:
            self._show_change(self._selected_setting)

    def action_usual(self) -> None:
        self._set(self._selected_setting, None)

    def _set(self, setting: Setting, value: Scalar | None) -> None:
        try:
            self._change(setting, value)
        except TuisimError as error:
            self._report_error(error)
        else:
            self._show_change(setting)

    def _report_error(self, error: TuisimError) -> None:
        # The path of the file stands above the list, so the message need not repeat it.
        self.say(str(error).removeprefix(f"{UserConfig.load().path}: "), wrong=True)

    def _show_change(self, setting: Setting) -> None:
        config = UserConfig.load()
        self.query_one(OptionList).replace_option_prompt(setting.path, _build_line(setting, config))
        if config.problems:
            self._report_error(config.problems[0])
        else:
            self.say(
                f"Written to {FILE}"
                + ("" if setting.is_live else "; applies from the next start on")
            )


def _build_line(setting: Setting, config: UserConfig) -> Table:
    """Return a setting as a line of the list: its name, its value, and whether the user has set it."""
    value = format_value(config.value(setting.path)) or "–"
    return name_and_title(
        setting.name, f"{value}  (yours)" if setting.path in config.written else value, _NAME_CELLS
    )
