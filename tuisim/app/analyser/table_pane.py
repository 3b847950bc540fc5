"""The table of the analyser as lines."""

from __future__ import annotations

from collections.abc import Sequence

from rich.style import Style

from tuisim.analysis.model import AnalysisModel
from tuisim.app import design
from tuisim.base import palette
from tuisim.base.errors import counted
from tuisim.logs.table import Rows
from tuisim.terminal.text_runs import Line, cut, escape_markup, find_first_row

PLAIN, DIM = Style(color=palette.INK), Style(color=palette.SOFT)
HEAD = Style(color=palette.BLUE, bold=True)
HERE = Style(color=palette.WHITE, bgcolor=design.CHOSEN)
CHOSEN = Style(color=palette.YELLOW, bold=True)
MAX_CELL = 28
"""Maximum width of a column of the table, in characters; longer texts are cut."""
_SAMPLED = 40
"""Number of rows, from the first visible one, whose texts determine the widths of the columns."""


def build_table_lines(model: AnalysisModel, width: int, height: int) -> list[Line]:
    """Return the lines of the table: the rows around the cursor, with as many columns as fit."""
    rows = model.rows
    if not len(rows):
        return [[("No row matches the filter: U clears it", DIM)]]
    place = rows.place(model.row)
    room = max(height - 1, 1)
    first = find_first_row(place, len(rows), room)
    shown_rows = [rows.row(index) for index in range(first, min(first + room, len(rows)))]
    number_width = max(len(f"{shown_rows[-1] + 1:,}"), len(f"{shown_rows[0] + 1:,}"))
    columns, widths = _fit_columns(model, shown_rows, width - number_width - 2)
    lines = [_build_head_line(model, columns, widths, number_width)]
    cells = [_read_cells(rows, column, shown_rows) for column in columns]
    for row, *texts in zip(shown_rows, *cells, strict=True):
        style = HERE if row == model.row else PLAIN
        line: Line = [(f"{row + 1:>{number_width},}  ", HERE if row == model.row else DIM)]
        for text, wide in zip(texts, widths, strict=True):
            shown_text = cut(text, wide)
            line.append(
                (
                    (shown_text.rjust(wide) if _is_number(text) else shown_text.ljust(wide)) + "  ",
                    style,
                )
            )
        if row == model.row:
            line.append((" " * width, HERE))
        lines.append(line)
    return lines


def _build_head_line(
    model: AnalysisModel, columns: Sequence[str], widths: Sequence[int], number_width: int
) -> Line:
    rows = model.rows
    head: Line = [(" " * (number_width + 2), HEAD)]
    for column, wide in zip(columns, widths, strict=True):
        arrow = ""
        if column == rows.view.sorted_by:
            arrow = "↓" if rows.view.descending else "↑"
        text = cut(build_heading(model, column) + arrow, wide).ljust(wide)
        head += [
            (text, CHOSEN + Style(underline=True) if column == rows.chosen else HEAD),
            ("  ", HEAD),
        ]
    return head


def _read_cells(rows: Rows, column: str, shown_rows: Sequence[int]) -> list[str]:
    """Return the texts of a column at some rows of the log; the decimal points of numbers are below each other."""
    texts = [rows.text(row, column).replace("\n", "↵").replace("\t", " ") for row in shown_rows]
    tails = [len(text) - len(text.partition(".")[0]) if _is_number(text) else 0 for text in texts]
    return [
        text + " " * (max(tails) - tail) if _is_number(text) else text
        for text, tail in zip(texts, tails, strict=True)
    ]


def _is_number(text: str) -> bool:
    return text[:1].isdigit() or (text[:1] == "-" and text[1:2].isdigit())


def _fit_columns(
    model: AnalysisModel, shown_rows: list[int], width: int
) -> tuple[list[str], list[int]]:
    """Return the names and widths of the columns that fit: the frozen columns and the selected one among them."""
    rows = model.rows
    seen = shown_rows[:_SAMPLED]

    def measure_column(column: str) -> int:
        widths = [
            len(build_heading(model, column)) + 1,
            *map(len, _read_cells(rows, column, seen)),
        ]
        return min(max(widths), MAX_CELL)

    frozen = rows.columns[: rows.frozen]
    widths = {column: measure_column(column) for column in frozen}
    left = width - sum(widths.values()) - 2 * len(frozen)
    others = rows.columns[rows.frozen :]
    index = max(rows.column - rows.frozen, 0)
    # The columns to the left of the selected one are chosen first, then those to its right, until the width is full.
    chosen: list[str] = []
    for column in [*reversed(others[: index + 1]), *others[index + 1 :]]:
        need = measure_column(column) + 2
        if need > left and chosen:
            break
        widths[column], left = min(need, max(left, 3)) - 2, left - need
        chosen.append(column)
    columns = frozen + [column for column in others if column in chosen]
    return columns, [widths[column] for column in columns]


def build_heading(model: AnalysisModel, column: str) -> str:
    """Return the heading of a column in the table: its name, but `nth run` for the column `run` of stored runs.

    This column counts the runs of the log from 1, while the title of the screen has their numbers in the store.
    """
    return f"nth {column}" if column == "run" and model.opened.runs else column


def count_rows(model: AnalysisModel) -> str:
    """Return in words how many rows the table shows, and the filter that selects them.

    If the log is from stored runs and its column `index` is selected, the text also explains the values of that column.
    """
    rows = model.rows
    if rows.columns and rows.chosen == "index" and model.opened.runs:
        return f"index: s since the first sample  {_count_shown_rows(model)}"
    return _count_shown_rows(model)


def _count_shown_rows(model: AnalysisModel) -> str:
    rows = model.rows
    total = model.log.rows
    words = f"{len(rows):,} of {total:,} rows" if len(rows) != total else counted(total, "row")
    conditions = " and ".join(map(str, rows.view.conditions))
    return escape_markup(f"{words}: {conditions}") if conditions else words
