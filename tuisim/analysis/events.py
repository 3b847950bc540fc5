"""Events: where a variable crosses a threshold, and what the program asked of motors and sensors."""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, among
from tuisim.engine.core.conditions import (
    NUMBER,
    Operator,
    ValueCondition,
    describe_comparison,
    parse_condition,
)
from tuisim.engine.runs.arrays import FloatArray
from tuisim.engine.runs.command_events import CommandEvent, CommandIndex, parse_command_search
from tuisim.logs.signals import sort_known
from tuisim.logs.units import drop_run

if TYPE_CHECKING:
    from tuisim.engine.runs.run_folder import StoredRun
    from tuisim.logs.log import Log, Series


@dataclass(frozen=True, slots=True)
class Crossing:
    """An instant at which a signal crosses a threshold."""

    sample: int
    """Index, in the signal, of the first sample on the other side of the threshold."""
    time_s: float
    """Time at which the straight line between the samples before and after the crossing meets the threshold."""
    value: float
    """Value of the first sample on the other side of the threshold."""
    rising: bool


def find_crossings(
    time_s: FloatArray, values: FloatArray, threshold: float, hysteresis: float = 0.0
) -> list[Crossing]:
    """Return the crossings of a threshold by a signal, in order of time.

    A value equal to the threshold is above it: a signal that only touches the threshold from above crosses nothing.

    Args:
        time_s: Shape (n,), in any order.
        values: Shape (n,); values that are not finite are skipped.
        threshold: The threshold.
        hysteresis: How far the signal must be from the threshold, before and after it, for a crossing.

    Raises:
        LogError: the hysteresis is negative.
    """
    if not hysteresis >= 0.0:
        raise LogError(f"the hysteresis must not be negative, got {hysteresis:g}")
    known = np.arange(len(values))[sort_known(time_s, values)]
    signal = values[known]
    above = signal >= threshold
    # Each sample gets 1 above the threshold, -1 below it, and 0 if it is within the hysteresis.
    side = np.where(
        signal >= threshold + hysteresis, 1, np.where(signal < threshold - hysteresis, -1, 0)
    )
    decided = np.flatnonzero(side)
    turns = side[decided[1:]] != side[decided[:-1]]
    before = decided[:-1][turns]
    changes = decided[1:][turns]
    results = []
    for start, end in zip(before.tolist(), changes.tolist(), strict=True):
        rising = bool(side[end] > 0)
        beyond = above[start + 1 : end + 1] == rising
        # The event is at the last crossing of the threshold, not where the signal leaves the hysteresis.
        index = start + 1 + (0 if beyond.all() else int(np.flatnonzero(~beyond)[-1]) + 1)
        first, last = int(known[index - 1]), int(known[index])
        results.append(
            Crossing(
                last,
                _compute_crossing_s(time_s, values, first, last, threshold),
                float(values[last]),
                rising,
            )
        )
    return results


def _find_changes(time_s: FloatArray, values: FloatArray) -> list[Crossing]:
    """Return the instants at which the value of a signal differs from its previous value, in order of time."""
    known = np.arange(len(values))[sort_known(time_s, values)]
    turns = np.flatnonzero(np.diff(values[known]))
    pairs = zip(known[turns].tolist(), known[turns + 1].tolist(), strict=True)
    return [
        Crossing(
            after, float(time_s[after]), float(values[after]), bool(values[after] > values[before])
        )
        for before, after in pairs
    ]


def _compute_crossing_s(
    time_s: FloatArray, values: FloatArray, first: int, last: int, threshold: float
) -> float:
    # The values are halved, so that the difference of huge values is finite.
    start = float(values[first]) / 2.0
    stop = float(values[last]) / 2.0
    part = (threshold / 2.0 - start) / (stop - start) if stop != start else 1.0
    return float(time_s[first]) + min(max(part, 0.0), 1.0) * float(time_s[last] - time_s[first])


