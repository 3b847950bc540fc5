"""`tuisim guide`: pages of the guide in the shell, and search."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

import click

from tuisim.base.errors import ConfigError
from tuisim.commands.echo import echo
from tuisim.settings.command_line import WordType, argument, command, option

if TYPE_CHECKING:
    from tuisim.terminal.text_runs import Line

_MAX_COLUMNS = 100
_MAX_RESULTS = 5


def _list_names() -> Sequence[str]:
    from tuisim.guide.catalogue import load_pages

    return list(load_pages())


@command(
    argument("topic", "[TOPIC]", _list_names, required=False),
    option(
        "--search",
        "words",
        metavar="WORDS",
        type=WordType(),
        help="Search the pages for words or a question.",
    ),
    instead={"--html": "`tuisim guide` and the key ? of the app show all pages"},
)
def guide(topic: str | None, words: str | None) -> int:
    """Read the guide: the contents, or the page on a topic.

    In the app, the key ? opens the same pages.
    """
    from tuisim.guide.catalogue import find_page
    from tuisim.guide.text import draw_contents, draw_page

    if topic is not None and words is not None:
        raise ConfigError(
            "TOPIC and --search cannot be combined", "give TOPIC or --search", key="guide"
        )
    if words is not None:
        return _search(words)
    width = _measure_width()
    _show(draw_page(find_page(topic), width) if topic is not None else draw_contents(width))
    return 0


def _measure_width() -> int:
    return (
        min(_MAX_COLUMNS, shutil.get_terminal_size().columns)
        if sys.stdout.isatty()
        else _MAX_COLUMNS
    )


def _show(lines: list[Line]) -> None:
    from tuisim.guide.text import render_lines

    styled = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    text = render_lines(lines, styled=styled)
    if len(lines) < shutil.get_terminal_size().lines:
        click.echo(text, nl=False)
    else:
        click.echo_via_pager(text, color=None)


def _search(words: str) -> int:
    from tuisim.guide.search import search
    from tuisim.guide.text import NO_WORDS, draw_results

    results = search(words)[:_MAX_RESULTS]
    if not results:
        echo(f"{NO_WORDS}: {words}. `tuisim guide` lists all pages.")
        return 1
    _show(draw_results(results, _measure_width()))
    return 0
