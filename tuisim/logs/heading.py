"""Where the table is in a text: what stands above it, its heading, its separator and its kinds of cells."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from itertools import takewhile
from typing import NamedTuple

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted
from tuisim.engine.core.conditions import NUMBER
from tuisim.logs.arrow import make_names_unique
from tuisim.logs.cells import EMPTY_CELLS, MINUS, UNIT_WORDS, is_unit
from tuisim.logs.columns import parse_time_name
from tuisim.logs.dates import is_date, is_moment
from tuisim.logs.warnings import Notes

SEPARATORS = (";", "\t", "|", ",")
"""The separators of cells that a text can have besides blanks; the comma, which may be a part of a number, comes last.
"""
BLANKS = " "
"""Stands for a separator that is any number of blanks."""
SNIFFED_LINES = 400
"""Number of lines at the beginning of a text in which the heading of its table is looked for."""

_COMMENT_SIGNS = ("#", "%", "//", ";")
_EXCEL = re.compile(r"sep=(.)", re.IGNORECASE)
"""Matches the line `sep=;`, which may be the first one of a CSV file for Excel; the group is the separator."""
_WORD = re.compile(r'(?<!\S)"[^"]*"(?!\S)|\S+')
"""Matches a cell of a row whose cells are separated by blanks; a cell in quotes may contain blanks."""
_NUMBER = re.compile(
    rf"(?:{NUMBER}|[+-]?\d{{1,3}}(?:[.,' \xa0\u202f’]\d{{3}})+(?:[.,]\d+)?|[+-]?\d+,\d+(?:[eE][+-]?\d+)?)"
    r"\s*(?:%|°\w?|[A-Za-zµΩ]{1,3}(?:/[a-z]{1,3}²?)?)?"
    r"|0[xX][0-9a-fA-F]+|[+-]?(?:inf|infinity|nan)|true|false",
    re.IGNORECASE,
)
is_rule = re.compile(r"[\s|+:=_-]*(?:--|==|__)[\s|+:=_-]*").fullmatch
"""Matches a line drawn of signs between the heading and the rows."""
_MIN_PART = 10
"""The table of a text is the first run of rows alike that has at least a tenth of the rows of the longest run."""
_MAX_LINES, _MAX_JOINS = 100, 100
"""Maximum number of lines of a row with a quoted cell, and maximum number of failed attempts in a text to join lines to
such a row.
"""


@dataclass(frozen=True, slots=True)
class Heading:
    """The beginning of a table in a text: its first row, the names of its columns, and its separator."""

    names: tuple[str, ...] = ()
    """Names of the table's columns; empty if all lines were comments."""
    separator: str = ","
    """The separator of cells, one of `SEPARATORS`, or `BLANKS`."""
    has_comments: bool = False
    """Whether lines that begin with `#` are skipped."""
    rows_follow: int = 1
    """Number of the line, from 1, from which on the table's rows follow."""
    kinds: str = ""
    """A letter for the kind of each column's cells, such as `n` for numbers; see `parse_kinds`."""
    row: int = 0
    """Number of the line that has the names of the columns, from 1; 0 if there is none."""


class Row(NamedTuple):
    """A row of cells in a text."""

    line: int
    """Number of the row's first line in the file, from 1."""
    cells: list[str]

    @property
    def kinds(self) -> str:
        """The kinds of its cells, see `parse_kinds`."""
        return parse_kinds(self.cells)


class _Run(NamedTuple):
    """Consecutive rows with the same number and kinds of cells."""

    start: int
    length: int
    kinds: str

    @property
    def numbers(self) -> int:
        """The number of columns with numbers or times."""
        return sum(kind in "nt" for kind in self.kinds)

    @property
    def is_table(self) -> bool:
        """Whether there are several columns, and numbers."""
        return len(self.kinds) > 1 and self.numbers > 0

    @property
    def rank(self) -> tuple[int, ...]:
        """How certainly these are the rows of a table: ranks are compared, the most important number comes first."""
        words = self.kinds.count("w")
        return self.is_table, self.length, self.numbers, -words, len(self.kinds)


def parse_kinds(cells: Sequence[str]) -> str:
    """Return a letter for the kind of each cell: `n` for a number, `t` for a time, `-` for nothing, `w` for words."""
    return "".join(map(_classify_cell, cells))


def _classify_cell(cell: str) -> str:
    text = cell.strip().replace(MINUS, "-")
    if text in EMPTY_CELLS:
        return "-"
    if _NUMBER.fullmatch(text):
        return "n"
    if is_moment(text):
        return "t"
    return "w"


