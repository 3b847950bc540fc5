"""Tables in text: CSV with its comments, header, separators and typed cells; JSON objects; printed samples."""

from __future__ import annotations

import csv
import io
import json
import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice, pairwise, takewhile
from typing import Any, TypeGuard

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from tuisim.core.conditions import NUMBER
from tuisim.data_class import dataclass
from tuisim.errors import LogError
from tuisim.logs.arrow import texts_array, unique_names
from tuisim.logs.blocks import Block
from tuisim.logs.csv_cells import WRITTEN, restored
from tuisim.logs.dates import is_date, is_moment
from tuisim.logs.units import TEXT, TIMEDELTA
from tuisim.logs.warnings import Notes
from tuisim.runs.samples import parse_sample

CODED = pa.dictionary(pa.int32(), pa.string())
"""Dictionary-encoded text."""

_LEAST_REPEATED = 4
"""Texts are dictionary-encoded if each occurs at least this often, on average."""
_FEWEST_CELLS = 100
"""With fewer cells, texts are not dictionary-encoded."""


def text_kind(cells: pa.Array) -> pa.DataType:
    """Return the type for a text column, from its first cells."""
    often = len(cells) > _FEWEST_CELLS and _LEAST_REPEATED * pc.count_distinct(
        cells
    ).as_py() <= len(cells)
    return CODED if often else pa.string()


_NUMBER = rf"^{NUMBER}$|^[+-]?(?i:inf|infinity|nan)$"
EMPTY_CELLS = ("", "NA", "N/A", "null", "None", "-")
"""Cells that mean a missing value."""


def parsed_numbers(cells: pa.Array, decimal_comma: bool) -> tuple[pa.Array, pa.Array]:
    """Parse cells as float64, with nulls for those that are not numbers.

    Args:
        cells: Texts.
        decimal_comma: Whether `1,5` is one and a half.

    Returns:
        Numbers, and a mask of the cells that are neither a number nor empty.
    """
    texts: Any = pc.utf8_trim_whitespace(cells)
    if decimal_comma:
        texts = pc.replace_substring(texts, ",", ".")
    nothing = pa.nulls(len(texts), pa.string())
    empty = pc.or_(pc.is_null(texts), pc.is_in(texts, value_set=texts_array(EMPTY_CELLS)))
    texts = pc.if_else(empty, nothing, texts)
    try:
        return pc.cast(texts, pa.float64()), pc.is_valid(nothing)
    except pa.ArrowInvalid:
        # For empty cells, false and null give false.
        good = pc.and_kleene(pc.is_valid(texts), pc.match_substring_regex(texts, _NUMBER))
        wrong = pc.and_(pc.invert(good), pc.invert(empty))
        return pc.cast(pc.if_else(good, texts, nothing), pa.float64()), wrong


def parsed_booleans(cells: pa.Array) -> tuple[pa.Array, pa.Array]:
    """Parse cells such as `true` or `False`, with nulls for others; also return a mask of the invalid cells."""
    texts: Any = pc.utf8_lower(pc.utf8_trim_whitespace(cells))
    known = pc.is_in(texts, value_set=texts_array(("true", "false")))
    empty = pc.or_(
        pc.is_null(cells),
        pc.is_in(pc.utf8_trim_whitespace(cells), value_set=texts_array(EMPTY_CELLS)),
    )
    values = pc.if_else(known, pc.equal(texts, "true"), pa.nulls(len(texts), pa.bool_()))
    return values, pc.invert(pc.or_(known, empty))


def are_booleans(cells: pa.Array) -> bool:
    """Return whether all cells that are not empty are true or false, and there is at least one."""
    values, wrong = parsed_booleans(cells)
    return values.null_count < len(values) and not pc.any(wrong).as_py()


def are_numbers(cells: pa.Array, decimal_comma: bool) -> bool | None:
    """Return whether most of the cells are numbers, None if all are empty."""
    numbers, wrong = parsed_numbers(cells, decimal_comma)
    good, bad = len(numbers) - numbers.null_count, pc.sum(wrong).as_py() or 0
    if not good and not bad:
        return None
    return bool(good > bad)


