"""Texts and lines that are too long say so, and brackets in them are no markup."""

from __future__ import annotations

import pytest
from rich.style import Style
from textual.content import Content

from tests.cases import for_each
from tuisim.terminal.text_runs import cut, cut_line, escape_markup

PLAIN, BOLD = Style(), Style(bold=True)


@pytest.mark.parametrize(
    "text, width, shown",
    [("name", 4, "name"), ("names", 4, "nam…"), ("names", 1, "…"), ("names", 0, ""), ("", 0, "")],
)
def test_a_text_that_is_too_wide_is_cut_with_an_ellipsis(text: str, width: int, shown: str) -> None:
    assert cut(text, width) == shown


@pytest.mark.parametrize(
    "texts, shown",
    [
        (["abc", "def"], ["abc", "def"]),
        (["abc", "defgh"], ["abc", "de…"]),
        (["abcdef", "g"], ["abcde…"]),
        (["abc", "def   "], ["abc", "def   "]),
        (["abcdefgh"], ["abcde…"]),
    ],
    ids=["fits", "in a piece", "between pieces", "blanks", "one piece"],
)
def test_a_line_of_several_runs_is_cut_with_an_ellipsis(texts: list[str], shown: list[str]) -> None:
    line = [(text, BOLD if at else PLAIN) for at, text in enumerate(texts)]
    assert [text for text, _ in cut_line(line, 6)] == shown


@for_each(
    text=["a[b]", "[bold]x[/]", "[ ]", "\\[a]", "[@click=app.quit]", '["=[(\\', "@=\\", "[/a"]
)
def test_escaped_text_is_shown_by_markup_as_it_is(text: str) -> None:
    assert Content.from_markup(escape_markup(text)).plain == text
