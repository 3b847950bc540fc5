"""The requests to the app of the page that shows it, and of the server of the page."""

from __future__ import annotations

from collections.abc import Mapping

from textual.message import Message


class ActionAsked(Message):
    """Posted when a button of the web page that shows the app requests an action."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name


class ServerAsks(Message):
    """Posted when the server that shows the app in a browser requests something."""

    def __init__(self, request: Mapping[str, object]) -> None:
        super().__init__()
        self.asked = request
        """The request, from JSON: its name under `what`, and its details."""
