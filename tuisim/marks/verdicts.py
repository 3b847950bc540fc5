"""The goals of one run in its report: a table, and the places on the mat where they were decided."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.analysis.pins import Pin
from tuisim.analysis.report import section, table
from tuisim.errors import LogError
from tuisim.goals.judgement import Change
from tuisim.goals.spec import ConditionKind, Goal
from tuisim.marks.outcome import GoalOutcome, Outcome
from tuisim.marks.sheet import SheetColumn, in_words
from tuisim.protocol import End
from tuisim.runs.run_folder import StoredRun

_HEADS = ("", "goal", "result", "why", "points")


def verdicts(
    columns: Sequence[SheetColumn], goals: Sequence[Goal], outcome: Outcome, run: StoredRun
) -> tuple[str, list[Pin]]:
    """Return the section with the goals of a run, and a pin for each goal that was decided at a place.

    Args:
        columns: The goals that are shown, in their order.
        goals: All goals of the task.
        outcome: What the run has achieved.
    """
    found = {one.name: one for one in outcome.goals}
    judged = _judged(goals, outcome, run)
    rows, pins = [], []
    for number, column in enumerate(columns, start=1):
        goal = found.get(column.name, GoalOutcome(column.name, False, outcome.failure))
        result = "met" if goal.met else "missed"
        why = f"{goal.reason} (line {goal.line})" if goal.line else goal.reason
        points = f"{in_words(column.points if goal.met else 0)} of {in_words(column.points)}"
        if (event := judged.get(column.name)) is not None:
            result += f" at {event.time_s:.2f} s, x {event.x_mm:.0f}, y {event.y_mm:.0f} mm"
            said = f"{number}. {column.say} {result}"
            pins.append(Pin(str(number), event.x_mm, event.y_mm, goal.met, f"{said}: {why}" if why else said))
        rows.append([str(number), column.say, result, why, points])
    return section("Goals", table(_HEADS, rows, numbers=len(_HEADS) - 1)), pins


def _judged(goals: Sequence[Goal], outcome: Outcome, run: StoredRun) -> dict[str, Change]:
    """Return when and where goals were met or missed, of those that were at a time and a place."""
    if outcome.end == End.FALSIFIED:
        return {}
    # Judging is slow to import, and most runs have been judged.
    from tuisim.goals.judge import judge

    try:
        judgements = judge(goals, run)
    except LogError:
        # What is known of the run is in its outcome.
        return {}
    return {one.goal.name: one.event for one in judgements if one.event and not _is_of_the_text(one.goal)}


def _is_of_the_text(goal: Goal) -> bool:
    return all(part.KIND is ConditionKind.FIXED for part in goal.parts)
