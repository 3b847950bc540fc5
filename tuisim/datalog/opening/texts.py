"""Columns of text: as they are, or as codes where the same few texts come again and again."""

from __future__ import annotations

import pyarrow as pa
import pyarrow.compute as pc

CODED = pa.dictionary(pa.int32(), pa.string())
"""Each text is kept once, each row holds its number."""

_LEAST_REPEATED = 4
"""Texts are coded that come so many times, on average."""
_FEWEST_CELLS = 100
"""Fewer do not tell."""


def text_kind(cells: pa.Array) -> pa.DataType:
    """Return how a column is kept, by its first cells."""
    often = len(cells) > _FEWEST_CELLS and _LEAST_REPEATED * pc.count_distinct(cells).as_py() <= len(cells)
    return CODED if often else pa.string()
