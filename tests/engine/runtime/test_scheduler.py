"""Threads of a program take turns in simulated time."""

from __future__ import annotations

import pytest

from tests.running import Run

THREADS = (
    "import threading, time\ns = [threading.Thread(target=time.sleep, args=(1,)) for _ in range({})]\n"
    + ("for t in s: t.start()\nfor t in s: t.join()\nprint(threading.active_count())")
)


def test_starting_too_many_threads_raises_with_the_limit(run: Run) -> None:
    summary = run(THREADS.format(1001), prelude="none").ended.summary
    assert (
        summary == "RuntimeError: can't start new thread: a program may have 1000 at once (line 3)"
    )


@pytest.mark.parametrize(
    "last, end, exit_code", [("sys.exit(3)", "finished", 3), ("1 / 0", "raised", 1)]
)
def test_other_threads_go_on_after_an_error_or_exit_of_the_main_thread(
    run: Run, last: str, end: str, exit_code: int
) -> None:
    done = run(f"import sys, threading\nthreading.Timer(0.3, print, ('late',)).start()\n{last}")
    assert (done.lines, done.ended.end, done.ended.exit_code) == (["late"], end, exit_code)


@pytest.mark.slow
def test_pandas_and_a_thread_pool_work_in_programs(run: Run) -> None:
    done = run(
        "import datetime, time\nimport pandas as pd\nfrom multiprocessing.pool import ThreadPool\n"
        "print(pd.DataFrame({'a': [1, 2]}).a.sum(), datetime.datetime.now().year)\n"
        "print(isinstance(datetime.datetime.now() + datetime.timedelta(1), datetime.date))\n"
        "def f(x):\n    time.sleep(0.1)\n    return x * x\n"
        "with ThreadPool(3) as pool: print(pool.map(f, range(5)))"
    )
    assert done.lines == ["3 2020", "True", "[0, 1, 4, 9, 16]"]
