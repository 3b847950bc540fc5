"""Simulated time in everything a program can tell the time with, and threads on the scheduler."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import Run, Start, until
from tuisim.app.snapshot import describe_busy_loop
from tuisim.engine.protocol import BusyLoop, Message

PROGRAMS = {
    "sleep": ("import time\ntime.sleep(1.5)\nprint(round(time.monotonic(), 3))", ["1.5"]),
    "reading before its value": ("colorLeft.color\nprint(get_clock())", ["0.02"]),
    "clock loop": (
        "import time\nt = time.time()\nwhile time.time() < t + 1: pass\nprint(round(time.time() - t, 2))",
        ["1.0"],
    ),
    "date": (
        "import datetime\nprint(datetime.datetime.now().year, datetime.date.today())",
        ["2020 2020-01-01"],
    ),
    "clock imported anew": (
        "import importlib, sys, time\ndel sys.modules['time']\nimport time\nprint(round(time.time()))\n"
        "importlib.reload(time)\nprint(round(time.time()))",
        ["1577836800", "1577836800"],
    ),
    "random": ("import random\nprint(random.random())", ["0.8444218515250481"]),
    "queue": (
        "import queue, threading, time\nq = queue.Queue()\n"
        "def work():\n    for i in range(3):\n        time.sleep(0.3)\n        q.put(i)\n"
        "threading.Thread(target=work).start()\nfor i in range(3): print(q.get(), round(time.monotonic(), 1))\n"
        "try: q.get(timeout=1)\nexcept queue.Empty: print('empty', round(time.monotonic(), 1))",
        ["0 0.3", "1 0.6", "2 0.9", "empty 1.9"],
    ),
    "pool": (
        "from concurrent.futures import ThreadPoolExecutor\nimport time\n"
        "def f(x):\n    time.sleep(x / 10)\n    return x\n"
        "with ThreadPoolExecutor(3) as pool: print(list(pool.map(f, range(6))))\nprint(round(time.monotonic(), 1))",
        ["[0, 1, 2, 3, 4, 5]", "0.7"],
    ),
    "asyncio": (
        "import asyncio, time\nasync def f(n):\n    for i in range(2):\n        await asyncio.sleep(0.1 * n)\n"
        "        print(n, i)\nasync def main(): await asyncio.gather(f(1), f(3))\nasyncio.run(main())\n"
        "print(round(time.monotonic(), 1))",
        ["1 0", "1 1", "3 0", "3 1", "0.6"],
    ),
    "what a lock looks like": (
        "import threading\nlock = threading.Lock()\nwith lock: print(lock, type(lock).__name__)\nprint(lock)",
        [
            "<locked _thread.lock object at 0x7f0000000010> lock",
            "<unlocked _thread.lock object at 0x7f0000000010>",
        ],
    ),
    "event": (
        "import threading, time\ne = threading.Event()\nthreading.Timer(0.5, e.set).start()\n"
        "print(e.wait(2), round(time.monotonic(), 1), e.wait(0.1))",
        ["True 0.5 True"],
    ),
    "condition and barrier": (
        "import threading, time\nb = threading.Barrier(3)\n"
        "def f(n):\n    time.sleep(n / 10)\n    b.wait()\n    print(n, round(time.monotonic(), 1))\n"
        "ts = [threading.Thread(target=f, args=(n,)) for n in range(3)]\n"
        "for t in ts: t.start()\nfor t in ts: t.join()\nprint(any(t.is_alive() for t in ts))",
        None,
    ),
    "spinning threads": (
        "import threading\nflag = []\ndef f():\n    while not flag: pass\n    print('seen')\n"
        "t = threading.Thread(target=f)\nt.start()\nfor i in range(2000): pass\nflag.append(1)\nt.join()\nprint('end')",
        ["seen", "end"],
    ),
    "non-daemon thread outlives main": (
        "import threading, time\ndef f():\n    time.sleep(1)\n    print('late')\n"
        "threading.Thread(target=f).start()\nprint('early')",
        ["early", "late"],
    ),
    "a sleep after a join that was given up": (
        "import threading, time\nt = threading.Thread(target=lambda: time.sleep(2))\nt.start()\nt.join(0.5)\n"
        "time.sleep(5)\nprint(round(time.monotonic(), 1))",
        ["5.5"],
    ),
    "error in a thread": (
        "import threading\nt = threading.Thread(target=lambda: 1 / 0)\nt.start()\nt.join()\nprint('main goes on')",
        ["main goes on"],
    ),
    "library's odometry thread": (
        "from ev3dev2.motor import MoveDifferential\nfrom ev3dev2.wheel import EV3Tire\n"
        "m = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 180)\nm.odometry_start()\nm.on_for_distance(30, 300)\n"
        "m.odometry_stop()\nprint(round(m.y_pos_mm))",
        ["300"],
    ),
}


@pytest.mark.quick_cases(
    "sleep", "spinning threads", "error in a thread", "event", "queue", "clock loop"
)
@cases("text, lines", PROGRAMS)
def test_clocks_and_threads_give_the_same_run_twice(
    run: Run, text: str, lines: list[str] | None
) -> None:
    first = run(text)
    assert first.ended.end == "finished", first.errors
    if lines is not None:
        assert first.lines == lines
    assert run(text).recording == first.recording


def test_output_and_ticks_are_recorded_with_the_programs_line(run: Run) -> None:
    done = run("import time\n\nprint('A: 1')\ntime.sleep(0.1)\nprint('A: 2')\n")
    rows = done.run.output.read_all_rows()
    assert [(row.text, row.line, row.time_ns, row.tick) for row in rows] == [
        ("A: 1", 3, 0, 0),
        ("A: 2", 5, 100_000_000, 10),
    ]
    assert [done.run.telemetry.record(tick).line for tick in range(11)] == [0] + [4] * 10


@pytest.mark.parametrize(
    "text, told",
    [
        (
            "import time\ntime.sleep(1)\nx = 0\nwhile True:\n    x += 1\n",
            [BusyLoop(5, 1_000_000_000)],
        ),
        ("while True:\n    x = colorLeft.reflected_light_intensity_pc\n", []),
    ],
    ids=["computes", "reads"],
)
def test_a_long_loop_without_a_wait_sends_an_event_with_its_line(
    start: Start, text: str, told: list[BusyLoop]
) -> None:
    seen: list[Message] = []
    run = start(text, live=True, speed=0.0, time_limit_s=7.0)
    until(run, lambda: run.ended is not None, seen)
    assert [event for event in seen if isinstance(event, BusyLoop)] == told


def test_the_output_says_what_stops_a_long_loop() -> None:
    words = "— line 5: a loop without a wait since 1.00 s. {stop} stops it"
    assert describe_busy_loop(BusyLoop(5, 1_000_000_000)) == words


@pytest.mark.parametrize(
    ("profile", "lines"),
    [("ev3", ["True 1.0"]), ("robolab", ["False"])],
)
def test_the_bricks_python_has_the_old_clock(run: Run, profile: str, lines: list[str]) -> None:
    text = "import time\nhas = hasattr(time, 'clock')\nif not has: print(has)\nelse:\n"
    text += "    start = time.clock()\n    time.sleep(1)\n    print(has, round(time.clock() - start, 3))"
    assert run(text, profile=profile, prelude="none").lines == lines
