"""Cells of text as numbers."""

from __future__ import annotations

from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

from tuisim.datalog.opening.plain import texts_array

_NUMBER = r"^[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?$|^[+-]?(?i:inf|infinity|nan)$"
EMPTY_CELLS = ("", "NA", "N/A", "null", "None", "-")
"""Cells that say that there is no value."""


def parsed_numbers(cells: pa.Array, decimal_comma: bool) -> tuple[pa.Array, pa.Array]:
    """Return cells as float64, with nulls for those that hold no number, and which cells were wrong.

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
        # Of what is empty the first is false and the second is nothing, which makes false.
        good = pc.and_kleene(pc.is_valid(texts), pc.match_substring_regex(texts, _NUMBER))
        wrong = pc.and_(pc.invert(good), pc.invert(empty))
        return pc.cast(pc.if_else(good, texts, nothing), pa.float64()), wrong


def parsed_booleans(cells: pa.Array) -> tuple[pa.Array, pa.Array]:
    """Return cells as booleans, with nulls for those that hold none, and which cells were wrong.

    Args:
        cells: Texts such as `true` or `False`.
    """
    texts: Any = pc.utf8_lower(pc.utf8_trim_whitespace(cells))
    known = pc.is_in(texts, value_set=texts_array(("true", "false")))
    empty = pc.or_(pc.is_null(cells), pc.is_in(pc.utf8_trim_whitespace(cells), value_set=texts_array(EMPTY_CELLS)))
    values = pc.if_else(known, pc.equal(texts, "true"), pa.nulls(len(texts), pa.bool_()))
    return values, pc.invert(pc.or_(known, empty))


def are_booleans(cells: pa.Array) -> bool:
    """Return whether cells hold nothing but true and false, at least one of them."""
    values, wrong = parsed_booleans(cells)
    return values.null_count < len(values) and not pc.any(wrong).as_py()


def are_numbers(cells: pa.Array, decimal_comma: bool) -> bool | None:
    """Return whether most of the cells are numbers, None if all are empty."""
    numbers, wrong = parsed_numbers(cells, decimal_comma)
    good, bad = len(numbers) - numbers.null_count, pc.sum(wrong).as_py() or 0
    if not good and not bad:
        return None
    return bool(good > bad)
