"""The timeline that all panels share: the current run, the instant of it in view, and how users name an instant."""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from tuisim.base.data_class import dataclass
from tuisim.base.errors import ConfigError, closest, did_you_mean
from tuisim.base.source import source_lines
from tuisim.engine.core.columns import find_column_name
from tuisim.engine.core.conditions import (
    Operator,
    ValueCondition,
    ValueSource,
    describe_comparison,
    list_operators,
    parse_run_condition,
)
from tuisim.engine.core.field import Field
from tuisim.engine.core.sensors import find_named_column, list_column_names, list_columns
from tuisim.engine.runs.brick_state import BrickState
from tuisim.engine.runs.command_events import parse_command_search
from tuisim.engine.runs.frames import compute_column_values, evaluate_condition
from tuisim.engine.runs.records import Mark, OutputRow
from tuisim.engine.runs.samples import parse_sample, select_rows

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.runs.recorded_run import Recording
    from tuisim.engine.runs.views import TickRecord

    Array = np.ndarray[Any, Any]

FASTEST = 16.0
"""Playback speed, relative to real time, when the speed is as fast as possible."""


class Timeline:
    """The current run, the instant in view, and the playback of the run's past."""

    def __init__(self) -> None:
        self.recording: Recording | None = None
        """The live run, the last one, or a stored one; None before the first."""
        self.at: int | None = None
        """The past tick in view; None for the newest instant."""
        self.breaks: list[int] = []
        """Ticks at which the run was paused by a breakpoint."""
        self.searched = ""
        """The words of the last search that found an instant."""
        self._played_s: float | None = None
        """Simulated time that playback has reached, None while it is stopped."""
        self._wall_s = 0.0
        self._face_numbers: list[int] = []
        self._face = BrickState()
        """What the brick showed after output rows, by row number."""

    def show_run(self, recording: Recording | None) -> None:
        """Switch to another run, or to none, at its newest instant."""
        self.recording = recording
        self._face_numbers, self._face = [], BrickState()
        self.breaks.clear()
        self.go(None)

    # State

    @property
    def newest(self) -> int:
        """The tick of the newest record of the run, -1 if there is none."""
        return self.recording.newest if self.recording else -1

    @property
    def tick(self) -> int:
        """The tick of the instant in view; the newest tick if the newest instant is in view."""
        return self.newest if self.at is None else self.at

    @property
    def tick_hz(self) -> int:
        """Ticks per simulated second of the run."""
        return self.recording.spec.profile.tick_hz if self.recording else 1

    @property
    def time_s(self) -> float:
        """The simulated time in view, in s."""
        return max(0, self.tick) / self.tick_hz

    @property
    def playing(self) -> bool:
        """Whether the recording is being played back."""
        return self._played_s is not None

    def find_tick(self, time_s: float) -> int:
        """Return the number of the last tick that is not after a simulated time in s."""
        return int(time_s * self.tick_hz + 1e-6)

    def record(self) -> TickRecord | None:
        """Return the record of the past tick in view; None at the newest instant."""
        if self.at is None or self.recording is None:
            return None
        return self.recording.telemetry.record(self.at)

    def face(self, tick: int) -> BrickState:
        """Return the state of the brick at a tick: its display, lights and sound."""
        if self.recording is None:
            return BrickState()
        numbers = self.recording.rows.list_face_numbers(tick)
        if numbers != self._face_numbers:
            self._face_numbers = numbers
            self._face = BrickState().update_face(
                [self.recording.rows.row(number) for number in numbers]
            )
        return self._face

    def list_marks(self) -> list[tuple[int, Mark]]:
        """Return the ticks with markers in the time bar, and the kind of each marker."""
        if self.recording is None:
            return []
        done = [(action.tick, Mark.ACTION) for action in self.recording.known_actions]
        breaks = ((tick, Mark.BREAK) for tick in self.breaks)
        return [*self.recording.rows.marks, *self.recording.commands.marks, *done, *breaks]

    # Navigation

    def go(self, tick: int | None) -> None:
        """Go to a tick of the run; a tick before the first one stands for the first.

        Args:
            tick: The tick; None, the newest tick or a later one stand for the newest instant.
        """
        self._played_s = None
        self.at = None if tick is None or tick >= self.newest or self.newest <= 0 else max(0, tick)

    def play(self, wall_s: float) -> None:
        """Start playback from the instant in view.

        Args:
            wall_s: The wall-clock time now, in s.
        """
        if self.at is not None:
            self._played_s, self._wall_s = self.at / self.tick_hz, wall_s

    def stop_playback(self) -> None:
        """Stop playing the recording back."""
        self._played_s = None

    def advance_playback(self, wall_s: float, speed: float) -> bool:
        """Go on in the playback. Return whether it has just reached the newest instant.

        Args:
            wall_s: The wall-clock time now, in s.
            speed: 1.0 real time, 0 as fast as possible.
        """
        if self._played_s is None:
            return False
        self._played_s += (wall_s - self._wall_s) * (speed or FASTEST)
        self._wall_s = wall_s
        tick = self.find_tick(self._played_s)
        if tick >= self.newest:
            self.go(None)
            return True
        self.at = tick
        return False


