"""Outcomes from results of tasks made by hand."""

from __future__ import annotations

from dataclasses import replace
from math import nan
from pathlib import Path

from ev3dev2 import motor

from tests.cases import for_rows
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import AllOf, FinishCondition, Goal, ReachCondition, UseCondition
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.marks.outcome import Outcome, build_outcome
from tuisim.tasks.task import Result

FOLDER = Path("/copy-of/student/7")
DONE = Result(7, {}, "finished", 0, "", "", 0, 100, 1.0, 0.0, 0.0, 0.0)


def _judgement(goal: Goal, state: GoalState, reason: str = "", line: int = 0) -> Judgement:
    return Judgement(goal, (Change(10, 0.1, state, 0.0, 0.0),), reason, line)


def _build(result: Result, seed: int) -> Outcome:
    """The outcome in a world in which all goals count."""
    names = tuple(judgement.goal.name for judgement in result.judgements)
    return build_outcome(result, seed, FOLDER, TrialWorld("", {}, names))


FAILURES = {
    "finished": (DONE, ""),
    "exit code": (
        replace(DONE, exit_code=1, summary="ended itself with exit code 1"),
        "ended itself with exit code 1",
    ),
    "exception": (
        replace(
            DONE,
            end="raised",
            error=f'File "{FOLDER}/a.py"\n',
            summary="OSError: <A object at 0x7f00deadbeef>",
        ),
        "OSError: <A object at 0x…>",
    ),
    "path": (
        replace(DONE, end="raised", summary=f"OSError: '{FOLDER}/data.csv'"),
        "OSError: 'data.csv'",
    ),
    "control characters": (replace(DONE, end="raised", summary="E: \x1b[2J"), "E: \ufffd[2J"),
    "too long": (replace(DONE, end="raised", summary="x" * 1000), "x" * 300 + "…"),
    "real time": (
        replace(DONE, end="stopped", summary="stopped"),
        "stopped, because it took too long",
    ),
    "stuck": (
        replace(
            DONE, end="stalled", summary="no simulated time passed in 10 s of computing, in line 3"
        ),
        "stuck: no simulated time passed",
    ),
    "not started": (replace(DONE, end="", error="no mat Nowhere", x_mm=nan), "no mat Nowhere"),
    "crashed without a word": (replace(DONE, end="crashed", exit_code=1), "crashed"),
}


@for_rows("result, failure", FAILURES)
def test_each_end_of_a_marked_run_has_its_words_for_the_failure(
    result: Result, failure: str
) -> None:
    assert _build(result, 3).failure == failure


def test_a_marked_runs_traceback_is_cut_and_has_no_path() -> None:
    error = f'Traceback\n  File "{FOLDER}/main.py", line 3\n' + "ValueError: " + "y" * 100_000
    found = _build(replace(DONE, end="raised", error=error, error_line=3), 3)
    assert (
        found.error.startswith('Traceback\n  File "main.py", line 3\nValueError: y')
        and len(found.error) < 5000
    )


def test_a_marked_runs_traceback_has_no_path_of_this_machine() -> None:
    library = f"cannot import name 'MoveTanks' from 'ev3dev2.motor' ({motor.__file__})"
    found = _build(
        replace(DONE, end="raised", error="Traceback", summary=f"ImportError: {library}"), 0
    )
    assert (
        found.failure
        == "ImportError: cannot import name 'MoveTanks' from 'ev3dev2.motor' (ev3dev2/motor.py)"
    )


def test_a_path_written_by_the_student_stays_in_an_error() -> None:
    found = _build(
        replace(DONE, end="raised", summary="FileNotFoundError: '/data/of/ada/x.csv'"), 0
    )
    assert found.failure == "FileNotFoundError: '/data/of/ada/x.csv'"


def test_a_combined_goal_is_missed_with_the_reason_of_its_first_missed_part() -> None:
    near = Goal("near", ReachCondition(x_mm=5))
    finish = Goal("finish", FinishCondition())
    both = Goal("both", AllOf(("near", "finish")))
    every = Goal("every", AllOf(("both",)))
    judgements = (
        _judgement(every, GoalState.MISSED, "“both” was missed.", 1),
        _judgement(both, GoalState.MISSED, "“finish” was missed.", 2),
        _judgement(near, GoalState.MET),
        _judgement(finish, GoalState.MISSED, "It raised an exception.", 9),
    )
    found = _build(replace(DONE, judgements=judgements), 0)
    missed = (False, "It raised an exception.", 9)
    assert {goal.name: (goal.met, goal.reason, goal.line) for goal in found.goals} == {
        "every": missed,
        "both": missed,
        "near": (True, "", 0),
        "finish": missed,
    }


def test_only_goals_that_a_sound_recording_decides_have_an_event() -> None:
    near = _judgement(Goal("near", ReachCondition(x_mm=5)), GoalState.MET)
    call = _judgement(Goal("call", UseCondition(("time.sleep",))), GoalState.MET)
    sound = replace(DONE, judgements=(near, call))
    events = [
        [goal.event for goal in _build(result, 0).goals]
        for result in (sound, replace(sound, end="falsified"))
    ]
    assert events == [[near.event, None], [None, None]]
