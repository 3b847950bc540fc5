"""The files of the project, read and parsed once for all rules."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from functools import cache, cached_property
from itertools import accumulate
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

LAYOUT = {
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.COMMENT,
    tokenize.ENDMARKER,
    tokenize.ENCODING,
}
PROGRAMS = frozenset({"brick_programs", "pybricks_programs", "real_programs"})
"""Folders with programs as other people write them."""

PIECE = re.compile(r"\w+|[^\w\s]")
"""A token is at least one of these."""

Function = ast.FunctionDef | ast.AsyncFunctionDef


class Source:
    """A file of the project, read and parsed once for all rules."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.text = path.read_text(encoding="utf-8")
        self.lines = self.text.splitlines()

    @cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text)

    @cached_property
    def nodes(self) -> list[ast.AST]:
        return list(ast.walk(self.tree))

    @cached_property
    def token_lines(self) -> list[int]:
        """The line of each token that is no comment, docstring or layout."""
        alone = {
            (node.lineno, node.col_offset)
            for node in self.nodes
            if isinstance(node, ast.Expr)
            and isinstance(node.value, ast.Constant)
            and isinstance(node.value.value, str)
        }
        tokens = tokenize.generate_tokens(io.StringIO(self.text).readline)
        return [
            token.start[0]
            for token in tokens
            if token.type not in LAYOUT and token.start not in alone
        ]

    @cached_property
    def most_tokens(self) -> list[int]:
        """How many tokens there can be at most before each line, and in all: counted far faster, with comments."""
        return [0, *accumulate(len(PIECE.findall(line)) for line in self.text.split("\n"))]

    @property
    def attributes(self) -> Iterator[ast.Attribute]:
        return (node for node in self.nodes if isinstance(node, ast.Attribute))


@cache
def source(path: Path) -> Source:
    return Source(path)


def python_files(folder: str) -> list[Path]:
    return [
        path for path in sorted((ROOT / folder).rglob("*.py")) if PROGRAMS.isdisjoint(path.parts)
    ]
