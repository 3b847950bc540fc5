"""Columns of texts as columns of numbers, or of texts that repeat."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.base.errors import listed
from tuisim.logs.cells import (
    DECIMAL_COMMA,
    PLAIN,
    NumberForm,
    find_form,
    is_empty,
    parse_numbers,
)
from tuisim.logs.warnings import Notes

CODED = pa.dictionary(pa.int32(), pa.string())
"""Dictionary-encoded text."""

_MIN_REPEATED = 4
"""Texts are dictionary-encoded if each occurs at least this often, on average."""
_MIN_CELLS = 100
"""With fewer cells, texts are not dictionary-encoded."""


@dataclass(frozen=True, slots=True)
class _Column:
    kind: pa.DataType
    form: NumberForm = PLAIN


class TypedColumns:
    """The types and number forms of the columns of one file, which their first cells decide.

    Args:
        decimal: The decimal sign; empty to find it.
    """

    def __init__(self, notes: Notes, decimal: str) -> None:
        self._notes = notes
        self._decimal = decimal
        self._columns: dict[str, _Column] = {}
        """By name; missing while all cells of a column were empty."""

    def list_plain(self) -> dict[str, pa.DataType]:
        """Return the types of the columns that pyarrow can parse itself, by column; the others are read as texts."""
        forms = (PLAIN, DECIMAL_COMMA) if self.has_decimal_commas else (PLAIN,)
        return {name: column.kind for name, column in self._columns.items() if column.form in forms}

    @property
    def has_decimal_commas(self) -> bool:
        """Whether the numbers of any column have a comma as decimal sign."""
        return any(column.form is DECIMAL_COMMA for column in self._columns.values())

    def convert(
        self,
        columns: Mapping[str, pa.Array],
        list_rows: Callable[[], Sequence[int]],
        separator: str,
    ) -> pa.Table:
        """Return a table in which each column of texts that this reader takes for numbers or times has such values.

        A column whose first cells are neither stays as it is. A cell that its column's type does not allow is null.

        Args:
            columns: The columns by name.
            list_rows: Returns the row of each cell in the file, for a note; called only if a cell is not a number.
            separator: The separator of cells in a line: a comma that separates cells is no decimal sign.
        """
        texts = {
            name: cells
            for name, cells in columns.items()
            if name not in self._columns and not is_empty(cells)
        }
        self._find_columns(texts, separator)
        return pa.table(
            {name: self._convert_column(name, cells, list_rows) for name, cells in columns.items()}
        )

    def _find_columns(self, texts: Mapping[str, pa.Array], separator: str) -> None:
        """Set the types and number forms of new columns.

        Args:
            texts: The first cells of each of these columns, by name.
            separator: The separator of cells in a line.
        """
        forms = {name: find_form(cells, separator, self._decimal) for name, cells in texts.items()}
        if DECIMAL_COMMA in forms.values():
            # If one column has decimal commas, points in the others separate thousands.
            forms = {
                name: find_form(texts[name], separator, ",") or form for name, form in forms.items()
            }
        names_by_words: dict[str, list[str]] = {}
        for name, form in forms.items():
            if form is None:
                self._columns[name] = _Column(_choose_text_kind(texts[name]))
                continue
            self._columns[name] = _Column(pa.float64(), form)
            if form.words and not (form is DECIMAL_COMMA and separator == ";"):
                names_by_words.setdefault(form.words, []).append(repr(name))
        for words, names in names_by_words.items():
            self._notes.say(f"the numbers of {listed(names)} {words}")

    def _convert_column(
        self, name: str, cells: pa.Array, list_rows: Callable[[], Sequence[int]]
    ) -> pa.Array:
        column = self._columns.get(name)
        if column is None:
            return pa.nulls(len(cells))
        if cells.type == column.kind:
            return cells
        if column.kind == CODED:
            return cells.dictionary_encode()
        numbers, wrong = parse_numbers(cells, column.form)
        if len(positions := np.flatnonzero(wrong)):
            rows = list_rows()
            self._notes.add(
                f"cell of {name!r} is not a number",
                f"cells of {name!r} are not numbers",
                [rows[position] for position in positions.tolist()],
            )
        return numbers


def _choose_text_kind(cells: pa.Array) -> pa.DataType:
    """Return the type for a column of texts: `CODED` if the given first cells often repeat, else strings."""
    count = len(cells)
    often = count > _MIN_CELLS and _MIN_REPEATED * pc.count_distinct(cells).as_py() <= count
    return CODED if often else pa.string()
