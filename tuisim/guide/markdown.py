"""Markdown as lines of styled text; cells of its tables break between words, and no word is cut."""

from __future__ import annotations

import io
from collections.abc import Iterator, Sequence
from typing import ClassVar

from rich import box
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.markdown import Markdown, MarkdownElement, TableElement
from rich.measure import Measurement
from rich.padding import Padding
from rich.style import Style
from rich.table import Table
from rich.text import Text
from rich.theme import Theme

from tuisim.base import palette
from tuisim.terminal.text_runs import Line, Run

_GAP = 2
"""Blank cells between two columns of a drawn table."""
_INDENT = 2
_PAIR = 2


class WholeTable(TableElement):
    """A Markdown table whose columns are at least as wide as their longest word.

    If the width is too small for that, each row becomes a list: its first cell, then the other cells with their
    headings.
    """

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        headings = (
            [cell.content.copy() for cell in self.header.row.cells]
            if self.header and self.header.row
            else []
        )
        rows = [[cell.content for cell in row.cells] for row in self.body.rows] if self.body else []
        for heading in headings:
            heading.stylize("markdown.table.header")
        columns = [
            _measure_column(console, options, column)
            for column in zip(headings, *rows, strict=False)
        ]
        widths = _compute_widths(columns, options.max_width - _GAP * len(columns))
        yield (
            _build_list(headings, rows) if widths is None else _build_table(headings, rows, widths)
        )


def _measure_column(
    console: Console, options: ConsoleOptions, column: Sequence[Text]
) -> Measurement:
    """Return the widths of the longest word and of the longest text of a table's column, in terminal cells."""
    cells = [Measurement.get(console, options, text) for text in column]
    return Measurement(max(cell.minimum for cell in cells), max(cell.maximum for cell in cells))


def _compute_widths(columns: Sequence[Measurement], room: int) -> list[int] | None:
    """Return the widths of a table's columns in terminal cells.

    The result is None if their longest words do not fit beside each other.

    Args:
        columns: For each column the widths of its longest word and longest text.
        room: The width of all columns together.
    """
    min_total = sum(column.minimum for column in columns)
    if min_total > room:
        return None
    total_span = sum(column.span for column in columns)
    more = min(room - min_total, total_span)
    return [
        column.minimum + (column.span * more // total_span if total_span else 0)
        for column in columns
    ]


def _build_table(
    headings: Sequence[Text], rows: Sequence[Sequence[Text]], widths: Sequence[int]
) -> Table:
    table = Table(
        box=box.SIMPLE,
        pad_edge=False,
        style="markdown.table.border",
        show_edge=True,
        collapse_padding=True,
    )
    for heading, width in zip(headings, widths, strict=True):
        table.add_column(heading, width=width, overflow="fold")
    for row in rows:
        table.add_row(*row)
    return table


def _build_list(headings: Sequence[Text], rows: Sequence[Sequence[Text]]) -> Group:
    def lines() -> Iterator[RenderableType]:
        for row in rows:
            yield Text("")
            yield Text.assemble((row[0].plain, "bold")) if not row[0].spans else row[0]
            for heading, cell in zip(headings[1:], row[1:], strict=False):
                if cell.plain:
                    # In a table of two columns, the cell needs no heading.
                    name = (heading, ": ") if len(headings) > _PAIR else ()
                    yield Padding(Text.assemble(*name, cell, overflow="fold"), (0, 0, 0, _INDENT))

    return Group(*lines())


CODE = Style(color=palette.YELLOW)
_THEME = Theme(
    {
        "markdown.code": CODE,
        "markdown.code_block": CODE,
        "markdown.strong": Style(color=palette.WHITE, bold=True),
        "markdown.item.bullet": Style(color=palette.GREEN),
        "markdown.item.number": Style(color=palette.GREEN),
        "markdown.h2": Style(color=palette.BLUE, bold=True),
        "markdown.h3": Style(bold=True),
        "markdown.link": Style(color=palette.LINK),
    }
)
PLAIN = Style(color=palette.INK)
"""The style of plain text."""


class _Markdown(Markdown):
    elements: ClassVar[dict[str, type[MarkdownElement]]] = {
        **Markdown.elements,
        "table_open": WholeTable,
    }


def render_markdown(text: str, width: int) -> list[Line]:
    """Return Markdown as lines of at most `width` columns, with indented lists and coloured code.

    Several empty lines in a row, as above and below code, become one.
    """
    console = Console(
        file=io.StringIO(),
        width=max(10, width),
        theme=_THEME,
        force_terminal=True,
        color_system="truecolor",
    )
    drawn = _Markdown(text, code_theme="ansi_dark", justify="left")
    lines = console.render_lines(drawn, console.options.update(width=max(10, width)), pad=False)
    rendered = [
        _strip_line([_run(segment.text, segment.style) for segment in line if segment.text])
        for line in lines
    ]
    return [line for line, above in zip(rendered, [[], *rendered], strict=False) if line or above]


def _run(text: str, style: Style | None) -> Run:
    # Background colours are dropped, as they differ from that of the panel.
    decoration = (
        (style or Style()) + Style(bgcolor="default")
        if style and style.bgcolor
        else style or Style()
    )
    return text, PLAIN + decoration


def _strip_line(line: Line) -> Line:
    while line and not line[-1][0].strip():
        line.pop()
    if line:
        text, style = line[-1]
        line[-1] = (text.rstrip(), style)
    return line


def render_plain_text(text: str, width: int = 80) -> str:
    """Return Markdown as plain text with lines of at most `width` columns."""
    return "\n".join("".join(part for part, _ in line) for line in render_markdown(text, width))
