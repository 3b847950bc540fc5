"""Samples: printed lines of the form `NAME: number [time]`. Pure Python, no numpy.

NAME is any identifier. A time in seconds may follow the number, and `^log ` may precede
the name. Any other line is text, not a sample.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator
from itertools import islice

from tuisim.base.data_class import dataclass
from tuisim.base.errors import listed
from tuisim.engine.core.conditions import NUMBER, ValueCondition, ValueSource
from tuisim.engine.runs.records import SAMPLE_STREAMS, OutputRow

_SAMPLE = re.compile(rf"(?:\^log[ \t]+)?([^\W\d]\w*):[ \t]*({NUMBER})(?:[ \t]+({NUMBER}))?\s*")
_PLAIN_SAMPLE = re.compile(
    rb"(?:\^log[ \t]+)?[A-Za-z_]\w*:[ \t]*[+-]?[0-9]{1,18}(?:\.[0-9]{0,18})?[ \t]*"
)
"""Matches most samples in the bytes of the recording; a line that it does not match may still be a sample."""

_NEAR_SAMPLE = re.compile(
    r"(?:\^log[ \t]+)?(?P<name>[^\W\d]\w*(?: +\w+){0,3}) *:[ \t]*(?P<number>[+-]?\d+(?:[.,]\d+)?)"
    r"(?: ?(?:%|°|[A-Za-z]{1,3})(?:/s)?)?\s*"
)
"""A name of several words, a number with a comma, or a unit behind it; also most samples."""
_MAX_ROWS_READ = 10_000
"""Largest number of rows in which a line that is nearly a sample is looked for: a program may print millions."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One value that a program has printed as a sample, with its variable's name, its time and its line."""

    name: str
    value: float
    time_s: float
    """Simulated time of the print, or the time in the line."""
    time_ns: int
    """Simulated time of the print."""
    tick: int
    line: int
    """Source line that printed it; 0 for none."""


def parse_sample(text: str) -> tuple[str, float, float | None] | None:
    """Return the name, the value and the time in seconds of a sample in a printed line; None if it is no sample.

    The time is None if the line has none.
    """
    if ":" not in text:
        return None
    match = _SAMPLE.fullmatch(text)
    if match is None:
        return None
    name = match[1]
    value = float(match[2])
    time = None if match[3] is None else float(match[3])
    # Extremely long numbers are parsed as infinity; such lines are not samples.
    if (
        not name.isidentifier()
        or not math.isfinite(value)
        or (time is not None and not math.isfinite(time))
    ):
        return None
    return name, value, time


def describe_near_sample(rows: Iterable[OutputRow]) -> str:
    """Return a hint that names printed rows which are nearly samples, and says how to print samples; empty if none are.

    Such a row is `speed: 5 cm`, where a sample is `speed: 5`. For each name, the hint has only the first such row. Rows
    after the first `_MAX_ROWS_READ` are not read.
    """
    places: dict[str, str] = {}
    remedies: list[str] = []
    for row in islice(rows, _MAX_ROWS_READ):
        if row.stream not in SAMPLE_STREAMS or not (match := _NEAR_SAMPLE.fullmatch(row.text)):
            continue
        name = "_".join(match["name"].split())
        if name not in places and parse_sample(row.text) is None:
            places[name] = f"{row.text.strip()!r} in line {row.line}"
            remedies.append(repr(f"{name}: {match['number'].replace(',', '.')}"))
    if not places:
        return ""
    verb = "is no sample, which is" if len(places) == 1 else "are no samples; one is"
    return (
        f"{listed(places.values())} {verb} one word, a colon and a number: print {listed(remedies)}"
    )


def is_sample(text: bytes) -> bool:
    """Return whether a printed line, as the bytes of the recording, is a sample."""
    return b":" in text and (
        _PLAIN_SAMPLE.fullmatch(text) is not None
        or parse_sample(str(text, "utf-8", "replace")) is not None
    )


def list_samples(rows: Iterable[OutputRow]) -> list[Sample]:
    """Return the samples among the rows that a program printed, in order."""
    return [sample for _, sample in find_samples(rows)]


def find_samples(rows: Iterable[OutputRow]) -> list[tuple[int, Sample]]:
    """Return the samples among the rows that a program printed, in order, each with the index of its row."""
    samples: list[tuple[int, Sample]] = []
    for number, row in enumerate(rows):
        if row.stream not in SAMPLE_STREAMS:
            continue
        parsed = parse_sample(row.text)
        if parsed is not None:
            name, value, time_s = parsed
            printed_s = row.time_ns / 1e9 if time_s is None else time_s
            sample = Sample(name, value, printed_s, row.time_ns, row.tick, row.line)
            samples.append((number, sample))
    return samples


def build_value_reader(condition: ValueCondition) -> Callable[[str], float | None]:
    """Return a function that takes a printed line, and returns the number in it that a condition tests.

    This is the number of a sample with the condition's name, or 1 for a line that matches its pattern. The function
    returns None for any other line.
    """
    if condition.source is ValueSource.PRINT:
        pattern = re.compile(condition.value)
        return lambda text: 1.0 if pattern.search(text) else None

    def number(text: str) -> float | None:
        sample = parse_sample(text)
        return sample[1] if sample is not None and condition.name in ("", sample[0]) else None

    return number


def select_rows(condition: ValueCondition, rows: Iterable[OutputRow]) -> Iterator[OutputRow]:
    """Yield the printed rows for which a condition is true.

    Raises:
        ValueError: the condition compares a sample with something that is not a number.
    """
    read = build_value_reader(condition)
    test = condition.test()
    before = math.nan
    for row in rows:
        value = read(row.text)
        if value is not None:
            if test(value, before):
                yield row
            before = value
