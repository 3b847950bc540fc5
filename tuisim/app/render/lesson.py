"""A lesson as lines of text: its progress, the step to do with its result and hints, and at the end a model answer."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from enum import StrEnum

from rich.style import Style

from tuisim.app import design
from tuisim.app.panels import PANELS
from tuisim.app.render.code_rows import split_rows
from tuisim.base import palette
from tuisim.base.data_class import dataclass
from tuisim.guide.markdown import render_markdown
from tuisim.tasks.goals.judgement import GoalState, Judgement
from tuisim.tasks.lessons.progress import StepState
from tuisim.tasks.lessons.spec import (
    Lesson,
    LessonStep,
    QuestionCheck,
    RunCheck,
    ShowCheck,
)
from tuisim.terminal.text_runs import Line, cut

_NAME = Style(color=palette.WHITE, bold=True)
_PLAIN = Style(color=palette.INK)
_PALE = Style(color=palette.SOFT)
_GOOD = Style(color=palette.GREEN, bold=True)
_BAD = Style(color=design.RED)
_HINT = Style(color=palette.YELLOW)
_CODE = Style(color=palette.YELLOW)
_MARKS = {
    StepState.OPEN: ("·", _PALE),
    StepState.DONE: ("✓", _GOOD),
    StepState.SKIPPED: ("–", _PALE),
}
_GOAL_MARKS = {
    GoalState.OPEN: ("· ", _PALE),
    GoalState.MET: ("✓ ", _GOOD),
    GoalState.MISSED: ("✗ ", _BAD),
    GoalState.UNKNOWN: ("? ", _PALE),
}


class Away(StrEnum):
    """The part of the app that gets the keys in place of the lesson: the editor, a log, or none of these."""

    NO = "no"
    EDITOR = "editor"
    LOG = "log"


NO_LESSON = "No lesson is open: M opens one"


@dataclass(frozen=True, slots=True)
class LessonView:
    """The content of the lesson panel: the lesson, the states of its steps, and the result of the last run."""

    lesson: Lesson | None = None
    """The open lesson; None for none."""
    states: tuple[StepState, ...] = ()
    """The state of each step."""
    at: int | None = None
    """Index of the step to do; None when none is open."""
    hints: int = 0
    """How many hints of that step are shown."""
    judgements: tuple[Judgement, ...] = ()
    """Judgements of the last run since the step began; empty while there is none."""
    good_runs: int = 0
    """How many runs have passed the step so far, if it needs several."""
    elsewhere: str = ""
    """Why the last run does not count, in a sentence: it did not begin in the lesson's world; empty if it did."""
    done: LessonStep | None = None
    """The step that has just been done."""
    story: str = ""
    """What the run did that has passed it; empty if it was not about a run."""
    error: str = ""
    """How the last run has failed; empty if it has not."""
    remark: str = ""
    """Why the last note, or the last program in another world, does not pass the step."""
    next_title: str = ""
    """Title of the next lesson; empty if this is the last."""

    @property
    def last_page(self) -> int:
        """The number of the last page, from 0: each step has a page, and the last page is the end of the lesson."""
        return 0 if self.lesson is None else len(self.lesson.steps)

    @property
    def asks(self) -> bool:
        """Whether the step to do is a question."""
        return bool(
            self.lesson
            and self.at is not None
            and isinstance(self.lesson.steps[self.at].check, QuestionCheck)
        )

    @property
    def page(self) -> int:
        """The number of the page to show, from 0: that of the step to do, or the last page if no step is to be done."""
        return self.last_page if self.at is None else self.at


@dataclass(frozen=True, slots=True)
class LessonPicture:
    """The lines of the lesson panel, and which rows of the lesson's text they show."""

    lines: list[Line]
    first: int = 0
    """The first row of the text that is shown."""
    below: int = 0
    """Number of rows of the text that do not fit."""


