"""Search: which pages answer words that somebody types, the best one first.

SQLite ranks pages, and their passages, by BM25 of the stems of their words: a rare word counts more. A page counts with
its best passage, and its further words are words of each. Which passage of a page answers is ranked without these: they
would make the rarest words of a page look common, and all its passages alike.
"""

from __future__ import annotations

import re
import sqlite3
from collections.abc import Iterator, Mapping
from functools import cache

from tuisim.data_class import dataclass
from tuisim.guide.catalogue import pages
from tuisim.guide.tables import markdown_of

_WORD = re.compile(r"\w+(?:→\w+)*")
"""A word; words joined by an arrow, as `in→out`, are looked for together."""
_HEADING = re.compile(r"^##+ (.+)$", re.MULTILINE)
_FENCE = re.compile(r"^```.*\n?", re.MULTILINE)
_PASSAGE_END = re.compile(r"\n\s*\n(?!    )|\n(?=- |\| )")
"""A passage is a paragraph, with a text set in below it, an item of a list or a row of a table."""
_HEAD = re.compile(r"^\|.*\n(?=\| ---)", re.MULTILINE)
"""The head of a table, which answers nothing."""
_RULE = re.compile(r"[-| ]*")
"""The line below it."""
_CONTRACTED = re.compile(r"(n't|['’](s|m|d|re|ve|ll|t))\b")
"""The ends of `doesn't`, `it's`, `I'm`."""
_SAYS_NOTHING = """
a about all am an and any are as at be because been being both but by can come could did do does doing each few for from
further get gets go goes going had has have having he her here hers him his how i if in into is it its itself just look
make makes making me more most my nor not of on once only or our ours see she should show so some somebody such tell
than that the their theirs them then there these they this those to too use used very want wanted was we were what when
where whether which while who whom why will with would you your yours
"""
_IGNORED = frozenset(_SAYS_NOTHING.split())
"""Words that say nothing about the subject of a question."""
_SHORTEST = 3
"""Letters from which a word may be the beginning of another."""
_FIELDS = "name UNINDEXED, heading UNINDEXED, passage, titles, words"
_TITLES, _WORDS = 2.0, 2.0
"""How much a word counts in title and heading, and among the page's further words; 1 in the text."""
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


def search(question: str) -> list[SearchResult]:
    """Return the pages that answer words of a question best, the best one first, ten at most.

    Args:
        question: Words; one that no page has may be the beginning of another.
    """
    words = dict.fromkeys(_WORD.findall(_CONTRACTED.sub("", question.lower())))
    terms = [f'"{word}"' for word in words if word not in _IGNORED]
    whole = [term if len(term) < _SHORTEST + 2 or _found("whole", term) else f"{term}*" for term in terms]
    if not whole:
        return []
    query = " OR ".join(whole)
    best, of_pages, answers = (_found(table, query) for table in ("passages", "whole", "answers"))
    order = sorted(best, key=lambda name: -best[name][0] - of_pages[name][0])
    return [answers[name][1] if name in answers else SearchResult(name, "", "") for name in order[:_MOST]]
