"""Search: which passages of the guide answer words that somebody types, the best one first.

Question and passages are compared by the cosine of the stems of their words, in which a word counts more the fewer
passages have it, and words that mean the same count as one, too. A passage counts with its own words, with those of its
headings and its page, and with the questions that people ask and it answers: with the one that is most alike, and with
all of them together, since people ask for the same thing in many words. To add a question: a line in `questions.toml`.
"""

from __future__ import annotations

import math
import re
import sqlite3
import tomllib
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from itertools import pairwise, takewhile
from pathlib import Path
from statistics import median
from textwrap import indent
from threading import Lock
from typing import TypeAlias

from tuisim.base.data_class import dataclass
from tuisim.guide.catalogue import load_pages
from tuisim.guide.tables import build_markdown

_MIN_LETTERS, _ENDING_LETTERS = 4, 2
"""A word matches a word of a question that begins like it: all letters but the last two must be equal, and at least
four.
"""
_PLAIN = ("not", "one")
"""Words of a question that `compile_pattern` leaves out, although the search uses them: they say too little."""


@cache
def load_questions() -> Mapping[str, Mapping[str, tuple[str, ...]]]:
    """Return the questions that the guide answers: by the page's name, then by a text in the answering passage."""
    text = (Path(__file__).parent / "questions.toml").read_text(encoding="utf-8")
    return {
        page: {key: tuple(asks) for key, asks in of.items()}
        for page, of in tomllib.loads(text).items()
    }


_HEADING = re.compile(r"^##+ (.+)$", re.MULTILINE)
_FENCED = re.compile(r"^```(.*)\n((?:.*\n)*?)```$\n?", re.MULTILINE)
_PASSAGE_END = re.compile(r"(?<!:)\n\s*\n(?!    )|\n(?=- |\| |\d+\. )")
"""Matches the gap between two passages. A passage is an item of a list, a row of a table, or a paragraph with the
indented text below it and, if it ends with a colon, what follows.
"""
_ITEM = re.compile(r"- |\| |\d+\. ")
SET_IN = "    "
"""The beginning of each line of indented text, such as code."""
_RULE = re.compile(r"[-| ]+")
"""Matches the line of dashes below the head of a table in Markdown."""
_NO_ANSWER = re.compile(r"# .*|")
"""Matches the title of a page, or an empty text: neither is a passage."""
_MIN_PREFIX_LETTERS = 3
"""An unknown word of a question with at least this number of letters also stands for the known words that begin with
it.
"""
_MIN_MISTYPED_LETTERS = 5
"""Fewest letters of an unknown word that is corrected to the most similar one: shorter words are like too many others.
"""
_ALIKE = 0.8
"""Smallest similarity, as `difflib` computes it from 0 to 1, of an unknown word and the known word to which it is
corrected.
"""
_PASSAGE_WEIGHT = 1.0
_HEADINGS_WEIGHT = 0.6
_PAGE_WORDS_WEIGHT = 1.0
_WHOLE_PAGE_WEIGHT = 0.6
"""`_PASSAGE_WEIGHT`, `_HEADINGS_WEIGHT`, `_PAGE_WORDS_WEIGHT` and `_WHOLE_PAGE_WEIGHT` say how much these count for a
question: the words of a passage, those of its headings, the further words of its page, and the share of the question's
words that are anywhere on its page.
"""
_ALL_QUESTIONS_WEIGHT = 1.0
_NEAREST_QUESTION_WEIGHT = 0.5
_SAME_QUESTION_WEIGHT = 1.5
"""`_ALL_QUESTIONS_WEIGHT`, `_NEAREST_QUESTION_WEIGHT` and `_SAME_QUESTION_WEIGHT` say how much a passage's questions in
`questions.toml` count: all together, the one most alike, and its similarity cubed, which is high for the same question.

The method is the vector space model: stems are weighted by their inverse document frequency, texts are compared by
the cosine, and the weighted cosines of the fields are added. The weights are set by hand. Of 400 questions, drawn at
random and left out of `questions.toml`, 28 % find their passage as the first one and 52 % among the first three.
Without the words of the passage it is 24 % and 47 %, without the headings 26 % and 52 %; half or twice a weight moves
neither figure by more than 3 %. The three weights of questions cost such new questions 2 to 4 % each. They are there
for the questions of the file, each of which must find its passage among the first two.
"""
_MIN_STEM_WEIGHT = 0.05
"""The smallest weight of a word in a question, which even the most common words have."""
_MAX_RESULTS = 12
"""Largest number of passages that a search returns for a question or a part of it; further ones only share common words
with it.
"""
_SURE_RESULTS = 2
_MIN_SHARE = 0.5
"""A search returns the best `_SURE_RESULTS` passages, whatever their scores; a further passage needs this share of the
best score.
"""
_PART_BREAK = re.compile(r"[?!.;,]+\s+|\b(?:and|or|but|then)\b")
"""Matches the gap between two parts of a question."""
_MIN_PART_WORDS = 2
"""Fewest words of a part of a question that is also looked for by itself."""

