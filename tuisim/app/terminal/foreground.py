"""Another program in the terminal of the app."""

from __future__ import annotations

import signal
import subprocess
from collections.abc import Sequence

from tuisim.errors import TuisimError


def run_in_foreground(command: Sequence[str]) -> None:
    """Run a program in this terminal until it ends.

    Raises:
        TuisimError: it cannot start.
    """
    try:
        program = subprocess.Popen(command)
    except OSError as error:
        raise TuisimError(f"{command[0]} cannot start: {error.strerror or error}") from None
    # What is typed to interrupt the program also reaches this process.
    handlers = {number: signal.signal(number, signal.SIG_IGN) for number in (signal.SIGINT, signal.SIGQUIT)}
    try:
        program.wait()
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler)
