"""Addresses that a program prints are the same in every run, and tell objects apart."""

from __future__ import annotations

import pytest

from tests.cases import cases
from tests.running import Run, over
from tuisim.base.errors import ConfigError
from tuisim.base.source import Program
from tuisim.engine.runs.child.isolation import check_isolation
from tuisim.engine.runs.handle import RunHandle, RunOptions
from tuisim.engine.runs.run_folder import field_files
from tuisim.engine.runs.store import RunStore
from tuisim.engine.runtime.output import Addresses
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings

PROGRAM = """\
import asyncio, sys, threading, weakref
class A:
    def f(self): pass
class Slotted:
    __slots__ = ()
kept = []
def g(): yield
for i in range(100):
    print(A(), object(), lambda: i, g(), map(str, []), Slotted(), A().f, [].append, f'{A()}')
    kept.append(A())
    if i % 3: del kept[0]
    print(kept[-1], kept[0], weakref.ref(kept[0]), threading.Lock(), sys._getframe(), g.__code__)
for _ in range(3):
    t = threading.Thread(target=lambda: print(threading.current_thread()))
    t.start()
    t.join()
    print(t)
raise ValueError(A())
"""


def started(text: str, isolated: bool = False, **options: object) -> RunHandle:
    """Start a program."""
    spec = build_run_spec(Settings({"background": "Empty_Map"}))
    made = RunOptions(**options)  # type: ignore[arg-type]
    return RunHandle(
        Program("program.py", text, "none"),
        spec,
        field_files(spec),
        made,
        RunStore(),
        isolated=isolated,
    )


@pytest.fixture(scope="module")
def forked() -> bytes:
    """What the program writes in a child that the warm process has forked."""
    return over(started(PROGRAM)).recording[1]


def test_a_process_started_by_itself_prints_the_same_addresses_as_a_forked_one(
    forked: bytes, real_start: None
) -> None:
    assert over(started(PROGRAM)).recording[1] == forked


def test_a_process_forked_from_a_template_prints_the_same_addresses(forked: bytes) -> None:
    started("pass", live=True, speed=0.0).prepare_next()
    assert over(started(PROGRAM, live=True, speed=0.0)).recording[1] == forked


def test_an_isolated_process_prints_the_same_addresses(forked: bytes) -> None:
    isolated = True
    try:
        check_isolation()
    except ConfigError:
        # This machine cannot isolate programs: then it is the child that another test starts.
        isolated = False
    assert over(started(PROGRAM, isolated=isolated)).recording[1] == forked


TOLD = {
    "two that exist": ("a, b = object(), object()\nprint(a, b, a)", "{0} {1} {0}"),
    "one after another": ("for _ in range(3): print(object())", "{0}\n{1}\n{2}"),
    "nested": (
        "class B:\n    def __init__(self): self.o = object()\nb = B()\nfor _ in 'ab': print(b.o)",
        "{0}\n{0}",
    ),
    "of the prelude's kind": (
        "import sys\nx = sys.stdin, object()\nfor _ in 'ab': print(x[1])",
        "{0}\n{0}",
    ),
}


@cases("text, told", TOLD)
def test_each_printed_address_stands_for_one_object(run: Run, text: str, told: str) -> None:
    lines = "\n".join(run(text, prelude="none").lines)
    names = [f"<object object at {0x7F0000000010 + 16 * n:#x}>" for n in range(3)]
    assert lines == told.format(*names)


def test_a_summary_has_the_address_of_the_error_text(run: Run) -> None:
    done = run("class A: pass\nraise ValueError(A())", prelude="none")
    told = "ValueError: <__main__.A object at 0x7f0000000010>"
    assert (done.ended.summary, done.errors[-1]) == (f"{told} (line 2)", told)


def test_printing_an_objects_address_does_not_keep_it_alive(run: Run) -> None:
    text = "class A:\n    def __del__(self): print('gone')\na = A()\nprint('at', a is not None, a)\ndel a\nprint('end')"
    assert run(text, prelude="none").lines[1:] == ["gone", "end"]


NO_ADDRESSES = (
    "a sensor at 0x70",
    "at 0x0001f",
    f"at {2**30:x}",
    "0x7f1234567890",
    ", started 99",
    "look at 0xyz",
)


@pytest.mark.parametrize("text", NO_ADDRESSES)
def test_numbers_that_are_no_addresses_are_printed_as_they_are(text: str) -> None:
    assert Addresses(dict).stabilize(text) == (text,)
