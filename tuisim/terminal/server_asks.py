"""The requests to the app of the page that shows it, and of the server of the page."""

from __future__ import annotations

from collections.abc import Mapping

from textual.message import Message


class ActionAsked(Message):
    """Posted to the app when the user has clicked a button of the web page that stands for an action of the app."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name


class ServerAsks(Message):
    """Posted when the server that shows the app in a browser requests something of the app, as `asked` says."""

    def __init__(self, request: Mapping[str, object]) -> None:
        super().__init__()
        self.asked = request
        """The request, from JSON: its name under `what`, and its details."""
