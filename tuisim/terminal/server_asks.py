"""What a page that shows the app, and its server, ask of the app."""

from __future__ import annotations

from collections.abc import Mapping

from textual.message import Message


class ActionAsked(Message):
    """A button of the page that shows the app asks for an action."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name


class ServerAsks(Message):
    """The server that shows the app in a browser asks for something."""

    def __init__(self, request: Mapping[str, object]) -> None:
        super().__init__()
        self.asked = request
        """The request, from JSON: its name under `what`, and its details."""
