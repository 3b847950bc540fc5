"""Tables in text with separators: rows with typed cells, read block by block, up to where another table begins."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import islice, takewhile
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.csv as pa_csv
from pyarrow.types import is_floating

from tuisim.base.errors import LogError, counted, listed
from tuisim.logs.arrow import build_text_array
from tuisim.logs.blocks import Block
from tuisim.logs.cells import EMPTY_CELLS, TypedColumns
from tuisim.logs.choices import NAMES_OF_SIGNS, ReadChoices
from tuisim.logs.csv_cells import WRITTEN, restore_formula
from tuisim.logs.heading import (
    BLANKS,
    SNIFFED_LINES,
    Heading,
    close_quotes,
    find_heading,
    has_numbers,
    is_rule,
    parse_kinds,
    split_rows,
)
from tuisim.logs.units import TEXT, TIMEDELTA
from tuisim.logs.warnings import Notes

_BLANKS = re.compile(r'(?<!\S)("[^"\n]*")(?!\S)|[ \t]+')
_MARGINS = re.compile(r"(?m)^[ \t]+|[ \t]+$")
_COMMENTS = re.compile(r"(?m)^#.*")
_MAY_BE_NAMES = re.compile(r"(?m)^[ \t]*[\"']?[^\W\d]")
_LOOK_AHEAD = 10
"""Lines in which a heading and rows below it are looked for."""
_MIN_ROWS = 2
"""Rows below a heading that make another table."""


class CsvReader:
    """Reads a text table block by block; the first block fixes names and types of the columns.

    Args:
        notes: Receives warnings.
        choices: The user's choices for reading the file.
        rewrite: Returns a line with separators between its cells; None if all lines have them already.
    """

    def __init__(
        self, notes: Notes, choices: ReadChoices, rewrite: Callable[[str], str] | None = None
    ) -> None:
        self._notes = notes
        self._choices = choices
        self._rewrite = rewrite
        self._heading = Heading()
        self._tables_left = choices.table - 1
        """The number of tables that are still to be skipped."""
        self._is_over = False
        """Whether the table has ended, so that the rest of the file is another one's."""
        self._has_gaps = False
        """Whether there are blanks between quotes and separators."""
        self._columns = TypedColumns(notes, choices.decimal)

    @property
    def _separator(self) -> str:
        return "\t" if self._heading.separator == BLANKS else self._heading.separator

    def read(self, block: Block) -> pa.Table | None:
        """Return the rows of a block as a table; None if it has none."""
        if self._rewrite:
            lines = map(self._rewrite, block.text.split("\n"))
            block = Block(block.first_row, "\n".join(lines))
        while not self._is_over:
            if not self._heading.names:
                block = self._begin(block)
                if not self._heading.names:
                    return None
            block = Block(block.first_row, self._clean(block.text))
            # In the usual, fast case every cell has the known type of its column.
            kinds = self._columns.list_plain()
            columns = self._parse_block(block.text, kinds) if kinds else None
            if columns is None:
                block, rest = self._cut_table(block)
                if rest is not None and self._tables_left:
                    self._tables_left -= 1
                    block = rest
                    self._heading = Heading()
                    self._columns = TypedColumns(self._notes, self._choices.decimal)
                    continue
                self._is_over = rest is not None
                columns = self._parse_block(block.text, {})
            return None if self._tables_left else self._build_rows(block, columns)
        return None

    def finish(self) -> None:
        """Check at the end of the file that it contains the table that the user has chosen, such as the second one.

        Raises:
            LogError: the file has fewer tables.
        """
        if self._tables_left:
            count = self._choices.table - self._tables_left
            raise LogError(f"has {counted(count, 'table')}", f"--table takes 1 to {count}")

    def _build_rows(self, block: Block, columns: list[pa.Array] | None) -> pa.Table | None:
        rows = None
        if columns is None:
            columns, rows = self._parse_lines(block)
        if not len(columns[0]):
            return None
        cells = dict(zip(self._heading.names, columns, strict=True))
        table = self._columns.convert(cells, lambda: rows or _list_rows(block), self._separator)
        decimal = "," if self._columns.has_decimal_commas else "."
        self._notes.form = replace(self._notes.form, decimal=decimal)
        return table.slice(0, len(table) - _count_words(columns, table.columns))

    # The heading

    def _begin(self, block: Block) -> Block:
        # All comments above the table, which may be many, and some of its lines are read.
        comments = sum(1 for _ in takewhile(lambda line: line[1].startswith("#"), block.lines()))
        first_lines = islice(block.lines(), comments + SNIFFED_LINES)
        lines = [line for line in first_lines if not is_rule(line[1])]
        if not lines:
            return block
        self._heading = find_heading(lines, self._notes, self._choices.sign, self._choices.header)
        self._notes.form = replace(
            self._choices,
            header=self._heading.row,
            separator=NAMES_OF_SIGNS.get(self._heading.separator, ""),
        )
        rows_follow = self._heading.rows_follow
        head = "\n".join(line for row, line in lines if rows_follow - 2 < row <= rows_follow)
        self._has_gaps = head != close_quotes(head, self._separator)
        return Block(rows_follow, block.text.split("\n", rows_follow - block.first_row)[-1])

    def _clean(self, text: str) -> str:
        """Return lines of the table without comments, and with tabs in place of blanks that separate cells."""
        if self._heading.has_comments:
            text = _COMMENTS.sub("", text)
        if self._heading.separator == BLANKS:
            return _BLANKS.sub(lambda match: match[1] or "\t", _MARGINS.sub("", text))
        return close_quotes(text, self._separator) if self._has_gaps else text

    # Where the table ends

    def _cut_table(self, block: Block) -> tuple[Block, Block | None]:
        """Return the rows of this table in a block, and a block with the lines of the next table.

        The second block begins with the heading of the next table; it is None if no other table begins here. If the
        heading of this table is repeated, it is left out.
        """
        if not has_numbers(self._heading.kinds) or not _MAY_BE_NAMES.search(block.text):
            return block, None
        lines = block.text.split("\n")
        repeated = []
        for index in range(len(lines)):
            names = self._find_names(lines[index : index + _LOOK_AHEAD])
            if names == list(self._heading.names):
                repeated.append(block.first_row + index)
                lines[index] = ""
            elif names:
                row = block.first_row + index
                if not self._tables_left:
                    self._notes.say(
                        f"another table begins in line {row}, with {listed(map(repr, names))}:"
                        f" --table {self._choices.table + 1} reads it"
                    )
                rest = Block(row, "\n".join(lines[index:]))
                return Block(block.first_row, "\n".join(lines[:index])), rest
        self._notes.say_rows("the heading is repeated", repeated)
        return Block(block.first_row, "\n".join(lines)), None

    def _find_names(self, lines: Sequence[str]) -> list[str]:
        """Return the cells of the first line if it is the heading of a table whose rows follow; else an empty list."""
        if not _MAY_BE_NAMES.match(lines[0]):
            return []
        rows = split_rows(list(enumerate(lines)), self._separator)
        first = next(rows)
        width = len(first.cells)
        if width < 2 or set(first.kinds) != {"w"}:
            return []
        below = list(islice(rows, _MIN_ROWS))
        are_rows = all(len(row.cells) == width and has_numbers(row.kinds) for row in below)
        is_heading = are_rows and len(below) == _MIN_ROWS
        return [name.strip() for name in first.cells] if is_heading else []

    # Cells

    def _parse_block(self, text: str, kinds: Mapping[str, pa.DataType]) -> list[pa.Array] | None:
        """Return rows parsed by pyarrow; None if a row has another number of cells, or a cell another type."""
        if text.isspace() or not text:
            return [pa.nulls(0, pa.string()) for _ in self._heading.names]
        types = {name: kinds.get(name, pa.string()) for name in self._heading.names}
        decimal_point = "," if self._columns.has_decimal_commas else "."
        parse = pa_csv.ParseOptions(delimiter=self._separator)
        try:
            table = _parse_csv(
                text, types, parse, null_values=EMPTY_CELLS, decimal_point=decimal_point
            )
        except pa.ArrowInvalid:
            return None
        if '"' in text and table.num_rows != len(list(Block(1, text).lines())):
            return None
        return [column.combine_chunks() for column in table.columns]

    def _parse_lines(self, block: Block) -> tuple[list[pa.Array], list[int]]:
        """Return the columns of rows that are parsed line by line, and the number of each row in the file.

        Short rows are filled, long rows are cut, both with a note.
        """
        width = len(self._heading.names)
        rows = []
        numbers = []
        short = []
        long = []
        others = []
        lines = list(enumerate(block.text.split("\n"), block.first_row))
        for row, cells in split_rows(lines, self._separator, width):
            if len(cells) < width:
                if has_numbers(self._heading.kinds) and not has_numbers(parse_kinds(cells)):
                    others.append(row)
                    continue
                short.append(row)
                cells += [""] * (width - len(cells))
            elif any(cell.strip() for cell in cells[width:]):
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