def find_heading(
    lines: Sequence[tuple[int, str]], notes: Notes, separator: str, header_row: int
) -> Heading:
    """Return where a table begins in the first lines of a text.

    Args:
        lines: The lines that are not blank, each with its number in the file.
        notes: Receives notes on the guesses.
        separator: One of `SEPARATORS` or `BLANKS`; empty to find it.
        header_row: Number of the line with the heading; 0 to find it.

    Raises:
        LogError: `header_row` is not the number of one of the lines.
    """
    if header_row:
        return _read_chosen(lines, notes, separator, header_row)
    if excel := _EXCEL.fullmatch(lines[0][1]):
        separator = separator or excel[1]
        lines = lines[1:]
    comments, lines = _split_comments(lines)
    # Only `#` marks comments below: a row of units, too, may begin with a percent sign.
    has_comments = bool(comments) and comments[0][1].startswith("#")
    if not lines:
        return Heading(has_comments=has_comments)
    separator = separator or sniff_separator([text for _, text in lines])
    rows = list(split_rows(lines, separator))
    rows = [*_read_comments(comments, rows[0], separator), *rows]
    run = _find_table(rows)
    # Rows directly above the typical ones belong to the table, too, even if one of their cells is of another kind.
    start = run.start
    while start and _is_row(rows[start - 1].kinds, run.kinds):
        start -= 1
    names, above = _find_names(rows[:start], run.kinds)
    if not names and not has_numbers(rows[start].kinds):
        # The first row has the names, although it looks like the rows below it.
        names = rows[start].cells
        start += 1
    _tell_unread(above, "above the table", notes)
    row = rows[len(above)].line if names else 0
    follow = rows[start].line if start < len(rows) else lines[-1][0] + 1
    names = names or _number_columns(rows[start].cells, notes)
    return Heading(_clean_names(names, notes), separator, has_comments, follow, run.kinds, row)


def _read_chosen(
    lines: Sequence[tuple[int, str]], notes: Notes, separator: str, header_row: int
) -> Heading:
    """Return the heading that is in a chosen line; the arguments are those of `find_heading`."""
    lines = [line for line in lines if line[0] >= header_row]
    if not lines or lines[0][0] != header_row:
        raise LogError(f"has no line {header_row} for --header", "lines count from 1")
    separator = separator or sniff_separator([text for _, text in lines])
    names, *rows = split_rows(lines, separator)
    run = _find_table(rows or [names])
    _tell_unread(rows[: run.start], "below the heading", notes)
    follow = rows[run.start].line if rows else header_row + 1
    return Heading(
        _clean_names(names.cells, notes), separator, False, follow, run.kinds, header_row
    )


def _split_comments(
    lines: Sequence[tuple[int, str]],
) -> tuple[Sequence[tuple[int, str]], Sequence[tuple[int, str]]]:
    """Return the comment lines above a table, and the other lines."""
    sign = next((sign for sign in _COMMENT_SIGNS if lines and lines[0][1].startswith(sign)), "")
    others = [line for line in lines if not line[1].startswith(sign)]
    if not sign or (sign in SEPARATORS and any(sign in text for _, text in others)):
        return (), lines
    comments = list(takewhile(lambda line: line[1].startswith(sign), lines))
    return comments, others if sign == "#" else lines[len(comments) :]


def _read_comments(
    comments: Sequence[tuple[int, str]], below: Row, separator: str
) -> Sequence[Row]:
    """Return the rows of a heading in the comments above a table: names, or names and units; empty if there is none.

    The heading is the last comment. If this has the units, the names are in the comment above it. A heading, such as
    `# time, distance`, has no numbers, and as many cells as the row below it.
    """
    rows = [
        Row(line, [name.strip() for name in split_cells(text.lstrip("#%/; \t"), separator)])
        for line, text in comments[-2:]
    ]
    fits = [len(row.cells) == len(below.cells) and is_words(row.kinds) for row in rows]
    if not fits or not fits[-1]:
        return ()
    return rows if all(fits) and _has_units(rows[-1].cells, rows[0]) else rows[-1:]


def _tell_unread(rows: Sequence[Row], where: str, notes: Notes) -> None:
    unread = f"{counted(len(rows), 'line')} {where} not read"
    notes.say_rows(unread, [row.line for row in rows])


def _clean_names(names: Sequence[str], notes: Notes) -> tuple[str, ...]:
    """Return column names without line breaks, changed to be unique."""
    return tuple(make_names_unique([" ".join(name.split()) for name in names], notes))


