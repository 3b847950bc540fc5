"""Base of the apps: themes, the command palette, screenshots, and the minimum size of the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING, Any

from rich.control import Control
from textual import events, on
from textual.geometry import Size
from textual.notifications import SeverityLevel
from textual.screen import Screen
from textual.theme import Theme

from tuisim.app import background, design
from tuisim.app.action import ActionHost, KeyFooter, fill_keys
from tuisim.app.dialogs.dialog import ClosesOnce, Dialog
from tuisim.app.notices import Notice, Notices
from tuisim.app.themes import (
    HIGH_CONTRAST,
    LIGHT,
    OWN_THEME,
    UNUSED_THEMES,
    ThemeColors,
    list_themes,
)
from tuisim.base.errors import ConfigError, TuisimError
from tuisim.engine.files import Scalar
from tuisim.pictures.charts.traces import TRACE_COLORS
from tuisim.settings.user_config import CELL_SET, SETTINGS, THEME, UserConfig
from tuisim.terminal.app import ActionAsked, BufferedApp, offer
from tuisim.terminal.cells import PALETTE_256
from tuisim.terminal.picture_mode import (
    PictureMode,
    choose_colors,
    choose_picture_mode,
    find_color_depth,
)
from tuisim.terminal.picture_options import NO_PIXELS
from tuisim.terminal.textual_internals import SUPPORTED, Codes, is_leaving

if TYPE_CHECKING:
    from tuisim.app.dialogs.palette import ThemeChooser

MINIMUM = Size(40, 12)
"""Minimum size of the terminal: panels and dialogs are unreadable below it."""


def is_too_small(size: Size) -> bool:
    """Return whether a terminal has less than the minimum size of the apps."""
    return size.width < MINIMUM.width or size.height < MINIMUM.height


def clamp_size(size: Size) -> Size:
    """Return the size for which panels and dialogs are laid out: that of the terminal, but at least the minimum."""
    return Size(max(size.width, MINIMUM.width), max(size.height, MINIMUM.height))


def _list_wordings(size: Size) -> Iterator[str]:
    """Yield the wordings of the message that a terminal is too small, the longest first."""
    needed = f"{MINIMUM.width}×{MINIMUM.height}"
    has = f"{size.width}×{size.height}"
    yield f"Too small: tuisim needs {needed} or more, and this terminal has {has}. Enlarge it, or press q to quit."
    yield f"Too small: tuisim needs {needed}, this terminal has {has}."
    yield f"Too small: needs {needed}"
    yield "Too small"


def build_message(size: Size) -> list[str]:
    """Return the message that a terminal is too small, as lines: the longest wording that fits."""
    for wording in _list_wordings(size):
        lines = wrap(wording, max(size.width, 1), break_long_words=False)
        if len(lines) <= size.height and all(len(line) <= size.width for line in lines):
            return lines
    return ["!"]


def _build_codes(size: Size) -> str:
    lines = build_message(size)
    top = (size.height - len(lines)) // 2
    rows = (Control.move_to(0, top + row).segment.text + line for row, line in enumerate(lines))
    return "\x1b[0m\x1b[2J" + "".join(rows)


class TerminalApp(BufferedApp):
    """Base of the apps in a terminal or a browser: themes, a command palette, notices, and a minimum size."""

    TITLE = "tuisim"
    NOTIFICATION_TIMEOUT = 4
    # The app has its own command palette.
    ENABLE_COMMAND_PALETTE = False

    def __init__(self, picture_mode: PictureMode | None = None) -> None:
        super().__init__(picture_mode)
        self.notices = Notices(self)
        """The notices to the user."""
        self.too_small: Size | None = None
        """Size of a terminal that is too small, else None."""
        for theme in (HIGH_CONTRAST, LIGHT):
            self.register_theme(theme)
        for name in UNUSED_THEMES:
            self.unregister_theme(name)
        if (chosen := str(UserConfig.load().value(THEME))) in self.available_themes:
            self.theme = chosen
        self._take_theme()

    def get_theme_variable_defaults(self) -> dict[str, str]:
        """Return the colours of the palette by their names in style sheets, such as `tuisim-ink`."""
        return {
            f"tuisim-{name.lower().replace('_', '-')}": color
            for name, color in design.COLORS.items()
        }

    def on_mount(self) -> None:
        self.theme_changed_signal.subscribe(self, self._apply_theme)
        self.set_class(find_color_depth(self) < PALETTE_256 or bool(self.no_color), "-few-colors")

    def _take_theme(self) -> None:
        is_own = self.theme == OWN_THEME
        self.picture_mode.theme = theme = (
            None if is_own else ThemeColors(self.current_theme, TRACE_COLORS)
        )
        filters = [
            line_filter
            for line_filter in self.line_filters
            if not isinstance(line_filter, ThemeColors)
        ]
        # The theme comes before the filter for terminals without colours, which would leave no colour to replace.
        self.line_filters = [theme, *filters] if theme else filters

    def _apply_theme(self, theme: Theme) -> None:
        """Draw the whole screen in the colours of a theme."""
        self._take_theme()
        self.redraw_pictures()
        self.call_later(self.action_redraw)

    def action_choose_theme(self) -> None:
        """Open the dialog of the themes, and store the user's choice."""

        def handle_choice(name: str | None) -> None:
            if name is not None:
                self.keep_setting(THEME, None if name == OWN_THEME else name)

        self.push_screen(self.build_theme_chooser(), handle_choice)

    def build_theme_chooser(self) -> ThemeChooser:
        """Return the dialog of the themes."""
        from tuisim.app.dialogs.palette import ThemeChooser

        return ThemeChooser(list_themes(), self.theme, partial(setattr, self, "theme"))

    def notify(
        self,
        message: str,
        *,
        title: str = "",
        severity: SeverityLevel = "information",
        timeout: float | None = None,
        markup: bool = False,
    ) -> None:
        """Show a notice to the user, on borders of the panels; see `Notices`.

        Args:
            message: The text, without markup.
            title: Comes before the text, unless it is empty.
            severity: An error stays until it can have been read.
            timeout: How long it is shown at least, in seconds; None for the usual time.
            markup: Not used.
        """
        text = f"{title}: {message}" if title else message
        shown_s = self.NOTIFICATION_TIMEOUT if timeout is None else timeout
        self.notices.add(Notice(text, severity, shown_s))

    def clear_notifications(self) -> None:
        """Remove all notices."""
        self.notices.clear()

    async def on_event(self, event: events.Event) -> None:
        """Handle an event; a resize gives the layout at least the minimum size."""
        if isinstance(event, events.Resize):
            was = self.too_small
            self.too_small = event.size if is_too_small(event.size) else None
            if self.too_small:
                event = events.Resize(clamp_size(event.size), clamp_size(event.size))
            if was != self.too_small:
                # The layout may stay the same, and then nothing would be drawn.
                self.call_later(self.action_redraw)
        await super().on_event(event)

    def _waits(self, event: events.Event) -> bool:
        """Return whether an event has to wait, because the topmost screen is not ready or names are being looked up."""
        top = self.screen_stack[-1] if self.screen_stack else None
        if top is not None and getattr(top.focused, "is_completing", False):
            return True
        return isinstance(top, ClosesOnce) and not top.can_take(event)

    def _ignores(self, event: events.Event) -> bool:
        """Return whether to ignore an event of the user.

        An event is ignored if nothing can handle it, or if its target is invisible or was just removed.
        """
        if super()._ignores(event):
            return True
        if not isinstance(event, events.MouseEvent):
            return False
        # The user cannot aim at what is not drawn yet.
        if self.too_small is not None or self._is_opening:
            return True
        if not isinstance(event, events.MouseDown):
            return False
        # Until the next layout a screen still finds a removed widget, and fails when a selection begins there.
        try:
            widget, _ = self.screen.get_widget_and_offset_at(event.x, event.y)
        except AttributeError:
            # Textual's tree fails to say what is at a place before it is drawn.
            return True
        return widget is not None and not widget.is_attached

    @on(ClosesOnce.Changed)
    async def give_waiting_keys(self) -> None:
        """After a screen was opened or closed, handle the keys that waited for that."""
        self.notices.follow_screen()
        await self._input.release_inputs()

    @on(ClosesOnce.Changed)
    @on(events.DescendantFocus)
    @on(events.DescendantBlur)
    def show_keys_of_dialog(self) -> None:
        """Show the keys of the open dialog in the footers of the screens below it."""
        top = self.screen_stack[-1] if self.screen_stack else None
        for footer in (
            footer_row for screen in self.screen_stack for footer_row in screen.query(KeyFooter)
        ):
            footer.show_dialog(top.keys if isinstance(top, Dialog) else ())

    @property
    def _is_opening(self) -> bool:
        top = self.screen_stack[-1] if self.screen_stack else None
        return isinstance(top, ClosesOnce) and not top.is_ready

    def show_update(self, screen: Screen[Any], update: object) -> None:
        """Send the changed cells to the terminal, or the message that the terminal is too small."""
        if isinstance(screen, ClosesOnce) and screen.is_closed:
            # A screen that was closed while being mounted still tries to draw itself.
            update = None
        elif self.too_small and update is not None and SUPPORTED:
            update = Codes(_build_codes(self.too_small))
            self.frame_buffer.forget()
        super().show_update(screen, update)

    def keep_setting(self, path: str, value: Scalar | None) -> None:
        """Write a setting, which the app has applied already, to `config.toml`; None stands for the default value."""

        try:
            SETTINGS[path].save(value)
        except ConfigError as error:
            self.notify(
                f"The choice applies to this session only: {error}",
                severity="warning",
            )

    def action_switch_pixels(self) -> None:
        """Switch between pictures with pixels and pictures with characters, for this session."""
        if self._left_pixels is not None:
            self.choose_pixels(self._left_pixels)
        elif self.picture_mode.graphics is not None:
            before = self.pixels
            self.choose_pixels(NO_PIXELS)
            self._left_pixels = before
            words = fill_keys(self, "Drawn with characters: {pixels} brings the pixels back")
            self.notify(words)
        else:
            self.notify("This terminal does not report that it can draw pixels")

    def action_save_screen(self) -> None:
        """Save a screenshot of the whole screen, as SVG and PNG, in the working directory."""
        # This is imported on demand, so that the app starts faster.
        from tuisim.app.screenshot import collect_cells, save_screenshot

        def handle_saved(files: tuple[Path, Path]) -> None:
            svg, png = files
            self.notify(f"Saved {svg.name} and {png.name} in {png.parent}")
            offer(self, svg, png)

        work = partial(save_screenshot, collect_cells(self), Path.cwd())
        background.run(
            self,
            work,
            handle_saved,
            lambda error: self.notify(str(error), severity="error"),
        )

    def run_in_terminal(self, command: Sequence[str]) -> None:
        """Run another program in the terminal until it ends.

        Raises:
            TuisimError: the app is not in a terminal, or the program cannot start.
        """
        try:
            is_lent = self.lend_terminal(command)
        except OSError as error:
            raise TuisimError(f"{command[0]} cannot start: {error.strerror or error}") from None
        if not is_lent:
            raise TuisimError(f"{command[0]} needs a terminal, which a browser does not have")

    @on(ActionAsked)
    def act_as_asked(self, event: ActionAsked) -> None:
        """Run the action that a button of the web page requests, also while the user types.

        If a dialog is open, or the action works only on another screen, show a notice instead.
        """
        host = self.screen if isinstance(self.screen, ActionHost) else self
        if isinstance(self.screen, Dialog):
            self.notify("A dialog is open: escape closes it")
        elif isinstance(host, ActionHost) and event.name in host.ACTIONS:
            host.action_act(event.name)
        elif host is not self and isinstance(self, ActionHost) and event.name in self.ACTIONS:
            self.notify("That works only in the lab: leave this screen first")

    def action_command_palette(self) -> None:
        """Open the command palette with the actions of the screen, or else of the app; not above an open dialog."""
        host = self.screen if isinstance(self.screen, ActionHost) else self
        if isinstance(self.screen, Dialog) or not isinstance(host, ActionHost) or is_leaving(self):
            return
        from tuisim.app.dialogs.palette import GUIDE_PREFIX, Palette

        def handle_choice(action: str | None) -> None:
            if action is not None and action.startswith(GUIDE_PREFIX):
                self._ask_guide(host, action.removeprefix(GUIDE_PREFIX))
            elif action is not None:
                host.action_act(action)

        self.push_screen(Palette(host.ACTIONS.values(), host.find_situation()), handle_choice)

    def _ask_guide(self, host: ActionHost, question: str) -> None:
        """Open the guide with the search for a question.

        Args:
            host: The app or the screen that opens the guide.
            question: What the user typed.
        """
        from tuisim.app.guide.screen import GuideScreen

        host.action_act("help")
        if isinstance(self.screen, GuideScreen):
            self.screen.ask(question)


def picture_mode_at_start(cells: str | None, colors: str) -> PictureMode:
    """Return how a starting app draws pictures.

    Args:
        cells: The set of glyphs from the command line; None lets `config.toml` decide.
        colors: The colour depth of the terminal; `AUTO` asks the terminal.
    """
    most_colors = choose_colors(colors)
    return replace(
        choose_picture_mode(cells, str(UserConfig.load().value(CELL_SET))), most_colors=most_colors
    )
