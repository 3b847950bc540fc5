"""The time that a process waits for a processor."""

from __future__ import annotations

import os
import subprocess
import sys
import time

from tests.running import PATIENCE_S
from tuisim.engine.runs.child.process import measure_computed_s, measure_waited_s


def test_the_time_a_process_waits_for_a_processor_is_measured() -> None:
    # Two processes for one processor: at least one of them waits.
    start_s = time.monotonic()
    only = {min(os.sched_getaffinity(0))}
    spinning = [
        subprocess.Popen(
            [sys.executable, "-c", f"import os; os.sched_setaffinity(0, {only})\nwhile True: pass"]
        )
        for _ in range(2)
    ]
    try:
        give_up = time.monotonic() + PATIENCE_S
        while sum(measure_waited_s(process.pid) for process in spinning) < 0.1:
            assert time.monotonic() < give_up
            time.sleep(0.01)
        assert sum(measure_waited_s(one.pid) for one in spinning) <= 2 * (
            time.monotonic() - start_s
        )
    finally:
        for process in spinning:
            process.kill()
            process.wait()
    assert measure_waited_s(spinning[0].pid) == measure_computed_s(spinning[0].pid) == 0.0


def test_the_time_its_other_threads_wait_for_a_processor_is_measured_too() -> None:
    busy = f"import os, threading\nos.sched_setaffinity(0, {{{min(os.sched_getaffinity(0))}}})\n"
    busy += "threading.Thread(target=lambda: sum(range(10**12))).start()\nprint(flush=True)\n"
    spinning = [
        subprocess.Popen([sys.executable, "-c", busy], stdout=subprocess.PIPE) for _ in range(2)
    ]
    try:
        give_up = time.monotonic() + PATIENCE_S
        while sum(
            measure_waited_s(process.pid) for process in spinning
        ) < 0.1 or not measure_computed_s(spinning[0].pid):
            assert time.monotonic() < give_up
            time.sleep(0.01)
    finally:
        for process in spinning:
            process.kill()
            process.communicate()
