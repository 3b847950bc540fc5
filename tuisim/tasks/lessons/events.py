"""What a student has done and measured, and whether that passes the check of a step."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TypeAlias, assert_never

from tuisim.base.data_class import dataclass
from tuisim.engine.core.conditions import NUMBER
from tuisim.tasks.lessons.spec import (
    BreakCheck,
    Check,
    ExportCheck,
    NoteCheck,
    QuestionCheck,
    RunCheck,
    ShowCheck,
    VisitCheck,
    WatchCheck,
)


@dataclass(frozen=True, slots=True)
class JudgedRun:
    """Event: a run has met goals of the lesson. When it meets further goals, another event follows."""

    run_id: str
    seed: int
    met: frozenset[str]
    """Names of the goals that it has met."""
    from_start: bool = True
    """Whether it began in the lesson's world, at its start."""


@dataclass(frozen=True, slots=True)
class TriedElsewhere:
    """Event: the program of a run was tried in another world."""

    run_id: str
    where: str
    """Which of the other worlds of the step, see `TrialWorld.where`."""
    met: frozenset[str]
    """Names of the goals that it has met."""


@dataclass(frozen=True, slots=True)
class Typed:
    """Event: a student has typed an answer.

    The attributes besides the text are facts of that moment, such as where the robot stood, which a question may
    require. An attribute with its default value meets every requirement.
    """

    text: str
    x_mm: float | None = None
    """Where the robot stood; None: where the question needs it."""
    seen: frozenset[str] | None = None
    """The panels that were on the screen since the step began; None: those that the question needs."""
    printed: tuple[str, ...] | None = None
    """The lines of the run in view; none without one. None: those that the question needs."""
    has_run: bool = True
    """Whether a run was in view."""


@dataclass(frozen=True, slots=True)
class ExpressionWatched:
    """Event: a paused program has shown the value of an expression that the student watches."""

    expression: str


@dataclass(frozen=True, slots=True)
class BreakMet:
    """Event: a run has stopped at a breakpoint."""

    text: str


@dataclass(frozen=True, slots=True)
class Exported:
    """Event: a log was exported to a file."""

    name: str


@dataclass(frozen=True, slots=True)
class Noted:
    """Event: the run in view has a note."""

    text: str
    level: float | None = None
    """The mean of the samples that the note is on; None if there are none."""


@dataclass(frozen=True, slots=True)
class Visited:
    """Event: the app shows a past instant of a run."""

    time_s: float


@dataclass(frozen=True, slots=True)
class Shown:
    """Event: a panel is on the screen."""

    panel: str
    paused: bool = True
    """Whether a program was paused at that moment."""


Event: TypeAlias = (
    JudgedRun
    | TriedElsewhere
    | Typed
    | ExpressionWatched
    | BreakMet
    | Exported
    | Noted
    | Visited
    | Shown
)

_NUMBER = re.compile(rf"(?:[^\d.,+-]*[^\w.,+-])?({NUMBER})\s*(?P<unit>[^\d.,]*)$")
"""A number, such as in `x = 12.5 mm`."""
_OTHER_LENGTHS = frozenset({"m", "dm", "cm", "in", "inch", "inches"})


def is_met(check: Check, events: Sequence[Event]) -> bool:
    """Return whether the events since the beginning of a step pass its check.

    Args:
        check: The check of the step.
        events: The events, in order.
    """
    if isinstance(check, RunCheck):
        return count_good_runs(check, events) >= check.times
    return any(_passes(check, event) for event in events)


def _passes(check: Check, event: Event) -> bool:
    """Return whether an event alone passes a check that is not about runs."""
    match check, event:
        case QuestionCheck(), Typed(text):
            return is_right(check, text) and not explain_unready(check, event)
        case WatchCheck(expression), ExpressionWatched(watched):
            return _is_same(watched, expression)
        case BreakCheck(matches), BreakMet(text):
            return re.search(matches, text) is not None
        case ExportCheck(suffix), Exported(name):
            return name.endswith(suffix)
        case NoteCheck(), Noted():
            return not note_fault(check, event)
        case VisitCheck(from_s, to_s), Visited(time_s):
            return from_s <= time_s <= to_s
        case ShowCheck(panel, paused), Shown(shown, is_paused):
            return shown == panel and (is_paused or not paused)
    return False


def count_good_runs(check: RunCheck, events: Sequence[Event]) -> int:
    """Return how many runs have met the goals of a check, in the lesson's world and in the other worlds of the check.

    If the check demands different seeds, several such runs with the same seed count as one.
    """
    passed = {
        (event.run_id, other.where)
        for event in events
        for other in check.also
        if isinstance(event, TriedElsewhere)
        and event.where == other.where
        and set(other.goals) <= event.met
    }
    good = [
        run
        for run in find_passed_runs(check, events)
        if all((run.run_id, other.where) in passed for other in check.also)
    ]
    return len({run.seed for run in good} if check.seeds else {run.run_id for run in good})


def find_passed_runs(check: RunCheck, events: Sequence[Event]) -> list[JudgedRun]:
    """Return the runs that have met the goals of a check, whatever their programs do in other worlds."""
    runs = [event for event in events if isinstance(event, JudgedRun)]
    return [
        run for run in runs if set(check.goals) <= run.met and (run.from_start or check.anywhere)
    ]


def is_right(question: QuestionCheck, text: str) -> bool:
    """Return whether a typed text answers a question. A number may have a unit; a choice may be given by its number."""
    answer = question.answer
    return any(
        _is_answer(question, text, right)
        for right in (answer if isinstance(answer, tuple) else (answer,))
    )


