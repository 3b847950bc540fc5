"""What a run did to meet the goals of a step, in a sentence for the student whose run it was."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from tuisim.tasks.goals.condition import Condition
from tuisim.tasks.goals.judgement import Change, GoalState, Judgement
from tuisim.tasks.goals.spec import (
    FinishCondition,
    FollowCondition,
    LogCondition,
    PassCondition,
    PrintCondition,
    ReachCondition,
)


def build_story(judgements: Iterable[Judgement]) -> str:
    """Return when and where a run met goals, such as `Your run: line 3 printed it at 5.42 s, at x = 1153 mm.`

    The text is empty if the run met none, or if only the program's text decided on them.

    Args:
        judgements: The judgements of the goals of the step.
    """
    parts = dict.fromkeys(
        part for each in sorted(judgements, key=_time_s) for part in _list_parts(each)
    )
    # Of several goals about one variable, the last one replaces the others.
    facts = {part.partition(" at ")[0]: part for part in parts}
    return f"Your run: {'; '.join(facts.values())}." if facts else ""


def _time_s(judgement: Judgement) -> float:
    return judgement.event.time_s if judgement.event is not None else 0.0


def _list_parts(judgement: Judgement) -> Iterator[str]:
    if judgement.state is not GoalState.MET or judgement.event is None:
        return
    for condition in judgement.goal.parts:
        if words := _describe_condition(condition, judgement.event, judgement.line):
            yield words


def _describe_condition(condition: Condition, event: Change, line: int) -> str:
    """Return in words when and where a run met a condition; empty for conditions that only the program's text decides.

    Args:
        condition: The condition.
        event: When and where it was met.
        line: The number of the program's line that ran at that time.
    """
    when = f"at {event.time_s:.2f} s"
    where = f"at x = {event.x_mm:.0f} mm, y = {event.y_mm:.0f} mm"
    match condition:
        case ReachCondition(at_end=True):
            return f"it ended {where}"
        case ReachCondition() | PassCondition():
            # A place on the way would be taken for the place where the robot stopped.
            return f"it came to the goal {when}"
        case PrintCondition(lines=lines):
            last = "" if len(lines) == 1 else " the last"
            return f"line {line} printed{last or ' it'} {when}, {where}"
        case LogCondition(name=name):
            return f"line {line} logged {name} {when}, {where}"
        case FollowCondition():
            return "the sensor was on the line for long enough"
        case FinishCondition():
            return f"it finished {when}"
    return ""
