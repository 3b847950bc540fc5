"""Alarms are refused; signals that a program sends to itself interrupt whatever its main thread waits for."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import Run

HEAD = """\
import os, signal, threading, time
now = lambda: round(time.monotonic(), 2)
class Late(Exception): pass
def tell(number, frame): print('hit', number, frame.f_lineno, now())
def late(number, frame): raise Late
def slow(number, frame):
    time.sleep(3)
    print('slept', now())
signal.signal(signal.SIGINT, {handler})
def after(seconds): threading.Timer(seconds, signal.raise_signal, (signal.SIGINT,)).start()
"""

PROGRAMS: dict[str, tuple[str, str, list[str]]] = {
    "at once": (
        "tell",
        "os.kill(os.getpid(), signal.SIGINT)\nprint(now())",
        ["hit 2 11 0.0", "0.0"],
    ),
    "a sleep goes on": ("tell", "after(2)\ntime.sleep(5)\nprint(now())", ["hit 2 12 2.0", "5.0"]),
    "a sleep ends with what is raised": (
        "late",
        "after(2)\ntry: time.sleep(5)\nexcept Late: print(now())",
        ["2.0"],
    ),
    "a pause": ("tell", "after(2)\nsignal.pause()\nprint(now())", ["hit 2 12 2.0", "2.0"]),
    "a lock that is free by then": (
        "slow",
        "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(2, lock.release).start()\n"
        "after(1)\nlock.acquire()\nprint(now(), lock.locked())",
        ["slept 4.0", "4.0 True"],
    ),
    "a lock that nobody gets": (
        "late",
        "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(2, lock.release).start()\n"
        "after(1)\ntry: lock.acquire()\nexcept Late: time.sleep(3)\nprint(now(), lock.locked())",
        ["4.0 False"],
    ),
    "a thread": (
        "slow",
        "thread = threading.Thread(target=time.sleep, args=(2,))\nthread.start()\n"
        "after(1)\nthread.join()\nprint(now())",
        ["slept 4.0", "4.0"],
    ),
    "ignored": ("signal.SIG_IGN", "after(1)\ntime.sleep(2)\nprint(now())", ["2.0"]),
    "what is set is known": ("tell", "print(signal.getsignal(signal.SIGINT) is tell)", ["True"]),
}


@cases("handler, text, lines", PROGRAMS)
def test_an_interrupt_comes_in_simulated_time(
    run: Run, handler: str, text: str, lines: list[str]
) -> None:
    done = run(HEAD.format(handler=handler) + text, prelude="none")
    assert (done.ended.end, done.lines) == ("finished", lines), done.errors


@pytest.mark.parametrize(
    "call",
    [
        "alarm(2)",
        "setitimer(signal.ITIMER_REAL, 0.5, 0.3)",
        "setitimer(signal.ITIMER_VIRTUAL, 1)",
        "getitimer(signal.ITIMER_REAL)",
        "signal(signal.SIGALRM, print)",
    ],
)
def test_an_alarm_is_refused(run: Run, call: str) -> None:
    done = run(f"import signal\nsignal.{call}", prelude="none")
    assert done.errors[-1] == (
        "NotSimulated: an alarm is not part of the simulated brick "
        "(use threading.Timer, or compare time.time() in the loop)"
    )
