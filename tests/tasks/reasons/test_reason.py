"""The reasons why a run went wrong, and their order."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from tests.cases import cases
from tests.tasks.goals.recorded import goals_of
from tests.tasks.reasons.runs import WRONG_SIGN, run_text
from tuisim.engine.runs.recorded_run import Recording
from tuisim.tasks.goals.judge import judge
from tuisim.tasks.reasons.reason import (
    Reason,
    ReasonKind,
    describe_end,
    find_reasons,
    sort_by_cause,
)

MISTAKE = """\
tank_drive.on_for_seconds(SpeedPercent(20), SpeedPercent(20), 1)
print(colour)
"""
IN_A_FUNCTION = """\
def mean(values):
    return sum(values) / len(values)
print(mean([]))
"""
IN_A_THREAD = """\
import threading, time
def work():
    time.sleep(1)
    print(1 / 0)
threading.Thread(target=work).start()
tank_drive.on_for_seconds(SpeedPercent(20), SpeedPercent(20), 2)
"""
AT_THE_WALL = """\
# %%sim_magic_preloaded -b Empty_Map -o Wall -x 700 -y 600 --solid
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), 6)
"""
BESIDE_THE_WALL = """\
# %%sim_magic_preloaded -b Empty_Map --solid --walls on -x 82 -y 500 -a 180
tank_drive.on_for_rotations(SpeedPercent(20), SpeedPercent(-20), 180 / 56 / 4)
"""
WAITS = """\
# %%sim_magic_imports -r Explorer -b Empty_Map
from ev3dev2.sensor.lego import TouchSensor
MoveTank(OUTPUT_B, OUTPUT_C).on_for_seconds(20, 20, 2)
TouchSensor(INPUT_1).wait_for_pressed()
"""
OFF_THE_MAT = """\
# %%sim_magic_preloaded -b Empty_Map -x 2100 -a 0
tank_drive.on_for_seconds(SpeedPercent(40), SpeedPercent(40), 3)
"""
COUNTS = """\
# %%sim_magic_preloaded -b Grey_bands
import time
count = 0
tank_drive.on(SpeedPercent(50), SpeedPercent(50))
for i in range(20):
    if colorLeft.reflected_light_intensity_pc < 90: {step}
    time.sleep(0.1)
    {more}
tank_drive.off()
"""
BOTH_WHEELS = """\
# %%sim_magic --profile lego-micropython
from pybricks.ev3devices import Motor
from pybricks.parameters import Port
left = Motor(Port.B)
right = Motor(Port.C)
for side in range(4):
    left.run_angle(300, 90, wait=False)
    right.run_angle(300, -90)
