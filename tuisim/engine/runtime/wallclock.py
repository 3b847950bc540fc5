"""The real clock and the real thread functions, saved before the program's are replaced.

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
fork = os.fork
getpid = os.getpid
signals: Any = import_module("_signal")
"""The C module behind `signal`; type checkers do not know it."""
set_signal, set_timer = signals.signal, signals.setitimer
settrace = sys.settrace
gettrace = sys.gettrace
setprofile = sys.setprofile


def _start_folder() -> str:
    try:
        return os.getcwd()
    except OSError:
        # The working directory no longer exists.
        return os.sep


start_folder = _start_folder()
"""Working directory at the start: a program may change it, and delete the folder."""


def absolute(path: str) -> str:
    """Return the absolute path for a path that may be relative to the working directory at the start of the process."""
    return os.path.normpath(os.path.join(start_folder, path))
