"""MicroPython's modules: every one can be imported, and its own names work in simulated time."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.conftest import Command
from tests.engine.shim.conftest import RunOn
from tuisim.engine.shim.pybricks.micropython import (
    BUILT_IN,
    OF_PYTHON,
    TICKS_PERIOD,
    ticks_add,
    ticks_diff,
)

PROFILE = "lego-micropython"


def test_every_module_of_micropython_can_be_imported(run_on: RunOn) -> None:
    names = [
        *OF_PYTHON,
        *OF_PYTHON.values(),
        *BUILT_IN,
        "micropython",
        "_thread",
        "threading",
        "math",
        "gc",
        "umqtt.simple",
    ]
    done = run_on(
        f"import {', '.join(names)}\nfrom utime import *\nprint(utime.sleep is sleep)",
        profile=PROFILE,
    )
    assert done.lines == ["True"], done.errors


def test_a_built_in_micropython_module_precedes_a_file_of_that_name(
    here: Command, tmp_path: Path
) -> None:
    for name in ("utime", "umqtt"):
        (tmp_path / f"{name}.py").write_text("own = True\n")
    text = "import pybricks, utime, umqtt\nprint(hasattr(utime, 'own'), hasattr(umqtt, 'own'))"
    (tmp_path / "main.py").write_text(text)
    assert here("run", "main.py").stdout == "False True\n"


def test_sys_implementation_is_pybricks_micropython_and_imports_still_work(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "helper.py").write_text("import usys\nprint(usys.implementation[0])\n")
    (tmp_path / "main.py").write_text(
        "import pybricks, sys, helper\nprint(sys.implementation.cache_tag)"
    )
    assert (
        here("run", "main.py").stdout == f"pybricks-micropython\n{sys.implementation.cache_tag}\n"
    )


@pytest.mark.parametrize(
    ("profile", "version"), [(PROFILE, "(1, 11, 0)"), ("pybricks4", "(1, 26, 0)")]
)
def test_sys_implementation_tells_the_micropython_version_of_the_profile(
    run_on: RunOn, profile: str, version: str
) -> None:
    done = run_on("import pybricks, usys\nprint(usys.implementation[1])", profile=profile)
    assert done.lines == [version], done.errors


def test_const_native_and_viper_are_known_and_annotations_dropped(
    here: Command, tmp_path: Path
) -> None:
    (tmp_path / "helper.py").write_text(
        "SIZE: Length = const(2)\n@micropython.viper\ndef half(x: ptr8) -> Half:\n    return x // SIZE\n"
    )
    (tmp_path / "main.py").write_text(
        "import pybricks\nfrom helper import half\nN = const(20)\n"
        "@micropython.native\ndef double(x: Number, *rest: List[int]) -> Nothing:\n    y: Other = 2 * x\n"
        "    return y\nclass Robot:\n    arm: Arm = None\nprint(double(N), half(N))"
    )
    assert here("run", "main.py").stdout == "40 10\n"


@pytest.mark.parametrize("text", ["@native\ndef f(): pass", "def f(x: Number): pass"])
def test_compiler_names_of_micropython_are_unknown_elsewhere(run_on: RunOn, text: str) -> None:
    done = run_on(text, profile=PROFILE if text.startswith("@") else "ev3")
    assert "NameError" in done.errors[-1]


def test_the_clock_of_another_library_counts_only_in_its_module_of_micropython(
    run_on: RunOn,
) -> None:
    text = "import time, utime\nprint(hasattr(time, 'ticks_ms'), hasattr(utime, 'ticks_ms'))"
    assert run_on(text).lines == ["False True"]


CLOCK = """
import time, utime
begin = time.ticks_ms(), utime.ticks_us()
utime.sleep_ms(20)
time.sleep_us(1500)
utime.sleep(0.5)
utime.sleep_ms(-5)
print(utime.ticks_diff(utime.ticks_ms(), begin[0]), time.ticks_diff(time.ticks_us(), begin[1]) // 100)
try:
    utime.sleep_ms(1.5)
except TypeError:
    print('whole numbers')
"""


def test_micropython_ticks_count_simulated_time(run_on: RunOn) -> None:
    assert run_on(CLOCK, profile=PROFILE).lines == ["521 5215", "whole numbers"]


@pytest.mark.parametrize("late", [0, 5, TICKS_PERIOD // 2 - 1, -1, -TICKS_PERIOD // 2])
def test_ticks_diff_is_right_after_the_counter_wraps_around(late: int) -> None:
    start = TICKS_PERIOD - 3
    assert 0 <= ticks_add(start, late) < TICKS_PERIOD
    assert ticks_diff(ticks_add(start, late), start) == late


NAMES = """
import micropython, os, sys, uos, urandom, ustruct
from micropython import const
LIMIT = const(3)

@micropython.native
def twice(value):
    return 2 * value

@micropython.viper
def thrice(value):
    return 3 * value

micropython.alloc_emergency_exception_buf(100)
micropython.opt_level(2)
micropython.schedule(print, 'scheduled')
print(LIMIT, twice(4), thrice(4), urandom.getrandbits(3) < 8, 1 <= urandom.randint(1, 6) <= 6)
print(ustruct.unpack('<H', b'\\x02\\x01'))
print(sorted(entry[:2] for entry in uos.ilistdir(FOLDER)))
try:
    1 / 0
except ZeroDivisionError as error:
    sys.print_exception(error)
"""


def test_functions_that_only_micropython_has_work(run_on: RunOn, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").touch()
    lines = run_on(f"FOLDER = {str(tmp_path)!r}\n{NAMES}", profile=PROFILE).lines
    assert lines[:4] == [
        "scheduled",
        "3 8 12 True True",
        "(258,)",
        "[('file', 32768), ('folder', 16384)]",
    ]
    assert lines[4 :: len(lines) - 5] == [
        "Traceback (most recent call last):",
        "ZeroDivisionError: division by zero",
    ]


@pytest.mark.parametrize(
    "use",
    ["micropython.qstr_info()", "uctypes.UINT32 | 4", "ffi.open('libc')", "machine.Pin(1)"],
)
def test_functions_of_micropython_that_cannot_be_simulated_raise_with_a_reason(
    run_on: RunOn, use: str
) -> None:
    done = run_on(f"import {use.partition('.')[0]}\n{use}", profile=PROFILE)
    name = use.partition("(")[0].partition(" ")[0]
    assert done.ended.summary.startswith(f"NotSimulated: {name}: ")


def test_namedtuple_and_stack_size_take_what_only_micropython_allows(run_on: RunOn) -> None:
    text = """\
from ucollections import namedtuple
import _thread, gc
Action = namedtuple('Action ', ['drive_speed', 'steering'])
print(Action(1, 2).steering, namedtuple('My Robot', 'class x')(3, 4).x, _thread.stack_size(8192))
print(gc.mem_free() > gc.mem_alloc() > 0)
"""
    assert run_on(text, profile=PROFILE).lines == ["2 4 0", "True"]
