"""Alarms of `signal` come in simulated time, and interrupt whatever the main thread waits for."""

from __future__ import annotations

import pytest

from tests.running import Run

HEAD = """\
import signal, threading, time
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
now = lambda: round(time.monotonic(), 2)
class Late(Exception): pass
def tell(number, frame): print('hit', number, frame.f_lineno, now())
def late(number, frame): raise Late
def slow(number, frame):
    time.sleep(3)
    print('slept', now())
signal.signal(signal.SIGALRM, {handler})
"""

PROGRAMS: dict[str, tuple[str, str, list[str]]] = {
    "a sleep goes on": (
        "tell",
        "signal.alarm(2)\ntime.sleep(5)\nprint(now())",
        ["hit 14 12 2.0", "5.0"],
    ),
    "a sleep ends with what is raised": (
        "late",
        "signal.alarm(2)\ntry: time.sleep(5)\nexcept Late: print(now())",
        ["2.0"],
    ),
    "a move": (
        "late",
        "signal.alarm(1)\ntry: MoveTank(OUTPUT_B, OUTPUT_C).on_for_seconds(20, 20, 5)\n"
        "except Late: print(now())",
        ["1.0"],
    ),
    "a loop that waits for nothing": (
        "late",
        "signal.alarm(1)\ntry:\n    while True: pass\nexcept Late: print(now())",
        ["1.0"],
    ),
    "again and again": (
        "tell",
        "print(signal.setitimer(signal.ITIMER_REAL, 0.5, 0.3), signal.getitimer(signal.ITIMER_REAL))\n"
        "time.sleep(1)\nprint(signal.alarm(0))\ntime.sleep(1)\nprint(now())",
        ["(0.0, 0.0) (0.5, 0.3)", "hit 14 12 0.5", "hit 14 12 0.8", "1", "2.0"],
    ),
    "set anew": (
        "tell",
        "signal.alarm(9)\nprint(signal.alarm(1))\ntime.sleep(2)",
        ["9", "hit 14 13 1.0"],
    ),
    "a pause": ("tell", "signal.alarm(2)\nsignal.pause()\nprint(now())", ["hit 14 12 2.0", "2.0"]),
    "a lock that is free by then": (
        "slow",
        "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(2, lock.release).start()\n"
        "signal.alarm(1)\nlock.acquire()\nprint(now(), lock.locked())",
        ["slept 4.0", "4.0 True"],
    ),
    "a lock that nobody gets": (
        "late",
        "lock = threading.Lock()\nlock.acquire()\nthreading.Timer(2, lock.release).start()\n"
        "signal.alarm(1)\ntry: lock.acquire()\nexcept Late: time.sleep(3)\nprint(now(), lock.locked())",
        ["4.0 False"],
    ),
    "a thread": (
        "slow",
        "thread = threading.Thread(target=time.sleep, args=(2,))\nthread.start()\n"
        "signal.alarm(1)\nthread.join()\nprint(now())",
        ["slept 4.0", "4.0"],
    ),
    "ignored": ("signal.SIG_IGN", "signal.alarm(1)\ntime.sleep(2)\nprint(now())", ["2.0"]),
    "what is set is known": ("tell", "print(signal.getsignal(signal.SIGALRM) is tell)", ["True"]),
    "another timer": (
        "tell",
        "try: signal.setitimer(signal.ITIMER_VIRTUAL, 1)\nexcept Exception as error: print(error)",
        ["this timer is not part of the simulated brick (use signal.ITIMER_REAL)"],
    ),
}


@pytest.mark.parametrize(("handler", "text", "lines"), PROGRAMS.values(), ids=PROGRAMS)
def test_an_alarm_comes_in_simulated_time(
    run: Run, handler: str, text: str, lines: list[str]
) -> None:
    done = run(HEAD.format(handler=handler) + text, prelude="none")
    assert (done.ended.end, done.lines) == ("finished", lines), done.errors


def test_an_alarm_that_nobody_handles_ends_the_program(run: Run) -> None:
    done = run("import signal, time\nsignal.alarm(2)\ntime.sleep(5)", prelude="none")
    assert (done.ended.end, done.ended.tick) == ("crashed", 200)
    assert done.ended.summary == "the program's process was ended by SIGALRM"
