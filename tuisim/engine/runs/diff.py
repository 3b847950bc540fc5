"""Differences between two runs: their setup, then tick by tick, row by row, and the distance of the poses over time."""

from __future__ import annotations

import difflib
import shlex
from collections.abc import Iterator
from dataclasses import asdict
from itertools import takewhile, zip_longest
from typing import TYPE_CHECKING, Any, assert_never

from tuisim.base.data_class import dataclass
from tuisim.base.source import source_lines
from tuisim.engine.core.tree import dump_run
from tuisim.engine.runs.records import OutputRow, Stream
from tuisim.engine.runs.run_folder import StoredRun
from tuisim.engine.runs.samples import list_samples

if TYPE_CHECKING:
    import numpy as np

    from tuisim.engine.runs.recorded_run import Recording

    _Series = np.ndarray[Any, Any]

DIFF_LINES = 20
"""Maximum number of lines of the unified diff of two programs."""
EXCEEDED_MM = (1.0, 10.0, 100.0)
PARTED_MM, PARTED_DEG = 1.0, 1.0
"""Distance in mm, and difference of heading in degrees, beyond which two robots count as apart."""
TABLE_ROWS = 10
_WORDS = {"deg": "°", "dps": "°/s", "pc": "%", "color": "colour"}
"""Words for parts of names of settings and telemetry, such as units."""


@dataclass(frozen=True, slots=True)
class TickDifference:
    """The first tick at which two recordings are not identical bit by bit."""

    tick: int
    time_s: float
    fields: tuple[str, ...]
    """Fields that differ; empty if one recording ends before this tick."""


@dataclass(frozen=True, slots=True)
class RowDifference:
    """The first position at which the output rows of two runs differ.

    `first` and `second` are the rows there; None for a run that has no more rows.
    """

    row: int
    """Number from 1 among the readable rows; a row of a motor gets the number of the next readable one."""
    first: str | None
    second: str | None
    times_s: tuple[float | None, float | None]
    """Simulated time in each run, in seconds."""


@dataclass(frozen=True, slots=True)
class Divergence:
    """The distance between the robots of two runs over the time that both runs cover."""

    max_mm: float
    max_at_s: float
    end_mm: float
    end_s: float
    exceeded: tuple[tuple[float, float | None], ...]
    """Distances between the two robots in mm, and the time in s at which each was first exceeded; None for never."""
    table: tuple[tuple[float, float, float], ...]
    """Time in s, distance of the two robots in mm, difference of their headings in degrees, at regular intervals."""