_Stems: TypeAlias = frozenset[str]


@dataclass(frozen=True, slots=True)
class SearchResult:
    """A passage of the guide, such as a paragraph, that answers a question."""

    name: str
    """The name of the page that has the passage."""
    heading: str
    """The heading of the section that has the passage; empty for the beginning of the page."""
    passage: str
    """The passage in Markdown: a paragraph, an item of a list or a row of a table."""
    head: str = ""
    """The head, in Markdown, of the table of which the passage is a row; empty if the passage is no row."""
    below: tuple[str, ...] = ()
    """The passages that this one introduces: items of a list, or rows of a table."""


class _Postings:
    """An index of texts, which finds those that are most similar to a question by their words' stems.

    Args:
        texts: The stems of each text, with their weights.
        power: How much the length of a text lowers its similarity. With 1, the similarity is the cosine of the angle
            between text and question; with less, longer texts count as more similar.
    """

    def __init__(self, texts: Sequence[Mapping[str, float]], power: float = 1.0) -> None:
        self._rows: defaultdict[str, list[tuple[int, float]]] = defaultdict(list)
        lengths = [math.hypot(*weights.values()) for weights in texts]
        usual = median(length for length in lengths if length) ** (1 - power)
        for row, (weights, length) in enumerate(zip(texts, lengths, strict=True)):
            for stem, weight in weights.items():
                self._rows[stem].append((row, weight / (length**power * usual)))

    def compute_cosines(self, question: Mapping[str, float]) -> Mapping[int, float]:
        """Return the similarity to a question of each text that shares a stem with it, by the text's row.

        Args:
            question: The weights of the question's stems; the sum of their squares is 1.
        """
        cosines: defaultdict[int, float] = defaultdict(float)
        for stem, weight in question.items():
            for row, text_weight in self._rows.get(stem, ()):
                cosines[row] += weight * text_weight
        return cosines


class _Index:
    """All passages of the guide, with the stems of their words and of the questions that they answer."""

    def __init__(self) -> None:
        self.passages = list(_iterate_passages())
        row_by_key = {
            (name, key): self._find_row(name, key)
            for name, of in load_questions().items()
            for key in of
        }
        questions = [
            (row, question)
            for (name, key), row in row_by_key.items()
            if row >= 0
            for question in load_questions()[name][key]
        ]
        self.row_of_ask = [row for row, _ in questions]
        texts = find_stems(passage.passage for passage in self.passages)
        question_stems = find_stems(question for _, question in questions)
        heads = find_stems(
            f"{load_pages()[passage.name].title} {passage.heading}" for passage in self.passages
        )
        of_pages = find_stems(f"{page.words} {page.about}" for page in load_pages().values())
        words = dict(zip(load_pages(), of_pages, strict=True))
        self._having = _count_passages(texts, zip(self.row_of_ask, question_stems, strict=True))
        self.stems_of_page = {
            name: frozenset().union(*(texts[row] | heads[row] | words[name] for row in rows))
            for name, rows in self._group_rows().items()
        }
        self.stems = frozenset().union(*self.stems_of_page.values(), *question_stems)
        self.texts = _Postings([self.weights(stems) for stems in texts], power=0.5)
        self.heads = _Postings([self.weights(stems) for stems in heads])
        self.words = _Postings([self.weights(words[passage.name]) for passage in self.passages])
        self.asks = _Postings([self.weights(stems) for stems in question_stems])
        self.all_asks = _Postings(self._sum_questions(question_stems))

    def _find_row(self, name: str, key: str) -> int:
        """Return the index of the passage of a page that contains a text.

        The result is -1 if no passage does, as users may change the questions.

        Args:
            name: The name of the page.
            key: The text.
        """
        return next(
            (
                row
                for row, passage in enumerate(self.passages)
                if passage.name == name and key in passage.passage
            ),
            -1,
        )

    def _group_rows(self) -> Mapping[str, Sequence[int]]:
        rows: defaultdict[str, list[int]] = defaultdict(list)
        for row, passage in enumerate(self.passages):
            rows[passage.name].append(row)
        return rows

    def _sum_questions(self, question_stems: Iterable[_Stems]) -> list[dict[str, float]]:
        """Return for each passage the weights of the stems in all questions that it answers, by stem.

        The weights of each question are scaled so that the sum of their squares is 1, and then added.

        Args:
            question_stems: The stems of each question.
        """
        sums: list[dict[str, float]] = [{} for _ in self.passages]
        for row, stems in zip(self.row_of_ask, question_stems, strict=True):
            weights = self.weights(stems)
            length = math.hypot(*weights.values())
            for stem, weight in weights.items():
                sums[row][stem] = sums[row].get(stem, 0.0) + weight / length
        return sums

    def weights(self, stems: Iterable[str]) -> dict[str, float]:
        """Return the weight of each stem, which is larger for stems that fewer passages contain."""
        count = len(self.passages) + 1
        return {
            stem: max(math.log(count / (self._having[stem] + 0.5)), _MIN_STEM_WEIGHT)
            for stem in stems
        }

    def expand_stems(self, typed: _Stems) -> _Stems:
        """Return the known stems for the stems of a question.

        An unknown stem is replaced by the known stems that begin with it, or by the most similar stem.
        """
        unknown = [stem for stem in typed - self.stems if len(stem) >= _MIN_PREFIX_LETTERS]
        return (typed & self.stems).union(*map(self._find_alike, unknown))

    def _find_alike(self, stem: str) -> Iterable[str]:
        begun = [known for known in self.stems if known.startswith(stem)]
        if begun or len(stem) < _MIN_MISTYPED_LETTERS:
            return begun
        return get_close_matches(stem, sorted(self.stems), 1, _ALIKE)


