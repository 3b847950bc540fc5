"""Lessons and their steps as frozen data.

To add a kind of check: its class and a line in `CHECKS` here, and a case in `is_met` and `event_of`, `events.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, ClassVar, TypeAlias

from msgspec import Meta

from tuisim.config.options import PANELS
from tuisim.errors import ConfigError, nearest, require_regex
from tuisim.goals.spec import Goal

SHOWABLE = (*PANELS, "debug", "brick", "obstacles", "goals")
"""Ids of the panels that a step can ask for."""
MAX_STEPS = 30
MAX_HINTS = 10

Count = Annotated[int, Meta(ge=1, le=100)]
Seconds = Annotated[float, Meta(ge=0, le=1e6)]
Number = Annotated[float, Meta(ge=-1e15, le=1e15)]
Tolerance = Annotated[float, Meta(ge=0, le=1e15)]


@dataclass(frozen=True, slots=True)
class Run:
    """Runs of the program meet goals of the lesson."""

    SHORT: ClassVar[str] = "goals"
    """The key that is meant if a file gives a value instead of a table."""

    goals: tuple[str, ...]
    """Names of goals in the lesson, all to be met by one run."""
    times: Count = 1
    """How many runs must meet them."""
    seeds: bool = False
    """Whether each of these runs needs another seed."""
    anywhere: bool = False
    """Whether a run may begin at another place than the lesson's start."""

    def __post_init__(self) -> None:
        if not self.goals:
            raise ConfigError("names no goal", "give the names of goals", key="goals")


@dataclass(frozen=True, slots=True)
class Question:
    """The student types the right answer: a number, a text, or one of several choices."""

    SHORT: ClassVar[str] = ""

    ask: str
    answer: Number | str | tuple[str, ...]
    """A list gives several texts that are right."""
    within: Tolerance = 0.0
    """How far a number may be off."""
    choices: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.answer, tuple) and not self.answer:
            raise ConfigError("has no right answer", key="answer")
        if self.within and not isinstance(self.answer, int | float):
            raise ConfigError("is only for numbers", key="within")
        if self.choices and self.answer not in self.choices:
            raise ConfigError(f"{self.answer!r} is none of the choices", key="answer")


@dataclass(frozen=True, slots=True)
class Watch:
    """The student watches a variable or an expression while the program is paused."""

    SHORT: ClassVar[str] = "expression"

    expression: str


@dataclass(frozen=True, slots=True)
class Break:
    """A run stops at a breakpoint."""

    SHORT: ClassVar[str] = "matches"

    matches: str
    """A regular expression for the text of the breakpoint, such as `left` or `^12`."""

    def __post_init__(self) -> None:
        require_regex(self.matches, "matches")


@dataclass(frozen=True, slots=True)
class Export:
    """The student exports a log."""

    SHORT: ClassVar[str] = "suffix"

    suffix: str
    """What the name of the file ends in, such as `.csv`."""


@dataclass(frozen=True, slots=True)
class Note:
    """The student writes a note on the run, perhaps on a band with a certain level."""

    SHORT: ClassVar[str] = "matches"

    matches: str = ""
    """A regular expression for the text of the note."""
    level: Number | None = None
    """The mean of the samples that the note is about; None for any."""
    within: Tolerance = 1.0

    def __post_init__(self) -> None:
        require_regex(self.matches, "matches")


@dataclass(frozen=True, slots=True)
class Visit:
    """The student goes back to a past instant of a run."""

    SHORT: ClassVar[str] = ""

    from_s: Seconds
    to_s: Seconds

    def __post_init__(self) -> None:
        if self.from_s >= self.to_s:
            raise ConfigError(f"must be less than to_s, {self.to_s:g}, got {self.from_s:g}", key="from_s")


@dataclass(frozen=True, slots=True)
class Show:
    """A panel of the app is on the screen."""

    SHORT: ClassVar[str] = "panel"

    panel: str

    def __post_init__(self) -> None:
        if self.panel not in SHOWABLE:
            raise ConfigError(f"there is no panel {self.panel!r}", nearest(self.panel, SHOWABLE), key="panel")


Check: TypeAlias = Run | Question | Watch | Break | Export | Note | Visit | Show

CHECKS: Mapping[str, type[Check]] = {
    "run": Run,
    "question": Question,
    "watch": Watch,
    "breakpoint": Break,
    "export": Export,
    "note": Note,
    "visit": Visit,
    "show": Show,
}
"""The kinds of checks by their key in a file."""


@dataclass(frozen=True, slots=True)
class WrongProgram:
    """A program that must not pass a step."""

    text: str
    line: int
    """Where it begins in the lesson's file."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step of a lesson."""

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
    """What passes another check: an answer, a breakpoint, an expression; see `event_of`."""
    wrong: tuple[str, ...] = ()
    """The same, but does not pass."""
    wrong_programs: tuple[WrongProgram, ...] = ()


@dataclass(frozen=True, slots=True)
class Lesson:
    """The contents of a lesson's file."""

    name: str
    """From the file name, such as `first-run` from `01-first-run.md`."""
    path: Path
    title: str
    why: str
    """Why it matters on a real robot."""
    intro: str
    """Markdown before the first step."""
    steps: tuple[Step, ...]
    program: str
    """The program to complete; empty for none."""
    goals: tuple[Goal, ...]
    minutes: int = 10
    settings: Mapping[str, Any] = field(default_factory=dict)
    """The world, by field of `Settings`."""

    @property
    def model_answer(self) -> str:
        """The last model answer, which appears when every step is done; empty if there is none."""
        return next((step.answer for step in reversed(self.steps) if step.answer), "")
