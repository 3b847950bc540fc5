"""Goals and their conditions as frozen data.

To add a kind of condition: its class and a line in `CONDITIONS` here, and its function and a line in `FINDERS`,
`tasks/goals/judge.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from enum import StrEnum
from keyword import iskeyword
from typing import Annotated, ClassVar

from msgspec import Meta

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError
from tuisim.engine.core.spec import FIELD_HEIGHT_MM, FIELD_WIDTH_MM
from tuisim.tasks.goals.comparisons import (
    CountCondition,
    KeepCondition,
    StructureCondition,
    WhenCondition,
)
from tuisim.tasks.goals.condition import (
    LIMITS,
    Condition,
    ConditionKind,
    Heading,
    Number,
    Offset,
    Percent,
    Seconds,
    Share,
    Tolerance,
    X,
    Y,
    check_count,
    require_regex,
)

MAX_GOALS = 200


class BodyPart(StrEnum):
    """The part of the robot that must be inside or outside an area."""

    CENTRE = "centre"
    """The midpoint between the robot's wheels."""
    BODY = "body"
    """The whole outline of the robot."""


class Reading(StrEnum):
    """A device that a goal can require the program to read: a kind of sensor, or a motor."""

    COLOR = "color"
    ULTRASONIC = "ultrasonic"
    GYRO = "gyro"
    MOTOR = "motor"


Range = tuple[X, X]
"""The lower and upper limit along x, or along y, in mm."""


def _check_ranges(condition: PrintCondition | LogCondition | ReadCondition, count: int) -> None:
    for key, way in (("x_mm", "left to right"), ("y_mm", "below to above")):
        ranges: tuple[Range, ...] = getattr(condition, key)
        for number, (low, high) in enumerate(ranges, start=1):
            if low >= high:
                raise ConfigError(
                    f"must be from {way}, got {low:g} to {high:g}", key=f"{key}[{number}]"
                )
        if len(ranges) not in (0, 1, count):
            raise ConfigError(f"must have one entry, or {count}, has {len(ranges)}", key=key)


def select_place(
    condition: PrintCondition | LogCondition | ReadCondition, count: int = 0
) -> dict[str, Range]:
    """Return where the robot must be to print a line, log a level or read a sensor: ranges by `x_mm` and `y_mm`.

    The result is empty if the robot may be anywhere.

    Args:
        condition: The condition that gives the places.
        count: Index of the line or level in the condition.
    """
    places = {key: getattr(condition, key) for key in ("x_mm", "y_mm")}
    return {
        key: ranges[count if len(ranges) > 1 else 0] for key, ranges in places.items() if ranges
    }


@dataclass(frozen=True, slots=True)
class ReachCondition(Condition):
    """A condition of a goal: the robot comes to a place, turns to a heading, or both."""

    x_mm: X | None = None
    """None for any x."""
    y_mm: Y | None = None
    heading_deg: Heading | None = None
    """Counter-clockwise from +x; full turns do not matter."""
    within_mm: Tolerance = 20.0
    within_deg: Annotated[float, Meta(ge=0.1, le=180)] = 5.0
    for_s: Seconds = 0.0
    """How long it must stay there without a break."""
    at_end: bool = False
    """Whether it must be there when the run ends."""

    def __post_init__(self) -> None:
        if self.x_mm is None and self.y_mm is None and self.heading_deg is None:
            raise ConfigError("names no place and no heading", "give x_mm, y_mm or heading_deg")
        if self.at_end and self.for_s:
            raise ConfigError("cannot be combined with at_end", "give for_s or at_end", key="for_s")