def split_cells(line: str, separator: str) -> list[str]:
    """Return the cells of a line; a quote that is not closed is an ordinary character."""
    if separator == BLANKS:
        return [word.strip('"') for word in _WORD.findall(line)]
    try:
        return next(csv.reader([close_quotes(line, separator)], delimiter=separator, strict=True))
    except (csv.Error, StopIteration):
        return line.split(separator)


def close_quotes(text: str, separator: str) -> str:
    """Return a text without the blanks between separators and the quotes around cells."""
    if '"' not in text:
        return text
    sign = re.escape(separator)
    return re.sub(rf'(?m)(?:^|(?<={sign}))[ \t]+(?=")|(?<=")[ \t]+(?={sign})', "", text)


def split_rows(lines: Sequence[tuple[int, str]], separator: str, width: int = 0) -> Iterator[Row]:
    """Yield the rows of a text. A quoted cell may span lines.

    Args:
        lines: Each with its number in the file; blank lines are skipped.
        separator: The separator of cells.
        width: Number of cells of a row; 0 for the number of cells of the next line.
    """
    # Searching for the end of each unclosed quote, an ordinary character, would be too slow.
    joins_left = _MAX_JOINS
    start = 0
    while start < len(lines):
        number, text = lines[start]
        cells: list[str] = []
        count = 1
        if text.count('"') % 2 and joins_left:
            texts = [text for _, text in lines[start : start + _MAX_LINES]]
            cells, count = _join_lines(texts, separator, width)
            joins_left -= not cells
        start += count
        if text.strip():
            yield Row(number, cells or split_cells(text, separator))


def _join_lines(texts: Sequence[str], separator: str, width: int) -> tuple[list[str], int]:
    """Return the cells of a row that spans several lines, and the number of these lines.

    There are no cells if the row does not span lines.
    """
    reader = csv.reader([text + "\n" for text in texts], delimiter=separator, strict=True)
    try:
        cells = next(reader)
    except csv.Error:
        return [], 1
    count = reader.line_num
    width = width or len(split_cells(texts[min(count, len(texts) - 1)], separator))
    inner = [text.split(separator) for text in texts[1:count]]
    has_rows = any(
        len(row) == width and ('"' not in separator.join(row) or parse_kinds(row[:1]) == "n")
        for row in inner
    )
    return ([], 1) if has_rows or not 1 < len(cells) == width else (cells, count)


def sniff_separator(lines: Sequence[str]) -> str:
    """Return the separator that splits lines into the cells of a table best: one of `SEPARATORS` or `BLANKS`."""
    runs = {
        sign: _find_table(list(split_rows(list(enumerate(lines)), sign)))
        for sign in (*SEPARATORS, BLANKS)
    }
    blanks = runs[BLANKS]
    # Without any number, the separator that all lines have equally often is the best.
    best = max(SEPARATORS, key=lambda sign: (len(runs[sign].kinds) > 1, runs[sign].rank))
    signs = runs[best]
    beats = best == "," and blanks.rank > signs.rank and _has_inner_commas(lines)
    if blanks.is_table and (beats or not signs.is_table) and 2 * blanks.length >= len(lines) - 1:
        return BLANKS
    if len(signs.kinds) > 1:
        return best
    return BLANKS if len(blanks.kinds) > 1 and blanks.length == len(lines) else ","


def _has_inner_commas(lines: Sequence[str]) -> bool:
    """Return whether, in at least half of the lines, all commas are inside of numbers and times."""
    outside = 0
    for line in lines:
        words = [word for word in split_cells(line, BLANKS) if "," in word]
        outside += "w" in parse_kinds(words)
    return 2 * outside <= len(lines)


def _find_table(rows: Sequence[Row]) -> _Run:
    """Return the run of rows that is the table.

    It is the first long run whose rows begin with a number or a time; without one, the run that most certainly is a
    table.
    """
    runs = list(_find_runs(rows))
    strong = [run for run in runs if run.kinds[0] in "nt" and run.is_table]
    longest = max((run.length for run in strong), default=0)
    best = max(runs, key=lambda run: (run.numbers > 0, run.rank[1:]))
    return next((run for run in strong if _MIN_PART * run.length >= longest), best)


def _find_runs(rows: Sequence[Row]) -> Iterator[_Run]:
    start = 0
    kinds = rows[0].kinds
    for index, row in enumerate(rows[1:], 1):
        both = _merge_kinds(kinds, row.kinds)
        if both is None:
            yield _Run(start, index - start, kinds)
            start = index
            both = row.kinds
        kinds = both
    yield _Run(start, len(rows) - start, kinds)


