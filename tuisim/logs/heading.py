"""Where the table is in a text: what stands above it, its heading, its separator and its kinds of cells."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from itertools import starmap, takewhile
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
"""The comma, which may be a part of a number, comes last."""
BLANKS = " "
"""A separator of any number of blanks."""
SNIFFED_LINES = 400
"""Lines from the beginning of a text in which its table is looked for."""

_COMMENT_SIGNS = ("#", "%", "//", ";")
_EXCEL = re.compile(r"sep=(.)", re.IGNORECASE)
"""The first line of a CSV file for Excel."""
_WORD = re.compile(r'(?<!\S)"[^"]*"(?!\S)|\S+')
"""A cell between blanks."""
_NUMBER = re.compile(
    rf"(?:{NUMBER}|[+-]?\d{{1,3}}(?:[.,' \xa0\u202f’]\d{{3}})+(?:[.,]\d+)?|[+-]?\d+,\d+(?:[eE][+-]?\d+)?)"
    r"\s*(?:%|°\w?|[A-Za-zµΩ]{1,3}(?:/[a-z]{1,3}²?)?)?"
    r"|0[xX][0-9a-fA-F]+|[+-]?(?:inf|infinity|nan)|true|false",
    re.IGNORECASE,
)
is_rule = re.compile(r"[\s|+:=_-]*(?:--|==|__)[\s|+:=_-]*").fullmatch
"""Matches a line drawn of signs between the heading and the rows."""
_MIN_PART = 10
"""The table has at least one row for this many of the longest run of rows alike."""
_MAX_LINES, _MAX_JOINS = 100, 100
"""Maximum lines of a quoted row, and maximum failed attempts to join lines."""


@dataclass(frozen=True, slots=True)
class Heading:
    """The beginning of a table in a text: its first row, the names of its columns, and its separator."""

    names: tuple[str, ...] = ()
    """Names of the columns; empty if there were only comments."""
    separator: str = ","
    """One of `SEPARATORS`, or `BLANKS`."""
    has_comments: bool = False
    """Whether lines that begin with `#` are skipped."""
    rows_follow: int = 1
    """Line of the file where the table's first row may be."""
    kinds: str = ""
    """For each column a letter as `parse_kinds` returns them."""
    row: int = 0
    """Line of the file with the names, 0 if there is none."""


class _Line(NamedTuple):
    row: int
    """Line of the file, from 1."""
    cells: list[str]
    kinds: str
    next_row: int
    """Line of the file that follows."""


class _Rank(NamedTuple):
    """How certainly some lines are the rows of a table.

    Ranks are compared by their fields, the most important first.
    """

    is_table: bool
    """Whether there are several columns, and numbers."""
    length: int
    numbers: int
    """Columns with numbers or times."""
    words: int
    """Columns with words, negative: the fewer, the better."""
    width: int


class _Run(NamedTuple):
    """Consecutive lines with the same number and kinds of cells."""

    start: int
    length: int
    kinds: str

    @property
    def rank(self) -> _Rank:
        """How certainly these lines are the rows of a table."""
        numbers = sum(kind in "nt" for kind in self.kinds)
        words = -self.kinds.count("w")
        width = len(self.kinds)
        return _Rank(width > 1 and numbers > 0, self.length, numbers, words, width)


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
    comments: Sequence[tuple[int, str]] = ()
    if header_row:
        lines = _skip_to(lines, header_row)
    else:
        separator, lines = _read_excel_line(lines, separator)
        comments, lines = _split_comments(lines)
    # Only `#` marks comments below: a row of units, too, may begin with a percent sign.
    has_comments = bool(comments) and comments[0][1].startswith("#")
    if not lines:
        return Heading(has_comments=has_comments)
    separator = separator or sniff_separator([text for _, text in lines])
    table = _split_lines(lines, separator)
    if header_row:
        run = _find_table(table[1:] or table)
        start = min(1 + run.start, len(table))
        names: Sequence[str] | None = table[0].cells
        row = header_row
        _tell_unread(table[1:start], "below the heading", notes)
    else:
        table = [*_read_comments(comments, table[0], separator), *table]
        run = _find_table(table)
        start = _find_first_row(table, run)
        names, above, start = _find_names(table, table[:start], start, run)
        row = table[len(above)].row
        _tell_unread(above, "above the table", notes)
    if names is None:
        names = _number_columns(table[start].cells, notes)
        row = 0
    follow = table[start].row if start < len(table) else table[-1].next_row
    return Heading(_clean_names(names, notes), separator, has_comments, follow, run.kinds, row)


def _skip_to(lines: Sequence[tuple[int, str]], row: int) -> Sequence[tuple[int, str]]:
    """Return the lines of a file from a line number on.

    Args:
        lines: Lines, each with its number in the file.
        row: The number of the first line to return.

    Raises:
        LogError: no line has that number.
    """
    lines = [line for line in lines if line[0] >= row]
    if not lines or lines[0][0] != row:
        raise LogError(f"has no line {row} for --header", "lines count from 1")
    return lines


