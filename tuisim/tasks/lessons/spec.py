"""Lessons and their steps as frozen data.

To add a kind of check: its class and a line in `CHECKS` here, and a case in `_passes` and `parse_event`, `events.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeAlias

from msgspec import Meta

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, nearest
from tuisim.settings.options import OPTION_PANELS
from tuisim.tasks.goals.condition import require_regex
from tuisim.tasks.goals.files import GoalsFile
from tuisim.tasks.goals.spec import Goal, Range
from tuisim.tasks.goals.trial_world import TrialWorld

SHOWABLE = (*OPTION_PANELS, "debug", "brick", "obstacles", "goals")
"""Ids of the panels that a step can ask for."""
SEEABLE = (*SHOWABLE, "analyser")
"""Ids of what a student can look at for the answer to a question."""
MAX_STEPS = 30
MAX_HINTS = 10

Count = Annotated[int, Meta(ge=1, le=100)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Number = Annotated[float, Meta(ge=-1e15, le=1e15)]
Tolerance = Annotated[float, Meta(ge=0, le=1e15)]


def _check_panel(panel: str, key: str, known: tuple[str, ...] = SHOWABLE) -> None:
    if panel not in known:
        raise ConfigError(f"there is no panel {panel!r}", nearest(panel, known), key=key)


class Way(StrEnum):
    """A kind of wrong program or answer that might pass a step by mistake, such as one without a measurement."""

    LITERAL = "literal answer"
    """The program contains the answer instead of finding it out."""
    SENSOR = "no sensor"
    """Nothing is measured."""
    ORDER = "wrong order"
    PLACE = "wrong place"


@dataclass(frozen=True, slots=True)
class RunCheck:
    """Check of a step: runs of the student's program meet goals of the lesson."""

    SHORT: ClassVar[str] = "goals"
    """The key that is meant if a file gives a value instead of a table."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {}
    """The wrong ways that are impossible with such a check, each with the reason."""

    goals: tuple[str, ...]
    """Names of goals in the lesson, all to be met by one run."""
    times: Count = 1
    """How many runs must meet the goals."""
    seeds: bool = False
    """Whether each of these runs needs another seed."""
    anywhere: bool = False
    """Whether a run may begin at another place than the lesson's start."""
    also: tuple[TrialWorld, ...] = ()
    """Other worlds in which the program of a good run must do well, too."""

    def __post_init__(self) -> None:
        if not self.goals:
            raise ConfigError("names no goal", "give the names of goals", key="goals")


@dataclass(frozen=True, slots=True)
class QuestionCheck:
    """Check of a step: the student types the right answer, which is a number, a text, or one of several choices."""

    SHORT: ClassVar[str] = ""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {}

    ask: str
    answer: Number | str | tuple[str, ...]
    """A list gives several texts that are right."""
    within: Tolerance = 0.0
    """How far a number may be off."""
    choices: tuple[str, ...] = ()
    at_x_mm: tuple[Range, ...] = ()
    """Where the robot must stand when the answer is typed, in one of these ranges; empty for anywhere. The question is
    about what it measures there."""
    where: str = ""
    """The place in words, and how to get there, for a student whose robot is elsewhere."""
    seen: tuple[str, ...] = ()
    """Views, such as `instrumentation`, one of which must have been on the screen since the step began."""
    run: bool = False
    """Whether a run must be in view: the question is about what has happened in it."""
    printed: str = ""
    """A regular expression for a line that this run must have printed; empty for any run."""

    def __post_init__(self) -> None:
        if isinstance(self.answer, tuple) and not self.answer:
            raise ConfigError("has no right answer", key="answer")
        if self.within and not isinstance(self.answer, int | float):
            raise ConfigError("is only for numbers", key="within")
        if self.choices and self.answer not in self.choices:
            raise ConfigError(f"{self.answer!r} is not one of the choices", key="answer")
        for number, (left, right) in enumerate(self.at_x_mm, start=1):
            if left >= right:
                raise ConfigError(
                    f"must be from left to right, got {left:g} to {right:g}",
                    key=f"at_x_mm[{number}]",
                )
        if bool(self.at_x_mm) is not bool(self.where):
            raise ConfigError(
                "goes with at_x_mm", "the place in words, and how to get there", key="where"
            )
        require_regex(self.printed, "printed")
        for number, panel in enumerate(self.seen, start=1):
            _check_panel(panel, f"seen[{number}]", SEEABLE)