@dataclass(frozen=True, slots=True)
class AreaCondition(Condition):
    """The base class of conditions about an area of the field: a rectangle, or a circle.

    `x_mm` and `y_mm` are the lower left corner of the rectangle, or the centre of the circle.
    """

    KIND: ClassVar[ConditionKind] = ConditionKind.HELD

    x_mm: Annotated[float, Meta(ge=-10_000, le=10_000)]
    y_mm: Annotated[float, Meta(ge=-10_000, le=10_000)]
    width_mm: Annotated[float, Meta(ge=1, le=20_000)] | None = None
    height_mm: Annotated[float, Meta(ge=1, le=20_000)] | None = None
    radius_mm: Annotated[float, Meta(ge=1, le=20_000)] | None = None
    part: BodyPart = BodyPart.CENTRE

    def __post_init__(self) -> None:
        if self.radius_mm is not None and (self.width_mm is not None or self.height_mm is not None):
            raise ConfigError(
                "cannot be combined with width_mm or height_mm",
                "give width_mm and height_mm, or radius_mm",
                key="radius_mm",
            )
        if self.radius_mm is None and (self.width_mm is None or self.height_mm is None):
            raise ConfigError("has no size", "give width_mm and height_mm, or radius_mm")
        left, lower, right, upper = self.box_mm
        if left >= FIELD_WIDTH_MM or right <= 0 or lower >= FIELD_HEIGHT_MM or upper <= 0:
            raise ConfigError(
                "is not on the field", f"the field is {FIELD_WIDTH_MM} × {FIELD_HEIGHT_MM} mm"
            )

    @property
    def box_mm(self) -> tuple[float, float, float, float]:
        """The edges of the rectangle, or of the square around the circle: left, lower, right and upper, in mm."""
        if self.radius_mm is not None:
            radius = self.radius_mm
            return self.x_mm - radius, self.y_mm - radius, self.x_mm + radius, self.y_mm + radius
        assert self.width_mm is not None and self.height_mm is not None
        return self.x_mm, self.y_mm, self.x_mm + self.width_mm, self.y_mm + self.height_mm


@dataclass(frozen=True, slots=True)
class InsideCondition(AreaCondition):
    """A condition of a goal: the robot stays inside an area."""


@dataclass(frozen=True, slots=True)
class OutsideCondition(AreaCondition):
    """A condition of a goal: the robot stays out of an area."""

    def __post_init__(self) -> None:
        # `super()` without arguments fails here: `slots=True` replaces the class by a new one.
        AreaCondition.__post_init__(self)
        left, lower, right, upper = self.box_mm
        covers = left <= 0 and lower <= 0 and right >= FIELD_WIDTH_MM and upper >= FIELD_HEIGHT_MM
        if covers and self.radius_mm is None:
            raise ConfigError("covers the whole field", "no robot can stay out of it")


@dataclass(frozen=True, slots=True)
class TouchNothingCondition(Condition):
    """A condition of a goal: the robot touches no obstacle and no wall.

    An obstacle or wall that the robot touches at the start counts only after the robot has moved away from it.
    """

    KIND: ClassVar[ConditionKind] = ConditionKind.HELD

    obstacles: bool = True
    walls: bool = True
    gap_mm: Annotated[float, Meta(ge=0, le=1000)] = 0.0
    """The distance that it must keep."""

    def __post_init__(self) -> None:
        if not (self.obstacles or self.walls):
            raise ConfigError(
                "has nothing to check: obstacles and walls are both false", "set one to true"
            )


@dataclass(frozen=True, slots=True)
class PassCondition(Condition):
    """A condition of a goal: the robot passes each of several places."""

    SHORT: ClassVar[str] = "places_mm"

    places_mm: tuple[tuple[X, Y], ...]
    """x and y of each."""
    within_mm: Tolerance = 20.0
    in_order: bool = True

    def __post_init__(self) -> None:
        check_count(self.places_mm, "places_mm")


@dataclass(frozen=True, slots=True)
class FollowCondition(Condition):
    """A condition of a goal: a point of the robot is on a line of the mat for a share of the time.

    Noise and the pen's marks do not matter.
    """

    KIND: ClassVar[ConditionKind] = ConditionKind.HELD
    SHORT: ClassVar[str] = "sensors"

    sensors: tuple[str, ...] = ()
    """Names of colour sensors, such as `left`; one of them must be on the line."""
    point_mm: tuple[Offset, Offset] | None = None
    """Instead of sensors: a point of the robot, to the right and forward of the midpoint between its wheels."""
    darker_than: Percent | None = None
    """Reflected light below which it is on the line."""
    brighter_than: Percent | None = None
    share: Share = 0.9

    def __post_init__(self) -> None:
        if bool(self.sensors) == (self.point_mm is not None):
            raise ConfigError(
                "does not say what follows the line", "give sensors or point_mm, not both"
            )
        if self.darker_than is None and self.brighter_than is None:
            raise ConfigError(
                "does not describe the line", "give darker_than or brighter_than, in percent"
            )


@dataclass(frozen=True, slots=True)
class DrawCondition(Condition):
    """A condition of a goal: the pen draws a picture.

    A share of the picture must be drawn, and the same share of the drawing must lie on the picture.
    """

    picture: bytes
    """Indices of the picture's cells on the field, 32-bit integers in ascending order; see `tasks/goals/picture.py`."""
    within_mm: float
    share: float


