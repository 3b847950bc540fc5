"""Entry point: `python -m tuisim.engine.runtime FOLDER FD …` with the descriptors that `main` takes, or `--warm
SOCKET_FD`."""

from __future__ import annotations

import gc
import sys

# Start-up creates only permanent objects, so garbage collection would waste time. It is enabled again right before
# the program's first line.
gc.disable()

from tuisim.engine.runtime.child import main  # noqa: E402 - its imports are part of the start-up

prepared = None
if sys.argv[1] == "--warm":
    from tuisim.engine.runtime.warm import serve

    # `serve` returns only in a forked child; `sys.argv` is then that of a child which is started as a new process.
    prepared = serve(int(sys.argv[2]))
main(sys.argv[1:], prepared)
