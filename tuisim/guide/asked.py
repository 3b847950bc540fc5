"""Questions that people ask, in words that the guide need not have, and the passages that answer them.

To add one: a line in `questions.toml`. How alike two questions are is the cosine of their words' stems, in which a word
counts more the fewer questions have it.
"""

from __future__ import annotations

import math
import re
import sqlite3
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path

from tuisim.data_class import dataclass

_DENIES = re.compile(r"(?<=can)not\b|n['’]t\b")
_CONTRACTED = re.compile(r"['’](s|m|d|re|ve|ll)\b")
"""The ends of `it's`, `I'm`."""
_COLOR = re.compile(r"\bcolor(?!_)")
_WORD = re.compile(r"\w+(?:→\w+)*")
"""A word; words joined by an arrow, as `in→out`, are looked for together."""
_SAYS_NOTHING = """
a about all am an and any are as at be because been being both but by can come could did do does doing each few for from
further get gets go goes going had has have having he her here hers him his how i if in into is it its itself just look
make makes making me more most my nor not of on once only or our ours see she should show so some somebody such tell
than that the their theirs them then there these they this those to too use used very want wanted was we were what when
where whether which while who whom why will with would you your yours
"""
_IGNORED = frozenset(_SAYS_NOTHING.split())
"""Words that say nothing about the subject of a question."""
_DENIED = frozenset(["not"])
"""Counts in the questions that people ask: "does not move" is not about moving."""


@dataclass(frozen=True, slots=True)
class Likeness:
    """The question of a page that is most like one that somebody types."""

    cosine: float
    """From 0 to 1."""
    key: str
    """A text that is in the passage which answers it."""


def words_of(question: str, kept: frozenset[str] = frozenset()) -> Iterable[str]:
    """Return the words of a question that say something, and those of `kept`."""
    text = _COLOR.sub("colour", _CONTRACTED.sub("", _DENIES.sub(" not ", question.lower())))
    return dict.fromkeys(word for word in _WORD.findall(text) if word not in _IGNORED or word in kept)


@cache
def asked_questions() -> Mapping[str, Mapping[str, tuple[str, ...]]]:
    """Return by page the questions that it answers, by a text that is in the passage which answers them."""
    text = (Path(__file__).parent / "questions.toml").read_text(encoding="utf-8")
    return {page: {key: tuple(asks) for key, asks in of.items()} for page, of in tomllib.loads(text).items()}


class _Stems:
    """The stems of the words of questions, as SQLite finds them."""

    def __init__(self) -> None:
        # The app searches in threads, one at a time.
        self._texts = sqlite3.connect(":memory:", check_same_thread=False)
        self._texts.execute("CREATE VIRTUAL TABLE texts USING fts5(words, tokenize = 'porter unicode61')")
        self._texts.execute("CREATE VIRTUAL TABLE terms USING fts5vocab(texts, instance)")

    def of(self, questions: Iterable[str]) -> list[frozenset[str]]:
        """Return the stems of each question."""
        rows = [(row, " ".join(words_of(question, _DENIED))) for row, question in enumerate(questions)]
        self._texts.execute("DELETE FROM texts")
        self._texts.executemany("INSERT INTO texts (rowid, words) VALUES (?, ?)", rows)
        found: defaultdict[int, set[str]] = defaultdict(set)
        for term, row in self._texts.execute("SELECT term, doc FROM terms"):
            found[row].add(term)
        return [frozenset(found[row]) for row, _ in rows]


class _Questions:
    """All questions with the stems of their words."""

    def __init__(self) -> None:
        self._stems = _Stems()
        self._answers = [
            (page, key, ask) for page, of in asked_questions().items() for key, asks in of.items() for ask in asks
        ]
        self._of_each = self._stems.of(ask for *_, ask in self._answers)
        self._having = Counter(stem for stems in self._of_each for stem in stems)
        self._lengths = [math.sqrt(self._weight(stems)) for stems in self._of_each]

    def _weight(self, stems: Iterable[str]) -> float:
        count = len(self._of_each) + 1
        return math.fsum(math.log(count / (self._having[stem] + 0.5)) ** 2 for stem in stems)

    def like(self, question: str) -> Mapping[str, Likeness]:
        (typed,) = self._stems.of([question])
        length = math.sqrt(self._weight(typed))
        best: dict[str, Likeness] = {}
        for (page, key, _), stems, its_length in zip(self._answers, self._of_each, self._lengths, strict=True):
            if common := typed & stems:
                cosine = self._weight(common) / length / its_length
                if page not in best or cosine > best[page].cosine:
                    best[page] = Likeness(cosine, key)
        return best


@cache
def _questions() -> _Questions:
    return _Questions()


def like(question: str) -> Mapping[str, Likeness]:
    """Return by page the question that is most like one that somebody types, if it has a word of it."""
    return _questions().like(question)
