"""Cells of a text as columns: numbers in the forms that people and programs write, truth values as 1 and 0, texts."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.base.errors import listed
from tuisim.engine.core.conditions import NUMBER
from tuisim.logs.arrow import build_text_array
from tuisim.logs.warnings import Notes

EMPTY_CELLS = ("", "NA", "N/A", "null", "None", "-")
"""Cells that mean a missing value."""
MINUS = "\N{MINUS SIGN}"
_SPECIAL = r"^[+-]?(?i:inf|infinity|nan)$"
UNIT = (
    r"(?:[mµun]?s|sec|min|h|[mck]?m(?:/s²?)?|°c?|(?:deg|°|rad)(?:/s)?|%|m?v|m?a|w|k?hz|c|k|lux|n|nm|k?g|rpm|dps"
    r"|counts|pulses|ticks)"
)
"""Regular expression of a unit as it stands in cells and below names, in lower case."""
is_unit = re.compile(UNIT, re.IGNORECASE).fullmatch
UNIT_WORDS = frozenset(
    (
        "second",
        "volt",
        "volts",
        "amp",
        "ampere",
        "watt",
        "deg c",
        "degc",
        "ts",
        "rn",
        "units",
        "sequence",
    )
)
"""Further units that the row below the names of columns can have, such as an oscilloscope or a data logger writes it.
"""
_UNIT = r"^(?P<number>.*\d\.?)(?P<gap>\s*)(?P<unit>%|°\w?|[€$£¥]|[A-Za-zµΩ][A-Za-z0-9µΩ²/]{0,7})$"
_JUDGED_CELLS = 10_000
"""Number of cells of a column, from its first one, by which the form of its numbers is found."""
_CODED = pa.dictionary(pa.int32(), pa.string())
"""Arrow's type of dictionary-encoded texts, which stores equal texts once."""
_MIN_REPEATED = 4
"""The texts of a column are dictionary-encoded if each text occurs in it at least this often, on average."""
_MIN_CELLS = 100
"""The texts of a column are dictionary-encoded only if it has more than this number of cells."""


@dataclass(frozen=True, slots=True)
class _NumberForm:
    """The form of a column's numbers, such as their decimal sign."""

    pattern: str = rf"^{NUMBER}$|{_SPECIAL}"
    """Regular expression of a cell that is a number in this form."""
    changes: tuple[tuple[str, str], ...] = ()
    """Pairs of a regular expression and its replacement, which bring a number from this form to Python's."""
    words: str = ""
    """The form in words, such as that the numbers have a unit; empty for Python's own form."""
    decimal: str = ""
    """The decimal sign of numbers in this form; empty if the form does not decide it."""
    is_hexadecimal: bool = False


_PLAIN = _NumberForm(decimal=".")
_DECIMAL_COMMA = _NumberForm(
    rf"^[+-]?\d*,?\d+(?:[eE][+-]?\d+)?$|{_SPECIAL}",
    ((",", "."),),
    "have a comma as decimal sign",
    ",",
)
_COMMAS = _NumberForm(
    r"^[+-]?(?:\d{1,3}(?:,\d{2,3})*,\d{3}|\d{1,3})(?:\.\d*)?$",
    ((",", ""),),
    "have commas between thousands (1,000 is a thousand)",
    ".",
)
_POINTS = _NumberForm(
    r"^[+-]?(?:\d{1,3}(?:\.\d{3})+|\d{1,3})(?:,\d*)?$",
    ((r"\.", ""), (",", ".")),
    "have points between thousands (1.000 is a thousand)",
    ",",
)
_GAPS = _NumberForm(
    r"^[+-]?\d{1,3}(?:[ '\x{a0}\x{202f}’]\d{3})*(?:[.,]\d*)?$",
    ((r"[ '\x{a0}\x{202f}’]", ""), (",", ".")),
    "have gaps between thousands",
)
_HEXADECIMAL = _NumberForm(r"^0[xX][0-9a-fA-F]{1,15}$", (), "are hexadecimal", is_hexadecimal=True)
_BARE_HEXADECIMAL = replace(_HEXADECIMAL, pattern=r"^[0-9a-fA-F]{2,15}$", changes=(("^", "0x"),))
_TRUTHS = _NumberForm(r"^(?i:true|false)$", ((r"(?i)true", "1"), (r"(?i)false", "0")))


