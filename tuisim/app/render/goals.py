"""The goals of a task, and how a run does on them, as lines of text: a list, and below it one goal in detail."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import assert_never

from rich.style import Style

from tuisim.app import design
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.tasks.goals.judgement import GoalState, Judgement, compute_max_points, sum_points
from tuisim.tasks.goals.spec import Goal
from tuisim.terminal.text_runs import Line, cut

_NAME = Style(color=palette.WHITE, bold=True)
_PLAIN = Style(color=palette.INK)
_PALE = Style(color=palette.SOFT)
_HEAD = Style(color=palette.GREEN, bold=True)
_HINT = Style(color=palette.YELLOW)
_STATES = {
    GoalState.OPEN: ("·", _PALE),
    GoalState.MET: ("✓", Style(color=palette.GREEN, bold=True)),
    GoalState.MISSED: ("✗", Style(color=design.RED, bold=True)),
    GoalState.UNKNOWN: ("?", _HINT),
}
_PENALTY_WORDS = {
    GoalState.OPEN: "open",
    GoalState.MET: "lost",
    GoalState.MISSED: "kept",
    GoalState.UNKNOWN: "?",
}
"""The words for the states of a goal that takes points off."""
_STATE_COLUMNS = 9
"""Columns of the sign and the word, such as `✗ missed `."""
TITLED_ROWS = 9
"""In fewer rows, the lines begin without the title of the task, which is in the frame of the panel instead."""
_DETAIL_ROWS = 3
"""Rows that are kept for a goal in detail, however long the list is."""

NO_GOALS = "No goals: o opens a goals file such as square_goals.toml"


@dataclass(frozen=True, slots=True)
class GoalsView:
    """The content of the goals panel: goals, their judgements, and a hint."""

    title: str = ""
    """Title of the task; may be empty."""
    goals: tuple[Goal, ...] = ()
    """The goals; empty if none are open."""
    judgements: tuple[Judgement, ...] = ()
    """A judgement for each goal; empty while there is no run to judge."""
    hint: str = ""
    """What to do next; empty if there is a run."""

    def states(self, tick: int | None) -> tuple[GoalState, ...]:
        """Return the state of each goal at the end of a tick; None stands for the newest instant."""
        if not self.judgements:
            return (GoalState.OPEN,) * len(self.goals)
        return tuple(each.state if tick is None else each.at(tick) for each in self.judgements)


@dataclass(frozen=True, slots=True)
class GoalsPicture:
    """The lines of the goals panel, with the goals to which they belong."""

    lines: list[Line]
    rows: tuple[int | None, ...] = ()
    """For each line the index of the goal in the list that it belongs to, if any."""
    first: int = 0
    """The first row of the detail that is shown."""
    below: int = 0
    """Number of rows of the detail that do not fit."""


def find_current_goal(states: tuple[GoalState, ...]) -> int:
    """Return the index of the goal whose details are shown by default.

    This is the first missed goal; without one, the first open goal; if all are met, the first of all.
    """
    for state in (GoalState.MISSED, GoalState.OPEN):
        if state in states:
            return states.index(state)
    return 0


def draw_goals(
    view: GoalsView, states: tuple[GoalState, ...], chosen: int, first: int, width: int, height: int
) -> GoalsPicture:
    """Return the lines of the goals panel.

    The rows of the list depend only on the goals and the size, so that they stay in place during a run.

    Args:
        view: The goals.
        states: Their states.
        chosen: Index of the goal whose details are shown.
        first: First row of the details to show, if not all of them fit.
        width: Columns inside the border.
        height: Rows inside the border.
    """
    if not view.goals:
        return GoalsPicture(list(_wrap_text(NO_GOALS, width, _PALE)))
    reached = sum_points(
        goal.points
        for goal, state in zip(view.goals, states, strict=True)
        if state is GoalState.MET
    )
    total = f"{reached:g} of {compute_max_points(view.goals):g} points"
    lines = list(_wrap_text(view.title, width, _NAME)) if height >= TITLED_ROWS else []
    lines.append([(total, _HEAD)])
    listed = [
        (line, at)
        for at, (goal, state) in enumerate(zip(view.goals, states, strict=True))
        for line in _build_header(goal, state, width)
    ]
    room = height - len(lines) - 1
    max_rows = max(1, room - max(_DETAIL_ROWS, room // 2))
    # If the list is cut, the line below it shows which goal of how many is chosen.
    number = f" {chosen + 1} of {len(view.goals)} ─" if len(listed) > max_rows else ""
    listed = _select_rows(listed, chosen, max_rows)
    rows = (*(None for _ in lines), *(at for _, at in listed))
    lines += [line for line, _ in listed]
    name = cut(view.goals[chosen].name, width - 4 - len(number))
    lines.append(
        [
            ("── ", _PALE),
            (name, _NAME),
            (f" {'─' * (width - 4 - len(name) - len(number))}{number}", _PALE),
        ]
    )
    # Before a run, nothing is known about any goal.
    judgement = view.judgements[chosen] if view.judgements else Judgement(view.goals[chosen], ())
    detail = list(_detail(judgement, states[chosen], width))
    room = max(0, height - len(lines))
    first = max(0, min(first, len(detail) - room))
    return GoalsPicture(
        [*lines, *detail[first : first + room]], rows, first, max(0, len(detail) - first - room)
    )


def _select_rows(
    listed: list[tuple[Line, int]], chosen: int, max_rows: int
) -> list[tuple[Line, int]]:
    """Return at most `max_rows` lines of a list, among them those of the chosen goal.

    Args:
        listed: The lines, each with the index of its goal.
        chosen: Index of the chosen goal.
        max_rows: The largest number of lines.
    """
    begins = next(row for row, (_, index) in enumerate(listed) if index == chosen)
    first = max(0, min(begins - max_rows // 2, len(listed) - max_rows))
    return listed[first : first + max_rows]


def _build_header(goal: Goal, state: GoalState, width: int) -> Iterator[Line]:
    """Yield the sign, the state, the name and the points of a goal; a long name continues in further lines."""
    # For a goal that takes points off, being missed is the good state.
    good = (
        {GoalState.MET: GoalState.MISSED, GoalState.MISSED: GoalState.MET}
        if goal.points < 0
        else {}
    )
    sign, style = _STATES[good.get(state, state)]
    of = f"/{goal.points:g}" if goal.points > 0 else ""
    earned = "?" if state is GoalState.UNKNOWN else f"{goal.points * (state is GoalState.MET):g}"
    points = f" {earned}{of}" if goal.points else ""
    word = _PENALTY_WORDS[state] if goal.points < 0 or state is GoalState.UNKNOWN else state
    room = max(1, width - _STATE_COLUMNS - len(points))
    first, *rest = textwrap.wrap(goal.name, room) or [""]
    yield [(f"{sign} {word:<6} ", style), (first.ljust(room), _NAME), (points, style)]
    for text in rest:
        yield [(" " * _STATE_COLUMNS + text, _NAME)]


def _detail(judgement: Judgement, state: GoalState, width: int) -> Iterator[Line]:
    """Yield the lines about one goal; the most useful ones come first, as there may be few rows."""
    goal = judgement.goal
    line = f", line {judgement.line}" if judgement.line else ""
    match state:
        case GoalState.OPEN:
            yield from _wrap_text(goal.say, width, _PLAIN)
        case GoalState.MET:
            yield from _wrap_text(f"met {_describe_moment(judgement)}{line}", width, _PALE)
            yield from _wrap_text(goal.say, width, _PLAIN)
        case GoalState.UNKNOWN:
            yield from _wrap_text("It could not be judged.", width, _PALE)
            yield from _wrap_text(judgement.reason, width, _PLAIN)
        case GoalState.MISSED if goal.points < 0:
            yield from _wrap_text(f"It did not happen: {goal.say or goal.name}", width, _PLAIN)
        case GoalState.MISSED:
            yield from _wrap_text(f"missed {_describe_moment(judgement)}{line}", width, _PALE)
            yield from _wrap_text(judgement.reason, width, _PLAIN)
            yield from _wrap_text(f"Hint: {goal.hint}" if goal.hint else "", width, _HINT)
            yield from _wrap_text(goal.say, width, _PALE)
        case _:
            assert_never(state)


def _describe_moment(judgement: Judgement) -> str:
    """Return in words when and where a goal was decided; empty if it is not decided."""
    if judgement.is_of_text:
        return "by the program's text"
    if (event := judgement.event) is None:
        return ""
    return f"at {event.time_s:.2f} s, x {event.x_mm:z.0f}, y {event.y_mm:z.0f} mm"


def _wrap_text(text: str, width: int, style: Style) -> Iterator[Line]:
    for row in textwrap.wrap(text, max(1, width)):
        yield [(row, style)]
