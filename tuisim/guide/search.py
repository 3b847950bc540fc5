"""Search: which pages answer words that somebody types, the best one first."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from math import log

from tuisim.data_class import dataclass
from tuisim.guide.catalogue import pages
from tuisim.guide.tables import markdown_of

_WORD = re.compile(r"[^\W_]+")
_HEADING = re.compile(r"^##+ (.+)$", re.MULTILINE)
_SAYS_NOTHING = """
a an and are as at be by can do does for from get how i if in is it its me my not of on or same see show so somebody
that the there these they this to use used want was what when where which while why will with you your
"""
_IGNORED = frozenset(_SAYS_NOTHING.split())
"""Words that say nothing about the subject of a question."""
_ENDINGS = ("ings", "ing", "ies", "ed", "es", "s", "e")
_SHORTEST = 3
_TITLE, _WORDS, _HEADINGS, _TEXT = 4.0, 3.0, 1.5, 1.0
"""How much a word counts, by where it is."""
_ENOUGH = 2.0
"""A word in a text counts half as much as it can after so many times."""


@dataclass(frozen=True, slots=True)
class SearchResult:
    """A page that answers a question."""

    name: str
    score: float
    heading: str
    """The section with most of the words; empty for the beginning of the page."""


def _stem(word: str) -> str:
    for ending in _ENDINGS:
        if word.endswith(ending) and len(word) - len(ending) >= _SHORTEST:
            stem = word.removesuffix(ending)
            # run, running; stop, stopped
            return stem[:-1] if len(stem) > _SHORTEST and stem[-1] == stem[-2] and stem[-1] not in "lsz" else stem
    return word


def stems(text: str) -> list[str]:
    """Return the words of a text that say something, without their endings."""
    words = (word.lower() for word in _WORD.findall(text))
    return [_stem(word) for word in words if word not in _IGNORED]


@dataclass(frozen=True, slots=True)
class _Entry:
    title: frozenset[str]
    words: frozenset[str]
    headings: frozenset[str]
    text: Mapping[str, int]
    sections: tuple[tuple[str, frozenset[str]], ...]

    def weight(self, stem: str) -> float:
        """How much the page says about a word."""
        count = self.text.get(stem, 0)
        return (
            _TITLE * (stem in self.title)
            + _WORDS * (stem in self.words)
            + _HEADINGS * (stem in self.headings)
            + _TEXT * count / (count + _ENOUGH)
        )

    def has(self) -> frozenset[str]:
        return self.title | self.words | self.headings | self.text.keys()


def _sections(markdown: str) -> Iterator[tuple[str, frozenset[str]]]:
    parts = _HEADING.split(markdown)
    yield "", frozenset(stems(parts[0]))
    for heading, text in zip(parts[1::2], parts[2::2], strict=True):
        yield heading, frozenset(stems(f"{heading} {text}"))


@cache
def _index() -> Mapping[str, _Entry]:
    found = {}
    for name, page in pages().items():
        markdown = markdown_of(page)
        found[name] = _Entry(
            title=frozenset(stems(f"{page.title} {page.name}")),
            words=frozenset(stems(f"{page.words} {page.about}")),
            headings=frozenset(stems(" ".join(_HEADING.findall(markdown)))),
            text=Counter(stems(markdown)),
            sections=tuple(_sections(markdown)),
        )
    return found


def search(question: str) -> list[SearchResult]:
    """Return the pages that have words of a question, the best one first.

    Args:
        question: Words; the end of the last one may still be missing.
    """
    index = _index()
    wanted = dict.fromkeys(stems(question))
    every = {name: entry.has() for name, entry in index.items()}
    known = frozenset().union(*every.values())
    groups = [[stem] if stem in known else [one for one in known if one.startswith(stem)] for stem in wanted]
    rarity = [log(1 + len(index) / (1 + sum(any(one in has for one in group) for has in every.values())))
              for group in groups]  # fmt: skip
    found = []
    for name, entry in index.items():
        weights = [rare * max((entry.weight(one) for one in group), default=0.0)
                   for group, rare in zip(groups, rarity, strict=True)]  # fmt: skip
        if score := sum(weights):
            share = sum(weight > 0 for weight in weights) / len(weights)
            found.append(SearchResult(name, score * share, _best_section(entry, groups)))
    return sorted(found, key=lambda one: -one.score)


def _best_section(entry: _Entry, groups: list[list[str]]) -> str:
    counts = [(sum(any(one in stems_ for one in group) for group in groups), heading)
              for heading, stems_ in entry.sections]  # fmt: skip
    return max(counts, key=lambda pair: pair[0])[1]
