"""Plain tables for the shell."""

from __future__ import annotations

from collections.abc import Sequence

from tuisim.errors import printable


def table(heads: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """Return rows of text under their heads, with aligned columns; columns of numbers are right-aligned."""
    cells = [list(heads), *([printable(str(cell)) for cell in row] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    right = [bool(rows) and all(isinstance(row[at], int | float) for row in rows) for at in range(len(heads))]
    lines = [
        "  ".join(
            cell.rjust(width) if at_right else cell.ljust(width)
            for cell, width, at_right in zip(line, widths, right, strict=True)
        ).rstrip()
        for line in cells
    ]
    return "\n".join(lines)
