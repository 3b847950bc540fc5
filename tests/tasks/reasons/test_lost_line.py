"""Where a robot that followed a line has lost it; and where one has not, or did not follow any."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.running import PATIENCE_S
from tests.tasks.reasons.runs import PROGRAMS, WRONG_SIGN, run_example, run_text
from tuisim.engine.runs.handle import start_run
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.store import RunStore
from tuisim.tasks.lessons.catalogue import find_lesson_paths
from tuisim.tasks.lessons.files import load_lesson
from tuisim.tasks.lessons.trial import build_task, list_trials
from tuisim.tasks.reasons.lost_line import _Way
from tuisim.tasks.reasons.reason import Reason, ReasonKind, find_reasons

EXAMPLES = sorted(PROGRAMS.glob("*.py"))


def lost_in(run: StoredRun) -> list[Reason]:
    return [reason for reason in find_reasons(run) if reason.kind is ReasonKind.LOST]


@pytest.mark.quick_cases("log_greys", "until_black")
@pytest.mark.parametrize("path", EXAMPLES, ids=[path.stem for path in EXAMPLES])
def test_no_example_program_is_said_to_have_gone_wrong(
    path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # One of them writes a file.
    monkeypatch.chdir(tmp_path)
    assert find_reasons(run_example(path)) == ()


@pytest.mark.slow
@pytest.mark.parametrize("name", find_lesson_paths())
def test_no_model_answer_of_a_lesson_is_said_to_have_lost_the_line(name: str) -> None:
    lesson = load_lesson(find_lesson_paths()[name])
    for trial in list_trials(lesson):
        if trial.passes:
            task = build_task(lesson, trial.text, trial.seed)
            handle = start_run(task.program, task.spec, task.options)
            assert handle.wait(PATIENCE_S)
            assert find_reasons(RunStore().load_run(handle.run_id)) == (), trial.step.name


EDGE = """\
# %%sim_magic_preloaded -b Two_shapes -x 1219 -y 495 -a 90
while get_clock() < {seconds}:
    if colorLeft.reflected_light_intensity_pc < 50:
        tank_drive.on(SpeedPercent({left}), SpeedPercent({right}))
    else:
        tank_drive.on(SpeedPercent({right}), SpeedPercent({left}))
tank_drive.off()
"""
P = """\
# %%sim_magic_preloaded -b {mat}
while get_clock() < {seconds}:
    error = colorLeft.reflected_light_intensity_pc - 50
    turn = error * {gain}
    tank_drive.on(SpeedPercent({speed} + turn), SpeedPercent({speed} - turn))
tank_drive.off()
"""
THERE_AND_BACK = """\
# %%sim_magic_preloaded -b Grey_bands
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while get_clock() < 5:
    print("Light:", colorLeft.reflected_light_intensity_pc)
tank_turn.on_for_rotations(-100, SpeedPercent(20), 180 / 56 / 2)
tank_drive.on(SpeedPercent(40), SpeedPercent(40))
while get_clock() < 9:
    print("Light:", colorLeft.reflected_light_intensity_pc)
tank_drive.off()
"""
STAYS_INSIDE = """\
# %%sim_magic_preloaded -b Loop -x 900 -y 500
while get_clock() < 25:
    tank_drive.on(SpeedPercent(30), SpeedPercent(30))
    if colorLeft.reflected_light_intensity_pc < 30:
        tank_drive.on_for_rotations(SpeedPercent(-30), SpeedPercent(-30), 0.7)
        tank_turn.on_for_rotations(-100, SpeedPercent(30), 0.9)
tank_drive.off()
"""
# The mat is of several greys, and the robot sees more of them after it has lost the line.
WRONG_SIDES = """\
# %%sim_magic_preloaded -b Lollipop
while True:
    left = colorLeft.reflected_light_intensity_pc
    if left < 50:
        tank_drive.on(30, 10)
    elif colorRight.reflected_light_intensity_pc < 50:
        tank_drive.on(10, 30)
    else:
        tank_drive.on(20, 20)
"""
UNTIL_BLACK = """\
# %%sim_magic_preloaded -b Grey_bands
tank_drive.on(SpeedPercent(20), SpeedPercent(20))
while colorLeft.reflected_light_intensity_pc > 20:
    pass