"""
TURN_OF_A_BRICK = """\
from ev3dev2.motor import MoveTank, OUTPUT_B, OUTPUT_C
tank = MoveTank(OUTPUT_B, OUTPUT_C)
tank.on_for_degrees(30, 30, 500)
tank.on_for_degrees(20, -20, 180)
"""
CASES = {
    "raised": (MISTAKE, ReasonKind.RAISED, "1.00 s, line 2: NameError: name 'colour' is not"),
    "in a function": (
        IN_A_FUNCTION,
        ReasonKind.RAISED,
        "line 2: ZeroDivisionError: division by zero, called in line 3",
    ),
    "in a thread": (IN_A_THREAD, ReasonKind.RAISED, "1.00 s, line 4: ZeroDivisionError: division"),
    "at a wall": (AT_THE_WALL, ReasonKind.BLOCKED, "line 2: the robot stood at an obstacle from"),
    "turns beside a wall": (
        BESIDE_THE_WALL,
        ReasonKind.BLOCKED,
        "0.49 s, line 2: the robot was pushed 28 mm aside by the wall while it turned, from",
    ),
    "waits": (WAITS, ReasonKind.BLOCKED, "2.00 s, line 4: from here on it waited: touch sensor on"),
    "lost": (WRONG_SIGN, ReasonKind.LOST, "line 4: colorRight left the black, and did"),
    "never stopped": (
        "from ev3dev2.motor import *\nLargeMotor(OUTPUT_B).on(20)\nimport time\ntime.sleep(1)\n",
        ReasonKind.ENDED,
        "the program ended while outB was still set to turn",
    ),
    "not called": (
        "tank_drive.on_for_seconds(20, 20, 1)\ntank_drive.off\n",
        ReasonKind.MISTAKEN,
        "line 2: tank_drive.off without () does nothing: tank_drive.off() calls it",
    ),
    "a move not called": (
        "tank_drive.on_for_seconds(20, 20, 1)\ntank_turn.on_for_degrees\n",
        ReasonKind.MISTAKEN,
        "line 2: tank_turn.on_for_degrees without () does nothing: tank_turn.on_for_degrees() calls",
    ),
    "both ways alike": (
        "if colorLeft.reflected_light_intensity_pc < 50:\n    tank_drive.off()\n"
        "else:\n    tank_drive.off()\n",
        ReasonKind.MISTAKEN,
        "line 1: if and else do the same",
    ),
    "not returned": (
        "def is_grey():\n    colorLeft.reflected_light_intensity_pc < 90\nis_grey()\n",
        ReasonKind.MISTAKEN,
        "line 2: is_grey() returns nothing: return is missing before colorLeft.reflected_light",
    ),
    "degrees of the wheels": (
        "for side in range(4):\n    tank_drive.on_for_degrees(30, -30, 90)\n",
        ReasonKind.MISTAKEN,
        "0.01 s, line 2: this line turned the robot by 28°: on_for_degrees counts degrees of the "
        "wheels; 289 turn the robot by 90°",
    ),
    "rotations of the wheels": (
        "tank_turn.on_for_rotations(-100, SpeedPercent(20), 0.25)\n",
        ReasonKind.MISTAKEN,
        "wheels; 0.80 turn the robot by 90°",
    ),
    "degrees of the wheels, one motor at a time": (
        BOTH_WHEELS,
        ReasonKind.MISTAKEN,
        "line 7: this line turned the robot by 28°: run_angle counts degrees of the wheels; ",
    ),
    "degrees of the wheels, by motors that overshoot": (
        TURN_OF_A_BRICK,
        ReasonKind.MISTAKEN,
        "line 4: this line turned the robot by 56°: on_for_degrees counts degrees of the wheels; ",
    ),
    "each reading": (
        COUNTS.format(step="count += 1", more="pass"),
        ReasonKind.MISTAKEN,
        ", line 6: this line counted at 0.67 s and 0.78 s on the same band: it counts each reading "
        "that is less than 90 %, not each band",
    ),
    "off the mat": (OFF_THE_MAT, ReasonKind.LOST, "line 2: the robot left the mat"),
}


@pytest.mark.parametrize("name", CASES)
def test_a_reason_says_when_at_which_line_and_why(name: str) -> None:
    text, kind, words = CASES[name]
    first = find_reasons(run_text(text))[0]
    assert first.kind is kind
    assert words in first.words


@cases(
    "text",
    {
        "another angle": "tank_drive.on_for_degrees(30, -30, 289)\n",
        "a curve": "tank_drive.on_for_degrees(30, 10, 90)\n",
        "curves by steering": "for i in range(4):\n    tank_turn.on_for_degrees(-30, 30, 90)\n",
        "curves at full speed": "for i in range(4):\n    tank_drive.on_for_degrees(100, 30, 90)\n",
        "straight": "tank_drive.on_for_degrees(30, 30, 90)\n",
        "dark and bright readings": COUNTS.format(step="count += 1", more="print(count / 20)"),
        "readings in a row": COUNTS.format(step="count += 1", more="if i % 5 == 0: count = 0"),
        "a wait after each band": COUNTS.format(step="count += 1; time.sleep(1.2)", more="pass"),
        "a robot that stands": COUNTS.format(step="count += 1", more="pass")
        .replace("tank_drive.on(", "print(")
        .replace("-b Grey_bands", "-b Grey_bands -x 350"),
        "a whole rotation": "tank_drive.on_for_rotations(30, -30, 1)\n",
    },
)
def test_a_turn_that_is_meant_is_not_called_wrong(text: str) -> None:
    assert find_reasons(run_text(text)) == ()


END = {
    "a lost line": (
        WRONG_SIGN.replace("get_clock() < 8", "True"),
        ", line 4: colorRight left the black, and did not see it again",
    ),
    "at once": ("tank_drive.on(20, 20)\n", "0.00 s, line 1: the program ended when"),
    "a band between two reads": (
        "# %%sim_magic_preloaded -b Grey_bands\nimport time\ntank_drive.on(80, 80)\n"
        "while colorLeft.reflected_light_intensity_pc > 10:\n    time.sleep(1.02)\n",
        " s, line 5: colorLeft saw light of 0 here, but the program read it only at ",
    ),
    "as it should": ("tank_drive.on_for_seconds(20, 20, 1)\n", ""),
    "a wait": (WAITS, ""),
}


@cases("text, words", END)
def test_the_last_line_of_a_run_says_how_it_ended_wrong(text: str, words: str) -> None:
    sentence = describe_end(run_text(text))["went_wrong"]
    assert words in sentence
    assert bool(sentence) == bool(words)


def test_the_final_state_of_a_run_has_each_reason_once() -> None:
    run = run_text(
        "# %%sim_magic_preloaded -b Grey_bands\nspeed = 20\ndef go_faster():\n    speed = 60\ngo_faster()\n"
        "tank_drive.on(speed, speed)\nif colorLeft.reflected_light_intensity_pc < 5:\n    tank_drive.off()\n"
    )
    reasons = find_reasons(run)
    assert len(reasons) == 2
    assert describe_end(run) == {
        "waited_for": "",
        "went_wrong": "; ".join(reason.words for reason in reasons),
    }


def test_an_error_whose_cause_python_does_not_name_has_it_in_its_reason() -> None:
    text = "def measure():\n    x = 1\nx = measure()\nprint(x + 1)\n"
    (reason,) = find_reasons(run_text(text))
    assert reason.kind is ReasonKind.RAISED
    assert reason.words.endswith("and 'int': x is None: measure(), line 1, has no return")


TURNS_TOO_LITTLE = """\
# %%sim_magic_preloaded -b Empty_Map --solid --walls on -x 1200 -y 900 -a 0
tank_drive.on_for_degrees(SpeedPercent(20), SpeedPercent(-20), 90)
tank_drive.on_for_seconds(SpeedPercent(60), SpeedPercent(60), 8)
"""


def test_a_wrong_turn_comes_before_the_wall_to_which_it_led() -> None:
    reasons = find_reasons(run_text(TURNS_TOO_LITTLE))
    assert [reason.kind for reason in reasons] == [ReasonKind.MISTAKEN, ReasonKind.BLOCKED]


def test_a_lost_line_that_was_seen_again_is_no_cause_of_later_errors() -> None:
    wall = Reason(ReasonKind.BLOCKED, 6.0, 0, "the robot stood at the wall")
    error = Reason(ReasonKind.RAISED, 8.0, 0, "NameError")
    later = Reason(ReasonKind.MISTAKEN, 7.0, 0, "this line turned the robot by 28°")
    lost = Reason(ReasonKind.LOST, 1.0, 0, "the left sensor left the black")
    assert sort_by_cause([wall, lost, later, error]) == (error, lost, wall, later)
    seen_again = replace(lost, until_s=3.0)
    assert sort_by_cause([wall, seen_again, later]) == (wall, seen_again, later)


GOALS = """\
[[goal]]
name = "far"
say = "Drive far."
pass = { places_mm = [[1700, 500]], within_mm = 40 }

