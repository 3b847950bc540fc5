"""The first lines of a table as text: comments, heading, and what separates the cells."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, takewhile

from tuisim.datalog.opening.headings import unique_names
from tuisim.datalog.opening.notes import Notes
from tuisim.datalog.opening.numbers import are_numbers
from tuisim.datalog.opening.plain import texts_array

SEPARATORS = (",", ";", "\t", "|")
BLANKS = " "
"""Instead of a separator: any blanks are one."""
COMMENT = "#"
_YEARS = range(1900, 2101)


@dataclass(frozen=True, slots=True)
class Heading:
    """What the first lines say about a table."""

    names: tuple[str, ...] = ()
    """Of the columns; none if there was nothing but comments."""
    separator: str = ","
    """One of `SEPARATORS`, or `BLANKS`."""
    decimal_comma: bool = False
    has_comments: bool = False
    """Whether lines that begin with `COMMENT` are no rows."""
    rows_follow: int = 1
    """Row of the file that the first row of the table may stand in."""


def find_heading(lines: Sequence[tuple[int, str]], notes: Notes) -> Heading:
    """Return the heading of a table.

    Args:
        lines: The first lines that are not blank, each with its row in the file.
        notes: Where it says what was guessed.
    """
    comments = [text for _, text in takewhile(lambda line: line[1].startswith(COMMENT), lines)]
    body = lines[len(comments) :]
    if not body:
        return Heading(has_comments=bool(comments))
    texts = [text for _, text in body]
    fields = next((text for text in reversed(comments) if text.startswith("#fields")), "")
    separator = _zeek_separator(comments) if fields else sniff_separator(texts)
    decimal_comma = separator == ";" and _has_decimal_comma(texts[1:])
    rows = [cells_of(text, separator) for text in texts]
    above = _heading_above(comments, rows, separator, fields)
    if above:
        names, follow = above, body[0][0]
    elif _is_heading(rows, decimal_comma):
        names, follow = [name.strip() for name in rows[0]], body[0][0] + 1
    else:
        notes.say("no heading: the columns are numbered")
        names, follow = [f"column {at}" for at in range(1, len(rows[0]) + 1)], body[0][0]
    return Heading(tuple(unique_names(names, notes)), separator, decimal_comma, bool(comments), follow)


def cells_of(line: str, separator: str) -> list[str]:
    """Return the cells of a line; a quote that is never closed is but a character."""
    if separator == BLANKS:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator, strict=True))
    except (csv.Error, StopIteration):
        return line.split(separator)


def sniff_separator(lines: Sequence[str]) -> str:
    """Return what separates the cells: what most lines have as often as the first, then what most have equally often.

    Blanks separate only where nothing else does, and only if all lines have equally many cells.
    """

    def evenness(separator: str) -> tuple[int, int, int]:
        counts = Counter(line.count(separator) for line in lines)
        as_first = counts[wanted] if (wanted := lines[0].count(separator)) else 0
        counts.pop(0, None)
        if not counts:
            return 0, 0, 0
        number, times = counts.most_common(1)[0]
        return as_first, times, number

    best = max(SEPARATORS, key=evenness)
    if evenness(best) > (0, 0, 0):
        return best
    widths = {len(line.split()) for line in lines}
    return BLANKS if len(widths) == 1 and min(widths) > 1 and len(lines) > 1 else ","


def _zeek_separator(comments: Sequence[str]) -> str:
    """What a log of Zeek names as its separator, such as `#separator \\x09`."""
    named = next((text.split(maxsplit=1)[-1] for text in comments if text.startswith("#separator")), r"\x09")
    found = re.fullmatch(r"\\x([0-9a-fA-F]{2})", named)
    separator = chr(int(found[1], 16)) if found else named
    return separator if separator in SEPARATORS else "\t"


def _heading_above(comments: Sequence[str], rows: Sequence[list[str]], separator: str, fields: str) -> list[str]:
    """Names in the last comment, none if it is no heading: as many as there are cells, and all rows are alike."""
    if fields:
        return [name.strip() for name in fields.split(separator)[1:]]
    if not comments:
        return []
    text = comments[-1].lstrip(COMMENT).strip()
    names = [name.strip() for name in cells_of(text, separator)]
    if len(names) != len(rows[0]):
        names = text.split()
    alike = len(rows) < 2 or _are_numeric(rows[0]) == _are_numeric(rows[1])
    return names if len(names) == len(rows[0]) and alike and not all(_are_numeric(names)) else []


def _are_numeric(cells: Sequence[str], decimal_comma: bool = False) -> list[bool | None]:
    """Whether each cell is a number, None where it is empty."""
    return [are_numbers(texts_array([cell]), decimal_comma) for cell in cells]


def _is_heading(rows: Sequence[list[str]], decimal_comma: bool) -> bool:
    """Whether the first row names the columns: few of its cells are numbers, or these count something up."""
    first = _are_numeric(rows[0], decimal_comma)
    numbers = [int(cell) for cell in rows[0][1:] if re.fullmatch(r"\s*\d+\s*", cell)]
    if first[0] is False and len(numbers) == len(first) - 1 > 0 and all(a < b for a, b in pairwise(numbers)):
        below = {_are_numeric(row[:1], decimal_comma)[0] for row in rows[1:]}
        if (True in below and False not in below) or all(number in _YEARS for number in numbers):
            return True
    return not are_numbers(texts_array(rows[0]), decimal_comma)


def _has_decimal_comma(lines: Sequence[str]) -> bool:
    cells = [cell.strip() for line in lines for cell in line.split(";")]
    with_comma = sum(cell.count(",") == 1 and cell.replace(",", "").lstrip("+-").isdigit() for cell in cells)
    return with_comma > 0 and not any(cell.count(".") == 1 and cell.replace(".", "").isdigit() for cell in cells)
