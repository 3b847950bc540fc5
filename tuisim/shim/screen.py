"""The brick's screen, which images and text share."""

from __future__ import annotations

from tuisim.shim.session import Session


class Screen:
    """Records the contents of the screen each time they change.

    Args:
        session: Receives the rows.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._shown: tuple[str, int] | None = None

    def show(self, row: str, stream: int) -> None:
        """Show an image or a text; unchanged contents are not recorded again.

        Args:
            row: In the format of `runs.brick_state`.
            stream: `DISPLAY` or `CONSOLE` of `runs.records`.
        """
        if (row, stream) != self._shown:
            self._shown = (row, stream)
            self._session.show(row, stream)
