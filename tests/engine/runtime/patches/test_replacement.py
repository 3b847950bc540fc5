"""What the runtime puts in the place of Python's own functions and classes passes for them."""

from __future__ import annotations

import importlib
import inspect

from tests.cases import cases
from tests.running import Run

MODULES = (
    "time",
    "os",
    "posix",
    "_thread",
    "threading",
    "builtins",
    "faulthandler",
    "select",
    "signal",
    "sys",
    "gc",
)
"""Where there are builtins that the runtime could replace."""

CHECKS = {
    "does not become a method": "type('C', (), {'f': f})().f is f",
    "is a builtin": "inspect.isbuiltin(f)",
    "has its name": "f.__name__ == name and f.__qualname__ == qualname",
    "is shown as one": "repr(f).startswith('<built-in ')",
    "is itself when copied": "copy.copy(f) is f and copy.deepcopy([f])[0] is f",
    "is itself when pickled": "pickle.loads(pickle.dumps(f)) is f",
}

WALK = """\
import copy, importlib, inspect, pickle
for module, name, qualname in {names}:
    f = getattr(importlib.import_module(module), name, None)
    if f is not None and not ({check}): print(module, name, f)
"""


def builtins_of(module: str) -> list[tuple[str, str, str]]:
    """Return module, name and qualified name of the builtin functions of a module, as they are in this process."""
    names = vars(importlib.import_module(module)).items()
    return [
        (module, name, part.__qualname__)
        for name, part in names
        # `sys` has hooks that are put there, and `open` is one of `io`: pickled by another name.
        if inspect.isbuiltin(part) and part.__name__ == name and not name.endswith("hook")
    ]


@cases("check", CHECKS)
def test_replaced_builtins_still_look_like_builtins(run: Run, check: str) -> None:
    names = [row for module in MODULES for row in builtins_of(module)]
    done = run(WALK.format(names=names, check=check), prelude="none")
    assert (done.ended.end, done.lines) == ("finished", [])


FUNCTIONS = {
    "time.sleep": ("", "'x'", "-1", "1, 2", "seconds=1", "float('nan')", "1e300", "10**30", "1j"),
    "time.time": ("1", "x=1"),
    "time.monotonic_ns": ("1",),
    "time.clock_gettime": ("", "'x'", "99"),
    "time.localtime": ("1, 2", "'x'", "1e300"),
    "time.strftime": ("", "1", "'%H', 1"),
    "time.asctime": ("1",),
    "os.urandom": ("", "'x'", "-1"),
    "os._exit": ("'x'",),
    "signal.signal": ("", "15", "15, 3.5", "'x', 1"),
    "input": ("1, 2", "prompt='x'"),
    "_thread.start_new_thread": ("", "1, ()", "print, []", "print, (), 1"),
    "_thread.allocate_lock": ("1",),
    "threading.Lock": ("1",),
    "threading.Lock().acquire": (
        "timeout=1e300",
        "timeout='x'",
        "timeout=-2",
        "timeout=float('nan')",
        "False, 1",
    ),
}
CALLS = [f"{function}({arguments})" for function, every in FUNCTIONS.items() for arguments in every]

TELL = """\
import _thread, os, signal, threading, time
for call in {calls}:
    try:
        eval(call)
        said.append('no error')
    except Exception as error:
        said.append(f'{{type(error).__name__}}: {{error}}')
"""


def test_replaced_builtins_raise_pythons_errors_for_wrong_arguments(run: Run) -> None:
    text = TELL.format(calls=CALLS)
    said: list[str] = []
    exec(text, {"said": said})
    done = run(f"said = []\n{text}for one in said: print(one)", prelude="none")
    assert dict(zip(CALLS, done.lines, strict=True)) == dict(zip(CALLS, said, strict=True))


VALUES = {
    "a logger's time": (
        "import logging\nlogging.basicConfig(format='%(asctime)s %(message)s')\nlogging.warning('hi')\n",
        [],
        ["2020-01-01 00:00:00,000 hi"],
    ),
    "dates as text": (
        "import datetime\nprint(repr(datetime.datetime.now()), [datetime.date.today()], datetime.datetime)\n",
        [
            "datetime.datetime(2020, 1, 1, 0, 0, 0, 20) [datetime.date(2020, 1, 1)] <class 'datetime.datetime'>"
        ],
        [],
    ),
    "dates pickled": (
        "import copy, datetime as d, pickle\n"
        "for x in (d.datetime.now(), d.date.today(), d.datetime.now(d.UTC) + d.timedelta(1)):\n"
        "    print(pickle.loads(pickle.dumps(x)) == x == copy.deepcopy(x), b'tuisim' in pickle.dumps(x))\n"
        "print(isinstance(d.datetime.min, pickle.loads(pickle.dumps(d.datetime))))\n",
        ["True False"] * 3 + ["True"],
        [],
    ),
    "classes of dates": (
        "from datetime import date, datetime\nclass My(datetime): pass\nnow = datetime.now()\n"
        "print(isinstance(now, My), isinstance(My.now(), date), issubclass(datetime, My), My.now())\n",
        ["False True False 2020-01-01 00:00:00.000060"],
        [],
    ),
    "locks": (
        "import copy, pickle, threading\nlock = threading.Lock()\n"
        "for f in (copy.deepcopy, pickle.dumps):\n    try: f(lock)\n    except TypeError as error: print(error)\n"
        "print(isinstance(lock, type(threading.Lock())), threading.Thread.start.__qualname__)\n",
        ["cannot pickle '_thread.lock' object"] * 2 + ["True Thread.start"],
        [],
    ),
    "a thread's number": (
        "import _thread\nseen = []\n"
        "n = _thread.start_new_thread(lambda: seen.append(_thread.get_ident()), ())\n"
        "print(seen == [n])\n",
        ["True"],
        [],
    ),
}


@cases("text, lines, errors", VALUES)
def test_values_of_replaced_builtins_behave_like_the_real_ones(
    run: Run, text: str, lines: list[str], errors: list[str]
) -> None:
    done = run(text, prelude="none")
    assert (done.lines, done.errors) == (lines, errors)
