"""Damaged recordings, run files and catalogues: one clear line, and what is whole can still be read."""

from __future__ import annotations

import json
import sqlite3
import struct
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from tests.cases import cases
from tests.conftest import ROOT, Command
from tests.engine.runs.run_recorder import begun
from tuisim.cli import EXIT_OUR_MISTAKE
from tuisim.engine.core.profile import ROBOLAB
from tuisim.engine.core.spec import MotorSpec, RobotSpec, RunSpec, WorldSpec
from tuisim.engine.runs.catalogue import CATALOGUE_FILE
from tuisim.engine.runs.records import OUTPUT_FILE, TELEMETRY_FILE, Stream
from tuisim.engine.runs.run_folder import RUN_FILE
from tuisim.engine.runs.side_files import ACTIONS_FILE, STOP_FILE
from tuisim.engine.runs.store import RunStore

Damage = Callable[[Path], Any]
"""Does harm to a run folder."""


def record() -> Path:
    """Store a run that drove, printed and was acted upon, and return its folder."""
    robot = RobotSpec(extra_motors=(MotorSpec("outA"),))
    recorder = begun(RunStore(), RunSpec(robot, WorldSpec(), ROBOLAB))
    recorder.print("[[0.0, 10.0]]", stream=Stream.MOTORS)
    for at in range(6):
        recorder.drive(100, 100, 20)
        recorder.print(f"a: {at}")
    recorder.act("set_noise", light=5, motor=0)
    return recorder.end().folder


def at(name: str, place: int, data: bytes) -> Damage:
    """Write over some bytes of a file."""

    def harm(folder: Path) -> None:
        content = bytearray((folder / name).read_bytes())
        content[place : place + len(data)] = data
        (folder / name).write_bytes(content)

    return harm


def text(name: str, content: str) -> Damage:
    """Put another text in the place of a file."""
    return lambda folder: (folder / name).write_text(content)


def folder_for(name: str) -> Damage:
    """Put a folder in the place of a file."""

    def harm(folder: Path) -> None:
        (folder / name).unlink(missing_ok=True)
        (folder / name).mkdir()

    return harm


def cut(name: str, size: int) -> Damage:
    """Cut a file off."""
    return lambda folder: (folder / name).write_bytes((folder / name).read_bytes()[:size])


def key(path: str, value: object) -> Damage:
    """Change one value of `run.json`."""

    def harm(folder: Path) -> None:
        data = json.loads((folder / RUN_FILE).read_bytes())
        inner, names = data, path.split(".")
        for name in names[:-1]:
            inner = inner[name]
        inner[names[-1]] = value
        (folder / RUN_FILE).write_text(json.dumps(data))

    return harm


def catalogue(sql: str) -> Damage:
    """Change the catalogue."""

    def harm(folder: Path) -> None:
        with (
            closing(sqlite3.connect(folder.parent.parent / CATALOGUE_FILE)) as connection,
            connection,
        ):
            connection.executescript(sql)

    return harm


def row(stream: int, content: bytes) -> Damage:
    """Append a row of output."""

    def harm(folder: Path) -> None:
        data = bytearray((folder / OUTPUT_FILE).read_bytes())
        data += struct.pack("<IIqIB3x", len(content), 120, 1_200_000_000, 1, stream) + content
        data[16:24] = struct.pack("<Q", len(data) - 64)
        (folder / OUTPUT_FILE).write_bytes(data)

    return harm