def _read_excel_line(
    lines: Sequence[tuple[int, str]], separator: str
) -> tuple[str, Sequence[tuple[int, str]]]:
    """Return the separator, and the lines without a first line such as `sep=;`, in which Excel gives the separator."""
    excel = _EXCEL.fullmatch(lines[0][1])
    return (separator or excel[1], lines[1:]) if excel else (separator, lines)


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


def _read_comment(comment: tuple[int, str], below: _Line, separator: str) -> _Line | None:
    """Return the comment above a table as the heading with the names of the columns, such as `# time, distance`.

    The result is None if the comment has numbers, or not the same number of cells as the line below it.

    Args:
        comment: Line number and text.
        below: The next line.
        separator: The separator of cells.
    """
    row, text = comment
    names = [name.strip() for name in split_cells(text.lstrip("#%/; \t"), separator)]
    kinds = parse_kinds(names)
    is_heading = len(names) == len(below.cells) and is_words(kinds)
    return _Line(row, names, kinds, below.row) if is_heading else None


def _read_comments(
    comments: Sequence[tuple[int, str]], below: _Line, separator: str
) -> list[_Line]:
    """Return the lines of a heading in the comments above a table: names, or names and units; empty if there is none.

    The heading is the last comment. If this has the units, the names are in the comment above it.
    """
    headings = [_read_comment(comment, below, separator) for comment in comments[-2:]]
    match headings:
        case [_Line() as names, _Line() as units] if _has_units(units.cells, names):
            return [names, units]
        case [*_, _Line() as names]:
            return [names]
    return []


def _tell_unread(lines: Sequence[_Line], where: str, notes: Notes) -> None:
    unread = f"{counted(len(lines), 'line')} {where} not read"
    notes.say_rows(unread, [line.row for line in lines])


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


def _split_lines(lines: Sequence[tuple[int, str]], separator: str) -> list[_Line]:
    return [
        _Line(row, cells, parse_kinds(cells), next_row)
        for row, cells, next_row in split_rows(lines, separator, 0)
    ]


def split_rows(
    lines: Sequence[tuple[int, str]], separator: str, width: int
) -> Iterator[tuple[int, list[str], int]]:
    """Yield for each row its line number, its cells, and the line number of the next row.

    A quoted cell may span lines.

    Args:
        lines: Each with its number in the file; blank lines are skipped.
        separator: The separator of cells.
        width: Number of cells of a row; 0 for the number of cells of the next line.
    """
    # Searching for the end of each unclosed quote, an ordinary character, would be too slow.
    joins_left = _MAX_JOINS
    start = 0
    while start < len(lines):
        row, text = lines[start]
        cells: list[str] = []
        stop = start + 1
        if text.count('"') % 2 and joins_left:
            cells, stop = _join_lines(lines, start, separator, width)
            joins_left -= not cells
        start = stop
        if text.strip():
            next_row = lines[stop][0] if stop < len(lines) else row + 1
            yield row, cells or split_cells(text, separator), next_row


def _join_lines(
    lines: Sequence[tuple[int, str]], start: int, separator: str, width: int
) -> tuple[list[str], int]:
    """Return the cells of a row that spans several lines, and the index of the line after it.

    There are no cells if the row does not span lines.
    """
    texts = [text for _, text in lines[start : start + _MAX_LINES]]
    reader = csv.reader([text + "\n" for text in texts], delimiter=separator, strict=True)
    try:
        cells = next(reader)
    except csv.Error:
        return [], start + 1
    count = reader.line_num
    width = width or len(split_cells(texts[min(count, len(texts) - 1)], separator))
    inner = [text.split(separator) for text in texts[1:count]]
    has_rows = any(
        len(row) == width and ('"' not in separator.join(row) or parse_kinds(row[:1]) == "n")
        for row in inner
    )
    return ([], start + 1) if has_rows or not 1 < len(cells) == width else (cells, start + count)


def sniff_separator(lines: Sequence[str]) -> str:
    """Return the separator that splits lines into the cells of a table best: one of `SEPARATORS` or `BLANKS`."""
    ranks = {sign: _rank_separator(lines, sign) for sign in (*SEPARATORS, BLANKS)}
    # Without any number, the separator that all lines have equally often is the best.
    best = max(SEPARATORS, key=lambda sign: (ranks[sign].width > 1, ranks[sign]))
    signs = ranks[best]
    blanks = ranks[BLANKS]
    beats = best == "," and blanks > signs and _has_inner_commas(lines)
    if blanks.is_table and (beats or not signs.is_table) and 2 * blanks.length >= len(lines) - 1:
        return BLANKS
    if signs.width > 1:
        return best
    return BLANKS if blanks.width > 1 and blanks.length == len(lines) else ","


def _rank_separator(lines: Sequence[str], separator: str) -> _Rank:
    return _find_table(_split_lines(list(enumerate(lines)), separator)).rank


