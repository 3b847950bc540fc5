"""Tables as text: one row a line, cells between separators."""

from __future__ import annotations

import csv
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pyarrow as pa
import pyarrow.csv as pa_csv

from tuisim.datalog.opening.headings import unique_names
from tuisim.datalog.opening.lines import Block
from tuisim.datalog.opening.notes import Notes
from tuisim.datalog.opening.numbers import EMPTY_CELLS, are_booleans, are_numbers, parsed_booleans, parsed_numbers
from tuisim.datalog.opening.plain import texts_array
from tuisim.datalog.opening.texts import CODED, text_kind

SEPARATORS = (",", ";", "\t", "|")
_SNIFFED_LINES = 30
_MOST_LINES, _MOST_JOINS = 100, 100
"""Lines that a row may have, and how often one of several lines may turn out to be none."""


class CsvReader:
    """Reads blocks of one file; names and types of the columns are fixed by the first.

    Args:
        notes: Where it says what was wrong.
    """

    def __init__(self, notes: Notes) -> None:
        self._notes = notes
        self._names: list[str] = []
        self._separator = ","
        self._decimal_comma = False
        self._joins_left = _MOST_JOINS
        self._kinds: dict[str, pa.DataType] = {}
        """By column; missing while all its cells were empty."""

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block; None if it holds but the heading."""
        if not self._names:
            block = self._begin(block)
            if not self._names:
                return None
        rows = None
        # Most blocks hold what they should; cells are only looked at as texts where one of them does not.
        columns = self._parsed(block, self._kinds) or self._parsed(block, {})
        if columns is None:
            columns, rows = self._careful(block)
        if not len(columns[0]):
            return None
        return pa.Table.from_arrays(
            [self._typed(n, c, block, rows) for n, c in zip(self._names, columns, strict=True)], self._names
        )

    # The heading

    def _begin(self, block: Block) -> Block:
        lines = [line for _, line in zip(range(_SNIFFED_LINES), block.lines(), strict=False)]
        if not lines:
            return block
        self._separator = sniff_separator([text for _, text in lines])
        row, heading = lines[0]
        names = [name.strip() for name in self._cells(heading)]
        self._decimal_comma = self._separator == ";" and _has_decimal_comma([text for _, text in lines[1:]])
        if are_numbers(texts_array(names), self._decimal_comma):
            self._notes.say("no heading: the columns are numbered")
            self._names = [f"column {at}" for at in range(1, len(names) + 1)]
            return block
        self._names = unique_names(names, self._notes)
        skipped = block.text.split(b"\n", row - block.first_row + 1)
        return Block(row + 1, skipped[-1])

    # Cells

    def _parsed(self, block: Block, kinds: Mapping[str, pa.DataType]) -> list[pa.Array] | None:
        """All cells by the library's parser, None if a row is not like the others or a cell not of its kind."""
        if block.text.isspace() or not block.text:
            return [pa.nulls(0, pa.string()) for _ in self._names]
        try:
            table = pa_csv.read_csv(
                pa.BufferReader(block.text),
                pa_csv.ReadOptions(column_names=self._names, use_threads=False, block_size=len(block.text) + 1),
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
            cells, after = self._joined(lines, at) if '"' in line else (None, at + 1)
            yield block.first_row + at, self._cells(line.rstrip("\r")) if cells is None else cells

    def _joined(self, lines: Sequence[str], at: int) -> tuple[list[str] | None, int]:
        """The cells of a row of several lines and where the next row is; None if it is but one line."""
        ahead = [line + "\n" for line in lines[at : at + _MOST_LINES]]
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

    def _cells(self, line: str) -> list[str]:
        try:
            cells = next(csv.reader([line], delimiter=self._separator, strict=True))
        except (csv.Error, StopIteration):
            # A quote that is never closed is but a character.
            return line.split(self._separator)
        return cells

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


def _has_decimal_comma(lines: Sequence[str]) -> bool:
    cells = [cell.strip() for line in lines for cell in line.split(";")]
    with_comma = sum(cell.count(",") == 1 and cell.replace(",", "").lstrip("+-").isdigit() for cell in cells)
    return with_comma > 0 and not any(cell.count(".") == 1 and cell.replace(".", "").isdigit() for cell in cells)


def sniff_separator(lines: Sequence[str]) -> str:
    """Return what separates the cells: what is there in most lines, and in most of them equally often."""

    def evenness(separator: str) -> tuple[int, int]:
        counts = Counter(line.count(separator) for line in lines)
        counts.pop(0, None)
        if not counts:
            return 0, 0
        number, times = counts.most_common(1)[0]
        return times, number

    best = max(SEPARATORS, key=evenness)
    return best if evenness(best) > (0, 0) else ","