def _parse_numbers(cells: pa.Array, form: _NumberForm) -> tuple[pa.Array, pa.Array]:
    """Return texts as float64, with nulls for the texts that are not numbers.

    Args:
        cells: The texts.
        form: The form of the numbers.

    Returns:
        Numbers, and a mask of the cells that are neither a number nor empty.
    """
    texts, empty = _trim(cells)
    good = pc.fill_null(pc.match_substring_regex(texts, form.pattern), False)
    wrong = pc.invert(pc.or_(good, empty))
    texts = pc.if_else(good, texts, pa.scalar(None, pa.string()))
    for pattern, new in form.changes:
        texts = pc.replace_substring_regex(texts, pattern, new)
    whole = pc.cast(texts, pa.int64()) if form.is_hexadecimal else texts
    numbers = pc.cast(whole, pa.float64())
    is_special = pc.match_substring_regex(texts, _SPECIAL)
    too_large = pc.fill_null(pc.and_(pc.is_inf(numbers), pc.invert(is_special)), False)
    return pc.if_else(too_large, pa.scalar(None, pa.float64()), numbers), pc.or_(wrong, too_large)


def _trim(cells: pa.Array) -> tuple[Any, Any]:
    """Return texts without blanks around them, with null for empty texts, and a mask of the empty texts."""
    texts: Any = pc.replace_substring(pc.utf8_trim_whitespace(cells), MINUS, "-")
    empty = pc.or_(pc.is_null(texts), pc.is_in(texts, value_set=build_text_array(EMPTY_CELLS)))
    return pc.if_else(empty, pa.scalar(None, pa.string()), texts), empty


def _find_form(cells: pa.Array, separator: str, decimal: str) -> _NumberForm | None:
    """Return the form in which most cells of a column are numbers; None if most are not numbers.

    Args:
        cells: Texts, at least one of which is not empty.
        separator: The separator of the table's cells. If it is a comma, 1,000 in a cell means a thousand, otherwise 1.
        decimal: The decimal sign; empty to find it.
    """
    texts = _trim(cells)[0].drop_null()[:_JUDGED_CELLS]
    special = pc.match_substring_regex(texts, _SPECIAL)
    if not pc.all(special).as_py():
        texts = texts.filter(pc.invert(special))
    if _is_bare_hexadecimal(texts):
        return _BARE_HEXADECIMAL
    commas = (_COMMAS, _DECIMAL_COMMA) if separator == "," else (_DECIMAL_COMMA, _COMMAS)
    forms = [
        form
        for form in (_PLAIN, *commas, _POINTS, _GAPS, _HEXADECIMAL, _TRUTHS)
        if not decimal or form.decimal in ("", decimal)
    ]
    return _choose_form(texts, forms) or _find_unit_form(texts, forms)


def _is_bare_hexadecimal(texts: pa.Array) -> bool:
    """Return whether texts are hexadecimal numbers without `0x`, as loggers of a CAN bus write them.

    They must all have the same length. At least one must contain a letter, and at least one must look like a plain
    number.
    """
    are_alike = pc.count_distinct(pc.utf8_length(texts)).as_py() == 1
    if (
        not are_alike
        or not pc.all(pc.match_substring_regex(texts, _BARE_HEXADECIMAL.pattern)).as_py()
    ):
        return False
    are_plain = pc.match_substring_regex(texts, _PLAIN.pattern)
    begin_plain = pc.match_substring_regex(texts, r"^(?:\d+$|00)")
    return not pc.all(are_plain).as_py() and bool(pc.any(begin_plain).as_py())


def _find_unit_form(texts: pa.Array, forms: Sequence[_NumberForm]) -> _NumberForm | None:
    """Return the form of numbers followed by a unit, such as `12 cm`; None if most of the texts have no unit."""
    parts: Any = pc.extract_regex(texts, _UNIT)
    units = Counter(pc.struct_field(parts, "unit").drop_null().to_pylist())
    unit, count = next(iter(units.most_common(1)), ("", 0))
    inner = _choose_form(pc.struct_field(parts, "number").drop_null(), forms)
    # Time spans of pandas are times, not numbers with a unit, even if all are `0 days`.
    if inner is None or unit == "days" or 2 * count <= len(texts):
        return None
    # Labels such as 1a and 2a are not numbers with a unit.
    if not is_unit(unit) and not all(pc.struct_field(parts, "gap").to_pylist()):
        return None
    escaped = re.escape(unit)
    body = inner.pattern.replace("$", rf"\s*(?:{escaped})?$")
    words = f"have the unit {unit}" + (f" and {inner.words}" if inner.words else "")
    return _NumberForm(body, ((rf"\s*{escaped}$", ""), *inner.changes), words)


