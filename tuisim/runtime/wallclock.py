"""The real clock and the real thread functions, kept before the program's are replaced.

Import this before anything else of the runtime.
"""

from __future__ import annotations

import _thread
import os
import select
import sys
import time
from importlib import import_module
from typing import Any

monotonic = time.monotonic
process_time = time.process_time
get_ident = _thread.get_ident
allocate_lock = _thread.allocate_lock
start_new_thread = _thread.start_new_thread
stack_size = _thread.stack_size
select_files = select.select
exit_process = os._exit
fork, getpid = os.fork, os.getpid
signals: Any = import_module("_signal")
"""What `signal` has its functions from; no type checker knows it."""
set_signal, set_timer = signals.signal, signals.setitimer
settrace, gettrace = sys.settrace, sys.gettrace


def _start_folder() -> str:
    try:
        return os.getcwd()
    except OSError:
        # It is gone already.
        return os.sep


start_folder = _start_folder()
"""Where the process was started: a program may go elsewhere, and delete its folder."""


def absolute(path: str) -> str:
    """Return the whole path of a file as it was named at the start."""
    return os.path.normpath(os.path.join(start_folder, path))
