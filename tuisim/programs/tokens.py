"""The tokens of a program, in which names, numbers and texts are alike."""

from __future__ import annotations

import io
import keyword
import tokenize
from collections.abc import Iterator, Mapping

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
    """One token of a program."""

    kind: str
    """The same for all names, all numbers and all texts."""
    text: str
    line: int


def list_tokens(text: str) -> Iterator[Token]:
    """Yield the tokens of a program, up to where Python cannot read it."""
    try:
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type in _SKIPPED:
                continue
            kind = _ONE_TOKEN.get(token.type, token.string)
            if token.type == tokenize.NAME and not keyword.iskeyword(kind):
                kind = "x"
            word = kind if token.type in _BLANK else token.string
            yield Token(kind, word, token.start[0])
    except (tokenize.TokenError, SyntaxError):
        pass
