"""Cells of a text: numbers in the forms that people and programs write them in; truth values are 1 and 0."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from tuisim.base.data_class import dataclass
from tuisim.engine.core.conditions import NUMBER
from tuisim.logs.arrow import build_text_array

EMPTY_CELLS = ("", "NA", "N/A", "null", "None", "-")
"""Cells that mean a missing value."""
_SPECIAL = r"^[+-]?(?i:inf|infinity|nan)$"
UNIT = (
    r"(?:[mµun]?s|sec|min|h|[mck]?m(?:/s²?)?|°c?|(?:deg|°|rad)(?:/s)?|%|m?v|m?a|w|k?hz|c|k|lux|n|nm|k?g|rpm|dps"
    r"|counts|pulses|ticks)"
)
"""Regular expression of a unit as it stands in cells and below names, in lower case."""
is_unit = re.compile(UNIT, re.IGNORECASE).fullmatch
_UNIT = r"^(?P<number>.*\d\.?)(?P<gap>\s*)(?P<unit>%|°\w?|[A-Za-zµΩ][A-Za-z0-9µΩ²/]{0,7})$"
_JUDGED_CELLS = 10_000
"""Cells of a column from which the form of its numbers is found."""


@dataclass(frozen=True, slots=True)
class NumberForm:
    """The form of a column's numbers, such as their decimal sign."""

    pattern: str = rf"^{NUMBER}$|{_SPECIAL}"
    """Regular expression of a number."""
    changes: tuple[tuple[str, str], ...] = ()
    """Replacements that give Python's form of the number: regular expressions and texts."""
    words: str = ""
    """The form in words, such as that the numbers have a unit; empty for Python's own form."""
    decimal: str = ""
    """The decimal sign, if no other one is possible."""
    is_hexadecimal: bool = False


PLAIN = NumberForm(decimal=".")
DECIMAL_COMMA = NumberForm(
    rf"^[+-]?\d*,?\d+(?:[eE][+-]?\d+)?$|{_SPECIAL}",
    ((",", "."),),
    "have a comma as decimal sign",
    ",",
)
_COMMAS = NumberForm(
    r"^[+-]?(?:\d{1,3}(?:,\d{3})+|\d{1,3})(?:\.\d*)?$",
    ((",", ""),),
    "have commas between thousands (1,000 is a thousand)",
    ".",
)
_POINTS = NumberForm(
    r"^[+-]?(?:\d{1,3}(?:\.\d{3})+|\d{1,3})(?:,\d*)?$",
    ((r"\.", ""), (",", ".")),
    "have points between thousands (1.000 is a thousand)",
    ",",
)
_GAPS = NumberForm(
    r"^[+-]?\d{1,3}(?:[ '\x{a0}\x{202f}’]\d{3})*(?:[.,]\d*)?$",
    ((r"[ '\x{a0}\x{202f}’]", ""), (",", ".")),
    "have gaps between thousands",
)
_HEXADECIMAL = NumberForm(r"^0[xX][0-9a-fA-F]{1,15}$", (), "are hexadecimal", is_hexadecimal=True)
_TRUTHS = NumberForm(r"^(?i:true|false)$", ((r"(?i)true", "1"), (r"(?i)false", "0")))


def parse_numbers(cells: pa.Array, form: NumberForm) -> tuple[pa.Array, pa.Array]:
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
    texts: Any = pc.utf8_trim_whitespace(cells)
    empty = pc.or_(pc.is_null(texts), pc.is_in(texts, value_set=build_text_array(EMPTY_CELLS)))
    return pc.if_else(empty, pa.scalar(None, pa.string()), texts), empty


def find_form(cells: pa.Array, separator: str, decimal: str) -> NumberForm | None:
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
    commas = (_COMMAS, DECIMAL_COMMA) if separator == "," else (DECIMAL_COMMA, _COMMAS)
    forms = [
        form
        for form in (PLAIN, *commas, _POINTS, _GAPS, _HEXADECIMAL, _TRUTHS)
        if not decimal or form.decimal in ("", decimal)
    ]
    return _choose_form(texts, forms) or _find_unit_form(texts, forms)


def _find_unit_form(texts: pa.Array, forms: Sequence[NumberForm]) -> NumberForm | None:
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
    return NumberForm(body, ((rf"\s*{escaped}$", ""), *inner.changes), words)


def _choose_form(texts: pa.Array, forms: Sequence[NumberForm]) -> NumberForm | None:
    """Return the first of some forms that more than half of the texts have; None if no form does."""
    counts = []
    for form in forms:
        count = pc.sum(pc.match_substring_regex(texts, form.pattern)).as_py() or 0
        if count == len(texts):
            return form if count else None
        counts.append(count)
    largest = max(counts)
    return forms[counts.index(largest)] if 2 * largest > len(texts) else None


def is_empty(cells: pa.Array) -> bool:
    """Return whether all cells of a column are empty."""
    return bool(pc.all(_trim(cells)[1]).as_py())
