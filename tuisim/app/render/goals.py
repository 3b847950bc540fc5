"""The goals of a task, and how a run does on them, as lines of text."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from typing import assert_never

from rich.style import Style

from tuisim.charts.text_runs import Line
from tuisim.goals.judge import Change, GoalState, Judgement
from tuisim.goals.spec import Goal, Kind

_NAME = Style(color="#ffffff", bold=True)
_PLAIN = Style(color="#d8dee6")
_PALE = Style(color="#9fb0c3")
_HEAD = Style(color="#87d7af", bold=True)
_HINT = Style(color="#ffd75f")
_STATES = {
    GoalState.OPEN: ("·", _PALE),
    GoalState.MET: ("✓", Style(color="#87d7af", bold=True)),
    GoalState.MISSED: ("✗", Style(color="#ff6e6e", bold=True)),
}
_STATE_COLUMNS = 9
"""Columns of the sign and the word, such as `✗ missed `."""
_INDENT = "  "

NO_GOALS = "No goals: o opens a goals file such as square_goals.toml"


@dataclass(frozen=True, slots=True)
class GoalsView:
    """The content of the goals panel."""

    title: str = ""
    """The task; may be empty."""
    goals: tuple[Goal, ...] = ()
    """Empty: no goals are open."""
    judgements: tuple[Judgement, ...] = ()
    """One for each goal; empty while there is no run to judge."""
    hint: str = ""
    """What to do next; empty if there is a run."""

    def states(self, tick: int | None) -> tuple[GoalState, ...]:
        """Return the state of each goal when a tick was complete; None: now."""
        if not self.judgements:
            return (GoalState.OPEN,) * len(self.goals)
        return tuple(each.state if tick is None else each.at(tick) for each in self.judgements)


def goal_lines(view: GoalsView, states: tuple[GoalState, ...], width: int) -> list[Line]:
    """Return the text for a panel of that inner width, with the goals in the given states."""
    if not view.goals:
        return list(_wrapped(NO_GOALS, width, _PALE, ""))
    reached = sum(goal.points for goal, state in zip(view.goals, states, strict=True) if state is GoalState.MET)
    total = f"{reached:g} of {sum(goal.points for goal in view.goals):g} points"
    lines = [*_wrapped(view.title, width, _NAME, ""), [(total, _HEAD)]]
    # Before a run, nothing is known about any goal.
    judgements = view.judgements or tuple(Judgement(goal, ()) for goal in view.goals)
    for judgement, state in zip(judgements, states, strict=True):
        lines += _block(judgement, state, width)
    return lines


def _block(judgement: Judgement, state: GoalState, width: int) -> Iterator[Line]:
    goal = judgement.goal
    yield from _header(goal, state, width)
    yield from _wrapped(goal.say, width, _PLAIN)
    line = f", line {judgement.line}" if judgement.line else ""
    match state:
        case GoalState.OPEN:
            yield from _wrapped("not decided yet", width, _PALE)
        case GoalState.MET:
            yield from _wrapped(f"{_when(judgement)}{line}", width, _PALE)
        case GoalState.MISSED:
            yield from _wrapped(f"{_when(judgement)}{'' if judgement.reason else line}", width, _PALE)
            if judgement.reason:
                yield from _wrapped(f"{judgement.reason}{f' (line {judgement.line})' if line else ''}", width, _PLAIN)
            if goal.hint:
                yield from _wrapped(f"Hint: {goal.hint}", width, _HINT)
        case _:
            assert_never(state)


def _header(goal: Goal, state: GoalState, width: int) -> Iterator[Line]:
    """Yield sign, word, name and points; a long name goes on in further lines."""
    sign, style = _STATES[state]
    points = f" {goal.points if state is GoalState.MET else 0:g}/{goal.points:g}" if goal.points else ""
    room = max(1, width - _STATE_COLUMNS - len(points))
    first, *rest = textwrap.wrap(goal.name, room) or [""]
    yield [(f"{sign} {state:<6} ", style), (first.ljust(room), _NAME), (points, style)]
    for text in rest:
        yield [(" " * _STATE_COLUMNS + text, _NAME)]


def _when(judgement: Judgement) -> str:
    """Return when and where a goal was decided."""
    if all(part.KIND is Kind.FIXED for part in judgement.goal.parts):
        return "by the program's text"
    change: Change = judgement.changes[-1]
    return f"{change.time_s:.2f} s, x {change.x_mm:.0f}, y {change.y_mm:.0f} mm"


def _wrapped(text: str, width: int, style: Style, indent: str = _INDENT) -> Iterator[Line]:
    for row in textwrap.wrap(text, max(1, width - len(indent))):
        yield [(indent + row, style)]
