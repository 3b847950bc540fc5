"""Packs recordings of ended runs, each in its own process: `python -m tuisim.runs.packed.packer FOLDER`.

Nobody waits for it: neither who has just run a program, nor the app, whose threads it would hold up.
"""

from __future__ import annotations

import fcntl
import os
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

from tuisim.atomic import private
from tuisim.errors import LogError

LOCK_FILE = "packer.lock"
AT_WORK: list[threading.Thread] = []
"""Each waits for the end of a packer that this process has started."""

_POLITE = 10
"""By how much the priority of a packer is lower."""


def pack_later(folder: Path) -> None:
    """Let the recordings of a run be packed, and its samples be counted, soon; what goes wrong changes nothing."""
    AT_WORK[:] = [waiting for waiting in AT_WORK if waiting.is_alive()]
    with suppress(OSError):
        packer = subprocess.Popen(
            [sys.executable, "-s", "-P", "-m", "tuisim.runs.packed.packer", str(folder)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": str(Path(__file__).parent.parent.parent)},
            cwd="/",
            start_new_session=True,
        )
        AT_WORK.append(threading.Thread(target=packer.wait, daemon=True))
        AT_WORK[-1].start()


def main(folder: Path) -> None:
    """Pack the recordings of one run, after those that others are at."""
    from tuisim.runs.run_folder import read_run
    from tuisim.runs.store import RunStore, compact_run

    os.nice(_POLITE)
    home = folder.parent.parent
    # It stays as it was written where that is not possible; `tuisim runs compact` would tell why.
    with suppress(LogError, OSError), open(home / LOCK_FILE, "ab", opener=private) as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        RunStore(home).count_samples(folder.name)
        compact_run(read_run(folder))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
