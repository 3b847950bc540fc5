"""What must hold in a home that several clients use, while they use it and when they have gone."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tests.proof.commands import check_said
from tests.proof.kind import FaultError
from tuisim.base.errors import LogError
from tuisim.base.folders import home_folder
from tuisim.engine.protocol import End, Unended
from tuisim.engine.runs.run_folder import RUN_FILE, read_run

LINES = [f"A: {number}" for number in range(30)]
PROGRAM = f"import time\nfor n in range({len(LINES)}):\n    print('A:', n)\n    time.sleep(0.05)\n"
"""The program of all clients: it prints `LINES`, which takes some simulated time."""
MADE = "made"
REMOVED = "removed"
TAGGED = "tagged"
"""The files in which clients note what they did to which run, one line each."""


_SHOWN = 100
"""At most so many runs are shown at the end."""


def note(file: str, *words: object) -> None:
    """Add a line to a file in the working directory."""
    with Path(file).open("a", encoding="utf-8") as handle:
        print(*words, file=handle)


def _noted(folder: Path, file: str) -> list[list[str]]:
    return [
        line.split()
        for path in folder.glob(f"*/{file}")
        for line in path.read_text("utf-8").splitlines()
    ]


def folder_of(run_id: str) -> Path:
    """Return the folder of a run."""
    return home_folder() / "runs" / run_id


def is_complete(run_id: str) -> bool:
    """Return whether a run is there, with its file; one that is about to start may have none yet."""
    return (folder_of(run_id) / RUN_FILE).exists()


def listed() -> list[dict[str, Any]]:
    """Return all runs of the list, of which no two may have one number or one id."""
    found: list[dict[str, Any]] = json.loads(check_said(["runs", "list", "--json"], codes=(0,)).out)
    for column in ("number", "id"):
        if twice := [
            one for one, count in Counter(row[column] for row in found).items() if count > 1
        ]:
            raise FaultError(f"several runs have the {column} {twice}")
    return found


def check_readable(words: list[str], run_id: str) -> None:
    """Check that a command can read a run, unless that is removed meanwhile."""
    was_there = is_complete(run_id)
    done = check_said(words)
    if done.code and was_there and is_complete(run_id):
        raise FaultError(f"tuisim {' '.join(words)}: exit code {done.code}: {done.err}")


def _wrong_in(run_id: str) -> str:
    try:
        run = read_run(folder_of(run_id))
        lines = [row.text for row in run.output.rows() if row.text.startswith("A:")]
        count = run.telemetry.count
    except LogError as error:
        return f"cannot be read: {error}"
    if run.end is None:
        return "" if lines == LINES[: len(lines)] else f"has the lines {lines}"
    if lines != LINES[: None if run.end.end is End.FINISHED else len(lines)]:
        return f"has the lines {lines} and ended {run.end}"
    # One record for each tick, and one before the first; a stop may come before that.
    if count != run.end.tick + 1 and not (count == 0 == run.end.tick):
        return f"has {count} records and ended {run.end}"
    return ""


def check_recording(run_id: str) -> None:
    """Check that a run has all that its program did, unless it is removed meanwhile."""
    was_there = is_complete(run_id)
    if (wrong := _wrong_in(run_id)) and was_there and is_complete(run_id):
        raise FaultError(f"run {run_id} {wrong}")


def _check_row(row: Mapping[str, Any], tag: str) -> None:
    run = read_run(folder_of(row["id"]))
    if row["end"] in (Unended.RUNNING, Unended.DAMAGED) or row["end"] != run.state:
        raise FaultError(
            f"run {row['id']} is {run.state}, and listed as {row['end']}: {row['summary']}"
        )
    if run.end is not None and row["ticks"] != run.end.tick:
        raise FaultError(
            f"run {row['id']} ended {run.end}, and is listed with {row['ticks']} ticks"
        )
    if run.end is not None and run.end.end is End.FINISHED and row["samples"] != len(LINES):
        raise FaultError(f"run {row['id']} is listed with {row['samples']} samples")
    if (found := (" ".join(run.tags), row["tags"])) != (tag, tag):
        raise FaultError(f"run {row['id']} was tagged {tag!r}; its file and the list have {found}")


def check_home(folder: Path) -> None:
    """Check what clients have left in a home, with what they have noted in the folders of a folder."""
    rows = listed()
    ids = {row["id"] for row in rows}
    tags = dict(_noted(folder, TAGGED))
    removed = {run_id for (run_id,) in _noted(folder, REMOVED)}
    there = {path.name for path in folder_of("").iterdir()}
    if ids != there:
        raise FaultError(f"only listed: {ids - there}; only in the folder: {there - ids}")
    for run_id, number in _noted(folder, MADE):
        if (run_id in removed) == (run_id in ids):
            raise FaultError(f"run {run_id} is {'there, but removed' if run_id in ids else 'lost'}")
        if run_id in ids and [row["number"] for row in rows if row["id"] == run_id] != [
            int(number)
        ]:
            raise FaultError(f"run {run_id} had the number {number}, and has another one")
    for row in rows:
        check_recording(row["id"])
        _check_row(row, tags.get(row["id"], ""))
    # Each looks for its run in the whole list.
    for row in rows[:: len(rows) // _SHOWN + 1]:
        check_said(["runs", "show", row["id"], "--json"], codes=(0,))
    if half := [str(path) for path in home_folder().rglob("*.tmp")]:
        raise FaultError(f"half-written files: {half}")
