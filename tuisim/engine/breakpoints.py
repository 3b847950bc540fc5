"""Breakpoints: when a run pauses, in a small language shared by app, command line and child.

`FORMS` lists what a breakpoint can be. A leading `#` disables it. A comparison
triggers when it becomes true, not while it stays true.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, counted, see_page
from tuisim.base.source import find_code_line
from tuisim.base.syntax_tree import NOT_PYTHON, parse_expression
from tuisim.engine.core.conditions import (
    ValueCondition,
    ValueSource,
    describe_comparison,
    parse_finite_number,
    parse_run_condition,
)
from tuisim.engine.core.spec import RunSpec

FORMS = (
    ("12", "line 12 is about to run, or the next line of code if 12 is blank or a comment"),
    ("12 if x > 3", "line 12 is about to run, and the expression is true"),
    (
        "left_red_pc < 10",
        "a comparison becomes true; also ultrasonic_mm <= 200, gyro_deg > 90, x_mm > 1000",
    ),
    ("left_color changes", "the sensor sees another colour; left_color == Blue: it sees this one"),
    (
        "sample Colour < 50",
        "the program prints such a sample; also sample Colour changes, sample Colour",
    ),
    ("print matches black", "the program prints a line that matches the regular expression"),
    ("time 3.5", "3.5 simulated seconds have passed"),
    ("stall", "an obstacle stalls a running motor"),
)
"""The forms of a breakpoint, and when it pauses."""

ALLOWED = (
    f"{describe_comparison()}, such as left_red_pc < 10 · x_mm > 1000 · sample Colour < 50; or 12 · 12 if x > 3 · "
    "left_color changes · print matches REGEX · time 3.5 · stall"
)

_PRINT_FORM = "such as: print matches black|white"
_NO_CONDITION = {
    "print": ("a printed line can only be compared with `matches`", _PRINT_FORM),
    "sample": (
        "a sample has a name",
        f"{describe_comparison()}, such as: sample Colour < 50, sample Colour changes",
    ),
}
"""Message and hint for a text that begins like a condition but is none, by its first word."""


@dataclass(frozen=True, slots=True)
class LineBreak:
    """The rule of a breakpoint that pauses the program when a given line of the program is about to run."""

    line: int
    condition: str = ""
    """A Python expression that must be true; empty for none."""


@dataclass(frozen=True, slots=True)
class TimeBreak:
    """The rule of a breakpoint that pauses the program when a simulated time is reached."""

    time_s: float


@dataclass(frozen=True, slots=True)
class StallBreak:
    """The rule of a breakpoint that pauses the program when a running motor is blocked."""


BreakRule = LineBreak | ValueCondition | TimeBreak | StallBreak


@dataclass(frozen=True, slots=True)
class Breakpoint:
    """A breakpoint: its rule, its text, and whether it is enabled."""

    rule: BreakRule
    text: str
    """The normalized text, without the mark of a disabled breakpoint."""
    disabled: bool = False

    def written(self) -> str:
        """The breakpoint as a text that `parse` can read; the text of a disabled breakpoint begins with `# `."""
        return f"# {self.text}" if self.disabled else self.text

    def check_line(self, lines: Sequence[str]) -> None:
        """Check that the program has code on the line of a line breakpoint, or on a later line.

        Other breakpoints have no line, and are not checked.

        Args:
            lines: The lines of the program.

        Raises:
            ConfigError: there is no code on or after the line.
        """
        line = self.find_line()
        if line and not find_code_line(lines, line):
            last = len(lines)
            why = f"line {line} does not exist" if line > last else f"no code follows line {line}"
            raise _refuse(self.text, why, f"the program has {counted(last, 'line')}")

    def move(self, line: int) -> Breakpoint:
        """Return a copy of a line breakpoint on another line; return any other breakpoint unchanged."""
        if not isinstance(self.rule, LineBreak):
            return self
        rule = LineBreak(line, self.rule.condition)
        return Breakpoint(rule, _common_text(rule), self.disabled)

    def find_line(self) -> int:
        """Return the line of a breakpoint; 0 if it has none."""
        return self.rule.line if isinstance(self.rule, LineBreak) else 0

    @property
    def has_expression(self) -> bool:
        """Whether it pauses at its line only if an expression is true."""
        return isinstance(self.rule, LineBreak) and bool(self.rule.condition)

    @classmethod
    def parse(cls, text: str, run: RunSpec | None = None) -> Breakpoint:
        """Return the breakpoint that a text describes, such as `12 if x > 3`; a text that begins with `#` is disabled.

        Args:
            text: The text.
            run: The run, whose columns the text may name. Without a run, any word is accepted as the name of a column.

        Raises:
            ConfigError: the text is not a valid breakpoint; the hint lists what is allowed.
        """
        stripped = text.strip()
        disabled = stripped.startswith("#")
        bare = stripped.lstrip("#").strip()
        rule = _rule(bare, run)
        return cls(rule, _common_text(rule), disabled)


_LINE = re.compile(r"(?:line\s+)?(\d+)(?:\s+if\s+(.*))?", re.DOTALL)
_NAME = re.compile(r"\w+(?:[. ]\w+)*\s*%?")


def parse_breakpoints(texts: Iterable[str], run: RunSpec | None = None) -> tuple[Breakpoint, ...]:
    """Return the breakpoints that several texts describe, in their order; see `Breakpoint.parse`.

    Raises:
        ConfigError: a text is not a valid breakpoint.
    """
    return tuple(Breakpoint.parse(text, run) for text in texts)


def _refuse(
    text: str, why: str, hint: str = f"{ALLOWED}; {see_page('breakpoints')}"
) -> ConfigError:
    return ConfigError(f"{text!r}: {why}", hint, key="break")


def _rule(text: str, run: RunSpec | None) -> BreakRule:
    if not text:
        raise _refuse(text, "is empty")
    word, _, rest = text.partition(" ")
    if match := _LINE.fullmatch(text):
        return _line_rule(text, int(match[1]), match[2])
    if text == "stall":
        return StallBreak()
    if word == "time":
        return TimeBreak(_seconds(text, rest.strip().removesuffix("s").strip()))
    return _condition(text, word, run)


def _line_rule(text: str, line: int, condition: str | None) -> LineBreak:
    if line < 1:
        raise _refuse(text, "lines count from 1")
    if condition is None:
        return LineBreak(line)
    condition = condition.strip()
    if why := _why_no_expression(condition):
        raise _refuse(text, why, "such as: 12 if x > 3")
    return LineBreak(line, condition)


def _why_no_expression(text: str) -> str:
    """Return why Python cannot parse a text as an expression; empty if it can."""
    try:
        parse_expression(text)
    except NOT_PYTHON as error:
        return f"{text!r} is not an expression: {getattr(error, 'msg', None) or error}"
    return ""


def parse_watch(text: str) -> str:
    """Return a watch expression without surrounding whitespace.

    Raises:
        ConfigError: Python cannot parse the text.
    """
    text = text.strip()
    if why := _why_no_expression(text):
        raise ConfigError(why, "such as len(values)", key="watch")
    return text


def _condition(text: str, word: str, run: RunSpec | None) -> ValueCondition:
    condition = parse_run_condition(text)
    if condition is None or (condition.source is ValueSource.SAMPLE and not condition.name):
        raise _refuse(text, *_NO_CONDITION.get(word, ("is not a breakpoint",)))
    name = condition.name
    match condition.source:
        case ValueSource.PRINT:
            try:
                re.compile(condition.value)
            except (re.error, OverflowError, RecursionError) as error:
                raise _refuse(text, f"not a regular expression: {error}", _PRINT_FORM) from error
        case ValueSource.COLUMN:
            name = _column(text, condition.name, run)
    try:
        return condition.format_condition(name)
    except ValueError as error:
        raise _refuse(text, str(error)) from None


def _column(text: str, written: str, run: RunSpec | None) -> str:
    """Return the name of the column to which a word in the text of a breakpoint refers.

    Args:
        text: The text of the breakpoint, for errors.
        written: The word.
        run: The run whose columns are searched. Without a run, the word itself is returned if it has the form of a
            name.

    Raises:
        ConfigError: there is no such column.
    """
    if run is None:
        if not _NAME.fullmatch(written):
            raise _refuse(text, f"there is no {written!r}")
        return written
    try:
        # Imported on demand: most runs have no breakpoints, and nothing else in a host needs the sensors.
        from tuisim.engine.core.sensors import find_named_column

        return find_named_column(written, run)
    except ConfigError as error:
        raise _refuse(text, error.message, error.hint) from None


def _seconds(text: str, written: str) -> float:
    try:
        time_s = parse_finite_number(written)
    except ValueError as error:
        raise _refuse(text, str(error)) from None
    if time_s < 0.0:
        raise _refuse(text, f"{written!r} is not possible here")
    return time_s


def _common_text(rule: BreakRule) -> str:
    match rule:
        case LineBreak(line=line, condition=condition):
            return f"{line} if {condition}" if condition else str(line)
        case ValueCondition():
            return str(rule)
        case TimeBreak(time_s=time_s):
            return f"time {time_s:.12g}"
        case StallBreak():
            return "stall"