@dataclass(frozen=True, slots=True)
class RunDiff:
    """All differences between two runs."""

    setup: tuple[tuple[str, str, str], ...]
    """Differences in the setup: name, and values in the first and the second run."""
    program: tuple[str, ...]
    """First lines of a unified diff of the programs; empty if they are equal."""
    by_time: bool
    """Whether the tick rates of the two runs differ: then times are compared, and no record is equal."""
    tick: TickDifference | None
    line: TickDifference | None
    """The first tick with a different source line."""
    output: RowDifference | None
    sample: RowDifference | None
    divergence: Divergence | None
    """None if one of the runs has no telemetry."""

    @property
    def same(self) -> bool:
        """Whether recording and output of the two runs are identical bit by bit."""
        return not self.by_time and self.tick is None and self.output is None

    def to_plain(self) -> dict[str, Any]:
        """Return the differences as a dictionary of JSON-compatible data; `same` says whether there are none."""
        return {"same": self.same, **asdict(self)}

    def describe_recording(self) -> Iterator[tuple[str, str]]:
        """Yield a label and a text for each difference between the recordings.

        If recording and output are identical, yield one pair that says so.
        """
        if self.same:
            settings = "" if self.setup or self.program else ", settings"
            yield "bit-identical", f"recording, output{settings}"
            return
        if self.by_time:
            yield "tick rates differ", "compared by time, no record is the same"
        for what, difference in (("tick", self.tick), ("line", self.line)):
            if difference:
                how = ", ".join(map(spell_name, difference.fields)) or "one recording ends"
                yield (
                    f"first differing {what}",
                    f"tick {difference.tick}, {difference.time_s:.2f} s: {how}",
                )
        for what, row in (("output row", self.output), ("sample", self.sample)):
            if row:
                sides = zip((row.first, row.second), row.times_s, strict=True)
                left, right = (
                    "no more" if text is None else f"{text!r} at {at_s:.3f} s"
                    for text, at_s in sides
                )
                yield f"first differing {what}", f"{row.row}: {left} | {right}"
        if self.divergence:
            apart = self.divergence
            max_text = f"at most {apart.max_mm:.3f} mm apart, at {apart.max_at_s:.2f} s"
            yield (
                "poses",
                f"{max_text}; {apart.end_mm:.3f} mm at the common end, {apart.end_s:.2f} s",
            )
            for limit, since_s in apart.exceeded:
                yield f"over {limit:g} mm", "never" if since_s is None else f"from {since_s:.2f} s"

    def describe_setup(self) -> Iterator[tuple[str, str]]:
        """Yield a label and a text for each difference of the settings, then lines of the programs' diff.

        The lines of the diff have an empty label.
        """
        for name, left, right in self.setup:
            yield f"settings, {spell_name(name)}", f"{left} | {right}"
        for line in self.program:
            yield "", line


def spell_name(name: str) -> str:
    """Return the name of a setting or of telemetry in words: `drift, wheel %` for `world.drift.wheel_pc`.

    Members of lists count from 1: `robot, colour sensors 1` for `robot.color_sensors.0`.
    """
    words: list[str] = []
    for part in name.removeprefix("world.").split("."):
        if part.isdecimal():
            words[-1] += f" {int(part) + 1}"
        else:
            words.append(" ".join(_WORDS.get(word, word) for word in part.split("_")))
    return ", ".join(words)


def diff_runs(
    first: StoredRun, second: StoredRun, *, prefix: bool = False, until: int | None = None
) -> RunDiff:
    """Return the differences between two runs.

    Args:
        first, second: The runs.
        prefix: Whether the first run was cut off. If so, ticks and rows that only the second run has are ignored.
        until: Last tick to compare; None for all.

    Raises:
        LogError: a recording is damaged.
    """
    left, right = first.telemetry.array(), second.telemetry.array()
    hz = (first.spec.profile.tick_hz, second.spec.profile.tick_hz)
    by_time = hz[0] != hz[1]
    if until is not None:
        left, right = left[: until + 1], right[: until + 1]
    if prefix:
        right = right[: len(left)]
    old, new = source_lines(first.program.text), source_lines(second.program.text)
    unified = difflib.unified_diff(
        old, new, first.program.name, second.program.name, n=1, lineterm=""
    )
    return RunDiff(
        setup=tuple(_diff_setup(first, second)),
        program=tuple(line for line, _ in zip(unified, range(DIFF_LINES), strict=False)),
        by_time=by_time,
        tick=None if by_time else find_first_tick(left, right, hz[0]),
        line=None if by_time else _find_first_line(left, right, hz[0]),
        output=_find_first_row(_list_rows(first, until), _list_rows(second, until), prefix),
        sample=_find_first_row(_list_samples(first, until), _list_samples(second, until), prefix),
        divergence=measure_divergence(left, right, hz) if len(left) and len(right) else None,
    )


