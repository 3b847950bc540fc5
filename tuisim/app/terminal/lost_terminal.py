"""Input and output that survive the loss of their terminal."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from encodings import utf_8
from pathlib import Path
from typing import TextIO


class ResilientOutput:
    """Terminal output that accepts writes even after the terminal is gone, for example after a lost connection.

    Textual writes from a thread of its own. That thread would end at the first failed write, and the app, which has to
    write a little more before it can shut down, would wait for it for ever.

    Args:
        file: The output.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self.gone = False
        """Whether a write has failed; later output is dropped."""

    def write(self, text: str) -> int:
        """Write a text, or drop it. Return its length."""
        if not self.gone:
            try:
                self._file.write(text)
            except OSError:
                self._lose()
        return len(text)

    def flush(self) -> None:
        """Flush the output."""
        if not self.gone:
            try:
                self._file.flush()
            except OSError:
                self._lose()

    def _lose(self) -> None:
        # Data left in the file's buffer would fail again when Python ends, and change the exit code.
        with suppress(OSError), Path(os.devnull).open("wb") as nothing:
            os.dup2(nothing.fileno(), self._file.fileno())
            self._file.flush()
        self.gone = True

    def fileno(self) -> int:
        """Return the file descriptor."""
        return self._file.fileno()


class InputDecoder(utf_8.IncrementalDecoder):
    """Decodes what the terminal sends: bytes that are no UTF-8, as from a faulty line, must not end the app."""

    def __init__(self) -> None:
        super().__init__("replace")

    def decode(self, data: bytes, final: bool = False) -> str:  # type: ignore[override]
        """Return the characters that are complete.

        Raises:
            EOFError: the terminal is gone; it would be read again and again, in vain.
        """
        if not data and not final and not sys.stdin.isatty():
            raise EOFError
        return super().decode(data, final)