_OPERATORS = (Operator.LESS, Operator.GREATER, Operator.EQUAL)
THRESHOLD_FORM = f"{describe_comparison(_OPERATORS)}, such as `Colour > 50 +- 2`; `=` for both ways"
FORM = f"{THRESHOLD_FORM}; `command` for commands of the program; several with `,` between them"
_WIDTH = re.compile(rf"(?P<comparison>.+?)(?:\+-|±)\s*(?P<width>{NUMBER})\s*")


@dataclass(frozen=True, slots=True)
class Threshold(ValueCondition):
    """A condition on a variable, such as `Colour < 50`: that it falls below a value, rises above it, or changes."""

    hysteresis: float = 0.0
    """How far the variable must be from the level, before and after it, for an event; in the variable's unit."""

    def __str__(self) -> str:
        width = f" +- {self.hysteresis:g}" if self.hysteresis else ""
        return f"{self.name} {self.operator.short} {self.level}".rstrip() + width

    @property
    def level(self) -> str:
        """The value of the threshold as a text for display; empty for a change."""
        return f"{float(self.value):g}" if self.value else ""

    def select_series(self, series: Sequence[Series]) -> list[Series]:
        """Return the series of the threshold's variable: of all runs or, if the threshold names a run, of that run."""
        return [
            candidate
            for candidate in series
            if self.name in (candidate.name, drop_run(candidate.name))
        ]

    def find_crossings(self, series: Series) -> list[Crossing]:
        """Return the crossings of the threshold by a series, in order of time."""
        if self.operator is Operator.CHANGES:
            return _find_changes(series.time_s, series.values)
        results = find_crossings(series.time_s, series.values, float(self.value), self.hysteresis)
        ways = {Operator.GREATER: (True,), Operator.LESS: (False,)}.get(
            self.operator, (True, False)
        )
        return [crossing for crossing in results if crossing.rising in ways]


@dataclass(frozen=True, slots=True)
class Event:
    """A crossing of a threshold by a variable of a log."""

    variable: str
    threshold: Threshold
    crossing: Crossing
    row: int
    """Row of the table with the first sample on the other side of the threshold."""
    since_s: float
    """Seconds since the previous event of the same variable; NaN for the first."""


@dataclass(frozen=True, slots=True)
class CommandChoice:
    """A choice among the events: the commands that programs gave to motors and sensors."""

    words: str
    """Words to find in the names of the commanded part and of the called function; empty for all commands."""

    def __str__(self) -> str:
        return f"command {self.words}".rstrip()


EventChoice: TypeAlias = Threshold | CommandChoice


@dataclass(frozen=True)
class CommandRow:
    """A command that a program gave to a motor or sensor, once or repeatedly, with its row in a log."""

    index: CommandIndex
    number: int
    """Number of the command in the index of commands."""
    row: int
    """Row of the table with the first sample after the command."""
    run: int
    """Number of the run in the log, 0 if there is only one."""

    @property
    def time_s(self) -> float:
        """The time at which the program gave the command first, in s."""
        return self.index.time_s(self.number)

    @cached_property
    def event(self) -> CommandEvent:
        """The command; it is read from the recording on first use, and then stored."""
        return self.index.event(self.number)


def parse_threshold(text: str) -> Threshold | None:
    """Return the threshold that a text such as `Colour < 50` stands for; None if it is no threshold."""
    match = _WIDTH.fullmatch(text)
    condition = parse_condition(match["comparison"], value=NUMBER) if match else None
    width = float(match["width"]) if match and condition else 0.0
    condition = condition or parse_condition(text, value=NUMBER)
    if condition is None or condition.operator not in (*_OPERATORS, Operator.CHANGES):
        return None
    return Threshold(condition.name, condition.operator, condition.value, hysteresis=width)


def parse_event(text: str) -> EventChoice | None:
    """Return the threshold that a text such as `Colour < 50` means, or the search for commands; None for others."""
    threshold = parse_threshold(text)
    if threshold is None and (words := parse_command_search(text)) is not None:
        return CommandChoice(words)
    return threshold