def _has_inner_commas(lines: Sequence[str]) -> bool:
    """Return whether, in at least half of the lines, all commas are inside of numbers and times."""
    outside = 0
    for line in lines:
        words = [word for word in split_cells(line, BLANKS) if "," in word]
        outside += "w" in parse_kinds(words)
    return 2 * outside <= len(lines)


def _find_table(table: Sequence[_Line]) -> _Run:
    """Return the run of lines that is the table.

    It is the first long run whose rows begin with a number or a time; without one, the run that most certainly is a
    table.
    """
    runs = list(_find_runs(table))
    best = max(runs, key=lambda run: run.rank._replace(is_table=run.rank.numbers > 0))
    strong = [run for run in runs if run.kinds[0] in "nt" and run.rank.is_table]
    longest = max((run.length for run in strong), default=0)
    return next((run for run in strong if _MIN_PART * run.length >= longest), best)


def _find_runs(table: Sequence[_Line]) -> Iterator[_Run]:
    start = 0
    kinds = table[0].kinds
    for index, line in enumerate(table[1:], 1):
        both = _merge_kinds(kinds, line.kinds)
        if both is None:
            yield _Run(start, index - start, kinds)
            start = index
            both = line.kinds
        kinds = both
    yield _Run(start, len(table) - start, kinds)


def _merge_kinds(kinds: str, others: str) -> str | None:
    """Return the kinds of the cells that two lines have in common, such as `tn` for `t-` and `tn`; None if they differ.

    An empty cell, `-`, can be of any kind.
    """
    pairs = list(zip(kinds, others, strict=False))
    if len(kinds) != len(others) or any(a != b and "-" not in (a, b) for a, b in pairs):
        return None
    return "".join(b if a == "-" else a for a, b in pairs)


def _find_first_row(table: Sequence[_Line], run: _Run) -> int:
    """Return the index of the table's first row, given the run of its typical rows.

    Lines directly above the run are rows of the table, too, even if one of their cells is of another kind.
    """
    start = run.start
    while start and _is_row(table[start - 1].kinds, run.kinds):
        start -= 1
    return start


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


def _find_names(
    table: Sequence[_Line], above: list[_Line], start: int, run: _Run
) -> tuple[list[str] | None, list[_Line], int]:
    """Return the names of a table's columns, the lines above its heading, and the index of its first row.

    The names are None if the table has no heading.

    Args:
        table: The lines of the table.
        above: The lines above it.
        start: The index of the first line that may be a row.
        run: The table's typical rows.
    """
    width = len(run.kinds)
    above = [_leave_out_settings(line, run.kinds) for line in above]
    if above:
        *before, last = above
        if before and _has_gaps(last, before[-1]):
            *before, last = before
        if len(last.kinds) == width and is_words(last.kinds):
            if before and len(before[-1].kinds) == width and _has_units(last.cells, before[-1]):
                pairs = zip(before[-1].cells, last.cells, strict=True)
                return list(starmap(_join_unit, pairs)), before[:-1], start
            return last.cells, before, start
        if is_words(last.kinds) and len(last.kinds) > 1 and abs(len(last.kinds) - width) == 1:
            # R writes no name above the names of rows, and some programs end each row with a separator.
            if len(last.kinds) > width or run.kinds[-1] == "-":
                return last.cells, before, start
            if not before and run.kinds[0] != "t":
                return ["", *last.cells], before, start
        if not is_words(table[start].kinds):
            return None, above, start
    rows = table[start:]
    if _has_names(rows):
        return rows[0].cells, above, start + 1
    return None, above, start


def _leave_out_settings(line: _Line, usual: str) -> _Line:
    """Take a line above a table; return it without the numbers that are settings, such as a sampling period.

    These are the numbers above columns that are empty in the table. Empty cells beyond the width of the table are left
    out, too.

    Args:
        line: The line.
        usual: The kinds of the table's typical rows.
    """
    width = len(usual)
    if len(line.kinds) < width or set(line.kinds[width:]) - {"-"}:
        return line
    triples = zip(line.cells, line.kinds, usual, strict=False)
    cells = ["" if (kind, below) == ("n", "-") else cell for cell, kind, below in triples]
    return line._replace(cells=cells, kinds=parse_kinds(cells))


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


def _has_gaps(line: _Line, names: _Line) -> bool:
    """Return whether a line below the names of columns has words under some of them, and empty cells under the others.

    Such words may say how a column was averaged. Units do not count.
    """
    are_names = len(names.kinds) == len(line.kinds) and set(names.kinds) == {"w"}
    return are_names and set(line.kinds) == {"w", "-"} and not _has_units(line.cells, names)


def _has_units(cells: Sequence[str], names: _Line) -> bool:
    units = [cell.strip(" ()[]").lower() for cell in cells]
    are_units = all(is_unit(unit) or unit in UNIT_WORDS or unit in "-1" for unit in units)
    return is_words(names.kinds) and any(units) and are_units


def _has_names(rows: Sequence[_Line]) -> bool:
    """Return whether the first of some rows has the names of the columns, although it looks like the rows below it."""
    return not has_numbers(rows[0].kinds)


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
