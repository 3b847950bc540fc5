"""Tables in text with separators: rows with typed cells, read block by block, up to where another table begins."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import islice, takewhile
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv

from tuisim.base.data_class import dataclass
from tuisim.base.errors import LogError, counted, listed
from tuisim.logs.arrow import build_text_array
from tuisim.logs.blocks import Block
from tuisim.logs.cells import (
    DECIMAL_COMMA,
    EMPTY_CELLS,
    PLAIN,
    NumberForm,
    find_form,
    has_only_truths,
    parse_numbers,
    parse_truths,
)
from tuisim.logs.choices import NAMES_OF_SIGNS, ReadChoices
from tuisim.logs.csv_cells import WRITTEN, restore_formula
from tuisim.logs.heading import (
    BLANKS,
    SEPARATORS,
    SNIFFED_LINES,
    Heading,
    close_quotes,
    find_heading,
    is_words,
    parse_kinds,
    refuse_zeek,
    sniff_separator,
    split_cells,
)
from tuisim.logs.units import TEXT, TIMEDELTA
from tuisim.logs.warnings import Notes

CODED = pa.dictionary(pa.int32(), pa.string())
"""Dictionary-encoded text."""

_MIN_REPEATED = 4
"""Texts are dictionary-encoded if each occurs at least this often, on average."""
_MIN_CELLS = 100
"""With fewer cells, texts are not dictionary-encoded."""
_MIN_VALUES = 3
"""Numbers on the only line of a file that are the values of one column; fewer are a row."""
_BLANKS = re.compile(rb'(?<!\S)("[^"\n]*")(?!\S)|[ \t]+')
_MARGINS = re.compile(rb"(?m)^[ \t]+|[ \t]+$")
_MAX_LINES, _MAX_JOINS = 100, 100
"""Maximum lines of a quoted row, and maximum failed attempts to join lines."""
_MAY_BE_NAMES = re.compile(rb"(?m)^[ \t]*[\"']?[A-Za-z_\x80-\xff]")
_MIN_ROWS = 2
"""Rows below a heading that make another table."""


@dataclass(frozen=True, slots=True)
class _Column:
    kind: pa.DataType
    form: NumberForm = PLAIN


def choose_text_kind(cells: pa.Array) -> pa.DataType:
    """Return the type for a text column: `CODED` if its first cells often repeat, else a string."""
    often = len(cells) > _MIN_CELLS and _MIN_REPEATED * pc.count_distinct(cells).as_py() <= len(
        cells
    )
    return CODED if often else pa.string()


class CsvReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first block."""

    def __init__(self, notes: Notes, choices: ReadChoices) -> None:
        self._notes = notes
        self._choices = choices
        self._heading = Heading()
        self._tables_left = choices.table - 1
        """Tables that are still to be passed by."""
        self._is_over = False
        """Whether the table has ended, so that the rest of the file is another one's."""
        self._has_gaps = False
        """Whether there are blanks between quotes and separators."""
        self._joins_left = _MAX_JOINS
        self._columns: dict[str, _Column] = {}
        """By name; missing while all cells of a column were empty."""

    @property
    def _separator(self) -> str:
        return "\t" if self._heading.separator == BLANKS else self._heading.separator

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it has none of the table."""
        while not self._is_over:
            if not self._heading.names:
                block = self._begin(block)
                if not self._heading.names:
                    return None
            plain = self._clean_block(block)
            # The usual case is fast: every cell is of the known type of its column.
            columns = self._parse_block(plain, self._choose_kinds()) if self._columns else None
            if columns is None or any(map(_has_infinite, columns)):
                plain, rest = self._cut_table(plain)
                if rest is not None and self._tables_left:
                    self._tables_left -= 1
                    block = rest
                    self._heading = Heading()
                    self._columns = {}
                    continue
                self._is_over = rest is not None
                columns = self._parse_block(plain, {})
            return None if self._tables_left else self._build_rows(plain, columns)
        return None

    def finish(self) -> None:
        """Raise if the file has fewer tables than the user has asked for.

        Raises:
            LogError: the table that was asked for does not exist.
        """
        if self._tables_left:
            raise LogError(
                f"has {counted(self._choices.table - self._tables_left, 'table')}",
                f"--table takes 1 to {self._choices.table - self._tables_left}",
            )

    def _build_rows(self, block: Block, columns: list[pa.Array] | None) -> pa.Table | None:
        rows = None
        if columns is None:
            columns, rows = self._parse_lines(block)
        if not len(columns[0]):
            return None
        names = list(self._heading.names)
        self._find_columns(columns)
        typed = [
            self._convert_column(name, cells, block, rows)
            for name, cells in zip(names, columns, strict=True)
        ]
        table = pa.Table.from_arrays(typed, names)
        return table.slice(0, len(table) - _count_words(columns, typed))

    # The heading

    def _begin(self, block: Block) -> Block:
        # There may be many comments above a table: read all of them, and some lines of the table.
        lines = list(takewhile(lambda line: line[1].startswith("#"), block.lines()))
        lines += islice(
            (line for line in block.lines() if not line[1].startswith("#")), SNIFFED_LINES
        )
        if not lines:
            return block
        if one_column := _split_only_line(lines, self._notes):
            block = Block(lines[0][0], one_column, block.newline)
            lines = [(lines[0][0], "0")]
        refuse_zeek(lines[0][1])
        self._heading = find_heading(lines, self._notes, self._choices.sign, self._choices.header)
        self._notes.form = replace(
            self._choices,
            header=self._heading.row,
            separator=NAMES_OF_SIGNS.get(self._heading.separator, ""),
        )
        follow = self._heading.rows_follow
        head = "\n".join(line for row, line in lines if follow - 2 < row <= follow).encode()
        self._has_gaps = len(self._heading.names) == 1 or head != close_quotes(
            head, self._heading.separator
        )
        skipped = block.text.split(b"\n", self._heading.rows_follow - block.first_row)
        return Block(self._heading.rows_follow, skipped[-1], block.newline)

    def _clean_block(self, block: Block) -> Block:
        """Return the block without comments, and with tabs instead of separating blanks."""
        text = block.text
        sign = self._heading.comment.encode()
        if sign and (text.startswith(sign) or b"\n" + sign in text):
            text = re.sub(rb"(?m)^" + re.escape(sign) + rb".*$", b"", text)
        if self._heading.separator == BLANKS:
            text = _MARGINS.sub(b"", text)
            text = _BLANKS.sub(lambda match: match[1] or b"\t", text)
        elif self._has_gaps:
            text = close_quotes(text, self._heading.separator)
        return Block(block.first_row, text, block.newline)

    # Where the table ends

    def _cut_table(self, block: Block) -> tuple[Block, Block | None]:
        """Return the rows of this table, and the rest from another table's heading on, None without one.

        A repeated heading does not end the table.
        """
        if not set(self._heading.kinds) & set("nt") or not _MAY_BE_NAMES.search(block.text):
            return block, None
        lines = block.text.decode("utf-8").split("\n")
        repeated = []
        for index, line in enumerate(lines):
            if not (cells := self._find_names(line)) or not self._has_rows(
                cells, lines[index + 1 :][:9]
            ):
                continue
            if cells == list(self._heading.names):
                repeated.append(block.first_row + index)
                lines[index] = ""
                continue
            if not self._tables_left:
                self._notes.say(
                    f"another table begins in row {block.first_row + index}, with"
                    f" {listed(map(repr, cells))}: --table {self._choices.table + 1} reads it"
                )
            return self._join_block(block, lines[:index], 0), self._join_block(block, lines, index)
        self._notes.say_rows("the heading is repeated", repeated)
        return (self._join_block(block, lines, 0) if repeated else block), None

    def _join_block(self, block: Block, lines: Sequence[str], start: int) -> Block:
        text = "\n".join(lines[start:]).encode()
        return Block(block.first_row + start, text, block.newline)

    def _find_names(self, line: str) -> list[str]:
        """Return the cells of a line that may be the heading of a table; none if the line cannot be one."""
        if not line or line.isspace():
            return []
        cells = [cell.strip() for cell in split_cells(line, self._separator)]
        usual = self._heading.kinds
        kinds = parse_kinds(cells)
        alike = len(kinds) == len(usual) and any(
            kind == was for kind, was in zip(kinds, usual, strict=True) if was in "nt"
        )
        is_heading = len(cells) > 1 and is_words(kinds) and "-" not in kinds
        return cells if is_heading and not alike else []

    def _has_rows(self, names: Sequence[str], below: Sequence[str]) -> bool:
        """Return whether the lines below a heading are rows with as many cells, some of them numbers."""
        rows = [text for text in below if text and not text.isspace()][:_MIN_ROWS]
        kinds = [parse_kinds(split_cells(text, self._separator)) for text in rows]
        return len(kinds) == _MIN_ROWS and all(
            len(row) == len(names) and bool(set(row) & set("nt")) for row in kinds
        )

    # Cells

    def _choose_kinds(self) -> dict[str, pa.DataType]:
        """Return the columns that pyarrow can parse, with their types; the others are read as texts."""
        commas = self._has_decimal_commas
        forms = (PLAIN, DECIMAL_COMMA) if commas else (PLAIN,)
        return {
            name: column.kind
            for name, column in self._columns.items()
            if column.kind != pa.float64() or column.form in forms
        }

    @property
    def _has_decimal_commas(self) -> bool:
        return any(column.form is DECIMAL_COMMA for column in self._columns.values())

    def _parse_block(self, block: Block, kinds: Mapping[str, pa.DataType]) -> list[pa.Array] | None:
        """Parse the block with pyarrow; None if a row has another number of cells, or a cell another type."""
        if block.text.isspace() or not block.text:
            return [pa.nulls(0, pa.string()) for _ in self._heading.names]
        types = {name: kinds.get(name, pa.string()) for name in self._heading.names}
        options = {
            "null_values": EMPTY_CELLS,
            "decimal_point": "," if self._has_decimal_commas else ".",
        }
        try:
            table = _parse_csv(
                block.text, types, pa_csv.ParseOptions(delimiter=self._separator), **options
            )
        except pa.ArrowInvalid:
            return None
        if b'"' in block.text and table.num_rows != sum(
            1 for line in block.text.split(b"\n") if line.strip()
        ):
            return None
        return [c.chunk(0) if c.num_chunks == 1 else c.combine_chunks() for c in table.columns]

    def _parse_lines(self, block: Block) -> tuple[list[pa.Array], list[int]]:
        """Parse line by line; short rows are filled, long ones cut, and both are noted."""
        width = len(self._heading.names)
        usual = set(self._heading.kinds)
        rows = []
        numbers = []
        short = []
        long = []
        others = []
        for row, cells in self._split_rows(block):
            if len(cells) < width:
                if usual & set("nt") and not set(parse_kinds(cells)) & set("nt"):
                    others.append(row)
                    continue
                short.append(row)
                cells += [""] * (width - len(cells))
            elif len(cells) > width and any(cell.strip() for cell in cells[width:]):
                long.append(row)
            rows.append(cells[:width])
            numbers.append(row)
        few = "too few cells: the rest is empty"
        many = "too many cells: the rest is skipped"
        self._notes.add("line is not a row", "lines are not rows", others)
        self._notes.add(f"row has {few}", f"rows have {few}", short)
        self._notes.add(f"row has {many}", f"rows have {many}", long)
        return [
            pa.array([cells[index] for cells in rows], pa.string()) for index in range(width)
        ], numbers

    def _split_rows(self, block: Block) -> Iterator[tuple[int, list[str]]]:
        """Yield each non-blank row with its cells; a quoted cell may span lines."""
        lines = block.text.decode("utf-8").split("\n")
        after = 0
        for row, line in enumerate(lines):
            if row < after or not line or line.isspace():
                continue
            cells, after = self._join(lines, row, block.newline) if '"' in line else (None, row + 1)
            yield (
                block.first_row + row,
                split_cells(line.rstrip("\r"), self._separator) if cells is None else cells,
            )

    def _join(self, lines: Sequence[str], row: int, newline: str) -> tuple[list[str] | None, int]:
        """Return the cells of a row, None if it is on a single line, and the index of the next row."""
        ahead = [line + newline for line in lines[row : row + _MAX_LINES]]
        reader = csv.reader(
            ahead if self._joins_left else ahead[:1], delimiter=self._separator, strict=True
        )
        try:
            cells = next(reader)
        except csv.Error:
            cells = []
        further = lines[row + 1 : row + reader.line_num]
        if (
            further
            and len(cells) == len(self._heading.names)
            and not any(map(self._is_row, further))
        ):
            return cells, row + reader.line_num
        if further:
            # An unclosed quote is an ordinary character; searching for its end from every line would be too slow.
            self._joins_left -= 1
        return None, row + 1

    def _is_row(self, line: str) -> bool:
        """Return whether a line seems to be a row of its own, not text between quotes."""
        cells = line.split(self._separator)
        if len(cells) != len(self._heading.names):
            return False
        return '"' not in line or parse_kinds(cells[:1]) == "n"

    def _find_columns(self, columns: Sequence[pa.Array]) -> None:
        """Find type and number format of each column that has cells for the first time."""
        forms: dict[str, NumberForm | None] = {}
        texts = {
            name: cells
            for name, cells in zip(self._heading.names, columns, strict=True)
            if name not in self._columns and not _is_empty(cells)
        }
        separator = self._separator
        decimal = self._choices.decimal
        for name, cells in texts.items():
            forms[name] = find_form(cells, separator, decimal)
        if comma := DECIMAL_COMMA in forms.values():
            # Where one column has decimal commas, points are between thousands.
            forms = {
                name: find_form(texts[name], separator, ",") or form for name, form in forms.items()
            }
        self._notes.form = replace(self._notes.form, decimal="," if comma else ".")
        names_by_words: dict[str, list[str]] = {}
        for name, form in forms.items():
            if form is None:
                cells = texts[name]
                kind = pa.bool_() if has_only_truths(cells) else choose_text_kind(cells)
                self._columns[name] = _Column(kind)
                continue
            self._columns[name] = _Column(pa.float64(), form)
            if form.words and not (form is DECIMAL_COMMA and separator == ";"):
                names_by_words.setdefault(form.words, []).append(repr(name))
        for words, names in names_by_words.items():
            self._notes.say(f"the numbers of {listed(names)} {words}")

    def _convert_column(
        self, name: str, cells: pa.Array, block: Block, rows: list[int] | None
    ) -> pa.Array:
        column = self._columns.get(name)
        if column is None:
            return pa.nulls(len(cells))
        if cells.type == column.kind:
            return cells
        if column.kind == CODED:
            return cells.dictionary_encode()
        truths = column.kind == pa.bool_()
        numbers, wrong = parse_truths(cells) if truths else parse_numbers(cells, column.form)
        if (count := wrong.true_count) > 0:
            positions = [index for index, bad in enumerate(wrong.to_pylist()) if bad][:5]
            odd = [rows[index] for index in positions] if rows else _find_rows(block, positions)
            noun, nouns = ("true or false",) * 2 if truths else ("a number", "numbers")
            self._notes.add(
                f"cell of {name!r} is not {noun}", f"cells of {name!r} are not {nouns}", odd, count
            )
        return numbers


def _count_words(texts: Sequence[pa.Array], typed: Sequence[pa.Array]) -> int:
    """Return how many rows at the end have words where the numbers should be: they are sentences below the table."""
    numbers = [index for index, column in enumerate(typed) if pa.types.is_floating(column.type)]
    numbers = [index for index in numbers if pa.types.is_string(texts[index].type)]
    count = 0
    for row in range(len(typed[0]) - 1, -1, -1):
        kinds = parse_kinds([texts[index][row].as_py() or "" for index in numbers])
        if "w" not in kinds or set(kinds) & set("nt"):
            break
        count += 1
    return count


def _has_infinite(cells: pa.Array) -> bool:
    return pa.types.is_floating(cells.type) and bool(pc.any(pc.is_inf(cells)).as_py())


def _is_empty(cells: pa.Array) -> bool:
    texts: Any = pc.utf8_trim_whitespace(cells) if pa.types.is_string(cells.type) else cells
    empty = pc.is_in(texts, value_set=build_text_array(EMPTY_CELLS))
    return bool(pc.all(pc.or_(pc.is_null(texts), empty)).as_py())


def _split_only_line(lines: Sequence[tuple[int, str]], notes: Notes) -> bytes:
    """Return the numbers on the only line of a file, each on a line of its own; nothing if it has anything else."""
    body = [text for _, text in lines if not text.startswith("#")]
    if len(body) != 1:
        return b""
    text = body[0].strip().rstrip("".join(SEPARATORS) + " ")
    separator = sniff_separator([text])
    cells = [cell.strip() for cell in split_cells(text, separator)]
    form = DECIMAL_COMMA if separator == ";" else PLAIN
    numbers, _ = parse_numbers(build_text_array(cells), form)
    if len(cells) < _MIN_VALUES or numbers.null_count:
        return b""
    notes.say(f"the only line has {len(cells)} numbers: they are read as one column")
    return "".join(f"{number}\n" for number in numbers.to_pylist()).encode()


def _find_rows(block: Block, positions: Sequence[int]) -> list[int]:
    # pyarrow counts a line of blanks as a row.
    rows = [row for row, line in enumerate(block.text.split(b"\n"), block.first_row) if line]
    return [rows[position] for position in positions]


def _parse_csv(
    text: bytes, kinds: Mapping[str, pa.DataType], parse: pa_csv.ParseOptions, **convert: Any
) -> pa.Table:
    """Parse rows without a header; the columns are the keys of `kinds`. Raises ArrowInvalid if a cell does not fit."""
    return pa_csv.read_csv(
        pa.BufferReader(text),
        pa_csv.ReadOptions(column_names=list(kinds), use_threads=False, block_size=len(text) + 1),
        parse,
        pa_csv.ConvertOptions(column_types=dict(kinds), strings_can_be_null=False, **convert),
    )


def read_exported_csv(text: bytes) -> pa.Table:
    """Return the table in a CSV export, each column with the type that all its cells have.

    Raises:
        ValueError: the text is not UTF-8, or its rows do not fit its header.
    """
    names = next(csv.reader(io.StringIO(text.decode("utf-8"), newline="")), [])
    texts = _parse_csv(
        text, dict.fromkeys(names, pa.string()), pa_csv.ParseOptions(newlines_in_values=True)
    ).slice(1)
    columns = [
        texts.column(name) if name in (*TIMEDELTA, *TEXT) else _convert_texts(texts.column(name))
        for name in names
    ]
    columns = [
        pc.replace_substring_regex(column, WRITTEN, r"\1") if column.type == pa.string() else column
        for column in columns
    ]
    return pa.Table.from_arrays(columns, list(map(restore_formula, names)))


def _convert_texts(texts: pa.ChunkedArray) -> pa.ChunkedArray:
    """Return texts as whole numbers, numbers or truth values if all of them are; empty ones are missing numbers."""
    cells = pc.if_else(pc.equal(texts, ""), pa.scalar(None, pa.string()), texts)
    for kind in (pa.int64(), pa.float64()) if len(texts) else (pa.float64(),):
        try:
            return cells.cast(kind)
        except pa.ArrowInvalid:
            continue
    truths = pc.is_in(texts, value_set=build_text_array(("True", "False")))
    return pc.equal(texts, "True") if pc.all(truths).as_py() else texts