@dataclass(frozen=True, slots=True)
class PrintCondition(Condition):
    """A condition of a goal: the program prints lines that match patterns."""

    SHORT: ClassVar[str] = "lines"

    lines: tuple[str, ...]
    """Regular expressions, each searched for in single lines."""
    in_order: bool = True
    x_mm: tuple[Range, ...] = ()
    """Where the robot must be when it prints them: one range for all lines, or one for each; empty for anywhere."""
    y_mm: tuple[Range, ...] = ()
    """As `x_mm`, along y."""
    reading: Reading | None = None
    """A kind of reading that must be taken since the line before."""
    once: bool = False
    """Whether the run must end without a further line that matches one of them, and no line may match several."""
    still: bool = False
    """Whether the robot must stand still when it prints them."""

    def __post_init__(self) -> None:
        check_count(self.lines, "lines")
        _check_ranges(self, len(self.lines))
        for number, pattern in enumerate(self.lines, start=1):
            require_regex(pattern, f"lines[{number}]")


@dataclass(frozen=True, slots=True)
class LogCondition(Condition):
    """A condition of a goal: the program logs samples of a variable that reach certain levels."""

    name: str
    levels: tuple[Number, ...]
    within: Annotated[float, Meta(ge=0, le=1e15)] = 0.5
    in_order: bool = True
    x_mm: tuple[Range, ...] = ()
    """Where the robot must be when the value is read, or printed: one range, or one for each level; empty: anywhere."""
    y_mm: tuple[Range, ...] = ()
    """As `x_mm`, along y."""
    reading: Reading | None = None
    """A kind of reading that must be taken before the sample, where the robot must be."""
    as_read: bool = False
    """Whether the value must be one that a colour sensor gave where the program read it."""
    counts: str = ""
    """The name of other samples: the value must be how many of them were printed before; empty: any value."""
    once: bool = False
    """Whether the run must end without a further sample of the variable."""
    apart_mm: Annotated[float, Meta(ge=0, le=1e6)] = 0.0
    """How far the robot may go at most between two samples of the variable; 0: as far as it likes."""

    def __post_init__(self) -> None:
        if self.as_read and self.reading is not Reading.COLOR:
            raise ConfigError(
                "is only for readings of colour sensors", 'give reading = "color"', key="as_read"
            )
        check_count(self.levels, "levels")
        _check_ranges(self, len(self.levels))
        if not self.name.isidentifier():
            raise ConfigError(
                f"{self.name!r} cannot be the name of a sample", "such as Colour", key="name"
            )


@dataclass(frozen=True, slots=True)
class ReadCondition(Condition):
    """A condition of a goal: the program reads a sensor or motor at least a number of times."""

    reading: Reading
    times: Annotated[int, Meta(ge=1, le=1_000_000)] = 1
    x_mm: tuple[Range, ...] = ()
    """Where the robot must be; empty for anywhere."""
    y_mm: tuple[Range, ...] = ()
    """As `x_mm`, along y."""

    def __post_init__(self) -> None:
        _check_ranges(self, 1)


@dataclass(frozen=True, slots=True)
class FinishCondition(Condition):
    """A condition of a goal: the program finishes without an error."""


@dataclass(frozen=True, slots=True)
class CallsCondition(Condition):
    """The base class of conditions about calls in the program's text, such as `time.sleep`, also under another name."""

    KIND: ClassVar[ConditionKind] = ConditionKind.FIXED
    SHORT: ClassVar[str] = "calls"

    calls: tuple[str, ...]

    def __post_init__(self) -> None:
        check_count(self.calls, "calls")
        for number, call in enumerate(self.calls, start=1):
            if not all(word.isidentifier() for word in call.removesuffix("()").split(".")):
                hint = "a name such as tank_drive.on_for_rotations"
                raise ConfigError(
                    f"{call!r} is not the name of a call", hint, key=f"calls[{number}]"
                )
            if wrong := next(filter(iskeyword, call.removesuffix("()").split(".")), ""):
                hint = "a function or method such as tank_drive.on_for_rotations; loops and definitions are not calls"
                raise ConfigError(
                    f"{wrong!r} is a keyword, which no program can call",
                    hint,
                    key=f"calls[{number}]",
                )


@dataclass(frozen=True, slots=True)
class UseCondition(CallsCondition):
    """A condition of a goal: the program's text has all calls in a list, such as `time.sleep`."""


