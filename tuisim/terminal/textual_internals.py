"""Textual's private names, all that are used."""

from __future__ import annotations

from typing import Any

from textual.app import App


def is_leaving(app: App[Any]) -> bool:
    """Return whether the app is shutting down: nothing may be opened any more, for it could not be drawn."""
    return app._exit
