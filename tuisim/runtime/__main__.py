"""Entry point: `python -m tuisim.runtime FOLDER COMMAND_FD EVENT_FD LIFELINE_FD`, or `--warm SOCKET_FD`."""

from __future__ import annotations

import sys

from tuisim.runtime.child import main

prepared = None
if sys.argv[1] == "--warm":
    from tuisim.runtime.warm import serve

    # Returns in each forked child, whose arguments are then as those of a child that was started by itself.
    prepared = serve(int(sys.argv[2]))
main(sys.argv[1:], prepared)
