"""Lines that begin with a time, such as `[07-04-2023 / 16:02:52] : 5` or `16:02:52 Colour: 5`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import NamedTuple

import pyarrow as pa

from tuisim.logs.blocks import Block
from tuisim.logs.columns import NAMES, time_name
from tuisim.logs.dates import MOMENT
from tuisim.logs.text_tables import CsvReader, Heading, PrintedReader
from tuisim.logs.warnings import Notes
from tuisim.runs.samples import parse_sample

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_STAMPED = re.compile(
    rf"\s*(?:(?P<open>[\[(<])\s*)?(?P<stamp>(?>{MOMENT})|(?>{_NUMBER}))(?:\s*(?P<close>[\])>]))?"
    r"(?P<between>\s*(?::|->|=>|=|-(?= ))\s*| +|(?<=[\])>]))(?P<rest>\S.*?)\s*"
)
_LEVEL = re.compile(
    r"\[?(?:DEBUG|INFO|WARN(?:ING)?|ERROR|CRITICAL)\]?\s*:?\s*(?:[\w.]+:\s*(?=\w+:))?"
)
"""Level of Python's `logging`, and the name of the logger."""
_NAME = re.compile(r"([^\W\d]\w*)\s*[:=]\s*")
_VALUES = re.compile(rf"{_NUMBER}(?:(?:\s*[,;]\s*|\s+){_NUMBER})*")
_SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")
_WORDS = re.compile(r"[\s,;:]+")


class Stamped(NamedTuple):
    """A line that begins with a time."""

    time: str
    rest: str
    """A sample, or numbers."""
    is_sample: bool


def parse_stamped(line: str) -> Stamped | None:
    """Return the time of a line and what follows it; None without a time, or if no value follows."""
    found = _STAMPED.fullmatch(line)
    if found is None or (found["open"] is None) != (found["close"] is None):
        return None
    if found["open"] is None and ":" not in found["between"] and _is_number(found["stamp"]):
        # Of two numbers, the first need not be a time.
        return None
    rest = _LEVEL.sub("", found["rest"], 1)
    rest = _NAME.sub(r"\1: ", rest, 1) if _NAME.match(rest) else rest
    is_sample = parse_sample(rest) is not None
    return (
        Stamped(found["stamp"], rest, is_sample) if is_sample or _VALUES.fullmatch(rest) else None
    )


def looks_stamped(lines: Sequence[str]) -> bool:
    """Return whether more than half of the lines begin with a time, and are not a table with a heading."""
    stamped = [parse_stamped(line) is not None for line in lines]
    with_heading = (
        len(lines) > 1 and not stamped[0] and len(lines[0].split()) == len(lines[1].split())
    )
    return 2 * sum(stamped) > len(lines) and not with_heading


def reader_of_stamped(lines: Sequence[str], notes: Notes) -> StampedReader | PrintedReader:
    """Return what reads a file with these first lines."""
    found = [one for one in map(parse_stamped, lines) if one is not None]
    if 2 * sum(one.is_sample for one in found) <= len(found):
        return StampedReader(lines, notes)
    if all(_is_number(one.time) for one in found):
        return PrintedReader(notes, _numbered_sample)
    return PrintedReader(notes, _stamped_sample, pa.string())


def _is_number(time: str) -> bool:
    return re.fullmatch(_NUMBER, time) is not None


def _stamped_sample(line: str) -> tuple[str, float, str | None] | None:
    stamped = parse_stamped(line)
    sample = parse_sample(line if stamped is None else stamped.rest)
    return sample and (*sample[:2], None if stamped is None else stamped.time)


def _numbered_sample(line: str) -> tuple[str, float, float | None] | None:
    sample = _stamped_sample(line)
    return sample and (
        *sample[:2],
        float(sample[2]) if sample[2] is not None and _is_number(sample[2]) else None,
    )


class StampedReader:
    """Reads blocks of one file with numbers behind the times.

    Args:
        lines: First lines of the file, at least one of them with a time.
    """

    def __init__(self, lines: Sequence[str], notes: Notes) -> None:
        at, first = next(
            (at, one) for at, line in enumerate(lines) if (one := parse_stamped(line)) is not None
        )
        width = 1 + len(_SEPARATOR.split(first.rest))
        words = _WORDS.split(lines[at - 1].strip()) if at else []
        self._heading = (
            lines[at - 1] if len(words) == width and time_name(words[0]).base in NAMES else ""
        )
        if not self._heading:
            # A number may be a time or not, which the column then shows.
            words = ["column 1" if _is_number(first.time) else "time"]
            words += [f"column {number}" for number in range(2, width + 1)]
            notes.say("no header: the columns after the time are numbered")
        self._notes, self._table = notes, CsvReader(notes, Heading(tuple(words), "\t"))

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it has none."""
        rows, others = [], []
        for row, line in enumerate(block.text.decode("utf-8").split("\n"), block.first_row):
            stamped = parse_stamped(line)
            if stamped is not None and not stamped.is_sample:
                rows.append("\t".join((stamped.time, *_SEPARATOR.split(stamped.rest))))
                continue
            rows.append("")
            if line.strip() and line.rstrip("\r") != self._heading and not line.startswith("#"):
                others.append(row)
        self._notes.add(
            "line is not a time with a value", "lines are not times with values", others
        )
        return self._table.read(Block(block.first_row, "\n".join(rows).encode(), block.newline))
