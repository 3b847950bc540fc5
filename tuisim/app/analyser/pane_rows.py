"""Rows of the panes below the chart: cells and headings as lines of text, and the columns that fit."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from rich.style import Style

from tuisim.app.analyser.table_pane import HEAD, MAX_CELL
from tuisim.terminal.text_runs import Line

Cells = tuple[str, ...]

GAP = 2
"""Number of blank cells between two columns of a table, if the terminal is wide enough."""


def build_rows(
    texts: Sequence[str], widths: Sequence[int], gap: int, style: Style, width: int
) -> list[Line]:
    """Return a row of a pane as lines: one line, or several if its last text has to be wrapped.

    Args:
        texts: The cells of the row.
        widths: The width of each column in characters.
        gap: Blanks between two columns.
        style: The style of the row.
        width: Width of the pane in characters.
    """
    margin = sum(widths[:-1]) + gap * (len(widths) - 1)
    if margin + len(texts[-1]) <= width:
        return [build_row(texts, widths, gap, style)]
    first, *rest = wrap(texts[-1], max(width - margin, 10)) or [""]
    return [
        build_row([*texts[:-1], first], widths, gap, style),
        *([(" " * margin + text, style)] for text in rest),
    ]


def fit_columns(columns: Sequence[int], widths: Sequence[int], width: int) -> list[int]:
    """Return the indices of the first columns that fit into a width; at least one.

    If the last of them has wide texts, it may fit only in part; its texts are then cut.

    Args:
        columns: The indices of the columns to show, in order.
        widths: The widths of all columns in characters.
        width: The width of the pane in characters.
    """
    left = width
    seen: list[int] = []
    for index in columns:
        if seen and widths[index] > left and (widths[index] <= MAX_CELL or left < MAX_CELL // 2):
            break
        left -= widths[index] + GAP
        seen.append(index)
    return seen


def build_head(
    heads: Sequence[str],
    used: Sequence[int],
    rows: Sequence[Cells],
    widths: Sequence[int],
    gap: int,
) -> Line:
    """Return the headings of some columns as a line; those of columns with numbers are aligned to the right.

    Args:
        heads: The headings of all columns.
        used: The indices of the columns to show.
        rows: The rows of the pane.
        widths: The widths of all columns.
        gap: Blanks between two columns.
    """
    return [
        (
            (" " * gap).join(
                head.rjust(widths[index])
                if any(row[index][:1].isdigit() for row in rows)
                else head.ljust(widths[index])
                for head, index in zip(heads, used, strict=True)
            ),
            HEAD,
        )
    ]


def build_row(texts: Sequence[str], widths: Sequence[int], gap: int, style: Style) -> Line:
    """Return the cells of a row of a pane as a line; numbers are aligned to the right of their columns."""
    parts = (
        text.rjust(width) if text[:1].isdigit() or text[:1] == "-" else text.ljust(width)
        for text, width in zip(texts, widths, strict=True)
    )
    return [((" " * gap).join(parts), style)]
