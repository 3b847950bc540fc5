"""Holding a run at lines, instants and events, and going on from there."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.cases import cases
from tests.engine.runtime.debugging import Driver
from tests.running import Done, Run, Start, until
from tuisim.base.errors import ConfigError
from tuisim.engine.protocol import (
    AFTER_TICK,
    BEFORE_NEXT_TICK,
    Ended,
    LineStep,
    Paused,
    PauseReason,
    Resume,
    RunToInstant,
    RunToLine,
    SetBreaks,
    SetPose,
    StepLine,
    StepTicks,
)

FIRST_LINE = (0, 1)

CALLS = """\
import time
def add(a):
    b = a + 1
    time.sleep(0.05)
    return b
total = 0
for i in range(3):
    total += add(i)
    print('Total:', total)
"""

THREADS = """\
import threading, time
def work(name):
    for i in range(4):
        time.sleep(0.03)
        print(name, i, colorLeft.reflected_light_intensity)
tank_drive.on(30, 25)
threads = [threading.Thread(target=work, args=(name,), name=name) for name in ('A', 'B')]
for thread in threads:
    thread.start()
for i in range(5):
    time.sleep(0.02)
    print('main', i, ultrasonic.distance_centimeters)
for thread in threads:
    thread.join()
"""


@pytest.fixture
def debug(start: Start) -> Callable[..., Driver]:
    """`debug(text, …)`: start a program that can be held; at full speed, so that no test waits for the clock."""

    def begin(text: str, **options: object) -> Driver:
        return Driver(start(text, **{"live": True, "speed": 0.0, **options}))

    return begin


def places(driver: Driver, how: LineStep, most: int) -> list[int]:
    """Step until the end and return the lines."""
    lines = [driver.paused().line]
    for _ in range(most):
        event = driver.do_or_end(StepLine(how))
        if isinstance(event, Ended):
            assert (event.end, event.error) == ("finished", "")
            return lines
        lines.append(event.line)
    raise AssertionError("it never ended")


@cases(
    "how, lines",
    {
        "over": (LineStep.OVER, [1, 2, 6, 7, 8, 9, 7, 8, 9, 7, 8, 9, 7]),
        "into": (LineStep.INTO, [1, 2, 6, *[7, 8, 3, 4, 5, 9] * 3, 7]),
        "out": (LineStep.OUT, [1]),
    },
)
def test_steps_of_the_debugger_hold_only_at_lines_of_the_program(
    debug: Callable[..., Driver], how: LineStep, lines: list[int]
) -> None:
    assert places(debug(CALLS, hold_at=FIRST_LINE), how, 40) == lines


def test_stepping_out_of_a_function_holds_in_its_caller(debug: Callable[..., Driver]) -> None:
    driver = debug(CALLS, breaks=("3 if a == 1",))
    held = driver.paused()
    assert (held.line, held.reason, held.detail, held.value) == (
        3,
        "break",
        "3 if a == 1",
        "is true",
    )
    assert [(frame.function, frame.line) for frame in driver.look().stack] == [
        ("add", 3),
        ("<module>", 8),
    ]
    assert driver.do(StepLine(LineStep.OUT)).line == 9
    assert driver.values() == {"total": "3", "i": "1"}


def test_running_to_a_line_and_ticks_from_there(debug: Callable[..., Driver]) -> None:
    driver = debug(CALLS, hold_at=FIRST_LINE)
    driver.paused()
    held = driver.do(RunToLine(4))
    assert (held.tick, held.line, held.reason) == (0, 4, "line")
    held = driver.do(StepTicks(2))
    assert (held.tick, held.line, held.reason, held.ordinal) == (2, 4, "ticks", BEFORE_NEXT_TICK)
    assert driver.look().waiting == "sleeps until 0.05 s"
    assert driver.do(StepLine()).line == 5


INVERSED = """\
import time
from ev3dev2.motor import LargeMotor, OUTPUT_B
motor = LargeMotor(OUTPUT_B)
motor.polarity = "inversed"
motor.on_for_degrees(30, 500)
"""


@pytest.mark.parametrize("profile", ["robolab", "ev3"])
def test_breakpoints_on_motor_columns_use_the_sign_that_the_program_reads(
    debug: Callable[..., Driver], profile: str
) -> None:
    names = ["left_position_deg > 90", "left_speed_dps < 0"]
    names += ["left_measured_dps < 0"] if profile == "ev3" else []
    driver = debug(INVERSED, breaks=(*names[::-1],), profile=profile, prelude="none")
    held = driver.paused()
    assert held.detail == names[0]
    assert driver.look().waiting == "waits for motor outB to reach 500°"


BREAKS = {
    "left_color changes": "Black",
    "time 0.25": "0.25",
    "sample N >= 3": "N: 3",
    "sample N changes": "N: 1",
    "print matches ^N: [4-9]": "N: 4",
}
DRIVE = "import time\ntank_drive.on(60, 40)\nfor n in range(200):\n    time.sleep(0.05)\n    print('N:', n)\n"


@pytest.mark.parametrize("text", BREAKS)
def test_a_breakpoint_on_an_event_holds_where_it_is_met(
    debug: Callable[..., Driver], text: str
) -> None:
    driver = debug(
        DRIVE,
        breaks=(text, "# 3"),
        pose=(700.0, 500.0, 0.0) if "color" in text else (150.0, 500.0, 0.0),
    )
    held = driver.paused()
    assert (held.reason, held.detail) == ("break", text)
    assert BREAKS[text] in held.value or held.value.replace(".", "").isdigit()
    if text == "time 0.25":
        assert (held.tick, held.ordinal) == (25, AFTER_TICK)
    driver.run.send(SetBreaks(()))
    assert driver.finish(Resume()).end == "finished"


def test_the_breakpoint_stall_holds_when_a_motor_is_blocked(debug: Callable[..., Driver]) -> None:
    driver = debug(DRIVE, breaks=("stall",), solid=True, pose=(2200.0, 500.0, 0.0))
    assert driver.paused().detail == "stall"


CONDITIONS = {
    "8 if i == 2": ("is true", 2),
    "8 if [v for v in (i,) if v > total]": ("", None),
    "8 if len(str(i)) and i > 0": ("is true", 1),
    "8 if missing": ("", None),
    "8 if missing > 3 or i == 2": ("", None),
    "8 if i == 2 or missing > 3": ("is true", 2),
    "8 if len(missing)": ("", None),
    "8 if 1 / (i - 1)": ("is true", 0),
    "8 if time.sleep(1)": ("cannot be evaluated: RuntimeError", 0),
    "8 if [0 for _ in iter(int, 1)]": ("takes too long", 0),
    "8 if print('never seen')": ("", None),
}


@pytest.mark.parametrize("text, expected", CONDITIONS.items(), ids=CONDITIONS)
def test_evaluating_a_breakpoints_condition_does_not_change_the_run(
    debug: Callable[..., Driver], text: str, expected: tuple[str, int | None]
) -> None:
    value, i = expected
    driver = debug(CALLS, breaks=(text,))
    event = driver.wait_for(Paused, Ended)
    if i is None:
        assert isinstance(event, Ended)
        assert [row.text for row in driver.run.output.read_all_rows()] == [
            "Total: 1",
            "Total: 3",
            "Total: 6",
        ]
        return
    assert isinstance(event, Paused)
    assert event.value.startswith(value)
    assert driver.values()["i"] == str(i)


def test_every_instant_of_a_run_can_be_held_again(debug: Callable[..., Driver]) -> None:
    driver = debug(CALLS, hold_at=FIRST_LINE)
    met = [driver.paused()]
    while not isinstance(event := driver.do_or_end(StepLine(LineStep.INTO)), Ended):
        met.append(event)
    again = debug(CALLS, live=False, hold_at=(met[8].tick, met[8].ordinal))
    assert again.paused() == _at_instant(met[8])
    for wanted in met[9:]:
        assert again.do(RunToInstant(wanted.tick, wanted.ordinal)) == _at_instant(wanted)


def _at_instant(held: Paused) -> Paused:
    return Paused(
        held.tick,
        held.time_ns,
        held.line,
        PauseReason.INSTANT,
        ordinal=held.ordinal,
        thread=held.thread,
    )


BLANKS = """\
import time

