"""Goals on columns of a recording, on what the brick showed, and on how often something happened."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.cases import cases
from tests.engine.runs.run_recorder import Recorder
from tests.tasks.goals.recorded import Run, Step, ahead, goals_of, says, wait, world
from tuisim.engine.core.spec import Obstacle
from tuisim.engine.runs.brick_state import TextScreen, build_console_row, build_led_row
from tuisim.engine.runs.records import Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.goals.judge import judge


def brick(stream: Stream, text: str) -> Step:
    """The brick shows or plays something."""
    return lambda recorder: recorder.print(text, 1, stream)


BEEP = brick(Stream.SPEECH, "[beep]")
RED = brick(
    Stream.LED, build_led_row({"left red": 255, "left green": 0, "right red": 0, "right green": 0})
)
SCREEN = brick(Stream.CONSOLE, build_console_row(TextScreen(22, 12, ("", "Hello 5"))))
OK = says("ok")


def _presses(recorder: Recorder) -> None:
    recorder.act("set_buttons", pressed=["enter"])


WAY = (
    ahead(100, 1),
    says("Grey: 5"),
    says("Grey: 12"),
    BEEP,
    _presses,
    wait(1),
    RED,
    OK,
    SCREEN,
    OK,
    wait(0.5),
)
"""Ahead from x = 500 to 600 mm in 0.57 s."""

GOALS = {
    "kept": ("keep = 'x_mm >= 500'", ""),
    "not kept": ("keep = ['x_mm >= 500', 'x_mm < 550']", "x_mm < 550 was not so at 0.29 s."),
    "kept for a share": ("keep = { comparisons = 'x_mm > 590', share = 0.5 }", ""),
    "not kept for a share": (
        "keep = { comparisons = 'x_mm > 590', share = 0.9 }",
        "x_mm > 590 was not so at 0.00 s; it was for 75 %",
    ),
    "each sample": ("keep = 'sample Grey > 4'", ""),
    "not each sample": ("keep = 'sample Grey < 10'", "sample Grey < 10 was not so at 0.57 s."),
    "no such column": ("keep = 'xmm > 5'", "The robot has no column xmm"),
    "far from the wall": ("keep = { gap_mm = [300, 2000] }", ""),
    "too far from the wall": (
        "keep = { gap_mm = [300, 360] }",
        "The robot was not 300 to 360 mm from the nearest obstacle or wall at 0.00 s.",
    ),
    "counted lines": ("count = { of = 'print matches ^ok', at_least = 2, at_most = 2 }", ""),
    "too many lines": (
        "count = { of = 'print matches ^ok', at_most = 1 }",
        "came 2 times; the goal allows at most 1.",
    ),
    "too few samples": (
        "count = { of = 'sample Grey', at_least = 3 }",
        "came 2 times; the goal needs at least 3.",
    ),
    "a column": ("count = { of = 'x_mm > 550', at_least = 1, at_most = 1 }", ""),
    "a sound": ("when = 'sound matches beep'", ""),
    "another sound": ("when = 'sound matches song'", "sound matches song never became true."),
    "a text on the display": ("when = 'display matches Hello'", ""),
    "a light": ("when = 'led_left_red > 0'", ""),
    "a light for a time": ("keep = 'led_left_red = 0'\nuntil = 1", ""),
    "a button": ("when = ['button_enter = 1', 'x_mm > 590']", ""),
    "another button": ("when = 'button_up = 1'", "button_up = 1 never became true"),
    "within a time": ("reach = { x_mm = 600, within_mm = 1 }\nwithin_s = 0.6", ""),
    "not within a time": (
        "reach = { x_mm = 600, within_mm = 1 }\nwithin_s = 0.3",
        "Not within 0.3 s: at its nearest",
    ),
    "after another goal": ("when = 'led_left_red > 0'\nafter = 'there'\nwithin_s = 1.5", ""),
    "too long after another goal": (
        "when = 'led_left_red > 0'\nafter = 'there'\nwithin_s = 0.5",
        "Not within 0.5 s: led_left_red > 0 never became true",
    ),
    "held for a time": ("keep = 'led_left_red = 0'\nafter = 'there'\nwithin_s = 0.5", ""),
    "none": ("none = ['never']", ""),
    "none, but one was met": ("none = ['never', 'there']", "“there” was met."),
}
GOALS |= {
    "printed at a place": (
        "print = { lines = 'ok', x_mm = [[590, 610]], y_mm = [[490, 510]] }",
        "",
    ),
    "printed too low": (
        "print = { lines = 'ok', x_mm = [[590, 610]], y_mm = [[600, 700]] }",
        "the robot was at x = 600 mm and y = 500 mm; it must be at x from 590 to 610 mm and y from 600 to 700 mm.",
    ),
    "logged at a place": ("log = { name = 'Grey', levels = [12], y_mm = [[490, 510]] }", ""),
    "logged too low": (
        "log = { name = 'Grey', levels = [12], y_mm = [[600, 700]] }",
        "the robot was at y = 500 mm; it must be at y from 600 to 700 mm.",
    ),
}
OTHERS = """
[[goal]]
name = "there"
reach = { x_mm = 600, within_mm = 1 }
[[goal]]
name = "never"
reach = { x_mm = 2000 }
"""


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Iterator[StoredRun]:
    """A run of that way, beside an obstacle that it does not reach."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TUISIM_HOME", str(tmp_path_factory.mktemp("home")))
        run = Run(RunStore(), world(obstacles=(Obstacle(1000, 0, 50, 1143),)), "")
        run.do(WAY)
        yield run.end()


@cases("lines, reason", GOALS)
def test_goals_about_columns_of_a_run_are_met_or_missed_with_the_reason(
    lines: str, reason: str, tmp_path: Path, driven: StoredRun
) -> None:
    goals = goals_of(tmp_path, f"[[goal]]\nname = 'a'\n{lines}\n{OTHERS}")
    found = judge(goals, driven)[0]
    assert (found.state, reason in found.reason) == ("missed" if reason else "met", True), (
        found.reason
    )
