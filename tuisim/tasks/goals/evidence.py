"""Data of a recording for judging goals, as arrays and rows, computed when a condition first needs them."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.engine.core.conditions import Operator, ValueCondition, ValueSource
from tuisim.engine.core.field import Field
from tuisim.engine.core.profile import NS_PER_S
from tuisim.engine.protocol import End, Ended, Unended
from tuisim.engine.runs.frames import compute_column_values, evaluate_condition, tick_times_s
from tuisim.engine.runs.readings import Readings, read_readings
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.samples import Sample, find_samples, select_rows
from tuisim.tasks.goals.brick import (
    BRICK_COLUMNS,
    BRICK_STREAMS,
    BRICK_TEXTS,
    build_brick_column,
    find_text_ticks,
)
from tuisim.tasks.goals.patterns import Search, build_search

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.runs.handle import RunHandle

    Array = np.ndarray[Any, Any]


@dataclass(frozen=True, slots=True)
class Finding:
    """The result of judging a condition: when it was met or violated, or why it was not met."""

    moment: EvidencePoint | None = None
    """When it happened; None if it has not happened so far."""
    reason: str = ""
    """Why it is not reached, or how it was violated, in one sentence; empty where nothing needs to be said."""
    line: int | None = None
    """The program's line that this is about; 0: there is none; None: the line at the moment, none without a moment."""
    happened: EvidencePoint | None = None
    """When the condition was met, if only a later moment decides: with `once`, the end of the run."""


def format_distance(distance_mm: float) -> str:
    """Return a distance for a sentence, such as `35 mm`; a small distance has a decimal."""
    return f"{distance_mm:.1f} mm" if distance_mm < 10 else f"{distance_mm:.0f} mm"


def share_words(share: float) -> str:
    """Return a share from 0 to 1 for a sentence, such as `45 %`.

    The share is rounded down, so that the text names no share that was not reached.
    """
    return f"{int(share * 1000) / 10:g} %"


MAX_ROWS = 200_000
"""The most rows of output that are judged, so that a program that floods cannot fill the memory."""

JudgedRun: TypeAlias = "StoredRun | RunHandle"
"""A run to judge: a stored one, or one that may still be running."""


class EvidencePoint(NamedTuple):
    """A moment of a run: the end of a tick (then `row` is -1), or the moment at which a row of output was written."""

    tick: int
    row: int = -1
    """Index into `Evidence.rows`."""
    time_s: float = -1.0
    """The time of a moment that is defined by a time; `row` is then the first one after it."""


START = EvidencePoint(-1, -1)
"""The moment before the first tick and row."""


@dataclass(frozen=True, slots=True)
class EvidenceSpan:
    """The part of a run in which a condition is judged."""

    first_tick: int
    end_tick: int
    """The tick after the last one."""
    first_row: int
    end_row: int
    stop: EvidencePoint | None
    """The limit that has been reached; None if there is none, or the run did not get there."""
    over: bool
    """Whether the run has ended and the span reaches to its end."""

    @property
    def ticks(self) -> slice:
        """The ticks of the span, as a slice of the telemetry."""
        return slice(self.first_tick, max(self.first_tick, self.end_tick))


