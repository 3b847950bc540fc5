"""Base of an app that shares a terminal well: it sends only changes, and is suspended, resumed and ended cleanly."""

from __future__ import annotations

import asyncio
import os
import re
import signal
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any

from rich.cells import cell_len
from rich.segment import Segment
from textual import events, on
from textual.app import App, ScreenStackError
from textual.color import Color
from textual.css.query import NoMatches
from textual.dom import NoScreen
from textual.driver import Driver
from textual.filter import LineFilter
from textual.screen import Screen
from textual.widget import WidgetError
from textual.worker import WorkerFailed

from tuisim.terminal import input_order
from tuisim.terminal.cell_view import RowsView
from tuisim.terminal.driver import SIGNALLED, TerminalDriver, run_in_foreground
from tuisim.terminal.frame_buffer import FrameBuffer, TextMode
from tuisim.terminal.picture_mode import PictureMode, choose_graphics, find_color_depth
from tuisim.terminal.picture_options import AUTO, NO_PIXELS, CellSet
from tuisim.terminal.probe import is_in_browser, is_multiplexer
from tuisim.terminal.queries import (
    ATTRIBUTES_QUERY,
    CELL_SIZE_QUERY,
    KITTY_QUESTIONS,
    AnswerParser,
    TerminalAnswered,
    TerminalFacts,
    read_cell_size_px,
)
from tuisim.terminal.server_asks import ActionAsked as ActionAsked
from tuisim.terminal.server_asks import ServerAsks as ServerAsks
from tuisim.terminal.textual_internals import (
    SUPPORTED,
    Codes,
    CompositorUpdate,
    HookedApp,
    is_leaving,
    repair_textual,
)

_CONTROLS = re.compile("[\x00-\x1f\x7f-\x9f\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")
"""Control characters, and those that change the direction of writing."""


class Sanitize(LineFilter):
    """A filter for drawn text: it replaces control characters, and characters that change the direction of writing."""

    def apply(self, segments: list[Segment], background: Color) -> list[Segment]:
        """Return the segments with a blank in place of each replaced character, so that their width stays the same."""
        if all(segment.text.isprintable() or segment.control for segment in segments):
            return segments
        return [
            segment
            if segment.control
            else Segment(_CONTROLS.sub(_blank_match, segment.text), segment.style)
            for segment in segments
        ]


def _blank_match(match: re.Match[str]) -> str:
    return " " * cell_len(match[0])


def offer(app: App[Any], *files: Path) -> None:
    """Offer files for download in the browser that shows an app; do nothing for an app in a terminal.

    The app may run on another machine than the browser.
    """
    if app.is_web:
        for file in files:
            app.deliver_binary(file)