def draw_lesson(
    view: LessonView, page: int, first: int, width: int, height: int, away: Away = Away.NO
) -> LessonPicture:
    """Return the lines of the lesson panel.

    Args:
        view: The lesson.
        page: The page to show, see `LessonView.page`.
        first: First row of the text to show, if not all of it fits; -1 for the title of the step.
        width: Columns inside the border.
        height: Rows inside the border.
        away: What gets the keys: in the editor and in a log, the app's keys work only after escape.
    """
    if view.lesson is None:
        return LessonPicture(list(_wrap_text(NO_LESSON, width, _PALE)))
    text = list(
        _end(view, width, away) if page >= view.last_page else _build_page(view, page, width, away)
    )
    head = [_build_head(view, page, width)]
    room = max(0, height - len(head))
    if first < 0:
        titles = (
            index
            for index, line in enumerate(text)
            if line and line[0][0].startswith(f"{page + 1}. ")
        )
        first = next(titles, 0)
    first = max(0, min(first, len(text) - room))
    return LessonPicture(
        [*head, *text[first : first + room]], first, max(0, len(text) - first - room)
    )


def _build_head(view: LessonView, page: int, width: int) -> Line:
    """Return the title of the lesson with a mark for each step; the mark of the step on the page is underlined."""
    assert view.lesson is not None
    marks: Line = []
    for index, state in enumerate(view.states):
        mark, style = ("●", _HINT) if index == view.at else _MARKS[state]
        marks.append((mark, style + Style(underline=index == page)))
    title = cut(view.lesson.title, max(1, width - len(marks) - 1))
    return [(title, _NAME), (" " * (width - len(title) - len(marks)), _PLAIN), *marks]


def _build_page(view: LessonView, page: int, width: int, away: Away) -> Iterator[Line]:
    """Yield the page of a step: the result of the last run, then the text, the question, and the hints."""
    assert view.lesson is not None
    lesson = view.lesson
    step = view.lesson.steps[page]
    is_current = page == view.at
    if is_current and view.done and not view.judgements:
        yield from _describe_done(view.done, view.story, width, away)
    if page == 0 and not (is_current and view.judgements):
        yield from render_markdown(lesson.intro, width)
        yield []
    yield from _wrap_text(f"{page + 1}. {step.title}", width, _NAME)
    if is_current:
        yield from _build_result(view, step, width, away)
        if view.remark:
            yield from _wrap_text(view.remark, width, _BAD)
            yield []
    yield from render_markdown(step.text, width)
    if isinstance(step.check, QuestionCheck):
        yield []
        yield from _build_question(step.check, width)
    if not is_current:
        state = view.states[page]
        yield []
        words = "Not yet: an earlier step is not done" if state is StepState.OPEN else f"{state}"
        yield from _wrap_text(
            f"{words}: {step.why}" if state is StepState.DONE and step.why else words, width, _PALE
        )
        yield from _wrap_text("← → show the other steps.", width, _PALE)
        return
    yield []
    for number, hint in enumerate(step.hints[: view.hints], start=1):
        yield from _wrap_text(f"Hint {number}: {hint}", width, _HINT)
    yield from _wrap_text(_describe_task(view, step, away), width, _PALE)
    if view.hints < len(step.hints):
        yield from _wrap_text(
            f"{_escape(away)}Y shows hint {view.hints + 1} of {len(step.hints)}.", width, _PALE
        )
    if page == 0 and not view.judgements and not view.hints:
        # This comes last, so that a low terminal shows the task.
        yield []
        yield from _wrap_text(f"On a real robot: {lesson.why}", width, _PALE)


_RUN_KEYS = {
    Away.NO: "d edits the program, R runs it",
    Away.EDITOR: "ctrl+r runs the program",
    Away.LOG: "escape, then d edits the program, R runs it",
}


def _escape(away: Away) -> str:
    return "" if away is Away.NO else "escape, then "


def _describe_done(step: LessonStep, story: str, width: int, away: Away) -> Iterator[Line]:
    """Yield lines about the step that the student has just done.

    They say what happened in the run that has passed the step, why this was right, and which key shows the step again.
    """
    yield from _wrap_text(f"✓ {step.title}", width, _GOOD)
    yield from _wrap_text(story, width, _PALE)
    yield from _wrap_text(step.why, width, _PLAIN)
    yield from _wrap_text(f"{_escape(away)}M shows earlier steps again.", width, _PALE)
    yield []


def _build_question(question: QuestionCheck, width: int) -> Iterator[Line]:
    yield from _wrap_text(question.ask, width, _NAME)
    for number, choice in enumerate(question.choices, start=1):
        yield from _wrap_text(f"{number}  {choice}", width, _PLAIN, "   ")


