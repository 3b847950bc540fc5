"""A lesson that a student does: what a moment changes, and what is to follow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tuisim.base.errors import TuisimError
from tuisim.engine.core.geometry import Pose
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.tasks.goals.judgement import Change as Moment
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.goals.spec import FinishCondition, Goal
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons import session as sessions
from tuisim.tasks.lessons.events import Noted
from tuisim.tasks.lessons.progress import StepState, load_progress
from tuisim.tasks.lessons.session import Change, LessonSession, Sight
from tuisim.tasks.lessons.spec import Check, Lesson, LessonStep, NoteCheck, QuestionCheck, RunCheck

WORLD = {"background": "Empty_Map", "start.x_mm": 500.0, "start.y_mm": 500.0}
GOAL = Goal("far", FinishCondition(), say="Drive.")
BACK = TrialWorld("from farther back", {"start.x_mm": 460.0}, ("far",))


def _session(
    *checks: Check, hints: tuple[str, ...] = (), wrong: Mapping[str, str] | None = None
) -> LessonSession:
    steps = tuple(
        LessonStep(f"step {at}", f"Step {at}", "", check, 1, hints, wrong=wrong or {})
        for at, check in enumerate(checks, start=1)
    )
    lesson = Lesson("try", Path("try.md"), "Try", "", "", steps, "", (GOAL,), settings=WORLD)
    session = LessonSession(lesson)
    session.resume()
    session.begin_step("")
    return session


def _run(run_id: str, **world: float) -> Any:
    """A run in the world of the lesson, or in another one."""
    spec = build_run_spec(Settings.merge({**WORLD, **world}))
    return SimpleNamespace(run_id=run_id, spec=spec, folder=Path(run_id))


def _judged(state: GoalState) -> tuple[Judgement, ...]:
    return (Judgement(GOAL, (Moment(100, 1.0, state, 500.0, 500.0),), "It was too short."),)


def _sight(run: Any, state: GoalState = GoalState.MET) -> Sight:
    return Sight(frozenset(), is_over=True, judged=run, judgements=_judged(state))


def test_a_good_run_ends_a_lessons_step_and_does_not_count_for_the_next(home: Path) -> None:
    session = _session(RunCheck(("far",)), RunCheck(("far",)))
    sight = _sight(_run("a"))
    assert session.look(sight) is Change.GO_ON
    assert (session.done, session.at) == (session.lesson.steps[0], 1)
    assert session.story == "Your run: it finished at 1.00 s."
    session.begin_step("a")
    assert session.look(sight) is Change.NONE
    session.save()
    assert load_progress()["try"].of("step 1").state is StepState.DONE
    assert session.skip_step() is session.lesson.steps[1]
    assert (session.step, session.step_before, session.done) == (
        None,
        session.lesson.steps[1],
        None,
    )


def test_a_run_that_misses_a_lessons_goal_counts_as_one_try(home: Path) -> None:
    session = _session(RunCheck(("far",)))
    for _ in range(2):
        assert session.look(_sight(_run("a"), GoalState.MISSED)) is Change.SHOW
    assert session.progress.of("step 1").tries == 1


def test_after_a_run_from_another_start_a_lesson_says_what_to_do(home: Path) -> None:
    session = _session(RunCheck(("far",)))
    assert session.look(_sight(_run("a", **{"start.x_mm": 520.0}))) is Change.SHOW
    there = Pose(520.0, 500.0, 0.0)
    begun = session.describe_elsewhere(there, in_run=True)
    over = session.describe_elsewhere(there, in_run=False)
    back = session.describe_elsewhere(Pose(500.0, 500.0, 0.0), in_run=False)
    assert begun == "This run began elsewhere."
    assert over == "This run began elsewhere: m moves the robot to its start, then R."
    assert back.endswith("The robot is back at its start: R runs the program.")
    session.look(_sight(_run("b", **{"noise.light": 3})))
    assert "different noise or drift" in session.describe_elsewhere(there, in_run=False)


def test_runs_of_a_lessons_step_count_in_any_order_of_its_worlds(home: Path) -> None:
    session = _session(RunCheck(("far",), times=2, also=(BACK,)))
    trials = []
    for run_id in "ab":
        assert session.look(_sight(_run(run_id))) is Change.TRY
        trials.append(session.attempt.trial)
    first, second = trials
    assert first and second and session.attempt.remark.endswith("also runs from farther back …")
    assert session.take_trial(first, [(BACK, _judged(GoalState.MISSED))]) is Change.SHOW
    assert "also runs" in session.attempt.remark
    session.take_trial(second, [(BACK, _judged(GoalState.MISSED))])
    missed = "Also tried from farther back, it does not work (start x = 460 mm): It was too short."
    assert session.attempt.remark == missed
    session.take_trial(first, [(BACK, _judged(GoalState.MET))])
    assert session.take_trial(second, [(BACK, _judged(GoalState.MET))]) is Change.GO_ON
    assert session.take_trial(second, []) is Change.NONE


def test_a_lesson_says_why_a_note_does_not_pass(
    home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session = _session(NoteCheck("dark", 86.0))
    levels = [50.0]
    monkeypatch.setattr(sessions, "NOTES_PERIOD_S", 0.0)
    monkeypatch.setattr(sessions, "_read_notes", lambda _: [Noted("dark", levels[0])])
    sight = Sight(frozenset(), _run("a"))
    assert session.look(sight) is Change.SHOW
    assert session.attempt.remark.startswith("Your note “dark” is on samples with a mean of 50.0;")
    assert session.look(sight) is Change.NONE
    levels[0] = 86.0
    assert session.look(sight) is Change.GO_ON


PLACED = QuestionCheck("What?", 5, at_x_mm=((600.0, 700.0),), where="the right: → moves it")


def test_only_a_number_given_at_the_right_place_counts_as_a_try(home: Path) -> None:
    session = _session(PLACED, hints=("Look.",))
    sight = Sight(frozenset())
    for text, x_mm, words in (
        ("", 620.0, "Type an answer"),
        ("five", 620.0, "five: type a number"),
        ("5", 500.0, "The robot is at x = 500 mm. The question is about the right: → moves it."),
        ("6", 620.0, "6 is too large. Try again. Escape, then Y shows a hint"),
    ):
        with pytest.raises(TuisimError, match="^" + words.replace(".", r"\.")):
            session.answer(text, x_mm, sight)
    session.show_hint()
    with pytest.raises(TuisimError, match=r"Try again$"):
        session.answer("7", 620.0, sight)
    progress = session.progress.of("step 1")
    assert (progress.tries, progress.hints) == (2, 1)
    assert session.answer("5", 620.0, sight) is Change.GO_ON


def test_a_likely_wrong_answer_is_told_its_reason(home: Path) -> None:
    wrong = {"6": "That is the start.", "7": ""}
    choice = QuestionCheck("What?", "a", choices=("a", "b", "c"))
    for check, reasons, text, words in (
        (QuestionCheck("What?", 5), wrong, "x = 6 mm", "x = 6 mm is not right. That is the start"),
        (QuestionCheck("What?", 5), wrong, "7", "7 is too large. Try again"),
        (choice, {"b": "It is not."}, "2", "2 is not right. It is not"),
        (choice, {"b": "It is not."}, "3", "3 is not right. Try again"),
    ):
        session = _session(check, wrong=reasons)
        with pytest.raises(TuisimError) as error:
            session.answer(text, 620.0, Sight(frozenset()))
        assert str(error.value) == words


def test_a_panel_shown_since_a_lessons_step_began_counts_as_seen(home: Path) -> None:
    session = _session(replace(PLACED, at_x_mm=(), where="", seen=("chart",)))
    with pytest.raises(TuisimError, match=r"Look first: Chart .key {panel-chart}. shows it"):
        session.answer("5", 0.0, Sight(frozenset({"output"})))
    session.look(Sight(frozenset({"chart"})))
    assert session.answer("5", 0.0, Sight(frozenset())) is Change.GO_ON
