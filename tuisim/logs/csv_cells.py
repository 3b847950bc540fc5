"""Texts in cells of CSV that a spreadsheet would take for formulas: written with an apostrophe, and read without it."""

from __future__ import annotations

import csv
import re
from typing import TYPE_CHECKING, Any

from tuisim.engine.core.conditions import NUMBER

if TYPE_CHECKING:
    import pandas as pd

_SIGNS = "=+@\uff1d\uff0b\uff0d\uff20-"
"""Characters with which a formula of a spreadsheet can begin, also in their full-width forms."""
_RISKY = rf"'*(?:[ \f\v]*[{_SIGNS}]|[\t\r\n])"
"""Regular expression of the beginning of a cell that a spreadsheet may take for a formula. Apostrophes before it match
too, so that reading can undo writing.
"""
WRITTEN = f"^'({_RISKY})"
"""Regular expression of the beginning of an escaped cell in a CSV file; the group is the beginning without the added '.
"""

_is_risky = re.compile(_RISKY).match
_is_number = re.compile(NUMBER).fullmatch


def escape_formula(text: str) -> str:
    """Return a text with a ' in front if a spreadsheet would take it for a formula; numbers are unchanged."""
    return f"'{text}" if _is_risky(text) and not _is_number(text) else text


def restore_formula(text: str) -> str:
    """Return the original of a text returned by `escape_formula`."""
    return re.sub(WRITTEN, r"\1", text)


def write_csv(frame: pd.DataFrame, handle: Any) -> None:
    """Write a frame as CSV; cells and names of columns that a spreadsheet would take for formulas are escaped.

    Args:
        frame: The frame.
        handle: An open file, of text or of bytes.
    """
    escaped = frame.copy(deep=False)
    quoting = csv.QUOTE_MINIMAL
    for index in range(len(frame.columns)):
        column = frame.iloc[:, index]
        if column.dtype.kind in "biufmM":
            continue
        cells = column.tolist()
        texts = {cell for cell in cells if isinstance(cell, str)}
        if any("\r" in text for text in texts):
            # pandas does not quote a carriage return by itself, although it ends a row.
            quoting = csv.QUOTE_NONNUMERIC
        if changed := {text: safe for text in texts if (safe := escape_formula(text)) != text}:
            escaped.isetitem(
                index,
                [changed.get(cell, cell) if isinstance(cell, str) else cell for cell in cells],
            )
    heading = [escape_formula(str(name)) for name in frame.columns]
    # pandas writes floats as their shortest exact text, and time spans as it prints them.
    escaped.to_csv(
        handle, header=heading, index=False, quoting=quoting, lineterminator="\n", encoding="utf-8"
    )
