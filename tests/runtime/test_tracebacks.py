"""Errors that are hard to tell, and ends that come from below: told in the program's own terms all the same."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.running import PATIENCE_S, Run, Start, over, until
from tuisim.protocol import End, Ended
from tuisim.runs.child.events import decode_event

CAFE = "b'caf\\xe9'.decode('utf-8', 'surrogateescape')"
"""A text that no UTF-8 can hold, such as a file name of another system."""

ERRORS = {
    "lone surrogate": (f"raise ValueError({CAFE})", "ValueError: caf\\udce9 (line 1)"),
    "folder deleted": (
        "import os, tempfile\nos.chdir(tempfile.mkdtemp())\nos.rmdir(os.getcwd())\n1 / 0",
        "ZeroDivisionError: division by zero (line 4)",
    ),
    "3,000 causes": (
        "e = ValueError(0)\nfor i in range(3000):\n    e, e.__cause__ = ValueError(i), e\nraise e",
        "ValueError: 2999 (line 4)",
    ),
    "3,000 groups": (
        "e = ValueError(0)\nfor i in range(3000): e = ExceptionGroup('g', [e])\nraise e",
        "ExceptionGroup: g (1 sub-exception) (line 3)",
    ),
    "class that says nothing": (
        "class M(type):\n    def __getattribute__(cls, name): raise AttributeError(name)\n"
        "class Odd(Exception, metaclass=M): pass\nraise Odd",
        "Odd: <cannot be shown: AttributeError> (line 4)",
    ),
}


@pytest.mark.parametrize(("text", "summary"), ERRORS.values(), ids=ERRORS)
def test_an_error_that_is_hard_to_tell_is_told(run: Run, text: str, summary: str) -> None:
    done = run(text, prelude="none")
    assert (done.ended.end, done.ended.summary) == ("raised", summary)
    assert not any("tuisim" in line for line in done.errors)


def test_of_a_long_chain_the_first_and_the_last_errors_are_told(run: Run) -> None:
    text = "e = KeyError('first')\nfor i in range(3000):\n    e, e.__cause__ = ValueError(i), e\nraise e"
    errors = run(text, prelude="none").errors
    assert errors[0] == "KeyError: 'first'"
    assert "[2,981 more errors, each of which led to the next one]" in errors
    assert sum(line.startswith("ValueError: ") for line in errors) == 19


EXITS = {
    "no text": ("class A:\n    def __str__(self): 1 / 0\nraise SystemExit(A())", 1, ["<A, whose str() failed>"]),
    "lone surrogate": (f"raise SystemExit({CAFE})", 1, ["caf\\udce9"]),
    "no exit status": ("raise SystemExit(10**30)", -1, []),
    "in a thread": (
        "import os, threading, time\nthreading.Thread(target=lambda: os._exit(7)).start()\ntime.sleep(1)\nprint('no')",
        7,
        [],
    ),
}


@pytest.mark.parametrize(("text", "code", "errors"), EXITS.values(), ids=EXITS)
def test_a_program_that_ends_itself(run: Run, text: str, code: int, errors: list[str]) -> None:
    done = run(text, prelude="none")
    assert (done.ended.end, done.ended.exit_code, done.errors, done.lines) == ("finished", code, errors, [])


def test_lone_surrogates_lose_neither_output_nor_export(here: Command, tmp_path: Path) -> None:
    (tmp_path / "cafe.py").write_text(
        f"cafe = {CAFE}\nprint('A: 1')\nprint(cafe)\nsay(cafe, show=False)\n"
        "try: input(cafe)\nexcept EOFError: raise ValueError(cafe)"
    )
    done = here("run", "cafe.py", "--export", "cafe.csv")
    assert (done.returncode, done.stdout) == (1, "A: 1\ncaf\\udce9\n")
    assert "says: caf\\udce9\n" in done.stderr
    assert ",A,1" in (tmp_path / "cafe.csv").read_text()


ENDLESS = "    while True: time.sleep(1)\n"
LATE = {
    "exit function": f"import atexit, time\n@atexit.register\ndef f():\n{ENDLESS}",
    "two exit functions": f"import atexit, time\ndef f():\n{ENDLESS}atexit.register(f)\natexit.register(f)",
    "__del__": f"import time\nclass A:\n  def __del__(self):\n{ENDLESS}A()\ntime.sleep(0.1)\nprint('no')",
    "__del__ at the end": f"import time\nclass A:\n  def __del__(self):\n{ENDLESS}a = A()",
    "generator at the end": f"import time\ndef g():\n  try: yield\n  finally:\n{ENDLESS}a = g()\nnext(a)",
}


@pytest.mark.parametrize("text", LATE.values(), ids=LATE)
def test_a_limit_in_what_python_calls_at_the_end_is_one(run: Run, text: str) -> None:
    done = run(text, prelude="none", time_limit_s=2.0)
    assert (done.ended.end, done.lines, done.errors) == ("time_limit", [], [])


@pytest.mark.parametrize("text", LATE.values(), ids=LATE)
def test_a_stop_in_what_python_calls_at_the_end_is_one(start: Start, text: str) -> None:
    handle = start(text, prelude="none", live=True)
    until(handle, lambda: handle.telemetry.count > 2)
    handle.stop()
    done = over(handle)
    assert (done.ended.end, done.ended.summary, done.lines, done.errors) == ("stopped", "stopped", [], [])


def test_an_error_that_python_cannot_raise_shows_the_programs_lines_only(run: Run) -> None:
    done = run("import time\nclass A:\n    def __del__(self): time.sleep(-1)\nA()\nprint('on')", prelude="none")
    assert done.errors == [
        "Exception ignored in: <function A.__del__ at 0x7f0000000010>",
        "Traceback (most recent call last):",
        '  File "program.py", line 3, in __del__',
        "    def __del__(self): time.sleep(-1)",
        "                       ^^^^^^^^^^^^^^",
        "ValueError: sleep length must be non-negative",
    ]
    assert done.lines == ["on"]


def test_what_goes_at_the_end_still_finds_its_names(run: Run) -> None:
    text = (
        "class A:\n    def __del__(self): print('gone', seen)\nseen = [1]\na = A()\nseen.append(a.__class__.__name__)"
    )
    assert run(text, prelude="none").lines == ["gone [1, 'A']"]


CRASHES = {
    "SIGSEGV": "import ctypes\nprint('A: 1')\nctypes.string_at(0)",
    "SIGABRT": "import os\nprint('A: 1')\nos.abort()",
    "SIGFPE": "import signal\nprint('A: 1')\nsignal.raise_signal(signal.SIGFPE)",
}


@pytest.mark.parametrize(("signal", "text"), CRASHES.items(), ids=CRASHES)
@pytest.mark.parametrize("before", ["", "import faulthandler; faulthandler.enable(); "], ids=["plain", "enabled"])
def test_a_crash_names_the_line(run: Run, signal: str, text: str, before: str) -> None:
    done = run(before + text, prelude="none")
    assert (done.ended.end, done.ended.error_line, done.lines) == ("crashed", 3, ["A: 1"])
    assert done.ended.summary == f"the program's process was ended by {signal} in line 3"


OWN_STACK = {
    "print_stack": (
        "traceback.print_stack()",
        ['  File "program.py", line 2, in f', "    def f(): traceback.print_stack()"],
    ),
    "walk_stack": ("[print(f.f_code.co_name) for f, _ in traceback.walk_stack(None)]", ["<listcomp>", "f", "<module>"]),
    "print_exc": (
        "\n    try: time.sleep(-1)\n    except ValueError: traceback.print_exc()",
        ["    try: time.sleep(-1)", "         ^^^^^^^^^^^^^^", "ValueError: sleep length must be non-negative"],
    ),
    "inspect": ("print([info.function for info in inspect.stack()])", ["['f', '<module>']"]),
    "faulthandler": ("faulthandler.dump_traceback()", ['  File "program.py", line 2 in f']),
    "enabled": ("faulthandler.enable(); print(faulthandler.is_enabled())", ["True"]),
    "later": ("faulthandler.dump_traceback_later(1); print('on')", ["on"]),
}


@pytest.mark.parametrize(("text", "told"), OWN_STACK.values(), ids=OWN_STACK)
def test_a_program_sees_its_own_frames_only(run: Run, text: str, told: list[str]) -> None:
    done = run(f"import faulthandler, inspect, time, traceback\ndef f(): {text}\nf()", prelude="none")
    assert done.ended.end == "finished"
    seen = [row.text for row in done.run.output.all_rows()]
    assert set(told) <= set(seen)
    assert not any("tuisim" in line or "runpy" in line for line in seen)


THREADS = "import threading, time\ns = [threading.Thread(target=time.sleep, args=(1,)) for _ in range({})]\n" + (
    "for t in s: t.start()\nfor t in s: t.join()\nprint(threading.active_count())"
)


def test_500_threads_run(run: Run) -> None:
    done = run(THREADS.format(500), prelude="none")
    assert (done.lines, done.ended.time_ns) == (["1"], 1_000_000_000)


def test_the_limit_of_threads_is_named(run: Run) -> None:
    summary = run(THREADS.format(1001), prelude="none").ended.summary
    assert summary == "RuntimeError: can't start new thread: a program may have 1000 at once (line 3)"


ASKS = "import itertools\ndef ask(_):\n    try: input('? ')\n    except EOFError: pass\nall(ask(i) is None for i in {})"


@pytest.mark.parametrize(
    "options", [{}, {"live": True, "speed": 0.0}, {"live": True}], ids=["headless", "fast", "live"]
)
def test_asking_without_end_can_be_stopped(start: Start, options: dict[str, object]) -> None:
    handle = start(ASKS.format("map(int, itertools.count())"), prelude="none", time_limit_s=0.0, **options)
    until(handle, lambda: handle.started and len(handle.output.new_rows()) > 0)
    handle.stop()
    assert over(handle).ended.summary == "stopped"


@pytest.mark.usefixtures("home")
def test_a_program_whose_name_is_not_utf_8_runs_and_is_listed(here: Command, tmp_path: Path) -> None:
    program = tmp_path / os.fsdecode(b"caf\xe9.py")
    program.write_text("print('A: 1')\n")
    assert here("run", program).stdout == "A: 1\n"
    assert "caf?.py" in here("runs", "list").stdout


OWN_SIGNALS = {
    "a handler that raises": (
        "import signal, time\ndef f(*_): 1 / 0\nfor n in (signal.SIGUSR1, signal.SIGUSR2): signal.signal(n, f)\n"
        "while True: time.sleep(1)",
        "stopped",
    ),
    "no handler": ("import signal\nsignal.raise_signal(signal.SIGUSR1)", "crashed"),
    "without a name": ("import signal\nsignal.raise_signal(40)", "crashed"),
}


@pytest.mark.parametrize(("text", "end"), OWN_SIGNALS.values(), ids=OWN_SIGNALS)
def test_signals_are_the_programs(start: Start, text: str, end: str) -> None:
    handle = start(text, prelude="none", live=True)
    until(handle, lambda: handle.telemetry.count > 2 or handle.ended is not None)
    handle.stop()
    assert over(handle).ended.end == end


def test_a_run_whose_folder_cannot_be_used_says_why(tmp_path: Path) -> None:
    (commands, _), (events, event_fd), (lifeline, _), (lock, _) = pipes = [os.pipe() for _ in range(4)]
    fds = (commands, event_fd, lifeline, lock)
    try:
        words = [sys.executable, "-m", "tuisim.runtime", str(tmp_path / "gone"), *map(str, fds)]
        done = subprocess.run(
            # In a group of its own: the child asks for a signal to its group at the end of the lifeline.
            words,
            pass_fds=fds,
            capture_output=True,
            start_new_session=True,
            timeout=PATIENCE_S,
            check=False,
        )
        os.close(event_fd)
        with open(events, "rb", closefd=False) as file:
            told = [decode_event(line) for line in file]
    finally:
        for fd in {fd for pipe in pipes for fd in pipe} - {event_fd}:
            os.close(fd)
    reason = "the run cannot begin: No such file or directory"
    assert (told, done.stderr) == ([Ended(End.CRASHED, 0, 0, 1, reason)], b"")
