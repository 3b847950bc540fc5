"""An app that is shown in a browser instead of a terminal."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from textual.app import App

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