def _merge_kinds(kinds: str, others: str) -> str | None:
    """Return the kinds of the cells that two rows have in common, such as `tn` for `t-` and `tn`; None if they differ.

    An empty cell, `-`, can be of any kind.
    """
    pairs = list(zip(kinds, others, strict=False))
    if len(kinds) != len(others) or any(a != b and "-" not in (a, b) for a, b in pairs):
        return None
    return "".join(b if a == "-" else a for a, b in pairs)


def _is_row(kinds: str, usual: str) -> bool:
    if len(kinds) != len(usual) or kinds[0] not in (usual[0], "-"):
        return False
    return any(a == b and a in "nt" for a, b in zip(kinds, usual, strict=True))


def has_numbers(kinds: str) -> bool:
    """Return whether at least one cell of some kinds is a number or a time."""
    return not {"n", "t"}.isdisjoint(kinds)


def is_words(kinds: str) -> bool:
    """Return whether cells of some kinds can be names: there are words, and no numbers."""
    return "w" in kinds and "n" not in kinds


def _find_names(above: Sequence[Row], usual: str) -> tuple[Sequence[str], Sequence[Row]]:
    """Return the names of a table's columns, empty if the rows above it have none, and the rows above the names.

    Args:
        above: The rows above the table.
        usual: The kinds of the table's typical rows.
    """
    if not above:
        return (), above
    width = len(usual)
    *before, names = (_leave_out_settings(row, usual) for row in above)
    if before and _has_gaps(names, before[-1]):
        names = before.pop()
    count = len(names.cells)
    if not is_words(names.kinds):
        return (), above
    if count == width:
        if before and len(before[-1].cells) == width and _has_units(names.cells, before[-1]):
            titles = before.pop()
            return list(map(_join_unit, titles.cells, names.cells)), before
        return names.cells, before
    if count > 1 and abs(count - width) == 1:
        # R writes no name above the names of rows, and some programs end each row with a separator.
        if count > width or usual[-1] == "-":
            return names.cells, before
        if not before and usual[0] != "t":
            return ["", *names.cells], before
    return (), above


def _leave_out_settings(row: Row, usual: str) -> Row:
    """Take a row above a table; return it without the numbers that are settings, such as a sampling period.

    These are the numbers above columns that are empty in the table. Empty cells beyond the width of the table are left
    out, too.

    Args:
        row: The row.
        usual: The kinds of the table's typical rows.
    """
    width = len(usual)
    if len(row.cells) < width or set(row.kinds[width:]) - {"-"}:
        return row
    triples = zip(row.cells, row.kinds, usual, strict=False)
    cells = ["" if (kind, below) == ("n", "-") else cell for cell, kind, below in triples]
    return row._replace(cells=cells)


def _join_unit(name: str, unit: str) -> str:
    """Return the name of a column with a unit in brackets after it, such as `distance [mm]`.

    The name is unchanged if it has a unit already, or if the cell below it has none.

    Args:
        name: The name.
        unit: The cell below the name, in which some files have the unit.
    """
    name = name.strip()
    unit = unit.strip(" ()[]")
    has_unit = (
        unit in ("", "-", "1")
        or name.endswith((")", "]"))
        or parse_time_name(name).unit_s is not None
    )
    return name if has_unit else f"{name} [{unit}]"


def _has_gaps(row: Row, names: Row) -> bool:
    """Return whether a row below the names of columns has words under some of them, and empty cells under the others.

    Such words may say how a column was averaged. Units do not count.
    """
    are_names = len(names.cells) == len(row.cells) and set(names.kinds) == {"w"}
    return are_names and set(row.kinds) == {"w", "-"} and not _has_units(row.cells, names)


def _has_units(cells: Sequence[str], names: Row) -> bool:
    units = [cell.strip(" ()[]").lower() for cell in cells]
    are_units = all(is_unit(unit) or unit in UNIT_WORDS or unit in "-1" for unit in units)
    return is_words(names.kinds) and any(units) and are_units


def _number_columns(cells: Sequence[str], notes: Notes) -> list[str]:
    """Return names for columns without a heading, such as `date`, `time`, `column 3`.

    The first date and the first time get these names.

    Args:
        cells: The cells of the first row.
        notes: Receives a note about the names.
    """
    notes.say("no header: the columns are numbered")
    names: list[str] = []
    for number, cell in enumerate(cells, 1):
        if not is_moment(cell):
            name = ""
        elif is_date(cell):
            name = "date"
        else:
            name = "time"
        names.append(name if name and name not in names else f"column {number}")
    return names