def _count_passages(
    texts: Sequence[_Stems], question_stems: Iterable[tuple[int, _Stems]]
) -> Counter[str]:
    """Return for each stem the number of passages that have it in their text or in the questions that they answer.

    Args:
        texts: The stems of each passage.
        question_stems: The row of the passage and the stems of each question.
    """
    of_each = [{*stems} for stems in texts]
    for row, stems in question_stems:
        of_each[row] |= stems
    return Counter(stem for stems in of_each for stem in stems)


def _iterate_passages() -> Iterator[SearchResult]:
    for name, page in load_pages().items():
        parts = ["", *_HEADING.split(_FENCED.sub(_indent_fenced, build_markdown(page)))]
        for heading, text in zip(parts[::2], parts[1::2], strict=True):
            pairs = list(
                _pair_heads([*(part.strip("\n") for part in _PASSAGE_END.split(text)), ""])
            )
            for number, (passage, head) in enumerate(pairs):
                if not _NO_ANSWER.fullmatch(passage):
                    below = (
                        takewhile(_ITEM.match, (later for later, _ in pairs[number + 1 :]))
                        if passage.endswith(":")
                        else ()
                    )
                    yield SearchResult(name, heading, passage, head, tuple(below))


def _indent_fenced(fenced: re.Match[str]) -> str:
    """Return the text between two fences as indented code, so that it stays with the passage above it.

    Lines for a shell begin with `$ `.
    """
    prompt = "$ " if fenced[1].startswith("sh") else ""
    return indent(fenced[2], SET_IN + prompt, lambda _: True)


