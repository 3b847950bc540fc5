"""Programs whose runs gave files: what they print, export and record, and how their ends are told.

Of the files only checksums are kept, one for each column, so that a difference can be named.
"""

from __future__ import annotations

import csv
import hashlib
import io
import json
import lzma
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tests.config.golden import outside
from tests.config.golden.fixture import HERE, Recorded

RUNS = HERE / "programs.json.xz"
_STAMPS = re.compile(r"\d{8}T\d{6}-[0-9a-f]{6}|\d{4}-\d\d-\d\d[T ]\d\d:\d\d[\d:.+]*")
"""Ids of runs, and when they were."""
OF_THE_MACHINE = ("id", "created", "path")
"""Keys of what `run --json` prints that are other each time."""
SAMPLES, TELEMETRY = ("s.csv", "s.jsonl", "s.parquet"), ("t.csv", "t.jsonl", "t.parquet")


@dataclass(frozen=True, slots=True)
class GoldenProgram:
    """A program and how it is run."""

    words: tuple[str, ...]
    """The words after `tuisim run`."""
    files: Mapping[str, str] = field(default_factory=dict)
    then: tuple[tuple[str, ...], ...] = ()
    """Further command lines of `tuisim` after the run; what they say counts, too."""


THREADS = """\
# %%sim_magic_preloaded -b Radial_grey -N 5
import threading, time
stop = threading.Event()
def light():
    while not stop.is_set():
        print("Light:", colorLeft.reflected_light_intensity_pc)
        time.sleep(0.07)
def far():
    while not stop.is_set():
        print("Far:", round(ultrasonic.distance_centimeters, 3))
        time.sleep(0.11)
others = [threading.Thread(target=each) for each in (light, far)]
for each in others:
    each.start()
for turn in range(4):
    tank_drive.on_for_rotations(SpeedPercent(30), SpeedPercent(30 - 9 * turn), 0.5)
    time.sleep(0.03)
stop.set()
for each in others:
    each.join()
print("Turned:", gyro.angle)
"""
BRICK = """\
import random, sys
from time import sleep
from ev3dev2.led import Leds
from ev3dev2.motor import OUTPUT_A, OUTPUT_B, OUTPUT_C, MediumMotor, MoveDifferential, SpeedRPM
from ev3dev2.sensor.lego import ColorSensor, InfraredSensor, TouchSensor
from ev3dev2.wheel import EV3Tire
drive = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 120)
arm, eye, touch, ir = MediumMotor(OUTPUT_A), ColorSensor(), TouchSensor(), InfraredSensor()
print(sys.argv[1:], random.random())
Leds().set_color("LEFT", "AMBER")
drive.on_for_distance(SpeedRPM(40), 250)
arm.on_for_degrees(30, 75)
for step in range(6):
    drive.on_arc_right(SpeedRPM(30), 150, 60)
    print("Near: %s" % ir.proximity)
    print("Beacon: %s" % ir.distance())
    print("Colour: %d" % eye.color)
    print("Touch: %d" % touch.is_pressed)
    sleep(0.25)
raise ValueError("the end")
"""
WORLD = """\
program = "brick.py"
arguments = ["a b", "5"]
background = "Rainbow_bands"
profile = "ev3"
pen_marks = true
seed = 11
[start]
x_mm = 700
y_mm = 500
heading_deg = 30
[noise]
light = 9
motor = 40
[pen]
down = true
color = "navy"
[beacon]
x_mm = 1500
y_mm = 900
[[remote]]
buttons = ["top_left", "bottom_right"]
from_s = 2
until_s = 9
[[obstacle]]
x_mm = 1300
y_mm = 300
width_mm = 40
height_mm = 500
[robot]
wheel_spacing_mm = 120
gyro = false
ultrasonic = false
[robot.motors]
outA = { kind = "medium", low_deg = -90, high_deg = 60 }
[robot.color_sensors]
right = false
[robot.touch_sensors.bumper]
port = "in1"
y_mm = 70
[robot.infrared]
port = "in4"
"""
SAVED = json.dumps(
    {
        "wheeldiameter": 43,
        "sensor1": {"x": -30, "y": 40, "diameter": 30},
        "gyro": {"enabled": False},
        "wheelNoise": 6,
    }
)