def find_first_tick(
    left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], tick_hz: int
) -> TickDifference | None:
    """Return the first tick at which two recordings with the same tick rate differ; None if they are equal.

    `left` and `right` are results of `TelemetryView.array`.
    """
    import numpy as np

    count = min(len(left), len(right))
    # Bytes are compared, not numbers, so that NaN equals itself, and 0.0 differs from -0.0.
    size = left.dtype.itemsize
    raw = [
        np.ascontiguousarray(records[:count]).view(np.uint8).reshape(count, size)
        for records in (left, right)
    ]
    differ = np.flatnonzero((raw[0] != raw[1]).any(axis=1))
    if len(differ):
        tick = int(differ[0])
        names = left.dtype.names or ()
        fields = tuple(
            name for name in names if left[name][tick].tobytes() != right[name][tick].tobytes()
        )
        return TickDifference(tick, tick / tick_hz, fields)
    return None if len(left) == len(right) else TickDifference(count, count / tick_hz, ())


def measure_divergence(
    left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], tick_hz: tuple[int, int]
) -> Divergence:
    """Return how far the robots of two runs were apart, over the time that both runs cover.

    Args:
        left: Records of the first run, at least one. The distance is measured at their ticks.
        right: Records of the second run, at least one. If the tick rates differ, its poses are interpolated.
        tick_hz: Ticks per second of the first and of the second run.
    """
    import numpy as np

    times, distance, turned = _measure_apart(left, right, tick_hz)
    top = int(distance.argmax())
    exceeded = []
    for limit in EXCEEDED_MM:
        over = np.flatnonzero(distance > limit)
        exceeded.append((limit, float(times[over[0]]) if len(over) else None))
    rows = np.unique(np.linspace(0, len(times) - 1, TABLE_ROWS).round().astype(int))
    table = tuple((float(times[row]), float(distance[row]), float(turned[row])) for row in rows)
    return Divergence(
        float(distance[top]),
        float(times[top]),
        float(distance[-1]),
        float(times[-1]),
        tuple(exceeded),
        table,
    )


def find_first_difference_s(
    left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], tick_hz: tuple[int, int]
) -> float | None:
    """Return the time in s at which the robots were first more than 1 mm or 1 degree apart; None if they never were.

    Only the time that both runs cover is compared. So the runs may differ although the result is None: one of the two
    may have gone on longer.

    Args:
        left: Records of the first run, at least one. The distance is measured at their ticks.
        right: Records of the second run, at least one. If the tick rates differ, its poses are interpolated.
        tick_hz: Ticks per second of the first and of the second run.
    """
    times, distance, turned = _measure_apart(left, right, tick_hz)
    is_apart = (distance > PARTED_MM) | (abs(turned) > PARTED_DEG)
    return float(times[is_apart.argmax()]) if is_apart.any() else None


def _measure_apart(
    left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], tick_hz: tuple[int, int]
) -> tuple[_Series, ...]:
    """Return how far two robots are apart, as arrays: times in s, distances in mm, differences of heading in degrees.

    Args:
        left: Records of the first run, at least one. The times are those of its ticks, as far as both runs go.
        right: Records of the second run, at least one. If the tick rates differ, its poses are interpolated.
        tick_hz: Ticks per second of the first and of the second run.
    """
    import numpy as np

    end_s = min((len(left) - 1) / tick_hz[0], (len(right) - 1) / tick_hz[1])
    times = np.arange(int(end_s * tick_hz[0] + 1e-9) + 1) / tick_hz[0]
    theirs = np.arange(len(right)) / tick_hz[1]
    apart = []
    for name in ("x_mm", "y_mm", "heading_deg"):
        other = (
            right[name][: len(times)]
            if tick_hz[0] == tick_hz[1]
            else np.interp(times, theirs, right[name])
        )
        apart.append(other - left[name][: len(times)])
    return times, np.hypot(apart[0], apart[1]), (apart[2] + 180.0) % 360.0 - 180.0


def _find_first_line(
    left: np.ndarray[Any, Any], right: np.ndarray[Any, Any], tick_hz: int
) -> TickDifference | None:
    count = min(len(left), len(right))
    differ = (left["line"][:count] != right["line"][:count]).nonzero()[0]
    return (
        TickDifference(int(differ[0]), int(differ[0]) / tick_hz, ("line",)) if len(differ) else None
    )