@dataclass(frozen=True, slots=True)
class AvoidCondition(CallsCondition):
    """A condition of a goal: the program's text has no call in a list, such as `time.sleep`."""


@dataclass(frozen=True, slots=True)
class DialogueTurn:
    """One turn of a dialogue: an answer to `input()`, and what the program prints next."""

    answer: str
    prompt: str = ""
    """A regular expression for the prompt; empty for any."""
    reply: str = ""
    """A regular expression for a line printed before the next question; empty for none."""


@dataclass(frozen=True, slots=True)
class DialogueCondition(Condition):
    """A condition of a goal: the program asks questions with `input()`, and replies to the answers."""

    SHORT: ClassVar[str] = "turns"

    turns: tuple[DialogueTurn, ...]

    def __post_init__(self) -> None:
        check_count(self.turns, "turns")
        for number, turn in enumerate(self.turns, start=1):
            require_regex(turn.prompt, f"turns[{number}].prompt")
            require_regex(turn.reply, f"turns[{number}].reply")


@dataclass(frozen=True, slots=True)
class Combination(Condition):
    """The base class of conditions about other goals, such as that all of them are met."""

    KIND: ClassVar[ConditionKind] = ConditionKind.COMBINED
    SHORT: ClassVar[str] = "goals"

    goals: tuple[str, ...]

    def __post_init__(self) -> None:
        check_count(self.goals, "goals")


@dataclass(frozen=True, slots=True)
class AllOf(Combination):
    """A condition of a goal: all goals that it names are met."""


@dataclass(frozen=True, slots=True)
class AnyOf(Combination):
    """A condition of a goal: at least one of the goals that it names is met."""


@dataclass(frozen=True, slots=True)
class NoneOf(Combination):
    """A condition of a goal: none of the goals that it names is met."""


@dataclass(frozen=True, slots=True)
class Together(Condition):
    """The conditions of one goal with several keys in the goals file: all of them must be met."""

    KIND: ClassVar[ConditionKind] = ConditionKind.COMBINED

    conditions: tuple[Condition, ...]


CONDITIONS: Mapping[str, type[Condition]] = {
    "reach": ReachCondition,
    "pass": PassCondition,
    "inside": InsideCondition,
    "outside": OutsideCondition,
    "touch_nothing": TouchNothingCondition,
    "follow": FollowCondition,
    "draw": DrawCondition,
    "print": PrintCondition,
    "log": LogCondition,
    "read": ReadCondition,
    "when": WhenCondition,
    "keep": KeepCondition,
    "count": CountCondition,
    "dialogue": DialogueCondition,
    "finish": FinishCondition,
    "use": UseCondition,
    "avoid": AvoidCondition,
    "structure": StructureCondition,
    "all": AllOf,
    "any": AnyOf,
    "none": NoneOf,
}
"""The kinds of conditions by their key in a file."""


@dataclass(frozen=True, slots=True)
class Goal:
    """One goal of a task: its condition, its points, and when it is judged, in simulated seconds."""

    name: str
    condition: Condition
    say: str = ""
    """The goal as a sentence for the student."""
    points: float = 1.0
    hint: str = ""
    """Shown if the goal is missed."""
    hidden: bool = False
    """Whether the goal is hidden from students."""
    before: str | float | None = None
    """A goal or a time: the condition must be reached before."""
    after: str | float | None = None
    """A goal or a time: only what happens after it is judged."""
    until: str | float | None = None
    """A goal, which must be met, or a time: the condition must stay true until then."""
    within_s: float | None = None
    """A duration from the beginning of the goal: the condition must become true in it, or stay true for it."""

    @property
    def needs(self) -> tuple[str, ...]:
        """The names of the goals that this one refers to."""
        named = [word for word in (self.before, self.after, self.until) if isinstance(word, str)]
        combined = [part for part in self.parts if isinstance(part, Combination)]
        return (*(name for part in combined for name in part.goals), *named)

    @property
    def parts(self) -> tuple[Condition, ...]:
        """The conditions of the goal, usually one."""
        return (
            self.condition.conditions if isinstance(self.condition, Together) else (self.condition,)
        )

    def limits(self, kind: ConditionKind) -> tuple[str, ...]:
        """Return the keys of the goal's limits, such as `before` and `after`, that apply to a kind of condition."""
        return tuple(limit for limit in LIMITS[kind] if getattr(self, limit) is not None)
