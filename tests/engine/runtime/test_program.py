"""However a program ends, it is told with the program's own lines, and nothing printed is lost."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cases import cases
from tests.running import Run

ENDS = {
    "nothing to do": ("pass", "finished", 0),
    "exit status": ("import sys\nprint('A: 1')\nsys.exit(3)", "finished", 3),
    "exit text": ("import sys\nprint('A: 1', end='')\nsys.exit('bye')", "finished", 1),
    "process exit": ("import os\nprint('A: 1')\nos._exit(3)", "finished", 3),
    "undefined name": ("print('A: 1')\nprint(sensor_val)", "raised", 1),
    "not Python": ("x = = 3", "raised", 1),
    "null byte": ("print('A: 1')\0", "raised", 1),
    "endless recursion": ("print('A: 1')\ndef f(): f()\nf()", "raised", 1),
    "2 GiB at once": ("print('A: 1')\nx = [0] * (2 * 1024**3 // 8)", "raised", 1),
    "memory bit by bit": (
        "print('A: 1')\nx = []\nwhile True: x.append(bytearray(10_000_000))",
        "raised",
        1,
    ),
    "other process": ("print('A: 1')\nimport os\nos.fork()", "raised", 1),
    "multiprocessing": (
        "print('A: 1')\nimport multiprocessing\nmultiprocessing.Queue()",
        "raised",
        1,
    ),
    "deadlock": (
        "import threading\nprint('A: 1')\na = threading.Lock()\na.acquire()\na.acquire()",
        "deadlock",
        1,
    ),
    "spin": ("while True: pass", "time_limit", 0),
    "spin on a reading": ("while True: colorLeft.color", "time_limit", 0),
    "spin on a motor": (
        "tank_drive.on(10, 10)\nwhile tank_drive.is_running: pass",
        "time_limit",
        0,
    ),
    "spin on the clock": ("import time\nwhile time.time() > 0: pass", "time_limit", 0),
    "spin on commands": ("while True: tank_drive.on(50, 50)", "time_limit", 0),
    "a line without an end": (
        "print('A: 1')\nfor _ in range(10**4): print('.', end='')\nwhile True: print('x' * 10**7, end='')",
        "output_limit",
        0,
    ),
    "swallows everything": ("while True:\n    try: x = 1\n    except: pass", "time_limit", 0),
    "a long cleanup": (
        "import time\ntry: time.sleep(100)\nfinally: time.sleep(50)",
        "time_limit",
        0,
    ),
    "endless cleaning up": (
        "try:\n    while True: pass\nfinally:\n    while True: pass",
        "time_limit",
        0,
    ),
}


@pytest.mark.quick_cases(
    "nothing to do",
    "exit status",
    "undefined name",
    "not Python",
    "2 GiB at once",
    "deadlock",
    "spin",
)
@cases("text, end, exit_code", ENDS)
@pytest.mark.usefixtures("real_start")
def test_each_way_a_program_ends_has_its_end_and_exit_code(
    run: Run, text: str, end: str, exit_code: int
) -> None:
    done = run(text, time_limit_s=1.0)
    assert (done.ended.end, done.ended.exit_code) == (end, exit_code)
    if ("A: 1" in text and end != "raised") or text.startswith("print('A: 1')\n"):
        assert done.lines == ["A: 1"]
    assert not any("tuisim" in line for line in done.errors)


HINTS = {
    "say": "into its first line.",
    "tank_drive": "or make it: `tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)`",
    "SpeedPercent": "into its first line.",
    "sensor_val": "",
}


@pytest.mark.parametrize("name, how", HINTS.items(), ids=HINTS)
def test_an_undefined_predefined_name_is_explained_in_the_error(
    run: Run, name: str, how: str
) -> None:
    done = run(f"print('A: 1')\n{name}\n", prelude="none")
    told = done.errors[-1]
    if name == "sensor_val":
        assert told == "NameError: name 'sensor_val' is not defined"
        return
    assert told.startswith(f"`{name}` is a predefined name")
    assert "put `# %%sim_magic_preloaded` into its first line" in told
    assert how in told


IMPORTED = {
    "SpeedPercent": "Did you forget `from ev3dev2.motor import SpeedPercent`?",
    "tank_drive": "To use `tank_drive`, make it: `tank_drive = MoveTank(OUTPUT_B, OUTPUT_C)`.",
}


@pytest.mark.parametrize("name, how", IMPORTED.items(), ids=IMPORTED)
def test_a_program_with_imports_is_not_told_to_use_predefined_names(
    run: Run, name: str, how: str
) -> None:
    done = run(f"from ev3dev2.motor import MoveTank\n{name}\n", prelude="none")
    assert done.errors[-1].endswith(how)


def test_error_shows_the_programs_lines_only(run: Run) -> None:
    done = run("import time\n\ndef look():\n    return sensor_val\n\nprint('A: 1')\nlook()\n")
    assert done.errors == [
        "Traceback (most recent call last):",
        '  File "program.py", line 7, in <module>',
        "    look()",
        '  File "program.py", line 4, in look',
        "    return sensor_val",
        "           ^^^^^^^^^^",
        "NameError: name 'sensor_val' is not defined",
    ]
    assert done.ended.error_line == 4
    assert done.ended.summary == "NameError: name 'sensor_val' is not defined (line 4)"


REFUSED = {
    "balancing": (
        "from ev3dev2.control.GyroBalancer import GyroBalancer\nGyroBalancer()",
        "NotSimulated: ev3dev2.control.GyroBalancer.GyroBalancer is not part of the simulated brick (it balances on",
    ),
    "network": (
        "from ev3dev2.control.webserver import WebControlledTank\nWebControlledTank('outB', 'outC')",
        "NotSimulated: ev3dev2.control.webserver.WebControlledTank is not part of the simulated brick (a program",
    ),
}


@cases("text, words", REFUSED)
def test_library_classes_for_other_hardware_are_refused(run: Run, text: str, words: str) -> None:
    done = run(text)
    assert done.ended.end == "raised"
    assert words in done.errors[-1]
    assert done.ended.error_line == text.count("\n") + 1


@pytest.mark.slow
def test_stall_in_python_code_names_the_line(run: Run) -> None:
    text = "import re\nprint('A: 1')\nre.match(r'(a+)+$', 'a' * 40 + 'b')"
    done = run(text, stall_limit_s=0.3)
    assert (done.ended.end, done.ended.error_line) == ("stalled", 3)
    assert "line 3" in done.ended.summary
    assert done.lines == ["A: 1"]


@pytest.mark.slow
def test_stall_in_a_c_call_is_killed_and_names_the_line(run: Run) -> None:
    done = run("print('A: 1')\nsum(range(10**12))", stall_limit_s=0.3)
    assert done.ended.end == "stalled"
    assert "line 2" in done.ended.summary
    assert done.lines == ["A: 1"]


def test_input_returns_the_answers_and_ends_after_the_last(run: Run) -> None:
    done = run("name = input('Name? ')\nprint('hello ' + name)\ninput()", answers=("Ada",))
    assert done.lines == ["hello Ada"]
    assert "EOFError" in done.errors[-1]
    assert [row.text for row in done.run.output.read_all_rows() if row.stream == 4] == [
        "Name? Ada",
        "",
    ]


def test_speaking_a_text_is_recorded_and_takes_simulated_time(run: Run) -> None:
    done = run('say("it\'s black", wait=True)\nprint(get_clock() > 0.5)')
    assert done.lines == ["it's black", "True"]
    assert [row.text for row in done.run.output.read_all_rows() if row.stream == 3] == [
        "it\u2019s black"
    ]


def test_the_end_of_a_program_closes_what_it_left_open(run: Run, tmp_path: Path) -> None:
    target = tmp_path / "log.csv"
    done = run(
        f"import atexit\nf = open({str(target)!r}, 'w')\nf.write('hello')\natexit.register(lambda: print('at exit'))\n"
        "class Thing:\n    def __del__(self): print('gone')\nthing = Thing()\n1 / 0"
    )
    assert target.read_text() == "hello"
    assert done.lines == ["at exit", "gone"]


SUMMARIES = {
    "several lines": ("raise RuntimeError('one\\ntwo')", "RuntimeError: one (line 1)"),
    "group": (
        "raise ExceptionGroup('both', [ValueError(1), KeyError(2)])",
        "ExceptionGroup: both (2 sub-exceptions) (line 1)",
    ),
    "syntax": ("x = = 3", "SyntaxError: invalid syntax (line 1)"),
    "no UTF-8": (
        "x = 1\ny = 'gr\udcfcn'",
        "SyntaxError: Non-UTF-8 code starting with '\\xfc', but no encoding declared; save it as UTF-8 (line 2)",
    ),
    "null": ("x = 1\n\0", "SyntaxError: source code cannot contain null bytes (line 2)"),
    "unknown encoding": (
        "# coding: klingon\nx = 1",
        "SyntaxError: encoding problem: klingon (line 1)",
    ),
    "no encoding of text": (
        "\n# -*- coding: rot13 -*-\nx = 1",
        "SyntaxError: encoding problem: rot13 (line 2)",
    ),
    "an encoding": ("# -*- coding: latin-1 -*-\nx = 'grün'", ""),
    "no declaration": ("x = 1\n# coding: klingon", ""),
    "no message": ("raise ValueError", "ValueError (line 1)"),
}


@cases("text, summary", SUMMARIES)
def test_summary_of_an_error_is_one_line(run: Run, text: str, summary: str) -> None:
    assert run(text).ended.summary == summary


CHANCE = (
    "import random, uuid, secrets, os\nrandom.seed()\n"
    "print(random.random(), random.Random().random(), random.SystemRandom().random(), uuid.uuid4(),"
    " secrets.token_hex(4), os.urandom(3))"
)


def test_every_source_of_random_numbers_follows_the_seed(run: Run) -> None:
    assert run(CHANCE).lines == run(CHANCE).lines
    assert run(CHANCE, seed=1).lines != run(CHANCE, seed=2).lines


BEHIND = """
import threading, time

def tick():
    while time.time() < 1577836803:
        time.sleep(1)
        print('tick')

threading.Thread(target=tick).start()
time.sleep(1.5)
print('end')
"""


@pytest.mark.parametrize("profile, ticks", [("ev3", 3), ("lego-micropython", 1)])
def test_a_program_of_micropython_ends_with_its_main_thread(
    run: Run, profile: str, ticks: int
) -> None:
    done = run(BEHIND, profile=profile, prelude="none")
    assert (done.lines.count("tick"), done.ended.end) == (ticks, "finished"), done.errors
