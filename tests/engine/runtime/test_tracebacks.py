"""Errors that are hard to tell, and ends that come from below: told in the program's own terms all the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.conftest import Command
from tests.running import Run

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


@cases("text, summary", ERRORS)
def test_errors_with_odd_or_broken_texts_still_have_a_summary(
    run: Run, text: str, summary: str
) -> None:
    done = run(text, prelude="none")
    assert (done.ended.end, done.ended.summary) == ("raised", summary)
    assert not any("tuisim" in line for line in done.errors)


def test_of_a_long_chain_the_first_and_the_last_errors_are_told(run: Run) -> None:
    text = "e = KeyError('first')\nfor i in range(3000):\n    e, e.__cause__ = ValueError(i), e\nraise e"
    errors = run(text, prelude="none").errors
    assert errors[0] == "KeyError: 'first'"
    assert "[2,981 more errors, each of which led to the next one]" in errors
    assert sum(line.startswith("ValueError: ") for line in errors) == 19


def test_an_error_text_that_is_too_long_is_cut_off(run: Run) -> None:
    done = run("raise ValueError('x' * (9 << 20))", prelude="none")
    assert done.ended.end == "raised"
    assert done.ended.summary.endswith("x… (too long: 9,437,196 characters) (line 1)")
    assert len(done.ended.error) < 1 << 20 and "too long" in done.ended.error


EXITS = {
    "no text": (
        "class A:\n    def __str__(self): 1 / 0\nraise SystemExit(A())",
        1,
        ["<A, whose str() failed>"],
    ),
    "lone surrogate": (f"raise SystemExit({CAFE})", 1, ["caf\\udce9"]),
    "no exit status": ("raise SystemExit(10**30)", -1, []),
    "in a thread": (
        "import os, threading, time\nthreading.Thread(target=lambda: os._exit(7)).start()\ntime.sleep(1)\nprint('no')",
        7,
        [],
    ),
}


@cases("text, code, errors", EXITS)
def test_a_program_that_exits_itself_finishes_with_its_exit_code(
    run: Run, text: str, code: int, errors: list[str]
) -> None:
    done = run(text, prelude="none")
    assert (done.ended.end, done.ended.exit_code, done.errors, done.lines) == (
        "finished",
        code,
        errors,
        [],
    )


def test_lone_surrogates_lose_neither_output_nor_export(here: Command, tmp_path: Path) -> None:
    (tmp_path / "cafe.py").write_text(
        f"cafe = {CAFE}\nprint('A: 1')\nprint(cafe)\nsay(cafe, show=False)\n"
        "try: input(cafe)\nexcept EOFError: raise ValueError(cafe)"
    )
    done = here("run", "cafe.py", "--export", "cafe.csv")
    assert (done.returncode, done.stdout) == (1, "A: 1\ncaf\\udce9\n")
    assert "says: caf\\udce9\n" in done.stderr
    assert ",A,1" in (tmp_path / "cafe.csv").read_text()


def test_an_ignored_error_in_a_destructor_shows_only_the_programs_lines(run: Run) -> None:
    done = run(
        "import time\nclass A:\n    def __del__(self): time.sleep(-1)\nA()\nprint('on')",
        prelude="none",
    )
    assert done.errors == [
        "Exception ignored in: <function A.__del__ at 0x7f0000000010>",
        "Traceback (most recent call last):",
        '  File "program.py", line 3, in __del__',
        "    def __del__(self): time.sleep(-1)",
        "                       ^^^^^^^^^^^^^^",
        "ValueError: sleep length must be non-negative",
    ]
    assert done.lines == ["on"]


def test_destructors_at_the_programs_end_still_find_global_names(run: Run) -> None:
    text = (
        "class A:\n    def __del__(self): print('gone', seen)\n"
        "seen = [1]\na = A()\nseen.append(a.__class__.__name__)"
    )
    assert run(text, prelude="none").lines == ["gone [1, 'A']"]


CRASHES = {
    "SIGSEGV": "import ctypes\nprint('A: 1')\nctypes.string_at(0)",
    "SIGABRT": "import os\nprint('A: 1')\nos.abort()",
    "SIGFPE": "import signal\nprint('A: 1')\nsignal.raise_signal(signal.SIGFPE)",
}


@pytest.mark.parametrize("signal, text", CRASHES.items(), ids=CRASHES)
@pytest.mark.parametrize(
    "before", ["", "import faulthandler; faulthandler.enable(); "], ids=["plain", "enabled"]
)
def test_a_crash_of_the_interpreter_names_the_programs_line(
    run: Run, signal: str, text: str, before: str
) -> None:
    done = run(before + text, prelude="none")
    assert (done.ended.end, done.ended.error_line, done.lines) == ("crashed", 3, ["A: 1"])
    assert done.ended.summary == f"the program's process was killed by {signal} in line 3"
