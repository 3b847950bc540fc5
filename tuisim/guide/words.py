"""The words of questions and of the guide: their stems, and which of them mean the same."""

from __future__ import annotations

import re
import sqlite3
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

_DENIES = re.compile(
    r"\b(?:cannot|can['’]?t|(?:do|does|did|is|are|was|were|has|have|had|wo|would|could|should)nt)\b|n['’]t\b"
)
"""`doesn't`, also typed as `doesnt`."""
_CONTRACTED = re.compile(r"['’](s|m|d|re|ve|ll)\b")
"""Matches the ends of contracted words, such as `it's` and `I'm`."""
_COLOR = re.compile(r"\bcolor(?!_)")
_WORD = re.compile(r"\w+(?:→\w+)*")
"""A word; words joined by an arrow, as `in→out`, are looked for together."""
_SAYS_NOTHING = """
a about all am an and any are as at be because been being both but by can come could did do does doing each few for from
further get gets go goes going had has have having he her here hers him his how i if in into is it its itself just look
make makes making me more most my nor of on once only or our ours see she should show so some somebody such tell
than that the their theirs them then there these they this those to too use used very want wanted was we were what when
where whether which while who whom why will with would you your yours
"""
_IGNORED = frozenset(_SAYS_NOTHING.split())
"""Words that say nothing about the subject of a question. "Not" does: "does not move" is not about moving."""


def split_words(text: str) -> Iterable[str]:
    """Return the words of a text without those that say nothing, such as articles, each once."""
    plain = _COLOR.sub("colour", _CONTRACTED.sub("", _DENIES.sub(" not ", text.lower())))
    return dict.fromkeys(word for word in _WORD.findall(plain) if word not in _IGNORED)


def find_stems(texts: Iterable[str]) -> list[frozenset[str]]:
    """Return for each text the stems of its words, and the meanings of those stems that have one."""
    return [
        stems.union(*(_load_meanings().get(stem, ()) for stem in stems))
        for stems in _stem_words(texts)
    ]


def _stem_words(texts: Iterable[str]) -> list[frozenset[str]]:
    """Return for each text the stems of its words, as SQLite finds them."""
    rows = [(row, " ".join(split_words(text))) for row, text in enumerate(texts)]
    stems: defaultdict[int, set[str]] = defaultdict(set)
    with sqlite3.connect(":memory:") as index:
        index.execute("CREATE VIRTUAL TABLE texts USING fts5(words, tokenize = 'porter unicode61')")
        index.execute("CREATE VIRTUAL TABLE terms USING fts5vocab(texts, instance)")
        index.executemany("INSERT INTO texts (rowid, words) VALUES (?, ?)", rows)
        for term, row in index.execute("SELECT term, doc FROM terms"):
            stems[row].add(term)
    return [frozenset(stems[row]) for row, _ in rows]


@cache
def _load_meanings() -> Mapping[str, frozenset[str]]:
    """Return the meanings of stems: their groups in `synonyms.toml`, each named by its first word, as `=chart`."""
    groups = tomllib.loads((Path(__file__).parent / "synonyms.toml").read_text(encoding="utf-8"))[
        "groups"
    ]
    meanings_of_stem: defaultdict[str, set[str]] = defaultdict(set)
    for group, stems in zip(groups, _stem_words(groups), strict=True):
        for stem in stems:
            meanings_of_stem[stem].add(f"={group.split()[0]}")
    return {stem: frozenset(meanings) for stem, meanings in meanings_of_stem.items()}
