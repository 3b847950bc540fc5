"""Textual's driver for browsers, with an app that ends with its server and has the focus that the browser reports."""

from __future__ import annotations

import os
from threading import Lock
from typing import Any

from textual import events, messages
from textual.app import App
from textual.drivers.web_driver import WebDriver
from textual.message import Message

from tuisim.terminal import kitty
from tuisim.terminal.queries import QUESTIONS, AnswerParser
from tuisim.terminal.server_asks import ActionAsked, ServerAsks
from tuisim.terminal.textual_internals import find_app, replace_write, set_page_parser

_MODES = "\x1b[?1049h\x1b[?25l\x1b[?1000h\x1b[?1003h\x1b[?1015h\x1b[?1006h\x1b[?2004h"
"""What an app sets in a terminal: the screen of an app without a cursor, reports of the mouse and of pastes."""


class BrowserDriver(WebDriver):
    """Textual's driver of an app in a browser; it exchanges messages with the server that shows the app."""

    def __init__(
        self,
        app: App[Any],
        *,
        debug: bool = False,
        mouse: bool = True,
        size: tuple[int, int] | None = None,
    ) -> None:
        super().__init__(app, debug=debug, mouse=mouse, size=size)
        replace_write(self, self._write_all)
        self._one_at_a_time = Lock()
        self._server_is_gone = False

    def _write_all(self, data: bytes) -> int:
        """Write all of the data and return its length, even if a signal interrupts this; drop it if the server is gone.

        Drawing and downloads write from different threads, and packets must not be mixed.
        """
        with self._one_at_a_time:
            left = data
            while left and not self._server_is_gone:
                try:
                    left = left[os.write(self.fileno, left) :]
                except OSError:
                    self._server_is_gone = True
        return len(data)

    def start_application_mode(self) -> None:
        """Begin to draw on the page's terminal, and ask the page what it can do."""
        super().start_application_mode()
        self.write(QUESTIONS)

    def write(self, data: str) -> None:
        """Write codes to the terminal of the page."""
        super().write(kitty.wrap_page(data))

    def process_message(self, message: Message) -> None:
        """Pass on a message of the page's terminal, except a size: the server reports the size."""
        if not isinstance(message, events.Resize):
            super().process_message(message)

    def run_input_thread(self) -> None:
        """Pass on input until the app ends; if the server ends first, end the app."""
        super().run_input_thread()
        if not self.exit_event.is_set():
            find_app(self).post_message(messages.ExitApp())

    def on_meta(self, packet_type: str, payload: dict[str, object]) -> None:
        """Handle a message of the server, such as another size of the page, or another page that shows the app.

        A new page gets the same codes as the first page. A size or a focus is handled after the events that the app has
        queued at its start: these would override it.
        """
        match packet_type:
            case "focus" | "blur":
                event = events.AppFocus() if packet_type == "focus" else events.AppBlur()
                find_app(self).call_later(find_app(self).post_message, event)
            case "resize":
                find_app(self).call_later(super().on_meta, packet_type, payload)
            case "show":
                self.on_meta("resize", payload)
                self.write(_MODES + QUESTIONS)
                find_app(self).call_later(find_app(self).post_message, self.SignalResume())
            case "act":
                find_app(self).post_message(ActionAsked(str(payload["name"])))
            case "ask":
                find_app(self).post_message(ServerAsks(payload))
            case _:
                super().on_meta(packet_type, payload)


set_page_parser(AnswerParser)
