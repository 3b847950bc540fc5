"""The real clock and the real thread functions, kept before the program's are replaced.

Import this before anything else of the runtime.
"""

from __future__ import annotations

import _thread
import os
import select
import sys
import time

monotonic = time.monotonic
process_time = time.process_time
get_ident = _thread.get_ident
allocate_lock = _thread.allocate_lock
start_new_thread = _thread.start_new_thread
select_files = select.select
exit_process = os._exit
fork = os.fork
settrace, gettrace = sys.settrace, sys.gettrace