SEPARATORS = (",", ";", "\t", "|")
BLANKS = " "
"""A separator of any number of blanks."""
COMMENT = "#"
_ZEEK = re.compile(r"#separator \\x[0-9a-fA-F]{2}")
"""The first line of a Zeek log."""
_YEARS = range(1900, 2101)


@dataclass(frozen=True, slots=True)
class Heading:
    """The format of a table, from its first lines."""

    names: tuple[str, ...] = ()
    """Names of the columns; empty if there were only comments."""
    separator: str = ","
    """One of `SEPARATORS`, or `BLANKS`."""
    decimal_comma: bool = False
    has_comments: bool = False
    """Whether lines that begin with `COMMENT` are skipped."""
    rows_follow: int = 1
    """Line of the file where the table's first row may be."""


def find_heading(lines: Sequence[tuple[int, str]], notes: Notes) -> Heading:
    """Detect the header of a table from its first non-blank lines, each with its line number in the file.

    Raises:
        LogError: it is that of a Zeek log.
    """
    comments = [text for _, text in takewhile(lambda line: line[1].startswith(COMMENT), lines)]
    if comments and _ZEEK.match(comments[0]):
        raise LogError(
            "is a Zeek log with a heading of its own, which cannot be read", "let Zeek write JSON"
        )
    body = lines[len(comments) :]
    if not body:
        return Heading(has_comments=bool(comments))
    texts = [text for _, text in body]
    separator = sniff_separator(texts)
    decimal_comma = separator == ";" and _has_decimal_comma(texts[1:] or texts)
    rows = [cells_of(text, separator) for text in texts]
    above = _heading_above(comments, rows, separator)
    if above:
        names, follow = above, body[0][0]
    elif _is_heading(rows, decimal_comma):
        names, follow = [name.strip() for name in rows[0]], body[0][0] + 1
    else:
        notes.say("no header: the columns are numbered")
        names, follow = _names_without_heading(rows[0]), body[0][0]
    return Heading(
        tuple(unique_names(names, notes)), separator, decimal_comma, bool(comments), follow
    )


def _names_without_heading(cells: Sequence[str]) -> list[str]:
    """Return the names of columns from the cells of their first row: `date` and `time` once, else numbers."""
    names: list[str] = []
    for at, cell in enumerate(cells, 1):
        name = "" if not is_moment(cell) else "date" if is_date(cell) else "time"
        names.append(name if name and name not in names else f"column {at}")
    return names


def cells_of(line: str, separator: str) -> list[str]:
    """Return the cells of a line; an unclosed quote is an ordinary character."""
    if separator == BLANKS:
        return line.split()
    try:
        return next(csv.reader([line], delimiter=separator, strict=True))
    except (csv.Error, StopIteration):
        return line.split(separator)


