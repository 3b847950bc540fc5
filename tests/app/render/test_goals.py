"""Goals as lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from tests.cases import for_each
from tuisim.app.render.goals import GoalsView, draw_goals
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import AllOf, FinishCondition, Goal, UseCondition
from tuisim.terminal.text_runs import Line

MET = Judgement(
    Goal("there", FinishCondition(), "Drive to it.", 2),
    (Change(100, 1.0, GoalState.MET, 299.6, 80.2),),
    line=7,
)


MISSED = Judgement(
    Goal("closed", FinishCondition(), points=1.5, hint="Turn by 90."),
    (Change(200, 2.0, GoalState.MISSED, 1.0, 2.0),),
    "It was 30 mm off.",
    9,
)


BY_TEXT = Judgement(
    Goal("part", UseCondition(("f",)), points=0), (Change(0, 0.0, GoalState.MET, 1.0, 2.0),), line=3
)


OPEN = Judgement(
    Goal("both", AllOf(("there",)), "First the one, then the other."), (), "5 mm to go."
)


UNKNOWN = Judgement(
    Goal("says", FinishCondition(), "Say it.", 2),
    (Change(200, 2.0, GoalState.UNKNOWN, 1.0, 2.0),),
    "The expression is slow.",
)
KEPT = replace(MISSED, goal=replace(MISSED.goal, name="hit", say="Hit the wall.", points=-2))
LOST = replace(MET, goal=replace(MET.goal, name="hit", say="Hit the wall.", points=-2))

TEXTS = {
    "no points taken off": (
        KEPT,
        "✓ kept   hit                  0",
        ["It did not happen: Hit the", "wall."],
    ),
    "points taken off": (
        LOST,
        "✗ lost   hit                 -2",
        ["met at 1.00 s, x 300, y 80 mm,", "line 7", "Hit the wall."],
    ),
    "not known": (
        UNKNOWN,
        "? ?      says               ?/2",
        ["It could not be judged.", "The expression is slow."],
    ),
    "met": (
        MET,
        "✓ met    there              2/2",
        ["met at 1.00 s, x 300, y 80 mm,", "line 7", "Drive to it."],
    ),
    "missed": (
        MISSED,
        "✗ missed closed           0/1.5",
        ["missed at 2.00 s, x 1, y 2 mm,", "line 9", "It was 30 mm off.", "Hint: Turn by 90."],
    ),
    "by the text, without points": (
        BY_TEXT,
        "✓ met    part",
        ["met by the program's text, line", "3"],
    ),
    "open": (OPEN, "· open   both               0/1", ["First the one, then the other."]),
}


def texts(lines: Sequence[Line]) -> list[str]:
    return ["".join(text for text, _ in line).rstrip() for line in lines]


@pytest.mark.parametrize("name", TEXTS)
def test_a_goal_is_listed_with_its_state_and_its_details_below(name: str) -> None:
    judgement, listed, detail = TEXTS[name]
    view = GoalsView("A task", (judgement.goal,), (judgement,))
    lines = texts(draw_goals(view, view.states(None), 0, 0, 31, 12).lines)
    assert lines[0] == "A task"
    assert lines[2] == listed
    assert lines[3].startswith(f"── {judgement.goal.name} ──")
    assert lines[4:] == detail


def test_rows_of_the_list_of_goals_do_not_move_when_goals_are_met_or_missed() -> None:
    goals = (MET.goal, MISSED.goal, replace(OPEN.goal, name="a name that is longer than one line"))
    view = GoalsView("A task", goals, (MET, MISSED, OPEN))
    after = draw_goals(view, view.states(None), 1, 0, 24, 13)
    before = draw_goals(GoalsView("A task", goals), (GoalState.OPEN,) * 3, 0, 0, 24, 13)
    assert after.rows == before.rows == (None, None, 0, 1, 2, 2, 2)


@for_each(height=[6, 9, 13, 24], chosen=[0, 11, 19])
def test_a_long_list_shows_the_chosen_goal_and_its_detail(height: int, chosen: int) -> None:
    goals = tuple(replace(MISSED.goal, name=f"goal {number}") for number in range(20))
    view = GoalsView("A task", goals, tuple(replace(MISSED, goal=goal) for goal in goals))
    picture = draw_goals(view, view.states(None), chosen, 0, 40, height)
    assert chosen in picture.rows
    assert len(picture.lines) <= height
    assert any(
        line.startswith("── goal") and line.endswith(f" {chosen + 1} of 20 ─")
        for line in texts(picture.lines)
    )
    assert "missed at 2.00 s, x 1, y 2 mm, line 9" in texts(picture.lines)
    end = draw_goals(view, view.states(None), chosen, 99, 40, height)
    assert end.below == 0
    assert texts(end.lines)[-1] == "Hint: Turn by 90."
