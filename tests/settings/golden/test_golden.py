"""Settings and programs give what they gave before, to the byte.

`cases.json` holds what a user does and what came of it: at least one case of each place where settings come from, and
together they set every value of a specification. Of each specification it has what differs from that of a plain run,
which it has in full; of each file that a program's run gave, checksums.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.settings.golden import outside

GOLDEN: dict[str, Any] = json.loads(Path(__file__).with_name("cases.json").read_bytes())
CASES: dict[str, dict[str, Any]] = {case["name"]: case for case in GOLDEN["cases"]}
PROGRAMS = [name for name, case in CASES.items() if case["how"] == "program"]
SETTINGS = [name for name in CASES if name not in PROGRAMS]

STAMPS = re.compile(r"\d{8}T\d{6}-[0-9a-f]{6}|\d{4}-\d\d-\d\d[T ]\d\d:\d\d[\d:.+]*")
"""Ids of runs, and when they were."""
OF_THE_MACHINE = ("id", "created", "path")
"""Keys of what `run --json` prints that are other each time."""
SAMPLES = ("s.csv", "s.jsonl", "s.parquet")
TELEMETRY = ("t.csv", "t.jsonl", "t.parquet")


def flat(data: Any, path: str = "") -> dict[str, Any]:
    """Return nested data as values by path; an empty list or table is a value."""
    pairs: Iterable[tuple[object, Any]] = data.items() if isinstance(data, dict) else ()
    if isinstance(data, list | tuple):
        pairs = enumerate(data)
    values: dict[str, Any] = {}
    for key, value in pairs:
        values |= flat(value, f"{path}.{key}" if path else str(key))
    if values or not path:
        return values
    return {path: list(data) if isinstance(data, tuple) else data}


def is_same(value: object, other: object) -> bool:
    """Return whether two values are written alike in JSON: 3 is not 3.0."""
    return type(value) is type(other) and value == other


def differences(before: Any, now: Any) -> dict[str, tuple[object, object]]:
    """Return by path what was before and what is now."""
    first = flat(before)
    second = flat(now)
    return {
        path: (first.get(path), second.get(path))
        for path in dict.fromkeys((*first, *second))
        if not is_same(first.get(path, ...), second.get(path, ...))
    }


def describe_run(run: Mapping[str, Any]) -> dict[str, Any]:
    """Return a run as the golden file has it."""
    plain = GOLDEN["plain"]
    text = json.dumps(run["spec"])
    assert json.dumps(outside.read_back(json.loads(text))) == text
    values = flat(json.loads(text))
    changed = {
        path: value for path, value in values.items() if not is_same(value, plain.get(path, ...))
    }
    gone = [path for path in plain if path not in values]
    rest = {key: value for key, value in run.items() if key != "spec"}
    return {"set": changed, **({"gone": gone} if gone else {}), **rest}


def replace_places(text: str, folder: Path) -> str:
    """Return a text without what is other each time: folders, ids and dates."""
    places = {
        os.environ["TUISIM_HOME"]: "HOME",
        str(folder): "FOLDER",
        os.path.realpath(folder): "FOLDER",
        **outside.fixed_places(),
    }
    for place, word in places.items():
        text = text.replace(place, word)
    return STAMPS.sub("WHEN", text)


def do_settings(case: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Do what a case does where nothing starts, and return what comes of it."""
    match case["how"]:
        case "choices":
            done = outside.of_choices(case["words"][0], case["choices"])
        case "cells":
            done = outside.of_cells(case["words"])
        case "world" | "robot" | "obstacles" as what:
            done = outside.of_saved(case["words"], "saved.toml", what)
        case _:
            done = outside.of_command(case["words"])
    outcome: dict[str, Any] = {"code": done.code}
    outcome |= {key: text for key, text in (("out", done.out), ("err", done.err)) if text}
    if done.runs:
        outcome["runs"] = [describe_run(run) for run in done.runs]
    answer: dict[str, Any] = json.loads(
        replace_places(json.dumps(outcome, ensure_ascii=False), folder)
    )
    return answer


