"""Programs of a class that resemble each other: shown to the tutor, never judged.

The fingerprints are those of Schleimer, Wilkerson and Aiken, "Winnowing: Local Algorithms for Document Fingerprinting"
(SIGMOD 2003), on which MOSS is built. Names, numbers and texts count as one token each, and comments and blank lines
as none, so that a program resembles its copy with other names. What most of a class has in common says nothing and is
left out, as are programs too short to be told apart.
"""

from __future__ import annotations

import io
import keyword
import tokenize
import zlib
from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import chain, combinations, islice, takewhile

from tuisim.base.data_class import dataclass

_SKIPPED = frozenset(
    {
        tokenize.COMMENT,
        tokenize.NL,
        tokenize.ENCODING,
        tokenize.ENDMARKER,
        tokenize.TYPE_COMMENT,
    }
)
_ONE_TOKEN: Mapping[int, str] = {
    tokenize.NUMBER: "0",
    tokenize.STRING: '""',
    tokenize.NEWLINE: "\n",
    tokenize.INDENT: ">",
    tokenize.DEDENT: "<",
}
_BLANK = frozenset({tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT})


@dataclass(frozen=True, slots=True)
class Token:
    """A token of a program with its line; programs are compared by the kinds of their tokens."""

    kind: str
    """The same for all names, all numbers and all texts."""
    text: str
    line: int


MAX_LINE = 100_000
"""The most characters of a line: for each digit of a number, the search for tokens takes 600 bytes of memory."""


def list_tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a program; if it has a syntax error or a very long line, only the tokens before that."""
    lines = takewhile(lambda line: len(line) <= MAX_LINE, io.StringIO(text))
    try:
        for token in tokenize.generate_tokens(lines.__next__):
            if token.type in _SKIPPED:
                continue
            if token.type == tokenize.ERRORTOKEN and token.string in "'\"":
                # A string without an end stops the search, as each further quote would be searched to the end.
                return
            kind = _ONE_TOKEN.get(token.type, token.string)
            if token.type == tokenize.NAME and not keyword.iskeyword(kind):
                kind = "x"
            word = kind if token.type in _BLANK else token.string
            yield Token(kind, word, token.start[0])
    except (tokenize.TokenError, SyntaxError):
        pass


TOKENS = 10
"""Length of the passages that are compared: shorter ones are found in any two programs."""
WINDOW = 6
"""Of so many passages in a row, one is a fingerprint: a common passage of `TOKENS + WINDOW - 1` tokens is found."""
MIN_TOKENS = 40
"""Shorter programs are not compared, as they can be alike by chance."""
MAX_TOKENS = 50_000
"""The most tokens of a student that are compared, which limits the memory; longer texts are mostly data."""
COMMON_SHARE = 0.25
MIN_COMMON = 5
"""A passage in more than this share of the programs, and in more than so many, is common to the class."""
MIN_SHARE = 0.6
"""Pairs that share fewer of their fingerprints are left out."""
MIN_LINES = 5
"""Pairs with fewer lines in common are not shown."""
MAX_PAIRS = 60


@dataclass(frozen=True, slots=True)
class SimilarPair:
    """Two students' programs that share passages."""

    names: tuple[str, str]
    share: float
    """Share of the fingerprints that both have, of those of the program with fewer; 0 to 1."""
    lines: int
    """Number of the first one's lines in the shared passages."""


@dataclass(frozen=True, slots=True)
class SimilarGroup:
    """Students' programs that differ at most in names, numbers, texts and comments."""

    names: tuple[str, ...]
    same: tuple[tuple[str, ...], ...]
    """Groups of these programs that differ only in comments and blanks; the largest first."""


@dataclass(frozen=True, slots=True)
class Similar:
    """The pairs and groups of similar programs in a class."""

    groups: tuple[SimilarGroup, ...]
    """The largest first."""
    pairs: tuple[SimilarPair, ...]
    """Pairs that share much, among one program of each group and all others; the most alike first."""
    compared: int
    """Number of programs that were long enough."""