NAN = struct.pack("<d", float("nan"))
DAMAGES: dict[str, Damage] = {
    "a heading that is no number": at(TELEMETRY_FILE, 64 + 64 * 9 + 24, NAN),
    "the last record": at(TELEMETRY_FILE, 64 + 64 * 120, b"\xff" * 64),
    "ticks in disorder": at(TELEMETRY_FILE, 64 + 64 * 9, b"\xff\xff\xff\xff\xff\xff\xff\xff"),
    "a length without end": at(TELEMETRY_FILE, 16, b"\xff" * 8),
    "no records": cut(TELEMETRY_FILE, 64),
    "half a header": cut(TELEMETRY_FILE, 30),
    "empty telemetry": cut(TELEMETRY_FILE, 0),
    "a folder of telemetry": folder_for(TELEMETRY_FILE),
    "telemetry of another make": at(TELEMETRY_FILE, 0, b"x" * 64),
    "output of another make": at(OUTPUT_FILE, 0, b"x" * 64),
    "an unknown stream": row(99, b"x"),
    "a row longer than the file": at(OUTPUT_FILE, 64, b"\xff\xff\xff\x7f"),
    "lights that are no JSON": row(Stream.LED, b"{"),
    "motors that are no JSON": row(Stream.MOTORS, b"x"),
    "motors without numbers": row(Stream.MOTORS, b'[["a", null]]'),
    "a length of output without end": at(OUTPUT_FILE, 16, b"\xff" * 8),
    "a folder of output": folder_for(OUTPUT_FILE),
    "an action without end": text(
        ACTIONS_FILE, '{"tick": 1e999, "kind": "set_pen", "down": true}\n'
    ),
    "an action without fields": text(ACTIONS_FILE, '{"tick": 1, "kind": "set_noise"}\n'),
    "noise in words": text(
        ACTIONS_FILE, '{"tick": 1, "kind": "set_noise", "light": "x", "motor": null}\n'
    ),
    "an action of another kind": text(ACTIONS_FILE, '{"tick": 1, "kind": "fly", "down": 3}\n'),
    "a folder of actions": folder_for(ACTIONS_FILE),
    "a stop that is none": text(STOP_FILE, "[]"),
    "a stop nested without end": text(STOP_FILE, "[" * 100_000),
    "notes nested without end": text("notes.jsonl", "[" * 100_000 + "\n"),
    "a folder of notes": folder_for("notes.jsonl"),
    "a run file that is none": text(RUN_FILE, "{"),
    "a run file nested without end": text(RUN_FILE, "[" * 100_000),
    "a folder for the run file": folder_for(RUN_FILE),
    "no created": key("created", None),
    "no program text": key("program.text", None),
    "no end": key("end", "finished"),
    "an end without a time": key("end.time_ns", None),
    "a summary of numbers": key("end.summary", 5),
    "tags of numbers": key("tags", [1, None]),
    "a number without end": key("number", float("inf")),
    "options that are none": key("options", None),
    "a mat that is none": key("field", [1]),
    "a mat that nobody has": key("spec.world.background", "Nowhere"),
    "a tick rate of 0": key("spec.profile.tick_hz", 0),
    "a seed of words": key("spec.seed", "x"),
    "a robot that is true": key("spec.robot.name", True),
    "a mat of a number": key("spec.world.background", 0),
    "a start in words": key("spec.world.start.heading_deg", ""),
    "a folder of a number": key("program.working_directory", 2**63),
    "a name that no file can have": key("program.name", "\ud800"),
    "answers of a number": key("options.answers", 1.5),
    "a mat without sums": key(
        "field", {"width_px": 2362, "height_px": 1143, "pixels": "/x", "sums": []}
    ),
    "no robot": key("spec.robot", None),
    "a catalogue with holes": catalogue('UPDATE runs SET seed = "x", samples = "y"'),
    "a catalogue without its table": catalogue("DROP TABLE runs"),
    "a catalogue without a column": catalogue("ALTER TABLE runs DROP COLUMN summary"),
    "an id of 10,000 digits": catalogue(f"UPDATE runs SET id = '{'9' * 10_000}' WHERE number = 1"),
    "an id elsewhere": catalogue("UPDATE runs SET id = '../x' WHERE number = 1"),
    "a number of 10,000 digits": text(RUN_FILE, '{"format": 1, "number": ' + "9" * 10_000 + "}"),
    "a catalogue of text": lambda folder: (folder.parent.parent / CATALOGUE_FILE).write_text(
        "x" * 5000
    ),
}

WORDS = (
    "runs",
    "runs --json",
    "runs show 1",
    "runs show 1 --json",
    "runs export 1 --out a.csv",
    "log summary 1",
    "log bands 1",
    "runs export 1 --telemetry a.parquet",
    "log reckon 1",
    "log diff 1 2",
    "log diff 2 1 --json",
    "log report 1",
    "log plot 1 --telemetry --size 60x20",
    "runs rerun 1",
    "runs picture 1 --out a.png",
    f"goals check {ROOT / 'programs' / 'square_goals.toml'} 1",
)


@pytest.mark.slow
@cases("damage", DAMAGES)
def test_a_damaged_run_is_reported_in_one_line(home: Path, here: Command, damage: Damage) -> None:
    folder = record()
    record()
    damage(folder)
    for words in WORDS:
        done = here(*words.split())
        assert done.returncode != EXIT_OUR_MISTAKE, f"{words}: {done.stderr}"
        assert done.stderr.count("\n") <= 3, f"{words}: {done.stderr}"
    # The other run is none the worse for it.
    assert here("runs", "show", "2").returncode == 0
    assert "2  " in here("runs").stdout