def _choose_form(texts: pa.Array, forms: Sequence[_NumberForm]) -> _NumberForm | None:
    """Return the first of some forms that more than half of the texts have; None if no form does."""
    counts = []
    for form in forms:
        count = pc.sum(pc.match_substring_regex(texts, form.pattern)).as_py() or 0
        if count == len(texts):
            return form if count else None
        counts.append(count)
    largest = max(counts)
    return forms[counts.index(largest)] if 2 * largest > len(texts) else None


def _is_empty(cells: pa.Array) -> bool:
    """Return whether all cells of a column are empty."""
    return bool(pc.all(_trim(cells)[1]).as_py())


@dataclass(frozen=True, slots=True)
class _Column:
    kind: pa.DataType
    form: _NumberForm = _PLAIN


class TypedColumns:
    """Converts the columns of one file from texts to numbers and times; the first cells of each column decide its type.

    Args:
        decimal: The decimal sign; empty to find it.
    """

    def __init__(self, notes: Notes, decimal: str) -> None:
        self._notes = notes
        self._decimal = decimal
        self._columns: dict[str, _Column] = {}
        """The type and form of each column, by its name; a column whose cells were all empty so far is missing."""

    def list_plain(self) -> dict[str, pa.DataType]:
        """Return the types of the columns that pyarrow can parse itself, by column; the others are read as texts."""
        forms = (_PLAIN, _DECIMAL_COMMA) if self.has_decimal_commas else (_PLAIN,)
        return {name: column.kind for name, column in self._columns.items() if column.form in forms}

    @property
    def has_decimal_commas(self) -> bool:
        """Whether the numbers of any column have a comma as decimal sign."""
        return any(column.form is _DECIMAL_COMMA for column in self._columns.values())

    def convert(
        self,
        columns: Mapping[str, pa.Array],
        list_rows: Callable[[], Sequence[int]],
        separator: str,
    ) -> pa.Table:
        """Return columns of texts as a table: the texts become numbers or times in each column that has such values.

        The first cells of a column decide this. If they are texts of another kind, the column stays as it is. A cell
        that does not fit the type of its column becomes null.

        Args:
            columns: The columns by name.
            list_rows: Returns the row of each cell in the file, for a note; called only if a cell is not a number.
            separator: The separator of cells in a line: a comma that separates cells is no decimal sign.
        """
        texts = {
            name: cells
            for name, cells in columns.items()
            if name not in self._columns and not _is_empty(cells)
        }
        self._find_columns(texts, separator)
        return pa.table(
            {name: self._convert_column(name, cells, list_rows) for name, cells in columns.items()}
        )

    def _find_columns(self, texts: Mapping[str, pa.Array], separator: str) -> None:
        """Find out the types of new columns and the forms of their numbers, and store them in this object.

        Args:
            texts: The first cells of each of these columns, by name.
            separator: The separator of cells in a line.
        """
        forms = {name: _find_form(cells, separator, self._decimal) for name, cells in texts.items()}
        if _DECIMAL_COMMA in forms.values():
            # If one column has decimal commas, points in the others separate thousands.
            forms = {
                name: _find_form(texts[name], separator, ",") or form
                for name, form in forms.items()
            }
        names_by_words: dict[str, list[str]] = {}
        for name, form in forms.items():
            if form is None:
                self._columns[name] = _Column(_choose_text_kind(texts[name]))
                continue
            self._columns[name] = _Column(pa.float64(), form)
            if form.words and not (form is _DECIMAL_COMMA and separator == ";"):
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
        if column.kind == _CODED:
            return cells.dictionary_encode()
        numbers, wrong = _parse_numbers(cells, column.form)
        if len(positions := np.flatnonzero(wrong)):
            rows = list_rows()
            self._notes.add(
                f"cell of {name!r} is not a number",
                f"cells of {name!r} are not numbers",
                [rows[position] for position in positions.tolist()],
            )
        return numbers


def _choose_text_kind(cells: pa.Array) -> pa.DataType:
    """Return the type for a column of texts, judged by its first cells.

    It is `_CODED`, which stores equal texts once, if the cells often repeat; otherwise it is that of plain strings.
    """
    count = len(cells)
    often = count > _MIN_CELLS and _MIN_REPEATED * pc.count_distinct(cells).as_py() <= count
    return _CODED if often else pa.string()
