"""Lines in a log file as programs print them: names with numbers, behind times, levels of logging and other prefixes.

The printed lines of a run become samples in `engine/runs/samples.py`, which reads only the form `NAME: number [time]`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

from tuisim.engine.core.conditions import NUMBER
from tuisim.engine.runs.samples import parse_sample
from tuisim.logs.cells import UNIT
from tuisim.logs.choices import ReadChoices
from tuisim.logs.columns import COUNTS, NAMES, UNITS_S, parse_time_name
from tuisim.logs.dates import MOMENT, MONTH
from tuisim.logs.heading import BLANKS, SEPARATORS, parse_kinds, split_cells
from tuisim.logs.json_rows import ObjectReader, Row
from tuisim.logs.text_tables import CsvReader
from tuisim.logs.warnings import Notes

_LEVEL = r"(?:DEBUG|INFO|WARN(?:ING)?|ERROR|CRITICAL)"
_STAMPED = re.compile(
    rf"\s*(?:\[?{_LEVEL}\]?:? +|[DEIVW] (?=\())?"
    rf"(?:(?P<open>[\[(<])\s*)?(?:{MONTH} +\d{{1,2}} )?(?P<stamp>(?>{MOMENT})|(?>{NUMBER})"
    r"(?:\s?(?P<unit>[mu]?s)(?=\]))?)(?(open)\s*[\])>])"
    r"(?P<between>\s*(?::(?!\d\d[.;,\t])|->|=>|=|-(?= ))\s*| +|(?<=[\])>]))(?P<rest>\S.*?)\s*"
)
_PREFIX = re.compile(
    rf"\s*(?:>+|[^\W\d]\w*\((?=\w+=)|\[[^\]=]*\]:?|{_LEVEL}(?=[\s:])\s*:?|-(?=\s)|[\w.]+\s*:(?=\s*[^\W\d][\w.]*\s*[:=])"
    r"|[\w.]+\s+-(?=\s)|[\w.\-]+ [^\s:\[]+\[\d+\]:)\s*"
)
"""Matches what may stand before samples in a line: a prompt, the type of a printed object, brackets, a level of
`logging`, a logger's name, or what syslog writes.
"""
_VALUE = rf"(?:{NUMBER}|(?i:[+-]?(?:nan|inf(?:inity)?)|none|null|na)\b)"
"""Regular expression of a number, or of a word for a missing one, such as `nan` or `None`."""
_ITEM = re.compile(
    rf"((?!{_LEVEL}\s)[^\W\d][\w.\-/]*(?: [^\W\d][\w.\-/]*){{0,2}}?)\s*[:=]\s*({_VALUE})"
    rf"(?:\s*(?i:{UNIT})(?![\w.\-/%°]|\s*[:=]))?"
)
"""Matches a sample, which is a name with its number, and the unit that may follow."""
_ITEMS = re.compile(rf"(?:(?>{_ITEM.pattern})(?:[\s,;|)]+|$))+")
_TELEPLOT = re.compile(rf">?([^\W\d]\w*):(\d{{9,}}(?:\.\d+)?):({NUMBER})(?:[|\xa7].*)?")
"""Matches a line in the format of Teleplot: a name, a time in milliseconds, and a value."""
_VALUES = re.compile(rf"{_VALUE}(?:(?:\s*[,;]\s*|\s+){_VALUE})*")
_SEPARATORS = frozenset(SEPARATORS)
_SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")
_WORDS = re.compile(r"[\s,;:]+")
_TUPLE = re.compile(
    r"\s*(?:[A-Za-z_]*\((?P<tuple>[^=]*)\)|\[(?P<list>[^\[\]{}]*)\]|\|(?P<row>.*)\|)\s*,?"
)
_TIME_NAMES = frozenset(NAMES) - {*COUNTS}
_MAX_CHARACTERS = 4000
"""Largest number of characters of a line that is searched for samples; longer lines have none."""

Values = Sequence[tuple[str, float | str]]
"""Samples of a line: pairs of a name and a number, which may be still a text."""


class ProgramLine(NamedTuple):
    """A line that a program printed: its time, and its samples or numbers."""

    time: float | str | None
    """The time in seconds if the line gives it with its samples, or the text of the time at the line's beginning; None
    without a time.
    """
    samples: Values = ()
    rest: str = ""
    """The part of the line with numbers that have no names; empty if there are samples."""


def parse_line(line: str) -> ProgramLine | None:
    """Return the time and the samples or numbers in a line that a program printed.

    The result is None if the line has no samples, and no numbers after a time.
    """
    if len(line) > _MAX_CHARACTERS:
        return None
    if (sample := parse_sample(line)) is not None:
        return ProgramLine(sample[2], (sample[:2],))
    if (teleplot := _TELEPLOT.fullmatch(line.strip())) is not None:
        return ProgramLine(float(teleplot[2]) / 1000, ((teleplot[1], teleplot[3]),))
    time, rest, certain = _split_time(line.strip())
    if samples := _ITEM.findall(_strip_prefixes(rest, _ITEMS)):
        unit_s = _find_time_unit_s(samples[0][0]) if time is None and len(samples) > 1 else None
        if unit_s is not None:
            number = samples[0][1]
            seconds = float(number) * unit_s if re.fullmatch(NUMBER, number) else math.nan
            return ProgramLine(seconds, samples[1:])
        return ProgramLine(time, samples)
    # If it is not certain that the first number is a time, it may be a value: numbers are then not read.
    numbers = _strip_prefixes(rest, _VALUES) if certain else ""
    return ProgramLine(time, (), numbers) if numbers else None


@lru_cache(maxsize=100)
def _find_time_unit_s(name: str) -> float | None:
    """Return the unit in seconds if the name of a sample means a time; else None."""
    base, unit_s = parse_time_name(name)
    return unit_s or 1.0 if base in _TIME_NAMES else None


def _split_time(line: str) -> tuple[str | None, str, bool]:
    """Return the time with which a line may begin, the rest of the line, and whether the time certainly is one.

    Without a time, the first result is None, and the rest the whole line.
    """
    match = _STAMPED.fullmatch(line)
    if match is None:
        return None, line, False
    # If only blanks separate two numbers, they may be cells of a row, so the first is not certainly a time.
    stamp = match["stamp"]
    if match["unit"]:
        stamp = str(float(stamp.removesuffix(match["unit"])) * UNITS_S[match["unit"]])
    return stamp, match["rest"], bool(match["open"] or match["between"].strip())


def _strip_prefixes(text: str, pattern: re.Pattern[str]) -> str:
    """Return a text without the prefixes in front of the part that matches a pattern.

    A prefix is, for example, the time or the name that a logger writes before each line. The result is empty if no part
    matches.
    """
    while pattern.fullmatch(text) is None:
        prefix = _PREFIX.match(text)
        if prefix is None:
            return ""
        text = text[prefix.end() :]
    return text


def _is_row(line: str) -> bool:
    """Return whether a line looks like a row of a table: it has separators, or several numbers between blanks."""
    kinds = parse_kinds(split_cells(line, BLANKS))
    numbers = sum(kind in "nt" for kind in kinds)
    return not _SEPARATORS.isdisjoint(line) or numbers > 1 or (numbers == 1 and len(kinds) == 1)


def choose_reader(
    lines: Sequence[str], is_table: bool, notes: Notes, choices: ReadChoices
) -> CsvReader | ObjectReader | None:
    """Return a reader for a file of lines that a program printed; None if its first lines are of another kind.

    Args:
        lines: The first lines.
        is_table: Whether the file has the suffix of a table; its lines must then have times to be read as printed
            lines.
        notes: Receives warnings.
        choices: The user's choices for reading the file.
    """
    by_line = [parse_line(line) for line in lines]
    parsed = [line for line in by_line if line is not None]
    samples = [line for line in parsed if line.samples]
    numbers = len(parsed) - len(samples)
    stamped = sum(line.time is not None for line in parsed)
    if numbers >= len(samples):
        is_stamped = 2 * stamped > len(lines)
        tabs = replace(choices, separator="tab")
        return CsvReader(notes, tabs, _split_stamped) if is_stamped else None
    rows = sum(_is_row(text) for text, line in zip(lines, by_line, strict=True) if line is None)
    if len(parsed) <= rows or (is_table and 2 * stamped <= len(lines)):
        return None
    return ObjectReader(notes, _list_samples, "a sample", "samples")


def _list_samples(row: int, line: str) -> list[Row]:
    """Return the samples in a line as rows; their time is None if the line has none."""
    parsed = parse_line(line)
    if parsed is None:
        return []
    return [
        {"row": row, "variable": name, "value": value, "time": parsed.time}
        for name, value in parsed.samples
    ]


def has_tuples(lines: Sequence[str]) -> bool:
    """Return whether most of the lines are tuples or lists in Python's form, or rows between bars."""
    if len(lines) < 2 or lines[0].strip() == "[" or lines[0].lstrip().startswith(("[[", "[{")):
        return False
    return 2 * sum(_TUPLE.fullmatch(line) is not None for line in lines) > len(lines)


def strip_brackets(line: str) -> str:
    """Return a line that is a tuple or list without its brackets, or a row without its outer bars; others unchanged."""
    match = _TUPLE.fullmatch(line)
    return line if match is None else match["tuple"] or match["list"] or match["row"] or ""


def _split_stamped(line: str) -> str:
    """Return a line with tabs between its time and its numbers; for a heading, with tabs between the names.

    Other lines are returned unchanged.
    """
    parsed = parse_line(line)
    if parsed is not None and parsed.rest:
        return "\t".join((str(parsed.time), *_SEPARATOR.split(parsed.rest)))
    words = _WORDS.split(line.strip())
    return "\t".join(words) if parse_time_name(words[0]).base in NAMES else line
