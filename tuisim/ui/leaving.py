"""Whether an app is about to end."""

from __future__ import annotations

from typing import Any

from textual.app import App


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app has been told to end: nothing may be opened any more, for it could not be drawn."""
    # Textual has no public word for it.
    return app._exit
