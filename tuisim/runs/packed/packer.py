"""Packs recordings of finished runs in separate processes: `python -m tuisim.runs.packed.packer FOLDER`.

Nothing waits for it: neither a finished run, nor the app, whose threads it would slow down.
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

_NICENESS = 10
"""Increment of a packer's niceness."""


def pack_later(folder: Path) -> None:
    """Pack the recordings of a run and count its samples in the background; errors are ignored."""
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
    """Pack the recordings of one run, after other packers have finished."""
    from tuisim.runs.run_folder import read_run
    from tuisim.runs.store import RunStore, compact_run

    os.nice(_NICENESS)
    home = folder.parent.parent
    # On failure it stays unpacked; `tuisim runs compact` shows the error.
    with suppress(LogError, OSError), open(home / LOCK_FILE, "ab", opener=private) as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        RunStore(home).count_samples(folder.name)
        compact_run(read_run(folder))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
