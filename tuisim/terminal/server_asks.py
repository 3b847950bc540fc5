"""The requests to the app of the page that shows it, and of the server of the page."""

from __future__ import annotations

from collections.abc import Mapping

from textual.message import Message


class ActionAsked(Message):
    """Message to the app: a button of the web page that shows the app requests one of the app's actions."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.name = name


class ServerAsks(Message):
    """Message to the app: the server that shows the app in a browser requests something, as `asked` says."""

    def __init__(self, request: Mapping[str, object]) -> None:
        super().__init__()
        self.asked = request
        """The request, from JSON: its name under `what`, and its details."""