def do_program(case: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Run a program, and return what it gave."""
    targets = [word for name in SAMPLES for word in ("--export", name)]
    done = outside.of_command(
        ("run", *case["words"], "--json", *targets, "--telemetry", TELEMETRY[0])
    )
    more = [
        outside.of_command(("runs", "export", "last", "--telemetry", name))
        for name in TELEMETRY[1:]
    ]
    facts = json.loads(done.out)
    then = [outside.of_command(words) for words in case.get("then", ())]
    return {
        "code": [done.code, *(outcome.code for outcome in (*more, *then))],
        "err": replace_places(done.err, folder),
        "then": [replace_places(outcome.out + outcome.err, folder) for outcome in then],
        "json": {key: value for key, value in facts.items() if key not in OF_THE_MACHINE},
        "keys": list(facts),
        "files": {name: describe_file(folder / name) for name in (*SAMPLES, *TELEMETRY)},
    }


def checksum(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def describe_columns(names: Sequence[str], columns: Sequence[Sequence[object]]) -> dict[str, str]:
    """Return a checksum of each column, so that a difference has a name."""
    return {
        name: checksum(repr(list(column)).encode())
        for name, column in zip(names, columns, strict=True)
    }


def describe_file(path: Path) -> dict[str, Any]:
    """Return the checksum of a text, or of the content of a table."""
    data = path.read_bytes()
    if path.suffix == ".csv":
        head, *rows = csv.reader(io.StringIO(data.decode()))
        columns = list(zip(*rows, strict=True)) if rows else [()] * len(head)
        return {"sum": checksum(data), "columns": describe_columns(head, columns)}
    if path.suffix == ".jsonl":
        return {"sum": checksum(data)}
    from pyarrow import parquet

    table = parquet.read_table(path)
    # What pandas adds names its own version.
    about = {
        key.decode(): text.decode()
        for key, text in table.schema.metadata.items()
        if key != b"pandas"
    }
    types = {field.name: str(field.type) for field in table.schema}
    return {"sum": checksum(repr(table.to_pydict()).encode()), "types": types, "about": about}


@pytest.fixture
def folder(tmp_path: Path, home: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder to work in; in a home of its own a run is the first."""
    place = tmp_path / "here"
    place.mkdir()
    monkeypatch.chdir(place)
    monkeypatch.setenv("COLUMNS", "80")
    yield place
    assert home.is_dir()


def lay_out(case: Mapping[str, Any], folder: Path) -> None:
    """Write the files of a case."""
    for name, text in case.get("files", {}).items():
        (folder / name).write_text(text, encoding="utf-8")


@pytest.mark.parametrize("name", SETTINGS)
def test_each_golden_set_of_settings_builds_the_recorded_run(
    name: str, folder: Path, home: Path
) -> None:
    case = CASES[name]
    lay_out(case, folder)
    home.mkdir()
    (home / "config.toml").write_text(case.get("defaults", ""), encoding="utf-8")
    with outside.nothing_starts():
        outcome = do_settings(case, folder)
    assert differences(case["gives"], outcome) == {}


@pytest.mark.quick_cases("a cell with noise")
@pytest.mark.parametrize("name", PROGRAMS)
def test_each_golden_program_gives_its_recorded_output(name: str, folder: Path) -> None:
    case = CASES[name]
    lay_out(case, folder)
    assert differences(case["gives"], do_program(case, folder)) == {}


def test_golden_cases_are_of_many_kinds() -> None:
    assert len(CASES) == len(GOLDEN["cases"]) == 30
    assert {CASES[name]["gives"]["json"]["profile"] for name in PROGRAMS} == {
        "robolab",
        "nbev3devsim",
        "ev3",
    }
    assert sum("err" in CASES[name]["gives"] for name in SETTINGS) >= 12


def test_golden_comparison_tells_integers_from_floats_and_booleans() -> None:
    assert differences({"light": [0, 1]}, {"light": [0.0, 1]}) == {"light.0": (0, 0.0)}
    assert differences({"light": 0}, {"light": False}) == {"light": (0, False)}
    assert differences({"light": 0}, {}) == {"light": (0, None)}
