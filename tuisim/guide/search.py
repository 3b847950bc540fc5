"""Search: which pages answer words that somebody types, the best one first.

SQLite ranks pages, and their passages, by BM25 of the stems of their words: a rare word counts more. A page counts with
its best passage, and its further words are words of each. Which passage of a page answers is ranked without these: they
would make the rarest words of a page look common, and all its passages alike.

A question that is like one of `asked` also counts for its page, and finds the passage that answers it.
"""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Iterator, Mapping
from functools import cache

from tuisim.data_class import dataclass
from tuisim.guide import asked
from tuisim.guide.catalogue import pages
from tuisim.guide.tables import markdown_of

_HEADING = re.compile(r"^##+ (.+)$", re.MULTILINE)
_FENCE = re.compile(r"^```.*\n?", re.MULTILINE)
_PASSAGE_END = re.compile(r"\n\s*\n(?!    )|\n(?=- |\| )")
"""A passage is a paragraph, with a text set in below it, an item of a list or a row of a table."""
_HEAD = re.compile(r"^\|.*\n(?=\| ---)", re.MULTILINE)
"""The head of a table, which answers nothing."""
_RULE = re.compile(r"[-| ]*")
"""The line below it."""
_SHORTEST = 3
"""Letters from which a word may be the beginning of another."""
_FIELDS = "name UNINDEXED, heading UNINDEXED, passage, titles, words"
_TITLES, _WORDS = 2.0, 2.0
"""How much a word counts in title and heading, and among the page's further words; 1 in the text."""
_ASKED = 1.5
"""How much the same question counts, where the page with most of the words counts 1; one less alike counts far less."""
_LIKE = 0.5
"""From this cosine on, the passage that answers a question which people ask answers the one that somebody types."""
_MOST = 10
"""So many pages are read through; further ones share common words only."""


@dataclass(frozen=True, slots=True)
class SearchResult:
    """A page that answers a question."""

    name: str
    heading: str
    """The section that answers best; empty for the beginning of the page."""
    passage: str
    """The part of it that answers best, in Markdown: a paragraph, an item of a list or a row of a table; empty if only
    the page as a whole answers."""


def _passages() -> Iterator[tuple[str, ...]]:
    for name, page in pages().items():
        parts = ["", *_HEADING.split(_HEAD.sub("", _FENCE.sub("", markdown_of(page))))]
        for heading, text in zip(parts[::2], parts[1::2], strict=True):
            found = map(str.strip, _PASSAGE_END.split(text))
            for passage in (one for one in found if not _RULE.fullmatch(one)):
                yield name, heading, passage, f"{page.title} {name} {heading}", f"{page.words} {page.about}"


@cache
def _index() -> sqlite3.Connection:
    # The app searches in threads, one at a time.
    index = sqlite3.connect(":memory:", check_same_thread=False)
    for table in ("passages", "whole", "answers"):
        index.execute(f"CREATE VIRTUAL TABLE {table} USING fts5({_FIELDS}, tokenize = 'porter unicode61')")
    index.executemany("INSERT INTO passages VALUES (?, ?, ?, ?, ?)", _passages())
    index.execute(
        "INSERT INTO whole SELECT name, '', group_concat(passage, ' '), group_concat(titles, ' '), words "
        "FROM passages GROUP BY name"
    )
    # The title of a page answers nothing.
    index.execute(
        "INSERT INTO answers SELECT name, heading, passage, heading, '' FROM passages WHERE passage NOT LIKE '# %'"
    )
    return index


def _found(table: str, query: str) -> Mapping[str, tuple[float, SearchResult]]:
    """Return by page the best row of a table, with its score."""
    ranked = (
        f"SELECT -bm25({table}, 0, 0, 1, {_TITLES}, {_WORDS}) AS score, name, heading, passage FROM {table} "
        f"WHERE {table} MATCH ? ORDER BY score"
    )
    return {name: (score, SearchResult(name, *rest)) for score, name, *rest in _index().execute(ranked, (query,))}


def _passage_with(name: str, key: str) -> SearchResult | None:
    """Return the passage of a page that has a text. Keys that a user has changed may be in none."""
    rows = _index().execute("SELECT heading, passage FROM answers WHERE name = ? ORDER BY rowid", (name,))
    return next((SearchResult(name, *row) for row in rows if key in row[1]), None)


def search(question: str) -> list[SearchResult]:
    """Return the pages that answer words of a question best, the best one first, ten at most.

    Args:
        question: Words; one that no page has may be the beginning of another.
    """
    terms = [f'"{word}"' for word in asked.words_of(question)]
    whole = [term if len(term) < _SHORTEST + 2 or _found("whole", term) else f"{term}*" for term in terms]
    if not whole:
        return []
    query = " OR ".join(whole)
    best, of_pages, answers = (_found(table, query) for table in ("passages", "whole", "answers"))
    scores = {name: best[name][0] + of_pages[name][0] for name in best}
    most, like = max(scores.values(), default=1.0), asked.like(question)

    def score(name: str) -> float:
        return scores.get(name, 0.0) / most + (_ASKED * like[name].cosine ** 3 if name in like else 0.0)

    def answer(name: str) -> SearchResult:
        if name in like and like[name].cosine >= _LIKE and (found := _passage_with(name, like[name].key)):
            return found
        return answers[name][1] if name in answers else SearchResult(name, "", "")

    return [answer(name) for name in sorted({**scores, **like}, key=score, reverse=True)[:_MOST]]