# Nothing runs here.
def add(a):
    \"\"\"Nor here.\"\"\"

    return a + 1

for i in range(2):

    time.sleep(0.05)
    add(i)
"""


@pytest.mark.parametrize(
    "line, held",
    [(2, 4), (3, 4), (5, 7), (8, 9), (10, 11)],
    ids=["blank", "comment", "doc", "between", "in a loop"],
)
def test_a_breakpoint_on_a_line_without_code_holds_at_the_next_line_of_code(
    debug: Callable[..., Driver], line: int, held: int
) -> None:
    assert debug(BLANKS, breaks=(str(line),)).paused().line == held
    driver = debug(BLANKS, hold_at=FIRST_LINE)
    driver.paused()
    assert driver.do(RunToLine(line)).line == held


def test_a_breakpoint_met_in_one_thread_holds_all_threads(debug: Callable[..., Driver]) -> None:
    driver = debug(THREADS, breaks=("5 if name == 'B'",))
    held = driver.paused()
    assert (held.line, held.thread) == (5, "B")
    looked = driver.look()
    waiting = {thread.name: thread.waiting for thread in looked.threads}
    assert set(waiting) == {"MainThread", "A", "B"}
    assert waiting["B"] == ""
    assert waiting["MainThread"].startswith(("sleeps until", "reads"))
    assert driver.look(thread="A").stack[0].function == "work"
    driver.run.send(SetBreaks(()))
    lines = [driver.do(StepLine()) for _ in range(4)]
    assert {(step.thread, step.line) for step in lines} <= {("B", line) for line in (3, 4, 5)}


def test_stepping_and_inspecting_do_not_change_the_recorded_run(
    debug: Callable[..., Driver], run: Run
) -> None:
    plain = run(THREADS, noise=(20, 30), seed=4)
    driver = debug(
        THREADS, hold_at=FIRST_LINE, breaks=("14", "sample main"), noise=(20, 30), seed=4
    )
    event: Paused | Ended = driver.paused()
    steps = iter([LineStep.OVER, LineStep.INTO, LineStep.INTO, LineStep.OUT, LineStep.OVER] * 40)
    while isinstance(event, Paused):
        driver.look("ultrasonic.distance_centimeters", "print('no')", "i")
        event = driver.do_or_end(StepLine(next(steps)))
    assert Done(driver.run, event).recording == plain.recording


def test_a_user_action_at_a_line_waits_for_the_next_tick(debug: Callable[..., Driver]) -> None:
    driver = debug("x = 1\nprint(colorLeft.color)\n", hold_at=FIRST_LINE)
    driver.paused()
    driver.run.send(SetPose(1500.0, 500.0, 0.0))
    assert driver.finish(Resume()).end == "finished"
    assert [row.text for row in driver.run.output.read_all_rows()] == ["1"]
    assert driver.run.telemetry.record(0).actions == 1


WAITS = {
    "sleep": ("import time\ntime.sleep(3)", "sleeps until 3.00 s"),
    "position": (
        "tank_drive.left_motor.on_for_rotations(20, 2)",
        "waits for motor outB to reach 720°",
    ),
    "time": ("tank_drive.on_for_seconds(20, 20, 2)", "to stop at 2.00 s"),
    "input": ("input('Name? ')", "waits in input()"),
    "lock": (
        "import threading\na = threading.Lock()\na.acquire()\na.acquire(timeout=2)",
        "waits for a lock until 2.00 s",
    ),
    "queue": ("import queue\nqueue.Queue().get(timeout=3)", "waits for a queue until 3.00 s"),
    "event": ("import threading\nthreading.Event().wait(2)", "waits for an event until 2.00 s"),
    "join": (
        "import threading, time\nt = threading.Thread(target=lambda: time.sleep(2), name='T')\nt.start()\nt.join()",
        "waits for the thread T",
    ),
    "button": (
        "from ev3dev2.button import Button\nButton().wait_for_pressed(['enter'])",
        "waits for the button enter",
    ),
    "files": (
        "import select\nselect.select([], [], [], 2)",
        "waits for timers and files until 2.00 s",
    ),
    "speech": ("say('hello there, how are you', True)", "sounds until"),
}


@cases("text, note", WAITS)
def test_a_paused_thread_says_what_it_waits_for(
    debug: Callable[..., Driver], text: str, note: str
) -> None:
    driver = debug(text, hold_at=(30, BEFORE_NEXT_TICK), asks_user=True)
    assert driver.paused().reason == "instant"
    assert note in driver.look(thread="MainThread").waiting


def test_a_wait_for_a_motor_is_said_where_the_library_waits_in_another_way(
    debug: Callable[..., Driver],
) -> None:
    text = "tank_drive.left_motor.on_for_rotations(20, 2)"
    driver = debug(text, hold_at=(30, BEFORE_NEXT_TICK), profile="nbev3devsim")
    driver.paused()
    assert "waits for motor outB" in driver.look().waiting


HELD_THEN_STOPPED = {
    "at a line": (CALLS, {"hold_at": FIRST_LINE}),
    "at a tick": (CALLS, {"hold_at": (3, BEFORE_NEXT_TICK)}),
    "in a thread": (THREADS, {"breaks": ("5",)}),
    "in a print of a thread": (THREADS, {"breaks": ("print matches A 0",)}),
    "in a print": (DRIVE, {"breaks": ("sample N",)}),
    "with a loop around": (
        "while True:\n    try:\n        x = 1\n    except BaseException:\n        pass",
        {"breaks": ("3",)},
    ),
}


@pytest.mark.slow_cases("with a loop around")
@cases("text, how", HELD_THEN_STOPPED)
def test_a_run_can_be_stopped_wherever_the_debugger_holds_it(
    debug: Callable[..., Driver], text: str, how: dict[str, object]
) -> None:
    driver = debug(text, **how)
    held = driver.paused()
    driver.run.stop()
    ended = driver.finish()
    assert ended.end == "stopped"
    assert ended.tick == held.tick or "except BaseException" in text


RUNNING = {
    "main thread": "n = 0\nwhile True:\n    n += 1\n",
    "other thread": (
        "def f():\n    while True: n = 1\nimport threading\nt = threading.Thread(target=f)\nt.start()\nt.join()\n"
    ),
    "sleeper": "import time\nwhile True:\n    time.sleep(0.02)\n    n = 1\n",
}


@cases("text", RUNNING)
def test_a_break_set_while_the_program_runs_is_met(debug: Callable[..., Driver], text: str) -> None:
    driver = debug("print('A: 1')\n" + text, speed=1.0)
    until(driver.run, lambda: driver.run.output.length > 0)
    line = 4 if "n += 1" in text else 3 if "def" in text else 5
    driver.run.send(SetBreaks((str(line),)))
    held = driver.paused()
    assert (held.line, held.reason) == (line, "break")
    assert driver.do(StepLine()).line in (line - 1, line, line + 1, 3, 4)
    driver.run.send(SetBreaks(()))
    driver.run.send(Resume())
    driver.run.stop()
    assert driver.finish().end == "stopped"


def test_an_invalid_breakpoint_is_refused_before_it_is_sent(debug: Callable[..., Driver]) -> None:
    driver = debug(CALLS, hold_at=FIRST_LINE)
    driver.paused()
    with pytest.raises(ConfigError, match="nonsense"):
        driver.run.send(SetBreaks(("nonsense",)))
    assert driver.finish(Resume()).end == "finished"