_FORMS = (
    ("3.5", "a time in seconds"),
    ("tick 120", "a tick"),
    ("line 12", "{which} time that line 12 runs"),
    ("sample Colour", "{which} sample with this name; `sample` alone: with any name"),
    ("Colour < 90", f"{{which}} sample that matches; operators: {list_operators()}"),
    (
        "left_red_pc < 50",
        "{which} tick at which a comparison becomes true; also left_color changes, gyro_deg > 90, x_mm …",
    ),
    (
        "command run",
        "{which} command with these words, such as left stop, or pen; `command` alone: any",
    ),
    ("print REGEX", "{which} printed line that matches the regular expression"),
    ("start, end", "the first and the latest instant"),
    (
        "… back, … first",
        "any of these except times: search backwards, or from the start of the run",
    ),
)
"""The accepted forms, with what they mean."""


def list_forms(timeline: Timeline) -> list[tuple[str, str]]:
    """Return the forms in which the user can name an instant, and what each means at the instant in view."""
    # Nothing can be found after the newest instant: the search goes from the start.
    which = "the first" if timeline.tick >= timeline.newest else "the next"
    recording = timeline.recording
    name = next(_list_printed_names(recording), "Colour") if recording else "Colour"
    return [
        (form.replace("Colour", name), meaning.replace("{which}", which))
        for form, meaning in _FORMS
    ]


_HINT = (
    f"3.5, tick 120, line 12, sample NAME, sample {describe_comparison()}, COLUMN < 50, command, "
    "print REGEX, start or end"
)
_IN_FRONT = re.compile(r"^(back|first)\s+(.+)$", re.IGNORECASE)
"""A text in which `back` or `first` stands in front of the other words, not behind them."""
_HAS_DIRECTION = re.compile(r"^(?:back|first)\s|\s(?:back|first)$", re.IGNORECASE)
_LINE = re.compile(
    r"(?:(?:back|first)\s+)?line\s+([0-9]+)(?:\s+(?:back|first))*", re.IGNORECASE | re.ASCII
)
_MAX_DESCRIBED = 3
"""Maximum number of commands of one instant that are described."""
_SECONDS = re.compile(r"([0-9]+\.?[0-9]*|\.[0-9]+)\s*s?")


@dataclass(frozen=True, slots=True)
class _Search:
    """A search in a run, with the tick at which it begins and its direction."""

    recording: Recording
    at: int
    back: bool

    @property
    def words(self) -> str:
        time_s = self.at / self.recording.spec.profile.tick_hz
        side = "before" if self.back else "after"
        return "in this run" if self.at < 0 else f"{side} {time_s:.2f} s"

    def texts(self) -> Iterator[OutputRow]:
        """Yield the printed rows of later ticks, the nearest first; in a backwards search, those of earlier ticks."""
        rows = self.recording.rows
        found = (
            rows.rows(rows.until(self.at - 1) - 1, -1)
            if self.back
            else rows.rows(rows.until(self.at))
        )
        return (row for row in found if row.is_text)

    def find_tick(self, condition: ValueCondition) -> int | None:
        """Return the tick of the nearest printed row that meets a condition, in the direction of the search.

        The result is None if no such row does.
        """
        if condition.operator is Operator.CHANGES:
            every = (row for row in self.recording.rows.rows(0) if row.is_text)
            return self.find_nearest([row.tick for row in select_rows(condition, every)])
        return next((row.tick for row in select_rows(condition, self.texts())), None)

    def find_nearest(self, ticks: list[int]) -> int | None:
        """Return the tick of a sorted list that comes first in the direction of the search; None if there is none."""
        where = bisect_left(ticks, self.at) - 1 if self.back else bisect_right(ticks, self.at)
        return ticks[where] if 0 <= where < len(ticks) else None