[[goal]]
name = "ends"
say = "Finish without an error."
finish = true
hidden = {hidden}
"""


def test_reasons_are_ordered_and_hidden_goals_left_out(tmp_path: Path) -> None:
    text = MISTAKE.replace("20)", "int(input()))", 1)
    run, earlier = (run_text(text, answers=(speed,)) for speed in ("20", "30"))
    mine = Recording(run)
    other = Recording(earlier)
    assert find_reasons(run)[0].line == 2
    for hidden, missed in (("false", 2), ("true", 1)):
        judgements = judge(goals_of(tmp_path, GOALS.replace("{hidden}", hidden)), run)
        kinds = [reason.kind for reason in find_reasons(run, judgements, other)]
        assert kinds == [ReasonKind.RAISED, *[ReasonKind.MISSED] * missed, ReasonKind.DIFFERS]
    assert find_reasons(run, (), mine) == find_reasons(run)


def test_a_run_of_another_program_text_is_not_compared_for_reasons() -> None:
    run = run_text("tank_drive.on_for_seconds(20, 20, 1)\n")
    for text in ("tank_drive.on_for_seconds(20, 30, 1)\n", "# -x 700\ntank_drive.off()\n"):
        assert find_reasons(run, (), Recording(run_text(text))) == ()


def test_a_run_that_met_its_goals_has_lost_nothing_and_a_missed_goal_follows_its_cause(
    tmp_path: Path,
) -> None:
    run = run_text(OFF_THE_MAT)
    goals = goals_of(tmp_path, '[[goal]]\nname = "ends"\nsay = "End."\nfinish = true\n')
    judgements = judge(goals, run)
    assert find_reasons(run) != ()
    assert find_reasons(run, judgements) == ()
    away = tuple(replace(each, goal=replace(each.goal, points=-1.0)) for each in judgements)
    assert [reason.kind for reason in find_reasons(run, away)] == [
        ReasonKind.LOST,
        ReasonKind.MISSED,
    ]


def test_a_reason_without_a_program_line_names_only_the_time() -> None:
    assert (
        Reason(ReasonKind.MISSED, 3.0, 0, "a goal was missed").words == "3.00 s: a goal was missed"
    )


def test_searching_reasons_of_a_growing_run_ignores_newer_readings(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run = run_text(WRONG_SIGN)
    records = run.telemetry.array()[:-50]
    monkeypatch.setattr(run.telemetry, "array", lambda *_: records)
    assert find_reasons(run)[0].kind is ReasonKind.LOST