def _pair_heads(passages: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield each passage with the heading row of its table, or an empty text; heading rows themselves are left out."""
    head = ""
    for passage, below in pairwise(passages):
        if _RULE.fullmatch(below):
            head = passage
        elif not _RULE.fullmatch(passage):
            head = head if passage.startswith("|") else ""
            yield passage, head


_LOCK = Lock()


def load_index() -> _Index:
    """Return the index of the guide; if another thread is building it already, wait for that."""
    with _LOCK:
        return _build_index()


@cache
def _build_index() -> _Index:
    return _Index()


def _score_passages(index: _Index, typed: _Stems) -> Mapping[int, float]:
    """Return the scores of the passages that may answer a question, by their row.

    Args:
        index: The passages.
        typed: The stems of the question.
    """
    weights = index.weights(typed)
    length = math.hypot(*weights.values())
    question = {stem: weight / length for stem, weight in weights.items()}
    scores: defaultdict[int, float] = defaultdict(float)
    for field, field_weight in (
        (index.texts, _PASSAGE_WEIGHT),
        (index.heads, _HEADINGS_WEIGHT),
        (index.words, _PAGE_WORDS_WEIGHT),
        (index.all_asks, _ALL_QUESTIONS_WEIGHT),
    ):
        for row, cosine in field.compute_cosines(question).items():
            scores[row] += field_weight * cosine
    nearest: dict[int, float] = {}
    for number, cosine in index.asks.compute_cosines(question).items():
        row = index.row_of_ask[number]
        nearest[row] = max(cosine, nearest.get(row, 0.0))
    for row, cosine in nearest.items():
        scores[row] += _NEAREST_QUESTION_WEIGHT * cosine + _SAME_QUESTION_WEIGHT * cosine**3
    whole = sum(weights.values())
    on_page = {
        name: sum(weights[stem] for stem in typed & page_stems) / whole
        for name, page_stems in index.stems_of_page.items()
    }
    return {
        row: score + _WHOLE_PAGE_WEIGHT * on_page[index.passages[row].name]
        for row, score in scores.items()
    }


def _rank_passages(index: _Index, question: str) -> list[int]:
    """Return the rows of the passages that answer a question, the best first, without passages of far lower scores."""
    typed = index.expand_stems(find_stems([question])[0])
    if not typed:
        return []
    scores = _score_passages(index, typed)
    rows = sorted(scores, key=lambda row: -scores[row])[:_MAX_RESULTS]
    return [
        row
        for place, row in enumerate(rows)
        if place < _SURE_RESULTS or scores[row] >= _MIN_SHARE * scores[rows[0]]
    ]


def _split_question(question: str) -> list[str]:
    """Return the parts of a question about several things; an empty list for a question about one thing."""
    parts = [
        part
        for part in _PART_BREAK.split(question)
        if len(list(split_words(part))) >= _MIN_PART_WORDS
    ]
    return parts if len(parts) > 1 else []


def compile_pattern(question: str) -> re.Pattern[str] | None:
    """Return a pattern that matches the words of a question, also with other endings; None if it has none."""
    words = [word for word in split_words(question) if word not in _PLAIN]
    begins = [re.escape(word[: max(_MIN_LETTERS, len(word) - _ENDING_LETTERS)]) for word in words]
    return re.compile(rf"(?i)\b(?:{'|'.join(begins)})\w*") if begins else None


def search(question: str) -> list[SearchResult]:
    """Return the passages of the guide that answer a question best, the best first.

    Args:
        question: Words; a word that is on no page may be the beginning of another, or mistyped. If the question is
            about several things, the best answers to its parts follow the first two.
    """
    index = load_index()
    rows = _rank_passages(index, question)
    part_rows = [
        row for part in _split_question(question) for row in _rank_passages(index, part)[:1]
    ]
    return [
        index.passages[row] for row in dict.fromkeys([*rows[:_SURE_RESULTS], *part_rows, *rows])
    ]


_DENIES = re.compile(
    r"\b(?:cannot|can['’]?t|(?:do|does|did|is|are|was|were|has|have|had|wo|would|could|should)nt)\b|n['’]t\b"
)
"""Matches the negation in a word such as `doesn't`, also typed as `doesnt`."""
_CONTRACTED = re.compile(r"['’](s|m|d|re|ve|ll)\b")
"""Matches the ends of contracted words, such as `it's` and `I'm`."""
_COLOR = re.compile(r"\bcolor(?!_)")
_WORD = re.compile(r"\w+(?:→\w+)*")
"""Matches a word; words that an arrow joins, as in `in→out`, count as one word."""
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
    """Return the words of a text, each once, without words such as articles that do not help the search."""
    plain = _COLOR.sub("colour", _CONTRACTED.sub("", _DENIES.sub(" not ", text.lower())))
    return dict.fromkeys(word for word in _WORD.findall(plain) if word not in _IGNORED)


def find_stems(texts: Iterable[str]) -> list[frozenset[str]]:
    """Return for each text the stems of its words, with the groups of synonyms of these stems."""
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
    """Return the groups of synonyms of each stem in `synonyms.toml`.

    A group is named by its first word, such as `=chart`.
    """
    groups = tomllib.loads((Path(__file__).parent / "synonyms.toml").read_text(encoding="utf-8"))[
        "groups"
    ]
    meanings_of_stem: defaultdict[str, set[str]] = defaultdict(set)
    for group, stems in zip(groups, _stem_words(groups), strict=True):
        for stem in stems:
            meanings_of_stem[stem].add(f"={group.split()[0]}")
    return {stem: frozenset(meanings) for stem, meanings in meanings_of_stem.items()}