@dataclass(frozen=True, slots=True)
class WatchCheck:
    """Check of a step: the student watches a variable or an expression while the program is paused."""

    SHORT: ClassVar[str] = "expression"
    WORDS: ClassVar[str] = "watch {0.expression}"
    """What the student has to do for the check, in words; attributes of the check stand in braces."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.LITERAL: "the value is that of the paused program",
        Way.SENSOR: "a variable is looked at, not a sensor",
        Way.ORDER: "it is seen only while the program is paused",
        Way.PLACE: "a variable has no place",
    }

    expression: str


@dataclass(frozen=True, slots=True)
class BreakCheck:
    """Check of a step: a run stops at a breakpoint."""

    SHORT: ClassVar[str] = "matches"
    WORDS: ClassVar[str] = "let a run stop at the breakpoint"
    """What the student has to do for the check, in words; attributes of the check stand in braces."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.LITERAL: "a run must really stop at it",
        Way.SENSOR: "the breakpoint's text says what it looks at",
        Way.ORDER: "a run stops only after the breakpoint was set",
        Way.PLACE: "the run stops where the condition is true",
    }

    matches: str
    """A regular expression for the text of the breakpoint, such as `left` or `^12`."""

    def __post_init__(self) -> None:
        require_regex(self.matches, "matches")


@dataclass(frozen=True, slots=True)
class ExportCheck:
    """Check of a step: the student exports a log."""

    SHORT: ClassVar[str] = "suffix"
    WORDS: ClassVar[str] = "export to a {0.suffix} file"
    """What the student has to do for the check, in words; attributes of the check stand in braces."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.LITERAL: "a file must really be written",
        Way.SENSOR: "what is exported was measured by a run before",
        Way.ORDER: "without a run there is nothing to export",
        Way.PLACE: "the file may be anywhere",
    }

    suffix: str
    """What the name of the file ends in, such as `.csv`."""


@dataclass(frozen=True, slots=True)
class NoteCheck:
    """Check of a step: the student writes a note on the run; the step can require a band with a certain level."""

    SHORT: ClassVar[str] = "matches"
    WORDS: ClassVar[str] = "write your note"
    """What the student has to do for the check, in words; attributes of the check stand in braces."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.SENSOR: "the note is on samples of the run in view",
        Way.ORDER: "without a run there is nothing to note",
    }

    matches: str = ""
    """A regular expression for the text of the note."""
    level: Number | None = None
    """The mean of the samples that the note is about; None for any."""
    within: Tolerance = 1.0

    def __post_init__(self) -> None:
        require_regex(self.matches, "matches")


@dataclass(frozen=True, slots=True)
class VisitCheck:
    """Check of a step: the student goes back to a past instant of a run."""

    SHORT: ClassVar[str] = ""
    WORDS: ClassVar[str] = "go to an instant between {0.from_s:g} and {0.to_s:g} s"
    """What the student has to do for the check, in words; attributes of the check stand in braces."""
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.LITERAL: "the instant must really be in view",
        Way.SENSOR: "the recording is looked at",
        Way.ORDER: "only what is past can be in view",
        Way.PLACE: "the instant says where the robot was",
    }

    from_s: Seconds
    to_s: Seconds

    def __post_init__(self) -> None:
        if self.from_s >= self.to_s:
            raise ConfigError(
                f"must be less than to_s, {self.to_s:g}, got {self.from_s:g}", key="from_s"
            )


@dataclass(frozen=True, slots=True)
class ShowCheck:
    """Check of a step: a panel of the app is on the screen."""

    SHORT: ClassVar[str] = "panel"
    EXCLUDES: ClassVar[Mapping[Way, str]] = {
        Way.LITERAL: "the panel must really open",
        Way.SENSOR: "nothing is measured yet",
        Way.ORDER: "it is one key",
        Way.PLACE: "a panel may be anywhere",
    }

    panel: str
    paused: bool = False
    """Whether a program must be paused at that moment."""

    def __post_init__(self) -> None:
        _check_panel(self.panel, "panel")