class Evidence:
    """The recording of a run so far, by which goals are judged.

    Args:
        run: The run.
        field: Its mat; None opens it when it is needed.
    """

    def __init__(self, run: JudgedRun, field: Field | None = None) -> None:
        self._run = run
        self._field = field
        self.spec = run.spec
        self.program = run.program
        # The end is looked up before the recording is read, so that the recording of an ended run is complete.
        if isinstance(run, StoredRun):
            self.end: Ended | None = run.end
            self.ended = run.end is not None or run.state is not Unended.RUNNING
            self.answers = tuple(run.options.get("answers", ()))
        else:
            self.end = run.ended
            self.ended = run.ended is not None
            # Only the answers given before the run: those that the user typed are among the rows of its output.
            self.answers = run.answers
        self.records: Array = run.telemetry.array()
        self.memo: dict[str, Any] = {}
        """A cache of what conditions have computed from the recording."""

    @cached_property
    def falsified(self) -> str:
        """How the program has falsified its recording, a sentence without a full stop.

        The result is empty if the recording can be trusted.
        """
        return self.end.summary if self.end is not None and self.end.end is End.FALSIFIED else ""

    @cached_property
    def times_s(self) -> Array:
        """The simulated time of each tick in seconds, shape (n,)."""
        return tick_times_s(self.records, self.spec)

    @cached_property
    def rows(self) -> list[OutputRow]:
        """The lines that the program printed or read as input, in order, up to `MAX_ROWS`."""
        return self._read_rows((Stream.STDOUT, Stream.STDERR, Stream.INPUT, Stream.DATA))

    def _read_rows(self, streams: Sequence[Stream]) -> list[OutputRow]:
        rows = (row for row in self._run.output.rows() if row.stream in streams)
        return list(islice(rows, MAX_ROWS))

    @cached_property
    def readings(self) -> Readings:
        """The readings of sensors and motors that the program took.

        Raises:
            LogError: the file of the readings is missing or damaged.
        """
        return read_readings(self._run.folder, is_over=self.ended)

    @cached_property
    def samples(self) -> list[tuple[int, Sample]]:
        """The samples that the program printed, each with the index of its row in `rows`."""
        return find_samples(self.rows)

    def list_sample_ticks(self, name: str) -> list[int]:
        """Return the ticks of the samples of a variable, in ascending order."""
        key = f"ticks of {name}"
        if key not in self.memo:
            self.memo[key] = sorted(
                sample.tick for _, sample in self.samples if sample.name == name
            )
        ticks: list[int] = self.memo[key]
        return ticks

    def search(self, pattern: str) -> Search:
        """Return a function that returns whether a regular expression matches anywhere in a line.

        Raises:
            UnjudgedError: the engine for searches with a time limit does not support the expression.
        """
        key = f"search {pattern}"
        if key not in self.memo:
            self.memo[key] = build_search(pattern)
        search_line: Search = self.memo[key]
        return search_line

    @cached_property
    def brick_rows(self) -> list[OutputRow]:
        """The texts that the brick displayed and the sounds that it played, as rows in order, up to `MAX_ROWS`."""
        return self._read_rows(BRICK_STREAMS)

    def column(self, name: str) -> Array:
        """Return the values of a column, one of `list_columns` or `BRICK_COLUMNS`, at every tick, shape (n,).

        Raises:
            LogError, ConfigError: the mat no longer exists, or its image has changed.
        """
        if name not in self.memo:
            actions = self._run.actions
            if name in BRICK_COLUMNS:
                self.memo[name] = build_brick_column(
                    name, len(self.records), self.brick_rows, actions
                )
                return self.column(name)
            self.memo |= compute_column_values((name,), self.records, self._run, actions, self.mat)
        values: Array = self.memo[name]
        return values

    def held(self, condition: ValueCondition) -> Array:
        """Return for each tick whether a comparison is true, shape (n,).

        A comparison with output, such as printed lines, is true in the ticks in which a matching line was printed.

        Raises:
            ValueError: the comparison needs a number and has another value.
            UnjudgedError: the comparison's regular expression takes too long.
            LogError, ConfigError: the mat no longer exists, or its image has changed.
        """
        import numpy as np

        if condition.operator is Operator.MATCHES and condition.name in BRICK_TEXTS:
            return np.isin(
                np.arange(len(self.records)), find_text_ticks(condition, self.brick_rows)
            )
        if condition.source is ValueSource.COLUMN:
            return evaluate_condition(condition, self.column(condition.name))
        return np.isin(
            np.arange(len(self.records)),
            [self.rows[number].tick for number in self.find_true_rows(condition)],
        )

    def find_true_rows(self, condition: ValueCondition) -> list[int]:
        """Return the indices of the rows for which a comparison with printed lines is true.

        Raises:
            ValueError: the comparison needs a number and has another value.
            UnjudgedError: its regular expression takes too long.
        """
        if condition.source is ValueSource.PRINT:
            search = self.search(condition.value)
            return [
                number
                for number, row in enumerate(self.rows)
                if row.may_be_sample and search(row.text)
            ]
        printed = [row for row in self.rows if row.may_be_sample]
        ids = set(map(id, select_rows(condition, printed)))
        return [number for number, row in enumerate(self.rows) if id(row) in ids]

    @cached_property
    def mat(self) -> Field:
        """The mat without the pen's marks.

        Raises:
            LogError, ConfigError: the mat no longer exists, or its image has changed.
        """
        if self._field is not None:
            return self._field
        if isinstance(self._run, StoredRun):
            return self._run.open_mat()
        return self._run.field.open_field(has_floor=self.spec.world.is_open)

    @cached_property
    def end_s(self) -> float:
        """The simulated time in seconds up to which the run is recorded."""
        newest = float(self.times_s[-1]) if len(self.records) else 0.0
        return max(newest, self.end.time_ns / NS_PER_S) if self.end else newest

    @property
    def last(self) -> EvidencePoint:
        """The moment at the end of the recording so far."""
        return EvidencePoint(len(self.records) - 1, len(self.rows), self.end_s)

    def find_moment(self, time_s: float) -> EvidencePoint | None:
        """Return the moment after all ticks and rows up to a time, including those at exactly this time.

        The time is in simulated seconds. The result is None if the recording does not go beyond that time.
        """
        if time_s >= self.end_s:
            return None
        tick = bisect_right(self.times_s, time_s) - 1
        row = bisect_right(self.rows, time_s * NS_PER_S, key=lambda row: row.time_ns)
        return EvidencePoint(tick, row, time_s)

    def find_earlier_moment(self, time_s: float) -> EvidencePoint | None:
        """Return the last moment before a time in simulated seconds; None if the recording does not reach that time."""
        if time_s > self.end_s:
            return None
        tick = bisect_left(self.times_s, time_s) - 1
        return EvidencePoint(
            tick, bisect_left(self.rows, time_s * NS_PER_S, key=lambda row: row.time_ns) - 1
        )

    def span(self, start: EvidencePoint, stop: EvidencePoint | None) -> EvidenceSpan:
        """Return the part of the run between two moments, without the two moments themselves.

        If `stop` is None, the part goes to the end of the recording.
        """
        end = self.last if stop is None else stop
        return EvidenceSpan(
            first_tick=start.tick + 1,
            end_tick=end.tick + (end.row >= 0),
            first_row=self._find_next_row(start) if start.row < 0 else start.row + 1,
            end_row=self._find_next_row(end) if end.row < 0 else end.row,
            stop=stop,
            over=stop is None and self.ended,
        )

    def _find_next_row(self, moment: EvidencePoint) -> int:
        return (
            bisect_left(self.rows, moment.tick, key=lambda row: row.tick) if moment.tick > 0 else 0
        )

    def time_s(self, moment: EvidencePoint) -> float:
        """Return the simulated time of a moment in seconds."""
        if moment.time_s >= 0:
            return moment.time_s
        if moment.row >= 0:
            return self.rows[moment.row].time_ns / NS_PER_S
        if not len(self.records):
            return 0.0
        return float(self.times_s[min(max(moment.tick, 0), len(self.records) - 1)])

    def place_mm(self, tick: int) -> tuple[float, float]:
        """Return x and y of the robot at the end of a tick, in mm."""
        if not len(self.records):
            return self.spec.world.start.x_mm, self.spec.world.start.y_mm
        record = self.records[min(max(tick, 0), len(self.records) - 1)]
        return float(record["x_mm"]), float(record["y_mm"])

    def line(self, moment: EvidencePoint) -> int:
        """Return the number of the program's line that ran at a moment; 0 if none did."""
        if moment.row >= 0 and moment.time_s < 0:
            return self.rows[moment.row].line
        if moment == self.last and self.end is not None and self.end.error_line:
            return self.end.error_line
        return int(self.records["line"][moment.tick]) if 0 <= moment.tick < len(self.records) else 0

    def time_words(self, tick: int) -> str:
        """Return the time of a tick for a sentence, such as `3.20 s`."""
        return f"{float(self.times_s[tick]):.2f} s"


def find_ticks(rows: Array, hz: int) -> Array:
    """Return the tick of each reading, shape (n,); this also works for other records that have a time.

    Args:
        rows: The readings or other records, with their times in the field `time_ns`.
        hz: Ticks per second.
    """
    seconds, rest_ns = divmod(rows["time_ns"], NS_PER_S)
    ticks: Array = seconds * hz + rest_ns * hz // NS_PER_S
    return ticks


def find_motion_line(records: Array, index: int) -> int:
    """Return the line of the program that ran when the robot last moved, up to a tick.

    If the robot moved only later, return the line of its first movement; if it never moved, return 0.

    Args:
        records: Telemetry, structured as `TICK_FIELDS`.
        index: The last tick to consider.
    """
    import numpy as np

    steps = [np.diff(records[name]) != 0 for name in ("x_mm", "y_mm", "heading_deg")]
    moved = np.flatnonzero(np.logical_or.reduce(steps)) + 1
    if not len(moved):
        return 0
    before = int(np.searchsorted(moved, index, side="right")) - 1
    return int(records["line"][moved[max(0, before)]])