def sniff_separator(lines: Sequence[str]) -> str:
    """Return the separator: the one that most lines have as often as the first line, else equally often.

    Blanks are the separator only if there is no other, and all lines have the same number of cells.
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
        # In `0;5,5`, there are as many commas as semicolons.
        is_decimal = evenness(best) == evenness(";") and _has_decimal_comma(lines)
        return ";" if is_decimal else best
    widths = {len(line.split()) for line in lines}
    if len(lines) == 1 and not _are_all_numbers(lines[0].split()[1:]):
        # It may be a sentence.
        return ","
    return BLANKS if len(widths) == 1 and min(widths) > 1 else ","


def _heading_above(comments: Sequence[str], rows: Sequence[list[str]], separator: str) -> list[str]:
    """Return column names from the last comment, if they match the number of cells; else an empty list."""
    if not comments:
        return []
    text = comments[-1].lstrip(COMMENT).strip()
    names = [name.strip() for name in cells_of(text, separator)]
    if len(names) != len(rows[0]):
        names = text.split()
    alike = len(rows) < 2 or _are_numeric(rows[0]) == _are_numeric(rows[1])
    return names if len(names) == len(rows[0]) and alike and not all(_are_numeric(names)) else []


def _are_numeric(cells: Sequence[str], decimal_comma: bool = False) -> list[bool | None]:
    """Return whether each cell is a number, None for empty cells."""
    return [are_numbers(texts_array([cell]), decimal_comma) for cell in cells]


def _are_all_numbers(cells: Sequence[str], decimal_comma: bool = False) -> bool:
    numbers, _ = parsed_numbers(texts_array(cells), decimal_comma)
    return not numbers.null_count


def _is_heading(rows: Sequence[list[str]], decimal_comma: bool) -> bool:
    """Return whether the first row is a header: few of its cells are numbers, or these are increasing."""
    if is_moment(rows[0][0]) and (len(rows) < 2 or is_moment(rows[1][0])):
        return False
    first = _are_numeric(rows[0], decimal_comma)
    numbers = [int(cell) for cell in rows[0][1:] if re.fullmatch(r"\s*\d+\s*", cell)]
    if (
        first[0] is False
        and len(numbers) == len(first) - 1 > 0
        and all(a < b for a, b in pairwise(numbers))
    ):
        below = {_are_numeric(row[:1], decimal_comma)[0] for row in rows[1:]}
        if (True in below and False not in below) or all(number in _YEARS for number in numbers):
            return True
    # One line with a number is a row: below a heading, nothing would be left.
    return not any(first) if len(rows) < 2 else not are_numbers(texts_array(rows[0]), decimal_comma)


def _has_decimal_comma(lines: Sequence[str]) -> bool:
    cells = [cell.strip() for line in lines for cell in line.split(";")]
    with_comma = sum(
        cell.count(",") == 1 and cell.replace(",", "").lstrip("+-").isdigit() for cell in cells
    )
    return with_comma > 0 and not any(
        cell.count(".") == 1 and cell.replace(".", "").isdigit() for cell in cells
    )


_LEAST_VALUES = 3
"""Numbers on the only line of a file that are the values of one column; fewer are a row."""


def _one_column(lines: Sequence[tuple[int, str]], notes: Notes) -> bytes:
    """Return the numbers on the only line of a file, each on a line of its own; nothing if there is more in it."""
    body = [text for _, text in lines if not text.startswith(COMMENT)]
    if len(body) != 1:
        return b""
    text = body[0].strip().rstrip("".join(SEPARATORS) + " ")
    separator = sniff_separator([text])
    cells = [cell.strip() for cell in cells_of(text, separator)]
    decimal_comma = separator == ";" and _has_decimal_comma([text])
    if len(cells) < _LEAST_VALUES or not _are_all_numbers(cells, decimal_comma):
        return b""
    notes.say(f"the only line has {len(cells)} numbers: they are read as one column")
    return "".join(
        f"{cell.replace(',', '.') if decimal_comma else cell}\n" for cell in cells
    ).encode()


_SNIFFED_LINES = 30
_COMMENTS = re.compile(rb"(?m)^#.*$")
_BLANKS = re.compile(rb"[ \t]+")
_MARGINS = re.compile(rb"(?m)^[ \t]+|[ \t]+$")
_MOST_LINES, _MOST_JOINS = 100, 100
"""Maximum lines of a quoted row, and maximum failed attempts to join lines."""


class CsvReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first.

    Args:
        heading: The format of the table; without one it is detected.
    """

    def __init__(self, notes: Notes, heading: Heading | None = None) -> None:
        self._notes = notes
        self._heading = heading or Heading()
        self._joins_left = _MOST_JOINS
        self._kinds: dict[str, pa.DataType] = {}
        """Type by column; missing while all cells of a column were empty."""

    @property
    def _separator(self) -> str:
        return "\t" if self._heading.separator == BLANKS else self._heading.separator

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it has only the header."""
        if not self._heading.names:
            block = self._begin(block)
            if not self._heading.names:
                return None
        block = self._plain(block)
        rows = None
        # Fast path: parse with the known types; fall back to texts if a cell does not fit.
        columns = self._parsed(block, self._kinds) or self._parsed(block, {})
        if columns is None:
            columns, rows = self._careful(block)
        if not len(columns[0]):
            return None
        names = list(self._heading.names)
        typed = [
            self._typed(name, cells, block, rows)
            for name, cells in zip(names, columns, strict=True)
        ]
        return pa.Table.from_arrays(typed, names)

    # The heading

    def _begin(self, block: Block) -> Block:
        # There may be many comments above a table: read all of them, and some lines of the table.
        lines = list(takewhile(lambda line: line[1].startswith(COMMENT), block.lines()))
        lines += islice(
            (line for line in block.lines() if not line[1].startswith(COMMENT)), _SNIFFED_LINES
        )
        if not lines:
            return block
        if one_column := _one_column(lines, self._notes):
            block, lines = Block(lines[0][0], one_column, block.newline), [(lines[0][0], "0")]
        self._heading = heading = find_heading(lines, self._notes)
        skipped = block.text.split(b"\n", heading.rows_follow - block.first_row)
        return Block(heading.rows_follow, skipped[-1], block.newline)

    def _plain(self, block: Block) -> Block:
        """Return the block without comments, and with tabs instead of separating blanks."""
        text = block.text
        if self._heading.has_comments and (text.startswith(b"#") or b"\n#" in text):
            text = _COMMENTS.sub(b"", text)
        if self._heading.separator == BLANKS:
            text = _BLANKS.sub(b"\t", _MARGINS.sub(b"", text))
        return Block(block.first_row, text, block.newline)

    # Cells

    def _parsed(self, block: Block, kinds: Mapping[str, pa.DataType]) -> list[pa.Array] | None:
        """Parse the block with pyarrow; None if a row has another number of cells, or a cell another type."""
        if block.text.isspace() or not block.text:
            return [pa.nulls(0, pa.string()) for _ in self._heading.names]
        types = {name: kinds.get(name, pa.string()) for name in self._heading.names}
        options = {
            "null_values": EMPTY_CELLS,
            "decimal_point": "," if self._heading.decimal_comma else ".",
        }
        try:
            table = _parsed_csv(
                block.text, types, pa_csv.ParseOptions(delimiter=self._separator), **options
            )
        except pa.ArrowInvalid:
            return None
        if b'"' in block.text and table.num_rows != sum(
            1 for line in block.text.split(b"\n") if line.strip()
        ):
            return None
        return [c.chunk(0) if c.num_chunks == 1 else c.combine_chunks() for c in table.columns]

    def _careful(self, block: Block) -> tuple[list[pa.Array], list[int]]:
        """Parse line by line; short rows are filled, long ones cut, and both are noted."""
        width = len(self._heading.names)
        rows, numbers, short, long = [], [], [], []
        for row, cells in self._records(block):
            if len(cells) < width:
                short.append(row)
                cells += [""] * (width - len(cells))
            elif len(cells) > width and any(cell.strip() for cell in cells[width:]):
                long.append(row)
            rows.append(cells[:width])
            numbers.append(row)
        few, many = "too few cells: the rest is empty", "too many cells: the rest is skipped"
        self._notes.add(f"row has {few}", f"rows have {few}", short)
        self._notes.add(f"row has {many}", f"rows have {many}", long)
        return [
            pa.array([cells[at] for cells in rows], pa.string()) for at in range(width)
        ], numbers

    def _records(self, block: Block) -> Iterator[tuple[int, list[str]]]:
        """Yield each non-blank row with its cells; a quoted cell may span lines."""
        lines = block.text.decode("utf-8").split("\n")
        after = 0
        for at, line in enumerate(lines):
            if at < after or not line or line.isspace():
                continue
            cells, after = self._joined(lines, at, block.newline) if '"' in line else (None, at + 1)
            yield (
                block.first_row + at,
                cells_of(line.rstrip("\r"), self._separator) if cells is None else cells,
            )

    def _joined(self, lines: Sequence[str], at: int, newline: str) -> tuple[list[str] | None, int]:
        """Return the cells of a row of several lines, or None for a single line, and the index of the next row."""
        ahead = [line + newline for line in lines[at : at + _MOST_LINES]]
        reader = csv.reader(
            ahead if self._joins_left else ahead[:1], delimiter=self._separator, strict=True
        )
        try:
            cells = next(reader)
        except csv.Error:
            cells = []
        further = lines[at + 1 : at + reader.line_num]
        if (
            further
            and len(cells) == len(self._heading.names)
            and not any(map(self._is_row, further))
        ):
            return cells, at + reader.line_num
        if further:
            # An unclosed quote is an ordinary character; searching for its end from every line would be too slow.
            self._joins_left -= 1
        return None, at + 1

    def _is_row(self, line: str) -> bool:
        """Return whether a line seems to be a row of its own, not text between quotes."""
        cells = line.split(self._separator)
        if len(cells) != len(self._heading.names):
            return False
        return '"' not in line or bool(
            are_numbers(texts_array(cells[:1]), self._heading.decimal_comma)
        )

    def _typed(self, name: str, cells: pa.Array, block: Block, rows: list[int] | None) -> pa.Array:
        if name not in self._kinds:
            numeric = are_numbers(cells, self._heading.decimal_comma)
            if numeric is None:
                return pa.nulls(len(cells), pa.float64())
            truths = not numeric and are_booleans(cells)
            self._kinds[name] = (
                pa.float64() if numeric else pa.bool_() if truths else text_kind(cells)
            )
        kind = self._kinds[name]
        if cells.type == kind:
            return cells
        if kind == CODED:
            return cells.dictionary_encode()
        truths = kind == pa.bool_()
        numbers, wrong = (
            parsed_booleans(cells) if truths else parsed_numbers(cells, self._heading.decimal_comma)
        )
        if (count := wrong.true_count) > 0:
            at = [index for index, bad in enumerate(wrong.to_pylist()) if bad][:5]
            where = [rows[index] for index in at] if rows else _rows_at(block, at)
            one, many = ("true or false",) * 2 if truths else ("a number", "numbers")
            self._notes.add(
                f"cell of {name!r} is not {one}", f"cells of {name!r} are not {many}", where, count
            )
        return numbers


def _rows_at(block: Block, positions: Sequence[int]) -> list[int]:
    # pyarrow counts a line of blanks as a row.
    rows = [row for row, line in enumerate(block.text.split(b"\n"), block.first_row) if line]
    return [rows[at] for at in positions]


def _parsed_csv(
    text: bytes, kinds: Mapping[str, pa.DataType], parse: pa_csv.ParseOptions, **convert: Any
) -> pa.Table:
    """Parse rows without a header; the columns are the keys of `kinds`. Raises ArrowInvalid if a cell does not fit."""
    return pa_csv.read_csv(
        pa.BufferReader(text),
        pa_csv.ReadOptions(column_names=list(kinds), use_threads=False, block_size=len(text) + 1),
        parse,
        pa_csv.ConvertOptions(column_types=dict(kinds), strings_can_be_null=False, **convert),
    )


def exported_csv(text: bytes) -> pa.Table:
    """Return the table in a CSV export, each column with the type that all its cells have.

    Raises:
        ValueError: the text is not UTF-8, or its rows do not fit its header.
    """
    names = next(csv.reader(io.StringIO(text.decode("utf-8"), newline="")), [])
    texts = _parsed_csv(
        text, dict.fromkeys(names, pa.string()), pa_csv.ParseOptions(newlines_in_values=True)
    ).slice(1)
    columns = [
        texts.column(name) if name in (*TIMEDELTA, *TEXT) else _exact(texts.column(name))
        for name in names
    ]
    columns = [
        pc.replace_substring_regex(one, WRITTEN, r"\1") if one.type == pa.string() else one
        for one in columns
    ]
    return pa.Table.from_arrays(columns, list(map(restored, names)))


def _exact(texts: pa.ChunkedArray) -> pa.ChunkedArray:
    """Return texts as whole numbers, numbers or truth values if all of them are; empty ones are missing numbers."""
    cells = pc.if_else(pc.equal(texts, ""), pa.scalar(None, pa.string()), texts)
    for kind in (pa.int64(), pa.float64()) if len(texts) else (pa.float64(),):
        try:
            return cells.cast(kind)
        except pa.ArrowInvalid:
            continue
    truths = pc.is_in(texts, value_set=texts_array(("True", "False")))
    return pc.equal(texts, "True") if pc.all(truths).as_py() else texts


_NAMELESS = "(no name)"


class JsonReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first.

    Columns are texts or numbers; if `exact`, each has the type that all its cells have, as in an export.
    """

    def __init__(self, notes: Notes, exact: bool = False) -> None:
        self._notes, self._exact = notes, exact
        self._kinds: dict[str, bool] = {}
        """By column, whether it has numbers; missing while all its cells were empty."""

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it has none."""
        found: list[tuple[int, dict[str, Any]]] = []
        broken: list[int] = []
        for row, line in block.lines():
            text = line.strip()
            if text in ("[", "]", "[]"):
                continue
            try:
                value = json.loads(text.removesuffix(","))
            except (ValueError, RecursionError):
                broken.append(row)
                continue
            objects = value if isinstance(value, list) else [value]
            if objects and all(isinstance(one, dict) for one in objects):
                found += [(row, one) for one in objects]
            else:
                broken.append(row)
        skipped = (
            "line is not a JSON object and was skipped",
            "lines are not JSON objects and were skipped",
        )
        self._notes.add(*skipped, broken)
        return self.table_of(found) if found else None

    def table_of(self, found: list[tuple[int, dict[str, Any]]]) -> pa.Table:
        """Return the table of objects, each with its row in the file."""
        names = dict.fromkeys(name for _, cells in found for name in cells)
        return pa.table({_valid(name) or _NAMELESS: self._column(name, found) for name in names})

    def _column(self, name: str, found: list[tuple[int, dict[str, Any]]]) -> pa.Array:
        cells = [cells.get(name) for _, cells in found]
        if self._exact:
            column = pa.array(cells)
            # Of numbers and truth values, a missing one is not a number.
            whole = column.null_count and (
                pa.types.is_null(column.type) or pa.types.is_boolean(column.type)
            )
            return column.cast(pa.float64()) if whole else column
        if name not in self._kinds:
            kinds = [_is_number(cell) for cell in cells if cell is not None]
            if not kinds:
                return pa.nulls(len(cells), pa.float64())
            self._kinds[name] = 2 * sum(kinds) >= len(kinds)
        if not self._kinds[name]:
            return pa.array([None if cell is None else _text(cell) for cell in cells], pa.string())
        wrong = [
            row
            for (row, _), cell in zip(found, cells, strict=True)
            if cell is not None and not _is_number(cell)
        ]
        self._notes.add(
            f"cell of {name!r} is not a number", f"cells of {name!r} are not numbers", wrong
        )
        return pa.array(
            [_float(cell) if _is_number(cell) else None for cell in cells], pa.float64()
        )


def _is_number(cell: object) -> TypeGuard[float]:
    # True and false count as 1 and 0.
    return isinstance(cell, int | float)


def _float(cell: float) -> float:
    try:
        return float(cell)
    except OverflowError:
        return float("inf") if cell > 0 else float("-inf")


def _text(cell: object) -> str:
    return _valid(cell) if isinstance(cell, str) else json.dumps(cell)


def _valid(text: str) -> str:
    """Return a text with surrogates, which are halves of characters, as escape sequences."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


