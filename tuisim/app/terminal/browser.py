"""Whether the app is shown in a browser instead of a terminal."""

from __future__ import annotations

import os

WEB_DRIVER = "textual.drivers.web_driver:WebDriver"
"""The driver that a server such as textual-serve names in the environment of an app in a browser."""


def in_browser() -> bool:
    """Return whether a server has started this process to show its app in a browser."""
    return os.environ.get("TEXTUAL_DRIVER") == WEB_DRIVER
