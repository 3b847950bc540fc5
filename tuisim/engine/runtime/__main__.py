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

    # Returns in each forked child, with the arguments of a child that was started by itself.
    prepared = serve(int(sys.argv[2]))
main(sys.argv[1:], prepared)