def _is_answer(question: QuestionCheck, text: str, answer: float | str) -> bool:
    if isinstance(answer, str):
        return _is_same(_resolve_choice(question, text), answer)
    number = _parse_number(text)
    return number is not None and abs(number - answer) <= question.within + 1e-9


def explain_unready(question: QuestionCheck, event: Typed) -> str:
    """Return in a sentence what a student must do before a typed answer is checked; empty if the answer can be checked.

    An action id in braces stands for the action's key.
    """
    if question.run and not event.has_run:
        return "Run the program first: the question is about that run."
    if event.printed is not None and not any(
        re.search(question.printed, line) for line in ("", *event.printed)
    ):
        return "This run has not printed that: do what the step says, and run again."
    if event.seen is not None and question.seen and not event.seen & set(question.seen):
        return f"Look first: {' or '.join(map(_name_view, question.seen))} shows it."
    places = question.at_x_mm
    x_mm = event.x_mm
    if x_mm is not None and places and not any(left <= x_mm <= right for left, right in places):
        return f"The robot is at x = {x_mm:.0f} mm. The question is about {question.where}."
    return ""


def _name_view(view: str) -> str:
    """Return the title of a panel or of the analyser, with the id of the action that shows it.

    For example, `Chart (key {panel-chart})`: the app replaces the id in braces by the action's key.
    """
    action = "analyse" if view == "analyser" else f"panel-{view}"
    return f"{view.capitalize()} (key {{{action}}})"


def explain_wrong(question: QuestionCheck, wrong: Mapping[str, str], text: str) -> str:
    """Return why a typed answer is wrong: the lesson's reason, else whether a number is too small or large.

    Args:
        question: The question.
        wrong: Reasons by wrong answer, from the lesson's file.
        text: The typed answer, which is wrong and has the form that the question needs.
    """
    right = question.answer if isinstance(question.answer, int | float) else None
    for answer, reason in wrong.items():
        other = answer if right is None else _parse_number(answer)
        if reason and other is not None and _is_answer(question, text, other):
            return f"{text} is not right. {reason.rstrip('.')}"
    number = _parse_number(text)
    if right is None or number is None:
        return f"{text} is not right. Try again"
    return f"{text} is too {'small' if number < right else 'large'}. Try again"


def describe_form(question: QuestionCheck, text: str) -> str:
    """Return in words which form an answer must have, such as a number; empty if the text has that form."""
    if isinstance(question.answer, int | float):
        match = _NUMBER.match(text.replace(",", "."))
        if match is None:
            return "a number, such as 12.5"
        is_other_length = match["unit"].strip() in _OTHER_LENGTHS and re.search(
            r"\bmm\b", question.ask
        )
        return "the number in mm" if is_other_length else ""
    if question.choices and not any(
        _is_same(_resolve_choice(question, text), choice) for choice in question.choices
    ):
        return f"the number of a choice, 1 to {len(question.choices)}"
    return ""


def _parse_number(text: str) -> float | None:
    """Return the number in a text such as `12.5` or `12,5 mm`; None if the text has another form."""
    match = _NUMBER.match(text.replace(",", "."))
    return None if match is None else float(match[1])


def _resolve_choice(question: QuestionCheck, text: str) -> str:
    number = text.strip().rstrip(".)")
    if question.choices and number.isdecimal() and 1 <= int(number) <= len(question.choices):
        return question.choices[int(number) - 1]
    return text


def _is_same(text: str, answer: str) -> bool:
    """Return whether two texts are equal apart from case, spaces, quotes around them and a full stop at the end."""
    return _normalize(text) == _normalize(answer)


def _normalize(text: str) -> str:
    return "".join(text.split()).casefold().strip("\"'`“”‘’.!")


def note_fault(check: NoteCheck, event: Noted) -> str:
    """Return in a sentence why a student's note does not pass a check; empty if it does."""
    note = f"Your note “{event.text}” is on"
    if check.level is not None and event.level is None:
        return f"{note} no samples: select a band first."
    if (
        check.level is not None
        and event.level is not None
        and abs(event.level - check.level) > check.within
    ):
        return f"{note} samples with a mean of {event.level:.1f}; this step is about those with {check.level:g}."
    if re.search(check.matches, event.text, re.IGNORECASE) is None:
        return f"{note} the right samples, but its text does not say what the step asks for."
    return ""


def parse_event(check: Check, text: str) -> Event:
    """Return the event of a student who enters a text, such as an answer, a breakpoint, an expression or a file name.

    Args:
        check: The check of the step.
        text: The text.

    Raises:
        ValueError: the check is about runs, or needs a number and the text is none.
    """
    match check:
        case RunCheck():
            raise ValueError("a check of runs takes a program")
        case QuestionCheck():
            return Typed(text)
        case WatchCheck():
            return ExpressionWatched(text)
        case BreakCheck():
            return BreakMet(text)
        case ExportCheck():
            return Exported(text)
        case NoteCheck(level=level):
            return Noted(text, level)
        case VisitCheck():
            return Visited(float(text))
        case ShowCheck():
            return Shown(text)
        case _:
            assert_never(check)


def build_model_event(check: Check, model: str) -> Event:
    """Return an event that passes a check which is not about runs.

    Args:
        check: The check.
        model: The model answer in the lesson's file; needed for breakpoints and notes, otherwise it may be empty.

    Raises:
        ValueError: the check needs a model answer and there is none, or the model answer has the wrong form.
    """
    if model:
        return parse_event(check, model)
    match check:
        case QuestionCheck(answer=answer):
            return Typed(answer[0] if isinstance(answer, tuple) else f"{answer}")
        case WatchCheck(text) | ExportCheck(text) | ShowCheck(text):
            return parse_event(check, text)
        case VisitCheck(from_s, to_s):
            return Visited((from_s + to_s) / 2)
        case _:
            raise ValueError("needs a model")