_Row = tuple[Any, str, float]
"""Value to compare, its text, its time in s."""


def _read_output(run: StoredRun, until: int | None) -> Iterator[OutputRow]:
    # Rows of the tick `until` itself are left out: they may have been written after the instant to compare up to.
    return takewhile(lambda row: until is None or row.tick < until, run.output.rows())


def _describe_row(row: OutputRow) -> str:
    """Return a row of output as text; a row of the brick's state is described, such as `[lights]`."""
    match row.stream:
        case (
            Stream.STDOUT | Stream.STDERR | Stream.SPEECH | Stream.INPUT | Stream.NOTE | Stream.DATA
        ):
            return row.format_line()
        case Stream.LED:
            return "[lights]"
        case Stream.CONSOLE:
            return "[text screen]"
        case Stream.DISPLAY | Stream.MOTORS | Stream.UNKNOWN:
            return f"[{row.stream.name.lower()}]"
        case _:
            assert_never(row.stream)


def _list_rows(run: StoredRun, until: int | None) -> Iterator[_Row]:
    for row in _read_output(run, until):
        yield row, _describe_row(row), row.time_ns / 1e9


def _list_samples(run: StoredRun, until: int | None) -> Iterator[_Row]:
    for sample in list_samples(_read_output(run, until)):
        yield (
            (sample.name, sample.value, sample.time_s),
            f"{sample.name}: {sample.value:g}",
            sample.time_ns / 1e9,
        )


def _find_first_row(
    first: Iterator[_Row], second: Iterator[_Row], prefix: bool
) -> RowDifference | None:
    number = 1
    for left, right in zip_longest(first, second):
        if left is None and prefix:
            return None
        if left is None or right is None or left[0] != right[0]:
            _, was, was_s = left or (None, None, None)
            _, now, now_s = right or (None, None, None)
            return RowDifference(number, was, now, (was_s, now_s))
        # Rows of motors, LEDs and pictures are compared, too, but not counted, because users do not see them as rows.
        number += not isinstance(left[0], OutputRow) or left[0].is_text
    return None


def _diff_setup(first: StoredRun, second: StoredRun) -> Iterator[tuple[str, str, str]]:
    before, now = _flatten(dump_run(first.spec)), _flatten(dump_run(second.spec))
    for name in before | now:
        left, right = (str(settings.get(name, "—")) for settings in (before, now))
        if left != right:
            yield name, left, right
    for name, label in (("name", "program name"), ("prelude", "predefined names")):
        left, right = getattr(first.program, name), getattr(second.program, name)
        if left != right:
            yield label, left, right
    if first.program.arguments != second.program.arguments:
        yield (
            "program arguments",
            shlex.join(first.program.arguments),
            shlex.join(second.program.arguments),
        )
    if first.actions != second.actions:
        yield "user actions", str(len(first.actions)), str(len(second.actions))


def _flatten(plain: Any, name: str = "") -> dict[str, Any]:
    """Return nested data as one flat table, with names such as `world.noise.light`.

    Args:
        plain: The data.
        name: The begin of each name in the table, such as `world.noise`; empty for none.
    """
    if isinstance(plain, dict) and plain:
        pairs = [(f"{name}.{key}" if name else str(key), value) for key, value in plain.items()]
    elif isinstance(plain, list | tuple) and plain:
        pairs = [(f"{name}.{number}", value) for number, value in enumerate(plain)]
    else:
        return {name: "none" if plain in ((), [], {}) else plain}
    return {path: leaf for below, value in pairs for path, leaf in _flatten(value, below).items()}


def is_repeat(run: StoredRun | Recording, earlier: StoredRun | Recording) -> bool:
    """Return whether a run has the same program text, arguments and settings as an earlier one.

    If it has, both runs must be equal: a difference between them is a fault.
    """
    program = run.program
    before = earlier.program
    return (program.text, program.arguments, run.spec) == (
        before.text,
        before.arguments,
        earlier.spec,
    )