class BufferedApp(HookedApp):
    """Base of an app that sends only changed cells to its terminal, and restores the terminal however the app ends."""

    def __init__(self, picture_mode: PictureMode | None = None) -> None:
        super().__init__(driver_class=_choose_driver_class())
        self.line_filters = [*self.line_filters, Sanitize()]
        # Multiplexers take the code for italics for that of reverse video.
        self._has_italics = not is_multiplexer(os.environ.get("TERM", ""))
        self.frame_buffer = FrameBuffer()
        self.picture_mode = picture_mode or PictureMode()
        """How pictures are drawn."""
        self.pixels = AUTO
        """One of `PIXELS`."""
        self._left_pixels: str | None = None
        """`pixels` before the user switched to characters with a key; None if the user has not."""
        self.terminal_facts = TerminalFacts()
        self._input = input_order.InputOrder(self, self._give, self._waits)

    async def on_event(self, event: events.Event) -> None:
        """Handle an event; events of the user are handled in order, each after all effects of the event before."""
        if isinstance(event, (events.InputEvent, events.Paste)):
            if not self._ignores(event):
                await (self._input.take if SUPPORTED and not event.is_forwarded else self._give)(
                    event
                )
            return
        await super().on_event(event)

    async def _give(self, event: events.Event) -> None:
        """Handle an event of the user, after all earlier ones; drop the event if nothing can handle it."""
        if not self._ignores(event):
            await super().on_event(event)

    def _waits(self, event: events.Event) -> bool:
        """Return whether an event of the user has to wait, because its target widget does not exist yet."""
        return False

    def _ignores(self, event: events.Event) -> bool:
        """Return whether to ignore an event of the user, because nothing can handle it."""
        return is_leaving(self)

    @property
    def is_typed_into(self) -> bool:
        """Whether the focused widget takes every letter as text."""
        return self.focused is not None and input_order.takes_letters(self.focused)

    def show_update(self, screen: Screen[Any], update: object) -> None:
        """Send the cells that differ from the cells on the terminal; if none differs, send nothing."""
        codes: str | None = None
        if (
            isinstance(update, CompositorUpdate)
            and not isinstance(update, Codes)
            and self.is_writing
        ):
            codes = self.frame_buffer.encode_update(update, self.text_mode)
            if codes is not None:
                update = Codes(codes) if codes else None
        super().show_update(screen, update)
        if codes:
            self.handle_painted(len(codes))

    def choose_cells(self, chosen: str) -> None:
        """Draw all pictures from now on with a set of glyphs, given by its name; `AUTO` is the terminal's best set."""
        self.picture_mode.choose(chosen)
        self._choose_graphics()
        self.redraw_pictures()

    def choose_pixels(self, pixels: str) -> None:
        """Set whether pictures are drawn with pixels or with glyphs, and draw all pictures again.

        Args:
            pixels: One of `PIXELS`.
        """
        self.pixels = pixels
        self._left_pixels = None
        self._choose_graphics()

    @property
    def has_pixels(self) -> bool:
        """Whether the terminal can draw pictures with pixels and the app does so.

        Also true if the user has switched from pixels to characters for this session only.
        """
        return self.picture_mode.graphics is not None or self._left_pixels is not None

    def handle_painted(self, size: int) -> None:
        """Handle that an update of `size` characters was sent to the terminal; this class does nothing."""

    @property
    def text_mode(self) -> TextMode:
        """What the terminal supports: colours, italics and glyphs."""
        is_ascii = self.picture_mode.cells is CellSet.ASCII
        return TextMode(find_color_depth(self), is_ascii, has_italics=self._has_italics)

    @on(events.DescendantFocus)
    def stop_blinking(self, event: events.DescendantFocus) -> None:
        """Stop the blinking of a cursor in the focused widget, because an idle app sends nothing."""
        if hasattr(event.widget, "cursor_blink"):
            event.widget.cursor_blink = False

    def on_resize(self, event: events.Resize) -> None:
        """Send the whole screen again, because a resized terminal has cut or moved its content."""
        self.frame_buffer.forget()
        self._choose_graphics()
        if self.terminal_facts.attributes and self.own_driver is not None:
            # Zooming also changes the size of the cells, so the terminal is asked for that again.
            AnswerParser.is_asked = True
            self.own_driver.write(CELL_SIZE_QUERY + ATTRIBUTES_QUERY)

    def on_ready(self) -> None:
        if self.is_headless:
            return
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            # The app exits with the code that a shell shows for a program ended by the signal.
            loop.add_signal_handler(number, partial(self.exit, return_code=SIGNALLED + number))
        if isinstance(self.own_driver, TerminalDriver):
            loop.add_signal_handler(signal.SIGTSTP, self.action_suspend_process)

    def on_terminal_answered(self, event: TerminalAnswered) -> None:
        """Switch to pixels if the terminal's answers allow it.

        If it is still unknown whether the terminal knows kitty's protocol, ask the terminal.
        """
        if event.facts.asks_for_kitty and self.own_driver is not None:
            AnswerParser.is_asked = True
            self.own_driver.write(KITTY_QUESTIONS)
        drew = self.picture_mode.graphics
        self.terminal_facts = event.facts
        self._choose_graphics()
        if event.facts.kitty_error and drew is not None and self.picture_mode.graphics is None:
            self.notify(
                f"The terminal cannot show a picture ({event.facts.kitty_error}): drawn with characters instead",
                severity="warning",
                markup=False,
            )

    def _choose_graphics(self) -> None:
        size_px = (
            read_cell_size_px(self.own_driver.fileno)
            if isinstance(self.own_driver, TerminalDriver)
            else None
        )
        # A user who has chosen glyphs wants to see them, and one without colours wants no pixels, which have colours.
        is_without = self.picture_mode.chosen != AUTO or self.no_color
        choice = NO_PIXELS if self.pixels == AUTO and is_without else self.pixels
        graphics = choose_graphics(self.terminal_facts, choice, size_px) if SUPPORTED else None
        if graphics != self.picture_mode.graphics:
            self.picture_mode.graphics = graphics
            self.redraw_pictures()
            self.call_after_refresh(self.handle_situation_change)

    def handle_situation_change(self) -> None:
        """Update what depends on the state of the app, such as which keys are available; this class does nothing."""

    def redraw_pictures(self) -> None:
        """Draw all pictures again, with pixels or glyphs as `picture_mode` says now."""
        for screen in self.screen_stack:
            for view in screen.query(RowsView):
                view.redraw()

    @on(Driver.SignalResume)
    def action_redraw(self) -> None:
        """Send the whole screen again, because something else has written over it, such as a shell."""
        self.frame_buffer.forget()
        self.refresh(layout=True)

    def action_suspend_process(self) -> None:
        if isinstance(self.own_driver, TerminalDriver):
            self.prepare_suspension()
            if not self.own_driver.stop_as_job():
                self.notify(
                    f"{self.TITLE} cannot be suspended: no shell could resume it", markup=False
                )
        elif is_in_browser():
            self.notify(f"{self.TITLE} cannot be suspended in a browser", markup=False)
        else:
            super().action_suspend_process()

    def lend_terminal(self, command: Sequence[str]) -> bool:
        """Run another program in the terminal until it ends.

        Returns:
            False, without running it, if the app is in a browser, which has no terminal to give.

        Raises:
            OSError: the program cannot start.
        """
        if not isinstance(self.own_driver, TerminalDriver):
            return False
        self.prepare_suspension()
        with self.own_driver.lend():
            run_in_foreground(command)
        return True

    def tell_server(self, what: str, **details: object) -> None:
        """Send a message to the server that shows the app in a browser; in a terminal, do nothing."""
        if not is_in_browser():
            return
        # This is imported on demand, since most apps run in a terminal.
        from tuisim.terminal.browser_driver import BrowserDriver

        if isinstance(self.own_driver, BrowserDriver):
            self.own_driver.write_meta({"type": "tell", "what": what, **details})

    def prepare_suspension(self) -> None:
        """Prepare for a stop of the app, or for another program in its terminal; this class does nothing."""

    def is_harmless(self, error: Exception) -> bool:
        """Return whether an error only comes from the shutdown of the app, and can be ignored.

        During the shutdown, widgets cannot be mounted, some are removed while they are being mounted, and at last there
        is no screen any more.
        """
        cause = error.error if isinstance(error, WorkerFailed) else error
        return is_leaving(self) and isinstance(
            cause, (WidgetError, NoMatches, NoScreen, ScreenStackError)
        )


repair_textual(input_order.end_messages)


def _choose_driver_class() -> type[Driver] | None:
    """Return the driver for the browser or the terminal in which the app runs; None for Textual's own driver."""
    if not SUPPORTED:
        return None
    if not is_in_browser():
        return TerminalDriver
    # This is imported on demand, since most apps run in a terminal.
    from tuisim.terminal.browser_driver import BrowserDriver

    return BrowserDriver