tank_drive.off()
tank_turn.on_for_degrees(-100, SpeedPercent(30), 289)
tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30), 1)
"""
STEERS = """\
# %%sim_magic_preloaded -b Two_shapes -x {x} -y 495 -a 90
while get_clock() < 8:
    light = colorLeft.reflected_light_intensity_pc
    steering = {sign} * 0.3 * (light - 50)
    tank_turn.on(steering, SpeedPercent({speed}))
tank_turn.off()
"""
GOOD = {
    "over bands up to the black": UNTIL_BLACK,
    "over bands, started in the loop": UNTIL_BLACK.replace("pass", "tank_drive.on(20, 20)"),
    "edge": EDGE.format(seconds=15, left=5, right=20),
    "proportional": P.format(mat="Lollipop", seconds=20, gain=0.4, speed=15),
    "there and back": THERE_AND_BACK,
    "stays inside": STAYS_INSIDE,
}
WRONG = {
    "the sign of two sensors": (WRONG_SIGN, "1.04", "colorRight left the black, and did not"),
    "and then far over the mat": (
        WRONG_SIDES,
        "1.03",
        "colorRight left the black, and did not",
    ),
    "too fast": (EDGE.format(seconds=9, left=30, right=40), "", "the robot left the mat"),
    "the sides swapped": (
        EDGE.format(seconds=18, left=20, right=5),
        "0.",
        "as it got brighter, the robot turned left, away from the line, so the steering in line 4 has the wrong sign",
    ),
    "the wrong sign of the steering": (
        STEERS.format(x=1219, sign=-1, speed=15),
        "0.44",
        "did not see it again: as it got brighter, the robot turned left, away from the line, so the steering in line "
        "5 has the wrong sign",
    ),
    "too weak": (
        P.format(mat="Lollipop", seconds=8, gain=0.05, speed=40),
        "0.01",
        "colorLeft saw only grey",
    ),
    "not at the line": (
        P.format(mat="Loop", seconds=8, gain=0.3, speed=15),
        "0.01",
        "from here on colorLeft saw only white",
    ),
}


@pytest.mark.quick_cases("edge", "over bands up to the black", "stays inside")
@pytest.mark.parametrize("name", GOOD)
def test_a_robot_that_follows_its_line_is_not_said_to_have_lost_it(name: str) -> None:
    assert lost_in(run_text(GOOD[name], limit_s=30.0)) == []


@pytest.mark.quick_cases("the sign of two sensors", "the wrong sign of the steering")
@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_program_is_told_where_it_lost_the_line(name: str) -> None:
    text, time_s, words = WRONG[name]
    first = lost_in(run_text(text, limit_s=30.0))[0]
    assert words in first.text
    assert first.words.startswith(time_s)


def test_the_right_sign_is_not_blamed_for_a_line_lost_at_high_speed() -> None:
    (reason,) = lost_in(run_text(STEERS.format(x=1240, sign=1, speed=40)))
    assert "left the black" in reason.text
    assert "sign" not in reason.text


def test_a_line_lost_and_seen_again_is_told_with_the_time() -> None:
    text = EDGE.format(seconds=18, left=20, right=5)
    reason = lost_in(run_text(text, limit_s=30.0))[0]
    assert "saw it again after" in reason.text
    assert reason.line == 3


@pytest.mark.parametrize(
    "gaps_s, losses",
    [((1.4,), 0), ((1.6,), 1), ((0.6, 1.7), 0), ((0.5, 1.7), 1), ((1.6, 1.7), 1), ((1.6, 5.0), 2)],
)
def test_a_line_counts_as_lost_after_a_gap_three_times_longer_than_before(
    gaps_s: tuple[float, ...], losses: int
) -> None:
    # A robot that moves all the time, over the dark for a second before each gap.
    is_dark = np.concatenate(
        [np.repeat([True, False], [100, round(gap_s * 100)]) for gap_s in gaps_s]
    )
    records = np.zeros(len(is_dark) + 1, [("x_mm", "f8"), ("y_mm", "f8"), ("heading_deg", "f8")])
    records["x_mm"] = np.arange(len(records))
    way = _Way(records, np.append(True, is_dark))
    assert len(way.find_long_gaps(100)) == losses
