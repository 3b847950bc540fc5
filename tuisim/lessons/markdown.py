"""Markdown as lines of styled text."""

from __future__ import annotations

import io
from typing import ClassVar

from rich.console import Console
from rich.markdown import Markdown, MarkdownElement
from rich.style import Style
from rich.theme import Theme

from tuisim import palette
from tuisim.lessons.markdown_table import WholeTable
from tuisim.terminal.text_runs import Line, Run

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
"""The style of a text that is nothing special."""


class _Markdown(Markdown):
    elements: ClassVar[dict[str, type[MarkdownElement]]] = {
        **Markdown.elements,
        "table_open": WholeTable,
    }


def markdown_lines(text: str, width: int) -> list[Line]:
    """Return Markdown as lines of at most a number of columns; lists are indented, code is coloured.

    Of several empty lines, as above and below code, there is one.
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
    found = [
        _stripped([_run(segment.text, segment.style) for segment in line if segment.text])
        for line in lines
    ]
    return [line for line, above in zip(found, [[], *found], strict=False) if line or above]


def _run(text: str, style: Style | None) -> Run:
    # Without background colours, which differ from those of the panel.
    shown = (
        (style or Style()) + Style(bgcolor="default")
        if style and style.bgcolor
        else style or Style()
    )
    return text, PLAIN + shown


def _stripped(line: Line) -> Line:
    while line and not line[-1][0].strip():
        line.pop()
    if line:
        text, style = line[-1]
        line[-1] = (text.rstrip(), style)
    return line


def plain_text(text: str, width: int = 80) -> str:
    """Return Markdown as plain text."""
    return "\n".join("".join(part for part, _ in line) for line in markdown_lines(text, width))