def parse_events(text: str, log: Log) -> tuple[EventChoice, ...]:
    """Return the thresholds and searches for commands in a text, see `FORM`; empty for an empty text.

    Raises:
        LogError: a part of the text is not a threshold, or there is no such variable.
    """
    choices: list[EventChoice] = []
    for part in text.split(",") if text.strip() else ():
        choice = parse_event(part)
        if choice is None:
            raise LogError(f"{part.strip()!r} is not a threshold", FORM)
        names = dict.fromkeys(drop_run(name) for name in log.names)
        if isinstance(choice, Threshold) and choice.name not in (*log.names, *names):
            raise LogError(
                f"no variable {choice.name!r}", among(choice.name, names), file=log.title
            )
        choices.append(choice)
    return tuple(choices)


def find_events(
    log: Log, choices: Sequence[EventChoice], runs: Sequence[StoredRun] = ()
) -> list[Event | CommandRow]:
    """Return the crossings of thresholds and the commands of programs in a log, in the order of its rows.

    Args:
        log: The log.
        choices: The thresholds and searches for commands.
        runs: The runs of the log; none for a file.
    """
    events: list[Event | CommandRow] = []
    series = [log.series(name) for name in log.names] if choices else []
    for threshold in choices:
        if isinstance(threshold, CommandChoice):
            for number, run in enumerate(runs, 1):
                run_series = [each for each in series if each.run in (0, number)]
                events += _find_commands(run, threshold, run_series, number if len(runs) > 1 else 0)
            continue
        for variable in threshold.select_series(series):
            before_s = float("nan")
            for crossing in threshold.find_crossings(variable):
                row = int(variable.rows[crossing.sample])
                events.append(
                    Event(variable.name, threshold, crossing, row, crossing.time_s - before_s)
                )
                before_s = crossing.time_s
    return sorted(events, key=lambda event: event.row)


def _find_commands(
    run: StoredRun, choice: CommandChoice, series: Sequence[Series], run_number: int
) -> list[CommandRow]:
    """Return the commands of a run's program that a search finds.

    Args:
        run: The run.
        choice: The search.
        series: The variables of the run in the log.
        run_number: The number of the run, for `CommandRow.run`.
    """
    index = CommandIndex(run)
    index.read_all()
    numbers = index.find_events(choice.words)
    rows = np.concatenate([each.rows for each in series]) if series else np.empty(0, np.int64)
    if not len(rows):
        return []
    order = np.argsort(rows, kind="stable")
    times_s = np.maximum.accumulate(np.concatenate([each.time_s for each in series])[order])
    places = np.searchsorted(times_s, [index.time_s(number) for number in numbers])
    rows = rows[order][np.minimum(places, len(rows) - 1)]
    pairs = zip(numbers, rows.tolist(), strict=True)
    return [CommandRow(index, number, row, run_number) for number, row in pairs]


class Events:
    """The events of a log that the user has chosen to see; when the log changes, they are searched for again.

    Args:
        runs: The runs of the log; empty for a file.
    """

    def __init__(self, runs: Sequence[StoredRun] = ()) -> None:
        self.runs = runs
        self.thresholds: tuple[EventChoice, ...] = ()
        self._of: tuple[Log | None, tuple[EventChoice, ...]] = (None, ())
        self._events: list[Event | CommandRow] = []

    def set(
        self, log: Log, thresholds: tuple[EventChoice, ...], events: list[Event | CommandRow]
    ) -> None:
        """Store events, and the log and the thresholds for which they were found."""
        self.thresholds = thresholds
        self._of = (log, thresholds)
        self._events = events

    def list_events(self, log: Log) -> list[Event | CommandRow]:
        """Return the events of a log for the present thresholds, in the order of its rows."""
        if self._of[0] is not log or self._of[1] != self.thresholds:
            self.set(log, self.thresholds, find_events(log, self.thresholds, self.runs))
        return self._events
