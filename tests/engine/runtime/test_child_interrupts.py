"""Stops, limits and signals reach a program wherever it is."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import PATIENCE_S, Run, Start, over, until

ENDLESS = "    while True: time.sleep(1)\n"


LATE = {
    "exit function": f"import atexit, time\n@atexit.register\ndef f():\n{ENDLESS}",
    "__del__": f"import time\nclass A:\n  def __del__(self):\n{ENDLESS}A()\ntime.sleep(0.1)\nprint('no')",
    "__del__ at the end": f"import time\nclass A:\n  def __del__(self):\n{ENDLESS}a = A()",
    "generator at the end": f"import time\ndef g():\n  try: yield\n  finally:\n{ENDLESS}a = g()\nnext(a)",
}


@cases("text", LATE)
def test_the_time_limit_also_ends_code_that_python_calls_at_exit(run: Run, text: str) -> None:
    done = run(text, prelude="none", time_limit_s=2.0)
    assert (done.ended.end, done.lines, done.errors) == ("time_limit", [], [])


@cases("text", LATE)
def test_a_stop_also_ends_code_that_python_calls_at_exit(start: Start, text: str) -> None:
    handle = start(text, prelude="none", live=True)
    until(handle, lambda: handle.telemetry.count > 2)
    handle.stop()
    done = over(handle)
    assert (done.ended.end, done.ended.summary, done.lines, done.errors) == (
        "stopped",
        "stopped",
        [],
        [],
    )


ASKS = "import itertools\ndef ask(_):\n    try: input('? ')\n    except EOFError: pass\nall(ask(i) is None for i in {})"


@pytest.mark.parametrize(
    "options", [{}, {"live": True, "speed": 0.0}, {"live": True}], ids=["headless", "fast", "live"]
)
def test_a_program_that_asks_for_input_without_end_can_be_stopped(
    start: Start, options: dict[str, object]
) -> None:
    handle = start(
        ASKS.format("map(int, itertools.count())"), prelude="none", time_limit_s=0.0, **options
    )
    until(handle, lambda: handle.started and len(handle.output.read_new_rows()) > 0)
    handle.stop()
    assert over(handle).ended.summary == "stopped"


OWN_SIGNALS = {
    "a handler that raises": (
        "import signal, time\ndef f(*_): 1 / 0\nfor n in (signal.SIGUSR1, signal.SIGUSR2): signal.signal(n, f)\n"
        "while True: time.sleep(1)",
        "stopped",
    ),
    "no handler": ("import signal\nsignal.raise_signal(signal.SIGUSR1)", "crashed"),
    "without a name": ("import signal\nsignal.raise_signal(40)", "crashed"),
}


@cases("text, end", OWN_SIGNALS)
def test_signal_handlers_of_the_program_do_not_prevent_a_stop(
    start: Start, text: str, end: str
) -> None:
    handle = start(text, prelude="none", live=True)
    until(handle, lambda: handle.telemetry.count > 2 or handle.ended is not None)
    handle.stop()
    assert over(handle).ended.end == end


HARD_TO_STOP = {
    "spin": "while True: pass",
    "sleep": "import time\nwhile True: time.sleep(10)",
    "bare except": "import time\nwhile True:\n    try: time.sleep(0.01)\n    except: pass",
    "regex": "import re\nre.match(r'(a+)+$', 'a' * 60 + 'b')",
    "C call": "sum(range(10**12))",
    "print flood": "i = 0\nwhile True:\n    print('A:', i)\n    i += 1",
    "memory": "x = []\nwhile True:\n    x.append(bytearray(100_000))\n    if len(x) > 5000: x.clear()",
    "threads": "import threading\ndef f():\n    while True: pass\nt = threading.Thread(target=f)\nt.start()\nt.join()",
    "ignores signals": "import signal\nfor n in range(34, 65): signal.signal(n, signal.SIG_IGN)\nwhile True: pass",
    "endless cleaning up": "try:\n    while True: pass\nfinally:\n    while True: pass",
}


@pytest.mark.slow_cases("C call")
@cases("text", HARD_TO_STOP)
def test_stop_always_works_and_keeps_what_was_printed(start: Start, text: str) -> None:
    run = start("print('Before: 1')\n" + text, live=True)
    until(run, lambda: run.output.length > 0)
    run.stop()
    ended = run.wait(PATIENCE_S)
    assert ended is not None
    assert ended.end == "stopped"
    assert run.output.read_all_rows()[0].text == "Before: 1"


def test_cleaning_up_runs_after_a_stop(start: Start) -> None:
    run = start(
        "import time\ntry:\n    print('A: 1')\n    time.sleep(100)\nfinally:\n    print('clean')",
        live=True,
    )
    until(run, lambda: run.output.length > 0)
    run.stop()
    run.wait(PATIENCE_S)
    assert [row.text for row in run.output.read_all_rows()] == ["A: 1", "clean"]
