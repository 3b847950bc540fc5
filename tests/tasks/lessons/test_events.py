"""What passes the check of a step, and what does not."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tests.cases import cases, for_rows
from tuisim.tasks.goals.trial_world import TrialWorld
from tuisim.tasks.lessons.events import (
    BreakMet,
    Event,
    Exported,
    ExpressionWatched,
    JudgedRun,
    Noted,
    Shown,
    TriedElsewhere,
    Typed,
    Visited,
    describe_form,
    explain_unready,
    is_met,
    note_fault,
)
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

NUMBER = QuestionCheck("Q", 50.2, within=0.5)
CHOICE = QuestionCheck("Q", "the light", choices=("the tick", "the light"))


def runs(*seeds: int, met: str = "a b", from_start: bool = True) -> list[Event]:
    """Runs that have met goals."""
    return [
        JudgedRun(f"r{at}", seed, frozenset(met.split()), from_start)
        for at, seed in enumerate(seeds)
    ]


BACK = "from farther back"
FARTHER = RunCheck(("a",), also=(TrialWorld(BACK, {"x_mm": 460.0}, ("a",)),))
HERE = QuestionCheck("Q", 50.2, within=0.5, at_x_mm=((200.0, 400.0),), where="the band: m")
SEEN = QuestionCheck("Q", 50.2, within=0.5, seen=("instrumentation", "chart"))
RAN = QuestionCheck("Q", 50.2, within=0.5, run=True, printed="Error")


CASES: dict[str, tuple[Check, Sequence[Event], bool]] = {
    "run": (RunCheck(("a", "b")), runs(0), True),
    "run, one goal missed": (RunCheck(("a", "c")), runs(0), False),
    "run, goals met by different runs": (
        RunCheck(("a", "b")),
        [*runs(0, met="a"), *runs(0, 0, met="b")[1:]],
        False,
    ),
    "run elsewhere": (RunCheck(("a",)), runs(0, from_start=False), False),
    "run anywhere": (RunCheck(("a",), anywhere=True), runs(0, from_start=False), True),
    "run whose program passes elsewhere": (
        FARTHER,
        [*runs(0), TriedElsewhere("r0", BACK, frozenset("a"))],
        True,
    ),
    "run whose program is not tried elsewhere": (FARTHER, runs(0), False),
    "run whose program fails elsewhere": (
        FARTHER,
        [*runs(0), TriedElsewhere("r0", BACK, frozenset())],
        False,
    ),
    "run of another program than that tried": (
        FARTHER,
        [*runs(0), TriedElsewhere("r9", BACK, frozenset("a"))],
        False,
    ),
    "several runs": (RunCheck(("a",), times=2), runs(0, 0), True),
    "the same run twice": (RunCheck(("a",), times=2), runs(0) * 2, False),
    "several seeds": (RunCheck(("a",), times=2, seeds=True), runs(0, 1), True),
    "several runs of one seed": (RunCheck(("a",), times=2, seeds=True), runs(0, 0), False),
    "number": (NUMBER, [Typed("50.2")], True),
    "number, comma and unit": (NUMBER, [Typed(" 50,6 %")], True),
    "number, at the limit": (NUMBER, [Typed("49.7")], True),
    "number, too far off": (NUMBER, [Typed("50.8")], False),
    "number, negative": (NUMBER, [Typed("-50.2")], False),
    "number, two of them": (NUMBER, [Typed("50.2 51")], False),
    "number, in words": (NUMBER, [Typed("x = 50.2 %")], True),
    "number, in a word": (NUMBER, [Typed("x50.2")], False),
    "number, negative, in words": (NUMBER, [Typed("x = -50.2")], False),
    "number, none": (NUMBER, [Typed("")], False),
    "a wrong answer, then the right one": (NUMBER, [Typed("1"), Typed("50")], True),
    "text": (QuestionCheck("Q", "time.sleep(0.1)"), [Typed("Time.sleep( 0.1 )")], True),
    "one of several texts": (
        QuestionCheck("Q", ("left", "the left one")),
        [Typed("the left one.")],
        True,
    ),
    "text in quotes": (QuestionCheck("Q", "White"), [Typed("'white'")], True),
    "text in other quotes": (QuestionCheck("Q", "White"), [Typed("“White.”")], True),
    "another text": (QuestionCheck("Q", "left"), [Typed("right")], False),
    "choice by number": (CHOICE, [Typed("2")], True),
    "choice by text": (CHOICE, [Typed("the light")], True),
    "another choice": (CHOICE, [Typed("1")], False),
    "no such choice": (CHOICE, [Typed("0")], False),
    "number, at its place": (HERE, [Typed("50.2", x_mm=300.0)], True),
    "number, elsewhere": (HERE, [Typed("50.2", x_mm=500.0)], False),
    "number that was looked at": (SEEN, [Typed("50.2", seen=frozenset({"chart", "code"}))], True),
    "number that was not looked at": (SEEN, [Typed("50.2", seen=frozenset({"code"}))], False),
    "number of a run": (RAN, [Typed("50.2", printed=("x", "NameError: y"))], True),
    "number of another run": (RAN, [Typed("50.2", printed=("x",))], False),
    "number without a run": (RAN, [Typed("50.2", printed=(), has_run=False)], False),
    "watch": (WatchCheck("error"), [ExpressionWatched(" error")], True),
    "another watch": (WatchCheck("error"), [ExpressionWatched("error2")], False),
    "breakpoint": (BreakCheck(r"left.*<"), [BreakMet("left.red% < 10")], True),
    "another breakpoint": (BreakCheck(r"left.*<"), [BreakMet("7")], False),
    "export": (ExportCheck(".csv"), [Exported("greys.csv")], True),
    "export of another format": (ExportCheck(".csv"), [Exported("greys.parquet")], False),
    "note": (NoteCheck("grey", 50.2), [Noted("Dark GREY", 50.0)], True),
    "note on another band": (NoteCheck("grey", 50.2), [Noted("grey", 82.7)], False),
    "note of another text": (NoteCheck("grey"), [Noted("white")], False),
    "visit": (VisitCheck(1, 2), [Visited(1.5)], True),
    "visit of another instant": (VisitCheck(1, 2), [Visited(2.1)], False),
    "panel": (ShowCheck("chart"), [Shown("world"), Shown("chart")], True),
    "panel of a paused program": (
        ShowCheck("debug", paused=True),
        [Shown("debug", paused=True)],
        True,
    ),
    "panel while it runs": (ShowCheck("debug", paused=True), [Shown("debug", paused=False)], False),
    "nothing": (ShowCheck("chart"), [], False),
}


@for_rows("check, events, passes", CASES)
def test_a_lessons_step_passes_only_by_what_it_checks(
    check: Check, events: Sequence[Event], passes: bool
) -> None:
    assert is_met(check, events) is passes


UNREADY = {
    "elsewhere": (
        HERE,
        Typed("1", x_mm=1120.4),
        "The robot is at x = 1120 mm. The question is about the band: m.",
    ),
    "not looked": (
        SEEN,
        Typed("1", seen=frozenset()),
        "Look first: Instrumentation (key {panel-instrumentation}) or Chart (key {panel-chart}) shows it.",
    ),
    "no run": (
        RAN,
        Typed("1", has_run=False),
        "Run the program first: the question is about that run.",
    ),
    "another run": (
        RAN,
        Typed("1", printed=("x",)),
        "This run has not printed that: do what the step says",
    ),
    "ready": (HERE, Typed("1", x_mm=300.0), ""),
}


@cases("question, typed, words", UNREADY)
def test_a_lessons_question_says_what_to_look_at_first(
    question: QuestionCheck, typed: Typed, words: str
) -> None:
    found = explain_unready(question, typed)
    assert found.startswith(words)
    assert bool(found) is bool(words)


NOTE = NoteCheck("grey", 50.2)
NOTES = {
    "wrong band": (
        Noted("grey", 86.27),
        "Your note “grey” is on samples with a mean of 86.3; this step is about those",
    ),
    "no samples": (Noted("grey"), "Your note “grey” is on no samples"),
    "wrong text": (Noted("?", 50.2), "Your note “?” is on the right samples, but its text"),
    "right": (Noted("grey", 50.2), ""),
}


@cases("note, words", NOTES)
def test_a_note_that_does_not_pass_is_answered_with_the_reason(note: Noted, words: str) -> None:
    found = note_fault(NOTE, note)
    assert found.startswith(words)
    assert bool(found) is bool(words)


@pytest.mark.parametrize(
    "text, words",
    [
        ("50.2 cm", "the number in mm"),
        ("0.502m", "the number in mm"),
        ("502 mm", ""),
        ("502", ""),
        ("far", "a number, such as 12.5"),
    ],
)
def test_number_in_another_unit_is_asked_for_again(text: str, words: str) -> None:
    assert describe_form(QuestionCheck("At which x, in mm?", 502, within=4), text) == words


def test_an_answer_may_have_any_unit_if_the_question_asks_for_none() -> None:
    assert describe_form(QuestionCheck("How far?", 502, within=4), "50.2 cm") == ""
