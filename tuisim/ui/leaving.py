"""What the apps have in common: they stop, go on and end in order, and send the terminal only what it lacks."""

from __future__ import annotations

import asyncio
import signal
from collections import deque
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, ClassVar, cast

from rich.console import Console, ConsoleRenderable, RichCast
from textual import events, on
from textual._compositor import CompositorUpdate
from textual.app import App
from textual.command import Provider
from textual.css.query import NoMatches
from textual.driver import Driver
from textual.filter import LineFilter
from textual.geometry import Size
from textual.screen import Screen

from tuisim.ui.driver import TerminalDriver
from tuisim.ui.framebuffer import FrameBuffer
from tuisim.ui.harmless import Harmless
from tuisim.ui.minimum import TooSmall, is_too_small, laid_out
from tuisim.ui.screens.dialog import ClosesOnce, Dialog

_HARMLESS = Harmless()


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app has been told to end: nothing may be opened any more, for it could not be drawn."""
    # Textual has no public word for it.
    return app._exit


class TerminalApp(App[None]):
    """An app that gives the terminal back in order, also when it is stopped or ended from outside."""

    # Its palette offers the app's own actions: Textual's help, zoom and themes would be a second set of them.
    COMMANDS: ClassVar[set[type[Provider] | Callable[[], type[Provider]]]] = set()

    def __init__(self) -> None:
        super().__init__(driver_class=TerminalDriver)
        self.frame_buffer = FrameBuffer()
        self.too_small: Size | None = None
        """Size of a terminal that is too small, None for one that is not."""
        self._waiting_keys: deque[events.Key] = deque()
        """Keys for a screen that is being opened."""

    async def on_event(self, event: events.Event) -> None:
        """Lay out for no smaller size than can be read; what cannot be seen cannot be clicked on."""
        if isinstance(event, events.Resize):
            was, self.too_small = self.too_small, event.size if is_too_small(event.size) else None
            if self.too_small:
                event = events.Resize(laid_out(event.size), laid_out(event.size))
            if was != self.too_small:
                # The layout may stay the same, and would not be drawn then.
                self.call_later(self.draw_again)
        elif isinstance(event, (events.InputEvent, events.Paste)) and self._is_deaf_to(event):
            return
        if isinstance(event, events.Key) and (self._waiting_keys or self._is_opening):
            # A screen that is not built yet would lose it.
            self._waiting_keys.append(events.Key(event.key, event.character))
            return
        await super().on_event(event)

    def _is_deaf_to(self, event: events.Event) -> bool:
        """Whether nobody is there to hear the user, or what is pointed at cannot be seen or has just been removed."""
        if is_leaving(self):
            return True
        if not isinstance(event, events.MouseEvent):
            return False
        if self.too_small is not None:
            return True
        if not isinstance(event, events.MouseDown):
            return False
        # Until the next layout a screen still finds a removed widget, and fails when a selection is to begin there.
        widget, _ = self.screen.get_widget_and_offset_at(event.x, event.y)
        return widget is not None and not widget.is_attached

    @on(ClosesOnce.Changed)
    async def give_waiting_keys(self) -> None:
        """Let the uppermost screen have the keys that were pressed while it was being opened."""
        while self._waiting_keys and not self._is_opening:
            await super().on_event(self._waiting_keys.popleft())

    @property
    def _is_opening(self) -> bool:
        top = self.screen_stack[-1] if self.screen_stack else None
        return isinstance(top, ClosesOnce) and not top.is_ready

    def _display(self, screen: Screen[Any], renderable: ConsoleRenderable | RichCast | str | None) -> None:
        # Textual writes what it is given; where it would write nothing, the terminal does not come to show it either.
        update: object = renderable
        codes: str | None = None
        if isinstance(screen, ClosesOnce) and screen.is_closed:
            # One that was closed while it was being built still comes to draw itself.
            renderable = None
        elif self.too_small and renderable is not None:
            renderable = cast(ConsoleRenderable, TooSmall(self.too_small))
            self.frame_buffer.forget()
        elif isinstance(update, CompositorUpdate) and self._writes:
            codes = self.frame_buffer.codes(update, self.console)
            if codes is not None:
                renderable = cast(ConsoleRenderable, _Codes(codes)) if codes else None
        super()._display(screen, renderable)
        if codes:
            self.painted(len(codes))

    def painted(self, size: int) -> None:
        """Be told that the terminal was sent what it did not show, so many characters."""

    @property
    def _writes(self) -> bool:
        return self._running and not (self._closed or self._batch_count or self.is_headless or self._driver is None)

    @on(events.DescendantFocus)
    def still_cursor(self, event: events.DescendantFocus) -> None:
        """Let no cursor blink: where nothing happens nothing is sent."""
        if hasattr(event.widget, "cursor_blink"):
            event.widget.cursor_blink = False

    def on_resize(self, event: events.Resize) -> None:
        """Send everything again: a terminal of another size has cut or moved what it showed."""
        self.frame_buffer.forget()

    def get_line_filters(self) -> Sequence[LineFilter]:
        """Return what all that is drawn goes through."""
        return [*super().get_line_filters(), _HARMLESS]

    def on_ready(self) -> None:
        """End the app as by a key when it is told to from outside."""
        if self.is_headless:
            return
        loop = asyncio.get_running_loop()
        for number in (signal.SIGTERM, signal.SIGHUP):
            # As a shell shows a program that the signal has ended.
            loop.add_signal_handler(number, partial(self.exit, return_code=128 + number))
        loop.add_signal_handler(signal.SIGTSTP, self.action_suspend_process)

    @on(Driver.SignalResume)
    def draw_again(self) -> None:
        """Draw all of the screen: while the app was stopped the shell has written over it."""
        self.frame_buffer.forget()
        self.refresh(layout=True)

    def action_suspend_process(self) -> None:
        """Stop as a job of the shell that the app was started from, until the shell lets it go on."""
        if isinstance(self._driver, TerminalDriver):
            self.suspending()
            if not self._driver.stop_as_job():
                self.notify("No shell is there that could let tuisim go on, so it does not stop", markup=False)

    def suspending(self) -> None:
        """Be told that the app is about to stop."""

    def action_command_palette(self) -> None:
        """Open the command palette, unless it is open, or a dialog is: its commands would open dialogs above that."""
        from tuisim.ui.palette import Palette

        if self.use_command_palette and not isinstance(self.screen, (Dialog, Palette)) and not is_leaving(self):
            self.push_screen(Palette())

    def _handle_exception(self, error: Exception) -> None:
        # A screen that was being opened when the app was told to end is taken down half built.
        if not (is_leaving(self) and isinstance(error, NoMatches)):
            super()._handle_exception(error)


class _Codes(CompositorUpdate):
    """An update that has been turned into codes."""

    def __init__(self, codes: str) -> None:
        self._codes = codes

    def render_segments(self, console: Console) -> str:
        """Return the codes."""
        return self._codes
