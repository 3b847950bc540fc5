"""`tuisim guide`: pages of the guide in the shell, and search."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Sequence

import click
from rich.style import Style

from tuisim.base.errors import ConfigError, closest, did_you_mean
from tuisim.commands.echo import echo
from tuisim.guide.catalogue import CONTENTS, Page, load_pages
from tuisim.guide.excerpt import draw_excerpt
from tuisim.guide.markdown import PLAIN, render_markdown
from tuisim.guide.search import SearchResult
from tuisim.settings.command_line import WordType, argument, command, option
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
    from tuisim.guide.text import draw_page

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

    styled = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    text = render_lines(lines, styled=styled)
    if len(lines) < shutil.get_terminal_size().lines:
        click.echo(text, nl=False)
    else:
        click.echo_via_pager(text, color=None)


def _search(words: str) -> int:
    from tuisim.guide.search import search
    from tuisim.guide.text import NO_WORDS

    results = search(words)[:_MAX_RESULTS]
    if not results:
        echo(f"{NO_WORDS}: {words}. `tuisim guide` lists all pages.")
        return 1
    _show(draw_results(results, _measure_width()))
    return 0


_PASSAGE_LINES = 2
"""The most lines of a passage that are shown among the results of a search."""


def draw_contents(width: int) -> list[Line]:
    """Return the contents of the guide as lines: the titles of the pages in each part."""
    text = [
        "# The guide",
        "`tuisim guide TOPIC` shows a page, `tuisim guide --search WORDS` finds one.",
    ]
    for part, names in CONTENTS.items():
        text += [
            f"## {part}",
            "\n".join(f"- `{name}` {load_pages()[name].title}" for name in names),
        ]
    return render_markdown("\n\n".join(text), width)


def draw_results(results: list[SearchResult], width: int) -> list[Line]:
    """Return the results of a search as lines, the best first, each under the names of its page and section."""
    lines = []
    for hit in results:
        title = f"- `{hit.name}` **{load_pages()[hit.name].title}**{f': {hit.heading}' if hit.heading else ''}"
        passage = draw_excerpt(hit, max(20, width - 3), _PASSAGE_LINES)
        lines += [*render_markdown(title, width), *([("   ", PLAIN), *line] for line in passage)]
    return lines


def render_lines(lines: list[Line], *, styled: bool) -> str:
    """Return lines as one text; if `styled`, with control sequences for a terminal."""

    def render_run(text: str, style: Style) -> str:
        # Colours become bold, as they may be illegible on the terminal's background.
        bold = style.bold or style.color != PLAIN.color
        return (
            Style(bold=bold, italic=style.italic, underline=style.underline).render(text)
            if styled
            else text
        )

    return "\n".join("".join(render_run(*run) for run in line) for line in lines) + "\n"


def find_page(name: str) -> Page:
    """Return the page of the guide with a name.

    Raises:
        ConfigError: there is no such page.
    """
    known = load_pages()
    if name not in known:
        raise ConfigError(
            f"no such page {name!r}",
            did_you_mean(closest(name, known, 1, 0.7))
            or f"`tuisim guide` lists the pages, `tuisim guide --search {name}` searches them",
            key="guide",
        )
    return known[name]
