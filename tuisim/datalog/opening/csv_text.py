"""Tables as text: one row a line, cells between separators."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, takewhile
from typing import Any

import pyarrow as pa
import pyarrow.csv as pa_csv

from tuisim.datalog.opening.csv_heading import BLANKS, COMMENT, Heading, cells_of, find_heading
from tuisim.datalog.opening.lines import Block
from tuisim.datalog.opening.notes import Notes
from tuisim.datalog.opening.numbers import EMPTY_CELLS, are_booleans, are_numbers, parsed_booleans, parsed_numbers
from tuisim.datalog.opening.plain import texts_array
from tuisim.datalog.opening.texts import CODED, text_kind

_SNIFFED_LINES = 30
_COMMENTS = re.compile(rb"(?m)^#.*$")
_BLANKS = re.compile(rb"[ \t]+")
_MARGINS = re.compile(rb"(?m)^[ \t]+|[ \t]+$")
_MOST_LINES, _MOST_JOINS = 100, 100
"""Lines that a row may have, and how often one of several lines may turn out to be none."""


class CsvReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first.

    Args:
        notes: Where it says what was wrong.
    """

    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._heading = Heading()
        self._joins_left = _MOST_JOINS
        self._kinds: dict[str, pa.DataType] = {}
        """By column; missing while all its cells were empty."""

    @property
    def _names(self) -> tuple[str, ...]:
        return self._heading.names

    @property
    def _separator(self) -> str:
        return "\t" if self._heading.separator == BLANKS else self._heading.separator

    @property
    def _decimal_comma(self) -> bool:
        return self._heading.decimal_comma

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it holds but the heading."""
        if not self._heading.names:
            block = self._begin(block)
            if not self._heading.names:
                return None
        block = self._plain(block)
        rows = None
        # Most blocks hold what they should; cells are only looked at as texts where one of them does not.
        columns = self._parsed(block, self._kinds) or self._parsed(block, {})
        if columns is None:
            columns, rows = self._careful(block)
        if not len(columns[0]):
            return None
        return pa.Table.from_arrays(
            [self._typed(n, c, block, rows) for n, c in zip(self._names, columns, strict=True)], list(self._names)
        )

    # The heading

    def _begin(self, block: Block) -> Block:
        # Comments above a table may be many: as many lines are looked at as there are, and some of the table's.
        lines = list(takewhile(lambda line: line[1].startswith(COMMENT), block.lines()))
        lines += islice((line for line in block.lines() if not line[1].startswith(COMMENT)), _SNIFFED_LINES)
        if not lines:
            return block
        self._heading = heading = find_heading(lines, self._notes)
        skipped = block.text.split(b"\n", heading.rows_follow - block.first_row)
        return Block(heading.rows_follow, skipped[-1], block.newline)

    def _plain(self, block: Block) -> Block:
        """The same rows without comments, and with separators where blanks separate the cells."""
        text = block.text
        if self._heading.has_comments and (text.startswith(b"#") or b"\n#" in text):
            text = _COMMENTS.sub(b"", text)
        if self._heading.separator == BLANKS:
            text = _BLANKS.sub(b"\t", _MARGINS.sub(b"", text))
        return Block(block.first_row, text, block.newline)

    # Cells

    def _parsed(self, block: Block, kinds: Mapping[str, pa.DataType]) -> list[pa.Array] | None:
        """All cells by the library's parser, None if a row is not like the others or a cell not of its kind."""
        if block.text.isspace() or not block.text:
            return [pa.nulls(0, pa.string()) for _ in self._names]
        try:
            table = pa_csv.read_csv(
                pa.BufferReader(block.text),
                pa_csv.ReadOptions(column_names=list(self._names), use_threads=False, block_size=len(block.text) + 1),
                pa_csv.ParseOptions(delimiter=self._separator, newlines_in_values=False),
                pa_csv.ConvertOptions(
                    column_types={name: kinds.get(name, pa.string()) for name in self._names},
                    strings_can_be_null=False,
                    null_values=EMPTY_CELLS,
                    decimal_point="," if self._decimal_comma else ".",
                ),
            )
        except pa.ArrowInvalid:
            return None
        if b'"' in block.text and table.num_rows != sum(1 for line in block.text.split(b"\n") if line.strip()):
            return None
        return [c.chunk(0) if c.num_chunks == 1 else c.combine_chunks() for c in table.columns]

    def _careful(self, block: Block) -> tuple[list[pa.Array], list[int]]:
        """Cells line by line; short rows are filled up, long ones cut, both are noted."""
        width = len(self._names)
        rows, numbers, short, long = [], [], [], []
        for row, cells in self._records(block):
            if len(cells) < width:
                short.append(row)
                cells += [""] * (width - len(cells))
            elif len(cells) > width and any(cell.strip() for cell in cells[width:]):
                long.append(row)
            rows.append(cells[:width])
            numbers.append(row)
        if short:
            self._notes.add("rows have too few cells: the rest is empty", short)
        if long:
            self._notes.add("rows have too many cells: the rest is left out", long)
        return [pa.array([cells[at] for cells in rows], pa.string()) for at in range(width)], numbers

    def _records(self, block: Block) -> Iterator[tuple[int, list[str]]]:
        """Yield each row that is not blank with its cells; one in quotes may go on in the next lines."""
        lines = block.text.decode("utf-8").split("\n")
        after = 0
        for at, line in enumerate(lines):
            if at < after or not line or line.isspace():
                continue
            cells, after = self._joined(lines, at, block.newline) if '"' in line else (None, at + 1)
            yield block.first_row + at, cells_of(line.rstrip("\r"), self._separator) if cells is None else cells

    def _joined(self, lines: Sequence[str], at: int, newline: str) -> tuple[list[str] | None, int]:
        """The cells of a row of several lines and where the next row is; None if it is but one line."""
        ahead = [line + newline for line in lines[at : at + _MOST_LINES]]
        reader = csv.reader(ahead if self._joins_left else ahead[:1], delimiter=self._separator, strict=True)
        try:
            cells = next(reader)
        except csv.Error:
            cells = []
        further = lines[at + 1 : at + reader.line_num]
        if further and len(cells) == len(self._names) and not any(map(self._is_row, further)):
            return cells, at + reader.line_num
        if further:
            # A quote that is never closed is but a character; looking for its end in each line would take too long.
            self._joins_left -= 1
        return None, at + 1

    def _is_row(self, line: str) -> bool:
        """Whether a line seems to be a row by itself rather than text between quotes."""
        cells = line.split(self._separator)
        if len(cells) != len(self._names):
            return False
        return '"' not in line or bool(are_numbers(texts_array(cells[:1]), self._decimal_comma))

    def _typed(self, name: str, cells: pa.Array, block: Block, rows: list[int] | None) -> pa.Array:
        if name not in self._kinds:
            numeric = are_numbers(cells, self._decimal_comma)
            if numeric is None:
                return pa.nulls(len(cells), pa.float64())
            truths = not numeric and are_booleans(cells)
            self._kinds[name] = pa.float64() if numeric else pa.bool_() if truths else text_kind(cells)
        kind = self._kinds[name]
        if cells.type == kind:
            return cells
        if kind == CODED:
            return cells.dictionary_encode()
        truths = kind == pa.bool_()
        numbers, wrong = parsed_booleans(cells) if truths else parsed_numbers(cells, self._decimal_comma)
        if (count := _count(wrong)) > 0:
            at = [index for index, bad in enumerate(wrong.to_pylist()) if bad][:5]
            where = [rows[index] for index in at] if rows else _rows_at(block, at)
            self._notes.add(
                f"cells of {name!r} hold {'neither true nor false' if truths else 'no number'}", where, count
            )
        return numbers


def _count(mask: Any) -> int:
    return int(mask.true_count)


def _rows_at(block: Block, positions: Sequence[int]) -> list[int]:
    # A line of nothing but blanks is a row to the library's parser.
    rows = [row for row, line in enumerate(block.text.split(b"\n"), block.first_row) if line]
    return [rows[at] for at in positions]
