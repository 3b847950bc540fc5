"""The brick's screen, which images and text share."""

from __future__ import annotations

from tuisim.runs.records import Stream
from tuisim.shim.session import Session


class Screen:
    """Records the contents of the screen each time they change.

    Args:
        session: Receives the rows.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._shown: tuple[str, Stream] | None = None

    def show(self, row: str, stream: Stream) -> None:
        """Show an image or a text; unchanged contents are not recorded again.

        Args:
            row: In the format of `runs.brick_state`.
            stream: `Stream.DISPLAY` or `Stream.CONSOLE`.
        """
        if (row, stream) != self._shown:
            self._shown = (row, stream)
            self._session.show(row, stream)