_TABLE_ROW = re.compile(r"[,;\t]|^[^A-Za-z]*[0-9][^A-Za-z]*$")
"""Cells with a separator between them, or only numbers."""


_SECONDS = pa.float64()


class PrintedReader:
    """Reads blocks of one file of printed samples.

    Args:
        parse: Returns name, value and time of a line, None if it is no sample.
        time_kind: Type of the times.
    """

    def __init__(
        self,
        notes: Notes,
        parse: Callable[[str], Any] = parse_sample,
        time_kind: pa.DataType = _SECONDS,
    ) -> None:
        self._notes, self._parse, self._time_kind = notes, parse, time_kind

    def read(self, block: Block) -> pa.Table | None:
        """Return the samples of a block; None if it has none. The time is empty where none was printed."""
        found, others = [], []
        for row, line in block.lines():
            if (sample := self._parse(line)) is None:
                others.append(row)
            else:
                found.append((row, *sample))
        self._notes.add("line is not a sample", "lines are not samples", others)
        if not found:
            return None
        kinds = {
            "row": pa.float64(),
            "variable": pa.string(),
            "value": pa.float64(),
            "time": self._time_kind,
        }
        cells = zip(*found, strict=True)
        return pa.table({name: pa.array(next(cells), kind) for name, kind in kinds.items()})


def looks_printed(lines: list[str]) -> bool:
    """Return whether more of the lines are samples than look like rows of a table."""
    others = [line for line in lines if parse_sample(line) is None]
    return len(lines) - len(others) > sum(_TABLE_ROW.search(line) is not None for line in others)
