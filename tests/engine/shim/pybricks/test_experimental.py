"""`run_parallel`, and threads whose motors move at the same time."""

from __future__ import annotations

import pytest

from tests.engine.shim.conftest import RunOn

MOVE = """
import _thread, threading, utime
from pybricks.ev3devices import Motor
from pybricks.experimental import run_parallel
from pybricks.parameters import Port

motors = Motor(Port.B), Motor(Port.C)

def move(at, speed):
    motors[at].run_angle(speed, 360)
    print(speed, utime.ticks_ms() // 100)
    return motors[at].angle()

def slow():
    return move(0, 200)

def fast():
    return move(1, 400)
"""
STARTS = {
    "run_parallel": "print(tuple(run_parallel(slow, fast).values()))",
    "threading": "threads = [threading.Thread(target=each) for each in (slow, fast)]\n"
    "for thread in threads:\n    thread.start()\nfor thread in threads:\n    thread.join()\nprint((360, 360))",
    "_thread": "_thread.start_new_thread(fast, ())\nslow()\nprint((360, 360))",
}


@pytest.mark.parametrize("start", STARTS)
def test_run_parallel_moves_two_motors_at_the_same_time(run_on: RunOn, start: str) -> None:
    done = run_on(MOVE + STARTS[start], profile="lego-micropython")
    # 360 degrees at 200 degrees per second last 1.9 s, at 400 1.2 s.
    assert done.lines == ["400 11", "200 19", "(360, 360)"], done.errors


def test_run_parallel_gives_each_functions_result_by_that_function(run_on: RunOn) -> None:
    text = f"{MOVE}\nfound = run_parallel(slow, fast)\nprint(found[slow], found[fast])"
    assert run_on(text, profile="lego-micropython").lines[-1] == "360 360"


def test_an_error_in_one_function_of_run_parallel_ends_the_others(run_on: RunOn) -> None:
    text = f"{MOVE}\nrun_parallel(lambda: 1 / 0, fast)"
    done = run_on(text, profile="lego-micropython")
    assert done.lines == []
    assert "ZeroDivisionError: division by zero" in done.errors
    assert done.errors[-1].startswith("RuntimeError: ")


@pytest.mark.parametrize("functions", ["fast", "fast, 5", ""])
def test_run_parallel_refuses_fewer_than_two_functions(run_on: RunOn, functions: str) -> None:
    done = run_on(f"{MOVE}\nrun_parallel({functions})", profile="lego-micropython")
    assert "TypeError: run_parallel() needs two or more functions" in done.errors
