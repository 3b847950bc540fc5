"""The brick's one screen, that pictures and text take turns on."""

from __future__ import annotations

from tuisim.shim.session import Session


class Screen:
    """Writes down what the screen shows, each time it changes.

    Args:
        session: Takes the rows.
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self._shown: tuple[str, int] | None = None

    def show(self, row: str, stream: int) -> None:
        """Show a picture or a text; the same again is not written down.

        Args:
            row: As `datalog.face` makes it.
            stream: `DISPLAY` or `CONSOLE` of `datalog.records`.
        """
        if (row, stream) != self._shown:
            self._shown = (row, stream)
            self._session.show(row, stream)
