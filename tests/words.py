"""Judges the names in a file by their words, which are in `words.toml`."""

from __future__ import annotations

import ast
import json
import re
import tomllib
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from tests.sources import ROOT, Function, Source

TABLE: dict[str, dict[str, Any]] = tomllib.loads(
    (ROOT / "tests" / "words.toml").read_text(encoding="utf-8")
)
VAGUE, VERBS, PREPOSITIONS = (
    frozenset(TABLE["words"][kind].split()) for kind in ("vague", "verbs", "prepositions")
)
USUAL = re.compile(TABLE["words"]["usual"])


def list_words(data: object) -> Iterator[str]:
    """Yield all keys and texts of nested data."""
    if isinstance(data, dict):
        for key, value in data.items():
            yield key.rpartition(".")[2]
            yield from list_words(value)
    elif isinstance(data, list):
        for value in data:
            yield from list_words(value)
    elif isinstance(data, str):
        yield data


@cache
def library_names() -> frozenset[str]:
    """Return the names that the brick's libraries give to functions."""
    names = set[str]()
    for path in (ROOT / "tests" / "engine" / "shim" / "pybricks").rglob("api.json"):
        names |= {*list_words(json.loads(path.read_bytes()))}
    for library in ("ev3dev2", "ev3dev"):
        spec = find_spec(library)
        for folder in spec.submodule_search_locations or () if spec else ():
            for path in Path(folder).rglob("*.py"):
                names |= {*re.findall(r"def (\w+)", path.read_text(encoding="utf-8"))}
    return frozenset(names)


def is_value(function: Function) -> bool:
    """Return whether a function is used as a value: a noun is right for it."""
    decorators = map(ast.unparse, function.decorator_list)
    return any("property" in name or "setter" in name for name in decorators)


def list_faults(file: Source) -> Iterator[tuple[str, str]]:
    """Yield what is wrong with names of a file, by kind."""
    for node in file.nodes:
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in VAGUE:
            yield "vague_locals", node.id
        if not isinstance(node, Function) or node.name.startswith("__") or is_value(node):
            continue
        words = [word for word in node.name.split("_") if word]
        if not words or node.name in library_names():
            continue
        if words[0] not in VERBS:
            yield "functions_without_a_verb", node.name
        if not PREPOSITIONS.isdisjoint((words[0], words[-1])) and not USUAL.match(node.name):
            yield "names_with_a_preposition", node.name


def count_faults(files: Iterable[Source]) -> dict[str, list[str]]:
    """Return by kind the names that are wrong."""
    names: dict[str, list[str]] = {kind: [] for kind in TABLE["most"]}
    for file in files:
        for kind, name in list_faults(file):
            names[kind].append(name)
    return names
