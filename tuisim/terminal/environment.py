"""What stands between an app and its terminal: a browser, GNU screen or tmux."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from textual.app import App

KIND = "screen"
"""What TERM begins with in GNU screen, and in tmux unless it is told otherwise."""
_ANSWER_S = 1.0
_ALL_COLORS = "RGB"
"""The feature of a terminal with all colours, as tmux calls it."""


def is_multiplexer(terminal: str) -> bool:
    """Return whether a kind of terminal, as in TERM, is GNU screen, or tmux under that name.

    It takes the code for italics for that of reverse video.
    """
    return terminal == KIND or terminal.startswith((f"{KIND}-", f"{KIND}."))


def has_all_colors(environment: Mapping[str, str]) -> bool:
    """Return whether the multiplexer says that it shows all colours.

    COLORTERM is no answer: it was inherited from the terminal around it. GNU screen before version 5 takes the numbers
    of such a colour for blinking, underlined and coloured text, and has no way to be asked. tmux has; inside GNU screen
    (STY) it may be the one around it.
    """
    if "TMUX" not in environment or "STY" in environment:
        return False
    command = ["tmux", "display-message", "-p", "#{client_termfeatures}"]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=_ANSWER_S, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return _ALL_COLORS in done.stdout.strip().split(",")


WEB_DRIVER = "textual.drivers.web_driver:WebDriver"
"""The driver that a server such as textual-serve names in the environment of an app in a browser."""


def in_browser() -> bool:
    """Return whether a server has started this process to show its app in a browser."""
    return os.environ.get("TEXTUAL_DRIVER") == WEB_DRIVER


def offer(app: App[Any], *files: Path) -> None:
    """Let the browser, if there is one, download files that have been written: it may be on another machine."""
    if app.is_web:
        for file in files:
            app.deliver_binary(file)
