"""The golden file of settings: read, written, and compared with what comes of its cases now.

It holds little of each specification: what differs from that of a plain run, and a checksum of its text in `run.json`,
in which the order of keys and the form of numbers count.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import lzma
import os
import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from tests.config.golden import outside
from tests.config.golden.cases import Case
from tests.config.golden.outside import Outcome

HERE = Path(__file__).parent
GOLDEN = HERE / "settings.jsonl.xz"
DIFFERENCES = HERE / "differences.toml"
CHECKSUM_CHARACTERS = 8
LONG = 240
"""Characters of a text from which on only the part is shown that has changed."""

Recorded = dict[str, Any]
"""What came of a case, as the golden file has it."""


def flat(data: Any, path: str = "") -> dict[str, Any]:
    """Return nested data as values by path; an empty list or table is a value."""
    inner = (
        data.items()
        if isinstance(data, dict)
        else enumerate(data)
        if isinstance(data, list | tuple)
        else ()
    )
    found: dict[str, Any] = {}
    for key, value in inner:
        found |= flat(value, f"{path}.{key}" if path else str(key))
    if found or not path:
        return found
    return {path: list(data) if isinstance(data, tuple) else data}


def checksum(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()[:CHECKSUM_CHARACTERS]


def of_run(run: Mapping[str, Any], plain: Mapping[str, Any]) -> Recorded:
    """Return a run as the golden file has it; `plain` has the values of a plain run by path."""
    rest = {key: value for key, value in run.items() if key != "spec"}
    text = json.dumps(run["spec"])
    if json.dumps(outside.read_back(json.loads(text))) != text:
        rest["is read back as another one"] = True
    values = flat(json.loads(text))
    changed = {
        path: value for path, value in values.items() if not same(value, plain.get(path, ...))
    }
    gone = [path for path in plain if path not in values]
    return {"sum": checksum(text), "set": changed, **({"gone": gone} if gone else {}), **rest}


def same(one: object, other: object) -> bool:
    return type(one) is type(other) and one == other


@contextlib.contextmanager
def in_folder(folder: Path, case: Case) -> Iterator[None]:
    """Lay out the files of a case in an empty folder, and work there."""
    for name, text in case.files.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())
    home = os.environ["TUISIM_HOME"]
    if case.defaults:
        # In its own folder, because a file that is read again at once looks like the one before.
        (folder / "home").mkdir()
        (folder / "home" / "config.toml").write_text(case.defaults, encoding="utf-8")
        os.environ["TUISIM_HOME"] = str(folder / "home")
    try:
        with contextlib.chdir(folder):
            yield
    finally:
        os.environ["TUISIM_HOME"] = home


def _done(case: Case) -> Outcome:
    match case.how:
        case "choices":
            return outside.of_choices(case.words[0], case.choices)
        case "cells":
            return outside.of_cells(case.words)
        case "world" | "robot" | "obstacles":
            return outside.of_saved(case.words, "saved.toml", case.how)
        case _:
            return outside.of_command(case.words)


def recorded(case: Case, folder: Path, plain: Mapping[str, Any]) -> Recorded:
    """Do what a case does in an empty folder, and return what comes of it; nothing may have been started."""
    with in_folder(folder, case):
        home = os.environ["TUISIM_HOME"]
        done = _done(case)
    places = {
        home: "HOME",
        str(folder): "FOLDER",
        os.path.realpath(folder): "FOLDER",
        **outside.fixed_places(),
    }
    found: Recorded = {"code": done.code}
    found |= {key: text for key, text in (("out", done.out), ("err", done.err)) if text}
    if done.runs:
        found["runs"] = [of_run(run, plain) for run in done.runs]
    text = json.dumps(found, ensure_ascii=False)
    for place, word in places.items():
        text = text.replace(place, word)
    if any(place in json.dumps(run["spec"]) for run in done.runs for place in places):
        text = re.sub(r'"sum": "\w+"', '"sum": "of paths"', text)
    answer: Recorded = json.loads(text)
    return answer


@dataclass(frozen=True, slots=True)
class Golden:
    """The contents of the golden file."""

    plain: Mapping[str, Any]
    """The values of a plain run by path."""
    inputs: str
    """A checksum of all cases: what makes them up must not change."""
    outcomes: Mapping[str, Recorded]
    """By the name of the case."""

    @staticmethod
    @cache
    def read() -> Golden:
        """Read it."""
        head, *lines = lzma.decompress(GOLDEN.read_bytes()).decode().split("\n")
        of_head = json.loads(head)
        return Golden(
            of_head["plain"], of_head["inputs"], dict(json.loads(line) for line in lines if line)
        )

    def write(self) -> None:
        """Write it."""
        lines = [json.dumps({"plain": self.plain, "inputs": self.inputs})]
        lines += [
            json.dumps([name, outcome], ensure_ascii=False)
            for name, outcome in self.outcomes.items()
        ]
        GOLDEN.write_bytes(lzma.compress("\n".join(lines).encode(), preset=9 | lzma.PRESET_EXTREME))


def checksum_of(cases: Iterable[Case]) -> str:
    """Return a checksum of what cases do."""
    whole = hashlib.sha256()
    for case in cases:
        whole.update(
            repr(
                (case.name, case.words, case.files, case.defaults, case.how, case.choices)
            ).encode()
        )
    return whole.hexdigest()


@dataclass(frozen=True, slots=True)
class Difference:
    """One entry of the list of differences: what was said in other words, and why that may be."""

    before: str
    now: str
    why: str
    pattern: bool = False
    """Whether `before` is a regular expression, and `now` what takes its place."""
    both: bool = False
    """Whether it also takes its place in what is said now: the words are other ones, or there are none any more."""

    def applied(self, text: str) -> str:
        """Return a text of before as it is said now."""
        return (
            re.sub(self.before, self.now, text)
            if self.pattern
            else text.replace(self.before, self.now)
        )


@cache
def accepted() -> tuple[Difference, ...]:
    """Return the list of accepted differences in wording."""
    with DIFFERENCES.open("rb") as file:
        return tuple(Difference(**entry) for entry in tomllib.load(file).get("difference", ()))


@cache
def listed(name: str) -> frozenset[str]:
    """Return one of the lists of `differences.toml`, such as `other_first`."""
    return frozenset(tomllib.loads(DIFFERENCES.read_text("utf-8"))[name])


def without_other_goals(outcome: Recorded, case: Case) -> Recorded:
    """Return an outcome without the goals of its first run if they come with the examples and were changed."""
    if (
        listed("other_goals").isdisjoint((*case.words, case.choices.get("goals")))
        or "runs" not in outcome
    ):
        return outcome
    first, *others = outcome["runs"]
    return {
        **outcome,
        "runs": [{key: value for key, value in first.items() if key != "goals"}, *others],
    }


def in_words_of_now(before: Recorded) -> Recorded:
    """Return what was recorded before, with the texts as they are said now."""
    return _in_other_words(before, accepted())


def in_common_words(now: Recorded) -> Recorded:
    """Return what was recorded now, with the texts as `in_words_of_now` has those of before."""
    return _in_other_words(now, [one for one in accepted() if one.both])


KEYS = re.compile(r"(?:^[\w.]+ ?= ?[^\n]*\n)+", re.MULTILINE)


def _in_other_words(recorded: Recorded, listed: Iterable[Difference]) -> Recorded:
    found = dict(recorded)
    if "out" in found:
        # The order of the keys of a table is that of the specification.
        found["out"] = KEYS.sub(
            lambda keys: "".join(sorted(keys[0].splitlines(keepends=True))), found["out"]
        )
    for difference in listed:
        found |= {key: difference.applied(found[key]) for key in ("out", "err") if key in found}
    return found


def _shown(values: Mapping[str, Any], path: str) -> str:
    if path in values:
        return repr(values[path])
    usual = Golden.read().plain.get(path.partition(".set.")[2], ...)
    return "nothing" if usual is ... else f"{usual!r}, as usual"


def differences(before: Recorded, now: Recorded) -> list[str]:
    """Return what differs, a line for each value."""
    first, second = flat(before), flat(now)
    return [
        f"{path}: {_told(first, second, path)}"
        for path in dict.fromkeys((*first, *second))
        if not same(first.get(path, ...), second.get(path, ...))
    ]


def _told(first: Mapping[str, Any], second: Mapping[str, Any], path: str) -> str:
    one, other = _shown(first, path), _shown(second, path)
    if min(len(one), len(other)) > LONG:
        # Only from where they part, and with what is before.
        parted = next(
            (at for at, pair in enumerate(zip(one, other, strict=False)) if len(set(pair)) > 1),
            len(one),
        )
        start = max(parted - LONG // 4, 0)
        one, other = (f"…{text[start : start + LONG]}…" for text in (one, other))
    return f"{one} → {other}"