def find(
    text: str, timeline: Timeline, mat: Field | None = None, *, first_at_end: bool = False
) -> int:
    """Return the tick of the instant that an expression means; it can be relative to the instant in view.

    Args:
        text: An expression in one of the forms of `list_forms`.
        timeline: The run, and the instant in view.
        mat: The run's mat, from which readings are taken; None if it is not prepared yet.
        first_at_end: Whether a search that starts at the newest instant goes forwards from the start of the run;
            otherwise it goes backwards from the newest instant.

    Raises:
        ConfigError: the expression is not understood, or there is no such instant.
    """
    recording = timeline.recording
    if recording is None or recording.newest < 0:
        raise ConfigError("there is no run yet")
    text = _IN_FRONT.sub(r"\2 \1", text.strip())
    word, _, rest = text.partition(" ")
    rest, back = re.subn(r"(?:^|\s+)back$", "", rest.strip())
    rest, first = re.subn(r"(?:^|\s+)first$", "", rest)
    word = word.lower()
    if not back and (word == "start" or word == "end") and not rest:
        return 0 if word == "start" else recording.newest
    if not back and (seconds := _SECONDS.fullmatch(text.strip())):
        return _check_reached(round(float(seconds[1]) * timeline.tick_hz), recording)
    if not back and word == "tick" and rest.isdecimal():
        return _check_reached(int(rest), recording)
    at_end = timeline.tick >= recording.newest
    backwards = bool(back) or (at_end and not first_at_end)
    search = (
        _Search(recording, -1, False)
        if first or (at_end and not backwards)
        else _Search(recording, timeline.tick, backwards)
    )
    if (line := parse_line(text)) is not None:
        return _find_line(search, line)
    condition = _parse_condition(word, rest, text)
    if condition is None and word == "command":
        return _find_command(search, rest)
    if condition is None:
        raise _refuse(text.strip(), recording)
    return _find_condition(search, condition, mat)


def describe_match(text: str, tick: int, timeline: Timeline, mat: Field | None = None) -> str:
    """Return remarks on the instant that a search has found, as one text; empty for none.

    One remark says that the instant is the newest one, another where the first match is if a later one was found.

    Args:
        text: The words of the search, as for `find`.
        tick: The tick that `find` returned for these words.
        timeline: The run, and the instant at which the search began.
        mat: As for `find`.
    """
    words = text.strip()
    if _SECONDS.fullmatch(words) or words.lower() in ("start", "end"):
        return ""
    hz = timeline.tick_hz
    texts = []
    if tick == timeline.newest:
        texts.append(f"{words}: the latest instant, {tick / hz:.2f} s")
    if timeline.tick < tick and not _HAS_DIRECTION.search(words):
        first = f"{words} first"
        if (first_tick := find(first, timeline, mat)) < tick:
            texts.append(f"`{first}` goes to {first_tick / hz:.2f} s")
    return " · ".join(texts)


def parse_line(text: str) -> int | None:
    """Return the line of the program in words for an instant, such as `line 12 back`; None if they name no line."""
    match = _LINE.fullmatch(text.strip())
    return int(match[1]) if match else None


def _find_condition(search: _Search, condition: ValueCondition, mat: Field | None) -> int:
    """Return the nearest tick, in the direction of a search, at which a condition is met.

    Raises:
        ConfigError: there is no such tick.
    """
    try:
        match condition.source:
            case ValueSource.PRINT:
                return _find_printed(search, condition)
            case ValueSource.SAMPLE:
                return _find_sample(search, condition)
            case ValueSource.COLUMN:
                return _find_change(search, condition, mat)
    except ValueError as error:
        raise ConfigError(str(error), _HINT) from error


def describe_commands(text: str, timeline: Timeline) -> str:
    """Return in words the commands that the program gives at the instant in view.

    The text is empty if there are none, or if the words in `text` are no search for commands.

    Args:
        text: The words with which the user went to the instant, such as a search for commands.
        timeline: The run, and the instant in view.
    """
    words = parse_command_search(re.sub(r"\b(?:back|first)\b", "", text))
    if words is None or timeline.recording is None:
        return ""
    commands = timeline.recording.commands
    tick = timeline.tick
    numbers = [number for number in commands.find_events(words) if commands.tick(number) == tick]
    events = [commands.event(number) for number in numbers[:_MAX_DESCRIBED]]
    texts = [f"{event.part}: {event.words}" for event in events]
    if more := len(numbers) - len(events):
        texts.append(f"{more} more")
    return f"{timeline.time_s:.2f} s, {'; '.join(texts)}" if texts else ""


def _parse_condition(word: str, rest: str, text: str) -> ValueCondition | None:
    """Return the condition in the words for an instant, such as `left_red_pc < 10`; None if they are no condition.

    Args:
        word: The first word.
        rest: All words except the one for the direction of the search, such as `back`.
        text: All words, for errors.
    """
    if word == ValueSource.PRINT and rest:
        return parse_run_condition(f"{word} {rest}") or ValueCondition(
            "", Operator.MATCHES, rest, ValueSource.PRINT
        )
    is_sample = word == ValueSource.SAMPLE
    return parse_run_condition(
        f"{word} {rest}" if is_sample else re.sub(r"\s+(?:back|first)$", "", text.strip())
    )


