"""`python -m tuisim` and the `tuisim` command."""

from __future__ import annotations

import gc
import os
import sys
from contextlib import suppress
from typing import NoReturn

COLLECT_EVERY = 300_000
"""After so many new objects, the garbage collector looks for cycles; a start makes many, and keeps nearly all."""


def main() -> NoReturn:
    """Run the command line, and end the process with its exit code."""
    gc.set_threshold(COLLECT_EVERY)
    from tuisim.cli import run_command

    _leave(run_command(sys.argv[1:]))


def _leave(code: int) -> NoReturn:
    """End the process at once: taking the modules down takes longer than many commands."""
    import atexit
    import threading

    vars(threading)["_shutdown"]()
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        # The reader of the stream may be gone; the command has reported that already.
        with suppress(OSError, ValueError):
            stream.flush()
    os._exit(code)


if __name__ == "__main__":
    # With `-m`, Python looks in the current folder first: a file there may be called as one of Python's own.
    if not sys.flags.safe_path:
        sys.path.append(sys.path.pop(0))
    main()
