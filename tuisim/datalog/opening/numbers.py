"""Cells of text as numbers."""

from __future__ import annotations

from typing import Any

import pyarrow as pa
import pyarrow.compute as pc

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
    empty = pc.fill_null(pc.is_in(texts, value_set=pa.array(EMPTY_CELLS)), True)
    texts = pc.if_else(empty, None, texts)
    wrong = pa.nulls(len(texts), pa.bool_())
    try:
        return pc.cast(texts, pa.float64()), pc.fill_null(wrong, False)
    except pa.ArrowInvalid:
        good = pc.fill_null(pc.match_substring_regex(texts, _NUMBER), False)
        wrong = pc.and_(pc.invert(good), pc.invert(empty))
        return pc.cast(pc.if_else(good, texts, None), pa.float64()), wrong


def are_numbers(cells: pa.Array, decimal_comma: bool) -> bool | None:
    """Return whether most of the cells are numbers, None if all are empty."""
    numbers, wrong = parsed_numbers(cells, decimal_comma)
    good, bad = len(numbers) - numbers.null_count, pc.sum(wrong).as_py() or 0
    if not good and not bad:
        return None
    return bool(good > bad)