_Prints = Mapping[int, frozenset[int]]
"""The fingerprints of one program: the lines of each."""


def _read_tokens(texts: Iterable[str]) -> list[Token]:
    return list(islice(chain.from_iterable(map(list_tokens, texts)), MAX_TOKENS))


def _compute_prints(tokens: Sequence[Token]) -> _Prints:
    """Return the fingerprints of a program, each with the numbers of the lines from which it was computed.

    A hash is computed for each sequence of `TOKENS` successive tokens. In each window of `WINDOW` successive hashes,
    the smallest hash becomes a fingerprint; the lines are those of its tokens. Of equal hashes in a window, the last is
    taken.
    """
    kinds = [token.kind for token in tokens]
    hashes = [
        zlib.crc32("\0".join(kinds[start : start + TOKENS]).encode("utf-8", "surrogatepass"))
        for start in range(len(kinds) - TOKENS + 1)
    ]
    chosen = {
        min(range(start, start + WINDOW), key=lambda place: (hashes[place], -place))
        for start in range(max(len(hashes) - WINDOW + 1, 0))
    }
    lines: dict[int, set[int]] = defaultdict(set)
    for start in chosen:
        lines[hashes[start]].update(token.line for token in tokens[start : start + TOKENS])
    return {key: frozenset(numbers) for key, numbers in lines.items()}


def find_similar(programs: Mapping[str, Iterable[str]]) -> Similar:
    """Return which programs of a class are similar.

    Args:
        programs: The texts of the main program and its modules, by the student's name; only `MAX_TOKENS` are compared.
    """
    tokens = {
        name: program_tokens
        for name, texts in programs.items()
        if len(program_tokens := _read_tokens(texts)) >= MIN_TOKENS
    }
    alike = _group_equal(
        {
            name: tuple(token.kind for token in program_tokens)
            for name, program_tokens in tokens.items()
        }
    )
    words = {
        name: tuple(token.text for token in program_tokens)
        for name, program_tokens in tokens.items()
    }
    groups = tuple(
        SimilarGroup(
            names,
            tuple(
                same
                for same in _group_equal({name: words[name] for name in names})
                if len(same) > 1
            ),
        )
        for names in alike
        if len(names) > 1
    )
    prints = {names[0]: _compute_prints(tokens[names[0]]) for names in alike}
    return Similar(groups, _find_pairs(prints, _find_common(prints)), len(tokens))


def _group_equal(contents: Mapping[str, tuple[str, ...]]) -> list[tuple[str, ...]]:
    """Return groups of the names with equal contents, the largest group first."""
    groups: dict[tuple[str, ...], list[str]] = defaultdict(list)
    for name, content in contents.items():
        groups[content].append(name)
    return sorted(map(tuple, groups.values()), key=lambda names: (-len(names), names))


def _find_common(prints: Mapping[str, _Prints]) -> set[int]:
    """Return the fingerprints that are in so many programs that they do not show copying."""
    count = Counter(key for program_prints in prints.values() for key in program_prints)
    limit = max(MIN_COMMON, COMMON_SHARE * len(prints))
    return {key for key, programs in count.items() if programs > limit}


def _find_pairs(prints: Mapping[str, _Prints], common: Collection[int]) -> tuple[SimilarPair, ...]:
    own = {
        name: {key for key in program_prints if key not in common}
        for name, program_prints in prints.items()
    }
    users: dict[int, list[str]] = defaultdict(list)
    for name, keys in own.items():
        for key in keys:
            users[key].append(name)
    both = Counter(pair for names in users.values() for pair in combinations(names, 2))
    pairs = []
    for (first, second), count in both.items():
        share = count / min(len(own[first]), len(own[second]))
        if share < MIN_SHARE:
            continue
        lines = frozenset[int]().union(*(prints[first][key] for key in own[first] & own[second]))
        if len(lines) >= MIN_LINES:
            pairs.append(SimilarPair((first, second), share, len(lines)))
    return tuple(sorted(pairs, key=lambda pair: (-pair.share, -pair.lines, pair.names))[:MAX_PAIRS])
