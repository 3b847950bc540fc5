"""Brings a terminal back to its usual state after an app that was killed had no time to do so."""

from __future__ import annotations

import os
import termios
from contextlib import suppress

from tuisim.terminal.graphics import kitty
from tuisim.terminal.probe import SILENT

_OFF = "".join(f"\x1b[?{mode}l" for mode in (1000, 1002, 1003, 1015, 1006, 1016, 1004, 2004, 2026, 2048))
"""Mouse, focus, bracketed paste, synchronized output and reports of the size."""
RESTORING = f"\x1b[<u{_OFF}\x1b[?1049l\x1b[?7h\x1b[?25h\x1b[0m\x1b(B\x0f\r"
"""Ends the keyboard protocol of kitty on the screen of the app, then that screen; lines wrap, the cursor is visible."""


def restore_terminal(fd: int, term: str) -> None:
    """Undo what the app, or another program that was killed, has set.

    Args:
        fd: The terminal, open for reading and writing.
        term: The variable TERM.

    Raises:
        OSError: the terminal is gone.
    """
    # Only where they are not shown as text: most terminals ignore what they do not know.
    os.write(fd, (RESTORING if term in SILENT else RESTORING + kitty.DELETE_ALL).encode())
    with suppress(termios.error):
        attributes = termios.tcgetattr(fd)
        attributes[:4] = _sane(*attributes[:4])
        termios.tcsetattr(fd, termios.TCSAFLUSH, attributes)


def _sane(iflag: int, oflag: int, cflag: int, lflag: int) -> list[int]:
    """Return the modes of a terminal with what `stty sane` switches on, as far as apps change it."""
    iflag = (iflag | termios.BRKINT | termios.ICRNL | termios.IXON | termios.IMAXBEL) & ~(termios.INLCR | termios.IGNCR)
    oflag |= termios.OPOST | termios.ONLCR
    lflag |= termios.ISIG | termios.ICANON | termios.IEXTEN
    lflag |= termios.ECHO | termios.ECHOE | termios.ECHOK | termios.ECHOCTL | termios.ECHOKE
    return [iflag, oflag, cflag, lflag]