Check: TypeAlias = (
    RunCheck
    | QuestionCheck
    | WatchCheck
    | BreakCheck
    | ExportCheck
    | NoteCheck
    | VisitCheck
    | ShowCheck
)

CHECKS: Mapping[str, type[Check]] = {
    "run": RunCheck,
    "question": QuestionCheck,
    "watch": WatchCheck,
    "breakpoint": BreakCheck,
    "export": ExportCheck,
    "note": NoteCheck,
    "visit": VisitCheck,
    "show": ShowCheck,
}
"""The kinds of checks by their key in a file."""


@dataclass(frozen=True, slots=True)
class WrongProgram:
    """A program in a lesson's file that must not pass a step."""

    text: str
    line: int
    """Where it begins in the lesson's file."""
    way: Way | None = None
    """The kind of its fault; None for another fault."""


@dataclass(frozen=True, slots=True)
class LessonStep:
    """One step of a lesson: its text, the check that the student must pass, hints, and model and wrong answers."""

    name: str
    """Identifies it in the progress of a student."""
    title: str
    text: str
    """Markdown."""
    check: Check
    line: int
    """Where its section begins in the file."""
    hints: tuple[str, ...] = ()
    why: str = ""
    """Why what passes is right: one or two sentences, shown when the step is done."""
    answer: str = ""
    """The model answer, a program, if the check is about runs."""
    model: str = ""
    """An answer that passes a check which is not about runs: a text, a breakpoint, an expression; see `parse_event`."""
    wrong: Mapping[str, str] = field(default_factory=dict)
    """Answers that must not pass such a check, and why each is wrong, in a sentence; it may be empty."""
    wrong_programs: tuple[WrongProgram, ...] = ()
    excludes: Mapping[Way, str] = field(default_factory=dict)
    """The wrong ways that are impossible in this step, each with the reason."""

    def find_missing_ways(self) -> tuple[Way, ...]:
        """Return the kinds of wrong programs of which the lesson says nothing for this step.

        For the other kinds, it has an example, or a reason why there is none.
        """
        covered = {
            *self.excludes,
            *self.check.EXCLUDES,
            *(program.way for program in self.wrong_programs),
        }
        match self.check:
            case QuestionCheck(choices=choices, at_x_mm=place, seen=seen, run=run):
                # `tuisim learn check` cannot try what a student must do before an answer, so a key of the question that
                # demands this is enough to cover a way.
                tried = {
                    Way.LITERAL: self.wrong or choices,
                    Way.PLACE: place,
                    Way.SENSOR: seen or place,
                    Way.ORDER: run,
                }
                covered |= {way for way, there in tried.items() if there}
            case NoteCheck(level=level):
                covered |= {Way.LITERAL} if self.wrong else set()
                covered |= {Way.PLACE} if level is not None else set()
        return tuple(way for way in Way if way not in covered)


@dataclass(frozen=True, slots=True)
class Lesson:
    """A lesson, as read from its file: texts, steps, goals, the program to complete, and the settings of the world."""

    name: str
    """From the file name, such as `first-run` from `01-first-run.md`."""
    path: Path
    title: str
    why: str
    """Why it matters on a real robot."""
    intro: str
    """Markdown before the first step."""
    steps: tuple[LessonStep, ...]
    program: str
    """The program to complete; empty for none."""
    goals: tuple[Goal, ...]
    minutes: int = 10
    settings: Mapping[str, Any] = field(default_factory=dict)
    """The world, by path."""

    @property
    def task(self) -> GoalsFile:
        """The lesson's world and goals, as a task."""
        return GoalsFile(self.path, self.title, self.goals, self.settings)

    @property
    def model_answer(self) -> str:
        """The model answer of the last step that has one; empty if no step has one.

        It is shown when every step is done.
        """
        return next((step.answer for step in reversed(self.steps) if step.answer), "")