def _build_result(view: LessonView, step: LessonStep, width: int, away: Away) -> Iterator[Line]:
    """Yield lines about the result of the last run: which goals of a step the run has met, and which it has missed."""
    if not isinstance(step.check, RunCheck) or not view.judgements:
        return
    if view.elsewhere and not step.check.anywhere:
        yield from _wrap_text(view.elsewhere, width, _BAD)
    if view.error:
        yield from _wrap_text(f"The program stopped with an error: {view.error}.", width, _BAD)
    by_name = {each.goal.name: each for each in view.judgements}
    # The missed goals come first, so that a low terminal shows the reason.
    for name in sorted(
        step.check.goals, key=lambda name: by_name[name].state is not GoalState.MISSED
    ):
        judgement = by_name[name]
        # After an error, missed goals say nothing: the error has to be fixed first.
        is_told = judgement.state is not GoalState.MISSED or not view.error
        mark, style = _GOAL_MARKS[judgement.state if is_told else GoalState.OPEN]
        for index, row in enumerate(textwrap.wrap(judgement.goal.say or name, max(1, width - 2))):
            yield [(mark if not index else "  ", style), (row, _PLAIN)]
        if judgement.state is GoalState.MISSED and is_told:
            yield from _wrap_text(judgement.reason, width, _BAD, "  ", "  ")
            if judgement.goal.hint:
                yield from _wrap_text(judgement.goal.hint, width, _HINT, "  ", "  ")
    if view.error or any(by_name[name].state is GoalState.MISSED for name in step.check.goals):
        yield from _wrap_text(f"{_escape(away)}! goes to where it went wrong.", width, _PALE)
    yield []


def _describe_task(view: LessonView, step: LessonStep, away: Away) -> str:
    """Return in words what the student has to do in a step, with the keys for it."""
    match step.check:
        case RunCheck(times=times, seeds=seeds):
            count = (
                f" {view.good_runs} of {times} runs{' with other seeds' if seeds else ''}."
                if times > 1
                else ""
            )
            words = f"{_RUN_KEYS[away]}.{count}"
        case QuestionCheck(choices=choices):
            words = f"{_escape(away)}Q types {'the number of your choice' if choices else 'your answer'}."
        case ShowCheck(panel=panel):
            words = f"Next: open the panel {PANELS[panel].title}."
        case check:
            words = f"Next: {check.WORDS.format(check)}."
    return words


def _end(view: LessonView, width: int, away: Away) -> Iterator[Line]:
    """Yield the last page of a lesson.

    It says which lesson is next, and what the lesson is good for on a real robot. If all steps are done, it also shows
    the model answer.
    """
    assert view.lesson is not None
    skipped = sum(state is StepState.SKIPPED for state in view.states)
    still_open = sum(state is StepState.OPEN for state in view.states)
    if still_open:
        yield from _wrap_text(
            "The end of the lesson: a model answer appears here when every step is done.",
            width,
            _PALE,
        )
        return
    yield from _wrap_text(
        "✓ The lesson is done." if not skipped else "The end of the lesson.", width, _GOOD
    )
    following = (
        f"{_escape(away)}M, then enter: the next lesson, {view.next_title}."
        if view.next_title
        else "This was the last lesson."
    )
    # This comes early, so that a low terminal shows how to go on.
    yield from _wrap_text(following, width, _HINT)
    yield []
    if view.done:
        yield from _describe_done(view.done, view.story, width, away)
    yield from _wrap_text(f"On a real robot: {view.lesson.why}", width, _PLAIN)
    yield []
    if skipped:
        yield from _wrap_text(
            "Steps were skipped: the model answer appears when every step is done.", width, _PALE
        )
    elif view.lesson.model_answer:
        yield from _wrap_text("A model answer:", width, _NAME)
        for row in split_rows(view.lesson.model_answer, width):
            yield [(cut(row, width), _CODE)]


def _wrap_text(
    text: str, width: int, style: Style, indent: str = "", first: str = ""
) -> Iterator[Line]:
    for row in textwrap.wrap(text, max(10, width), initial_indent=first, subsequent_indent=indent):
        yield [(row, style)]