def _list_rows(block: Block) -> list[int]:
    """Return the number in the file of each line of a block that pyarrow reads as a row: all except empty lines."""
    lines = enumerate(block.text.split("\n"), block.first_row)
    return [row for row, line in lines if line]


def _count_words(texts: Sequence[pa.Array], typed: Sequence[pa.ChunkedArray]) -> int:
    """Return how many rows at the end of a table have words in all columns of numbers.

    They are no rows, but sentences below the table.

    Args:
        texts: The columns as texts.
        typed: The same columns with their types.
    """
    numbers = [
        cells for cells, column in zip(texts, typed, strict=True) if is_floating(column.type)
    ]
    count = 0
    for row in range(len(typed[0]) - 1, -1, -1):
        kinds = parse_kinds([str(cells[row].as_py()) for cells in numbers])
        if "w" not in kinds or has_numbers(kinds):
            break
        count += 1
    return count


def _parse_csv(
    text: str, kinds: Mapping[str, pa.DataType], parse: pa_csv.ParseOptions, **convert: Any
) -> pa.Table:
    """Return rows without a heading as a table; raise ArrowInvalid if a cell does not fit.

    Args:
        text: The rows.
        kinds: The columns with their types.
        parse: Options for parsing.
        **convert: Options for converting cells.
    """
    data = text.encode()
    return pa_csv.read_csv(
        pa.BufferReader(data),
        pa_csv.ReadOptions(column_names=list(kinds), use_threads=False, block_size=len(data) + 1),
        parse,
        pa_csv.ConvertOptions(column_types=dict(kinds), strings_can_be_null=False, **convert),
    )


def read_exported_csv(text: str) -> pa.Table:
    """Return the table in a CSV file that tuisim exported, each column with a type that fits all its cells.

    Raises:
        ValueError: its rows do not fit its header.
    """
    names = next(csv.reader(io.StringIO(text, newline="")), [])
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
    """Return texts as whole numbers, numbers or truth values if all of them can be converted; else return the texts.

    Among numbers, empty texts become missing values.
    """
    cells = pc.if_else(pc.equal(texts, ""), pa.scalar(None, pa.string()), texts)
    for kind in (pa.int64(), pa.float64()) if len(texts) else (pa.float64(),):
        try:
            return cells.cast(kind)
        except pa.ArrowInvalid:
            continue
    truths = pc.is_in(texts, value_set=build_text_array(("True", "False")))
    return pc.equal(texts, "True") if pc.all(truths).as_py() else texts
