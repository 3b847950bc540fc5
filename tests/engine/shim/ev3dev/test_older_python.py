"""Programs for the older Python of the brick, and for MicroPython with ev3dev2."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from tests.running import Run

# The program, and what it prints on a brick.
PROGRAMS: Mapping[str, tuple[str, str]] = {
    "a coroutine by decorator": (
        """
import asyncio
@asyncio.coroutine
def answer():
    yield from asyncio.sleep(1)
    return 42
print(asyncio.get_event_loop().run_until_complete(answer()))
""",
        "42",
    ),
    "isAlive": (
        """
import threading, time
thread = threading.Thread(target=time.sleep, args=(1,))
thread.setDaemon(True)
thread.start()
print(thread.isAlive(), time.sleep(2), thread.isAlive())
""",
        "True None False",
    ),
    "gcd": ("import fractions\nprint(fractions.gcd(12, 18))", "6"),
    "collections": ("import collections\nprint(isinstance({}, collections.Mapping))", "True"),
    "utime": (
        """
from utime import sleep_ms, ticks_diff, ticks_ms
start = ticks_ms()
sleep_ms(500)
print(ticks_diff(ticks_ms(), start))
""",
        "500",
    ),
    "ujson": ("import ujson\nprint(ujson.loads('[1]'))", "[1]"),
}


@pytest.mark.parametrize("case", PROGRAMS)
def test_functions_that_only_the_bricks_older_python_has_work_without_a_warning(
    run: Run, case: str
) -> None:
    text, printed = PROGRAMS[case]
    done = run(text, profile="ev3", prelude="none")
    assert (done.lines, done.errors) == ([printed], [])


def test_a_program_in_the_course_profile_has_todays_python(run: Run) -> None:
    text = "import threading\nprint(hasattr(threading.Thread, 'isAlive'))"
    assert run(text, profile="robolab", prelude="none").lines == ["False"]
