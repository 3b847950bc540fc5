"""What is said of the run that has passed a step."""

from __future__ import annotations

from tests.cases import for_rows
from tuisim.tasks.goals.condition import Condition
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import (
    AvoidCondition,
    FinishCondition,
    FollowCondition,
    Goal,
    LogCondition,
    PassCondition,
    PrintCondition,
    ReachCondition,
    Together,
)
from tuisim.tasks.lessons.story import build_story

SAID: dict[str, tuple[Condition, str]] = {
    "end": (ReachCondition(x_mm=1150, at_end=True), "it ended at x = 1153 mm, y = 500 mm"),
    "reach": (ReachCondition(x_mm=1150), "it came to the goal at 5.42 s"),
    "pass": (PassCondition(((1150, 500),)), "it came to the goal at 5.42 s"),
    "print": (PrintCondition(("x",)), "line 3 printed it at 5.42 s, at x = 1153 mm, y = 500 mm"),
    "print lines": (
        PrintCondition(("x", "y")),
        "line 3 printed the last at 5.42 s, at x = 1153 mm, y = 500 mm",
    ),
    "print once": (
        PrintCondition(("x", "y"), once=True),
        "line 3 printed the last at 5.42 s, at x = 1153 mm, y = 500 mm",
    ),
    "log": (
        LogCondition("Grey", (50.2,)),
        "line 3 logged Grey at 5.42 s, at x = 1153 mm, y = 500 mm",
    ),
    "log levels": (
        LogCondition("Grey", (50.2, 0)),
        "line 3 logged Grey at 5.42 s, at x = 1153 mm, y = 500 mm",
    ),
    "follow": (
        FollowCondition(("left",), darker_than=50),
        "the sensor was on the line for long enough",
    ),
    "finish": (FinishCondition(), "it finished at 5.42 s"),
    "two": (Together((FinishCondition(), AvoidCondition(("f",)))), "it finished at 5.42 s"),
}


@for_rows("condition, words", SAID)
def test_the_sentence_about_a_run_says_how_its_goal_was_met(
    condition: Condition, words: str
) -> None:
    met = Judgement(
        Goal("a", condition), (Change(542, 5.42, GoalState.MET, 1152.9, 500.0),), line=3
    )
    assert build_story([met, met]) == f"Your run: {words}."


def test_the_sentence_about_a_goal_decided_at_the_end_names_when_it_happened() -> None:
    said = Change(542, 5.42, GoalState.MET, 1120.0, 500.0)
    end = Change(900, 9.0, GoalState.MET, 1420.0, 500.0)
    met = Judgement(
        Goal("a", LogCondition("Grey", (50.2,), once=True)), (end,), line=3, happened=said
    )
    assert (
        build_story([met]) == "Your run: line 3 logged Grey at 5.42 s, at x = 1120 mm, y = 500 mm."
    )


def test_of_several_goals_about_a_variable_the_sentence_names_the_last() -> None:
    goals = [
        Judgement(
            Goal(name, LogCondition("Colour", (50,))),
            (Change(1, time_s, GoalState.MET, 1120.0, 500.0),),
            line=7,
        )
        for name, time_s in (("a", 3.79), ("b", 5.35), ("c", 3.91))
    ]
    assert (
        build_story(goals)
        == "Your run: line 7 logged Colour at 5.35 s, at x = 1120 mm, y = 500 mm."
    )


def test_the_sentence_about_a_run_leaves_out_goals_not_met() -> None:
    assert (
        build_story(
            [
                Judgement(
                    Goal("a", FinishCondition()), (Change(1, 0.1, GoalState.MISSED, 1, 2),), "No."
                )
            ]
        )
        == ""
    )