def _refuse(word: str, recording: Recording) -> ConfigError:
    """Return the error for words that name no instant; for a mistyped name, it proposes the right form."""
    printed = _read_printed_names(recording)
    close = closest(word, [*list_column_names(recording.spec), *printed], 1)
    forms = [f"`{name} < 50`" for name in close]
    hint = did_you_mean(forms + [f"`sample {name}`" for name in close if name in printed])
    return ConfigError(f"{word!r} is not an instant" if word else "no instant given", hint or _HINT)


def _check_reached(tick: int, recording: Recording) -> int:
    hz = recording.spec.profile.tick_hz
    if tick > recording.newest:
        newest = recording.newest
        raise ConfigError(
            f"the run has reached {newest / hz:.2f} s, tick {newest}, so far", "an earlier instant"
        )
    return tick


def _find_line(search: _Search, line: int) -> int:
    lines = len(source_lines(search.recording.program.text))
    if not 1 <= line <= lines:
        raise ConfigError(f"the program has no line {line}", f"1 … {lines}")
    # Of consecutive ticks at one line, the first is meant: that is when the program reached the line.
    at_it = ValueCondition("line", Operator.EQUAL, str(line))
    came = find_begins(
        at_it, evaluate_condition(at_it, search.recording.telemetry.array()["line"])
    ).tolist()
    tick = search.find_nearest(sorted({*came, *search.recording.rows.list_ticks(line)}))
    if tick is None:
        hint = "a search finds only lines that let time pass or print"
        raise ConfigError(f"line {line} does not run {search.words}", hint)
    return tick


def _find_command(search: _Search, words: str) -> int:
    commands = search.recording.commands
    commands.read_all()
    tick = search.find_nearest([commands.tick(number) for number in commands.find_events(words)])
    if tick is None:
        raise ConfigError(f"no {f'command {words}'.rstrip()} {search.words}")
    return tick


def _find_sample(search: _Search, condition: ValueCondition) -> int:
    tick = search.find_tick(condition)
    if tick is None:
        seen = _read_printed_names(search.recording)
        is_unknown = seen and condition.name and condition.name not in seen
        close = did_you_mean(closest(condition.name, seen, 1)) or f"there are {', '.join(seen)}"
        hint = close if is_unknown else ""
        raise ConfigError(f"no {condition} {search.words}", hint)
    return tick


def _list_printed_names(recording: Recording) -> Iterator[str]:
    """Yield the name of each printed sample of a run."""
    printed = (row for row in recording.rows.rows(0) if row.is_text)
    return (sample[0] for row in printed if (sample := parse_sample(row.text)))


def _read_printed_names(recording: Recording) -> list[str]:
    """Return the names of the printed samples of a run, each once."""
    return sorted({*_list_printed_names(recording)})


def _find_change(search: _Search, condition: ValueCondition, mat: Field | None) -> int:
    """Return the nearest tick, in the direction of a search, at which a condition becomes true.

    If the condition is about a printed sample, return the tick of the nearest sample for which it is true.

    Raises:
        ConfigError: there is no such tick, or the run has no values of the name in the condition.
    """
    recording = search.recording
    if find_column_name(condition.name, list_columns(recording.spec)) is None:
        printed = _read_printed_names(recording)
        if condition.name in printed:
            return _find_sample(search, replace(condition, source=ValueSource.SAMPLE))
        if close := closest(condition.name, printed, 1):
            raise ConfigError(f"this run has no {condition.name!r}", did_you_mean(close))
    name = find_named_column(condition.name, recording.spec)
    if mat is None:
        raise ConfigError("the mat is still being opened", "a moment later")
    condition = condition.format_condition(name)
    values = compute_column_values(
        (name,), recording.telemetry.array(), recording, recording.actions(), mat
    )
    tick = search.find_nearest(
        find_begins(condition, evaluate_condition(condition, values[name])).tolist()
    )
    if tick is None:
        becomes = "" if condition.is_momentary else " becomes true"
        raise ConfigError(f"no tick {search.words} at which {condition}{becomes}")
    return tick


def _find_printed(search: _Search, condition: ValueCondition) -> int:
    pattern = condition.value
    try:
        tick = search.find_tick(condition)
    except re.error as error:
        raise ConfigError(f"{pattern!r} is not a regular expression: {error}") from error
    if tick is None:
        raise ConfigError(f"nothing printed {search.words} matches {pattern!r}")
    return tick


def find_begins(condition: ValueCondition, true: Array) -> Array:
    """Return the ticks at which a condition becomes true, in order.

    Some conditions, such as `left_color changes`, are true only at single instants; then return all these instants.

    Args:
        condition: The condition.
        true: Whether it is true, for each tick.
    """
    import numpy as np

    before = np.concatenate(([False], true[:-1]))
    began: Array = np.flatnonzero(true if condition.is_momentary else true & ~before)
    return began