def _notebook(*cells: str) -> str:
    listed: list[dict[str, Any]] = [
        {
            "cell_type": "code",
            "execution_count": None,
            "id": f"c{at}",
            "metadata": {},
            "outputs": [],
            "source": text,
        }
        for at, text in enumerate(cells)
    ]
    return json.dumps({"cells": listed, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


NOTEBOOK = _notebook(
    "%load_ext tuisim",
    "%%sim_magic_preloaded -b Coloured_bands -x 300 -R\nfor turn in range(9):\n"
    "    tank_drive.on_for_degrees(SpeedPercent(20), SpeedPercent(25), 60)\n    print('Red:', colorRight.rgb[0])\n",
    "%%sim_magic_imports -b Linear_grey -p -N 12 -M 30 --seed 4\nfrom ev3dev2.sensor.lego import GyroSensor\n"
    "tank = MoveTank(OUTPUT_B, OUTPUT_C)\ntank.on_for_seconds(SpeedPercent(15), SpeedPercent(-15), 1.3)\n"
    "print('Angle:', GyroSensor().angle)\n",
)
NOISE = ("-N", "20", "-M", "50")
PROGRAMS: Mapping[str, GoldenProgram] = {
    **{
        name: GoldenProgram((name,))
        for name in (
            "bumper",
            "draw_house",
            "draw_light",
            "follow_line",
            "log_greys",
            "name_colour",
            "read_once",
            "square",
            "stop_at_wall",
            "until_black",
        )
    },
    **{
        f"{name} by {profile}": GoldenProgram((name, "--profile", profile))
        for name in ("bumper", "follow_line", "log_greys", "square")
        for profile in ("nbev3devsim", "ev3")
    },
    "log_greys with noise": GoldenProgram(("log_greys", *NOISE, "--seed", "3")),
    "follow_line with noise": GoldenProgram(("follow_line", *NOISE)),
    "square with noise by nbev3devsim": GoldenProgram(
        ("square", *NOISE, "--seed", "7", "--profile", "nbev3devsim")
    ),
    "stop_at_wall with noise by ev3": GoldenProgram(
        ("stop_at_wall", *NOISE, "--profile", "ev3", "--solid")
    ),
    "square in the world of its goals": GoldenProgram(
        ("square_goals.toml", "-r", "Small_Robot"),
        then=(("goals", "check", "square"), ("runs", "show", "last")),
    ),
    "square elsewhere": GoldenProgram(
        ("square", "-x", "400", "-b", "Loop"),
        then=(
            ("goals", "check", "square"),
            ("goals", "check", "log_greys"),
            ("runs", "rerun", "last"),
        ),
    ),
    "two setups": GoldenProgram(
        ("read_once", "-N", "5", "-r", "Small_Robot", "-p", "-P", "navy"),
        then=(
            (
                "run",
                "read_once",
                "--profile",
                "ev3",
                "-o",
                "Wall",
                "--walls",
                "off",
                "--seed",
                "3",
                "-a",
                "45",
            ),
            ("log", "diff", "1", "2"),
            ("log", "diff", "1", "2", "--json"),
            ("runs", "show", "1", "--json"),
        ),
    ),
    "threads": GoldenProgram(("threads.py",), {"threads.py": THREADS}),
    "threads by nbev3devsim": GoldenProgram(
        ("threads.py", "--profile", "nbev3devsim"), {"threads.py": THREADS}
    ),
    "threads by ev3": GoldenProgram(("threads.py", "--profile", "ev3"), {"threads.py": THREADS}),
    "a cell of a notebook": GoldenProgram(("book.ipynb#1",), {"book.ipynb": NOTEBOOK}),
    "a cell with noise": GoldenProgram(("book.ipynb#2",), {"book.ipynb": NOTEBOOK}),
    "everything in a world": GoldenProgram(("w.toml",), {"w.toml": WORLD, "brick.py": BRICK}),
    "a robot of its own": GoldenProgram(("brick.py", "--timeout", "9"), {"brick.py": BRICK}),
    "a robot of the browser simulator": GoldenProgram(
        ("log_greys", "-r", "saved.json", "--pen-marks", "-p"), {"saved.json": SAVED}
    ),
}


def run_golden(program: GoldenProgram, folder: Path) -> Recorded:
    """Run a program in an empty folder, in a home without runs; return what it gave, less what is other each time."""
    for name, text in program.files.items():
        (folder / name).write_text(text, encoding="utf-8")
    targets = [word for name in SAMPLES for word in ("--export", name)]
    done = outside.of_command(
        ("run", *program.words, "--json", *targets, "--telemetry", TELEMETRY[0])
    )
    more = [
        outside.of_command(("runs", "export", "last", "--telemetry", name))
        for name in TELEMETRY[1:]
    ]
    facts = json.loads(done.out)
    then = [outside.of_command(words) for words in program.then]
    return {
        "code": [done.code, *(one.code for one in (*more, *then))],
        "err": _anywhere(done.err, folder),
        "then": [LATER.sub("", _anywhere(one.out + one.err, folder)) for one in then],
        "json": {key: value for key, value in facts.items() if key not in OF_THE_MACHINE},
        "keys": list(facts),
        "files": {name: _of_file(folder / name) for name in (*SAMPLES, *TELEMETRY)},
    }


LATER = re.compile(r'"values": \{[^}]*\}, |^values: [^\n]*\n', re.MULTILINE)
"""What `runs show` tells since the golden file was written: the values that options and world files set."""


def _anywhere(text: str, folder: Path) -> str:
    """Return what is said without what is other each time."""
    for place, word in {
        str(folder): "FOLDER",
        os.path.realpath(folder): "FOLDER",
        **outside.fixed_places(),
    }.items():
        text = text.replace(place, word)
    return _STAMPS.sub("WHEN", text)


def _sum(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def _columns(names: Sequence[str], rows: Sequence[Sequence[object]]) -> Recorded:
    columns = zip(*rows, strict=True) if rows else [()] * len(names)
    return {
        name: _sum(repr(list(column)).encode())[:16]
        for name, column in zip(names, columns, strict=True)
    }


def _of_file(path: Path) -> Recorded:
    """Return the checksum of a text, or of the content of a table, and one of each column."""
    data = path.read_bytes()
    if path.suffix == ".csv":
        head, *rows = csv.reader(io.StringIO(data.decode()))
        return {"sum": _sum(data), "rows": len(rows), "columns": _columns(head, rows)}
    if path.suffix == ".jsonl":
        listed = [json.loads(line) for line in data.decode().split("\n") if line]
        names = list(listed[0]) if listed else []
        return {
            "sum": _sum(data),
            "rows": len(listed),
            "columns": _columns(names, [[*row.values()] for row in listed]),
        }
    from pyarrow import parquet

    table = parquet.read_table(path)
    columns = {
        name: _sum(repr(table[name].to_pylist()).encode())[:16] for name in table.column_names
    }
    types = {name: str(table.schema.field(name).type) for name in table.column_names}
    # What pandas adds names its own version.
    about = {
        key.decode(): text.decode()
        for key, text in table.schema.metadata.items()
        if key != b"pandas"
    }
    return {"rows": table.num_rows, "columns": columns, "types": types, "about": about}


def read_runs() -> Mapping[str, Recorded]:
    """Return what each program gave when the golden file was written."""
    found: Mapping[str, Recorded] = json.loads(lzma.decompress(RUNS.read_bytes()))
    return found


def write_runs(runs: Mapping[str, Any]) -> None:
    """Write what each program has given."""
    RUNS.write_bytes(lzma.compress(json.dumps(runs).encode(), preset=9 | lzma.PRESET_EXTREME))
