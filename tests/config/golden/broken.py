"""Files that are wrong: right ones in which one thing has been spoilt, and rules across values that are broken."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable, Iterator, Mapping
from random import Random
from typing import Any

from tests.config.golden import documents as made
from tests.config.golden.cases import BRICK_PROGRAMS, PROGRAM, Case, batch_table, option_words
from tests.config.golden.documents import Table, toml

COUNT = 2700
"""Some turn out to be right."""

Place = tuple[Any, Any]
"""A table or list, and the key or index of a value in it."""

ODD: tuple[Any, ...] = (
    True,
    False,
    0,
    -1,
    1,
    3.5,
    -0.001,
    1e9,
    1e30,
    -1e9,
    float("nan"),
    float("inf"),
    2**63,
    10**30,
    "",
    " ",
    "far",
    "12",
    "red",
    "true",
    "a\nb",
    "ü" * 1200,
    [],
    [1],
    ["x"],
    [[1, 2]],
    {},
    {"x": 1},
    {"x_mm": "a"},
    "in5",
    "outE",
    "in1",
    "outB",
    "none",
    50.5,
    129,
    501,
)
"""Values that fit few keys."""
KEYS = (
    "",
    "x",
    "robot",
    "name",
    "weel_diameter_mm",
    "backgruond",
    "start.x",
    "in1",
    "outA",
    "Ü",
    "a b",
    "é\n",
    "k" * 200,
)
TOO_MANY: Mapping[str, Any] = {
    "obstacle": [{"x_mm": 1, "y_mm": 1, "width_mm": 1, "height_mm": 1}] * 1001,
    "ray_angles_deg": [0.5] * 101,
    "ultrasonic": {"ray_angles_deg": list(range(102))},
    "panels": ["chart"] * 11,
    "name": "n" * 101,
}

GOALS = """\
title = "A task"
program = "p.py"
background = "Grey_bands"
[start]
x_mm = 300
[[goal]]
name = "there"
say = "Go there."
points = 2
hint = "Ahead."
reach = { x_mm = 700, y_mm = 800, within_mm = 20 }
before = 30
[[goal]]
name = "path"
pass = { places_mm = [[700, 800], [700, 400]], within_mm = 20 }
after = "there"
[[goal]]
name = "levels"
log = { name = "Colour", levels = [100, 86.3, 0], within = 0.5 }
[[goal]]
name = "grey"
inside = { x_mm = 0, y_mm = 480, width_mm = 2362, height_mm = 40 }
until = "there"
[[goal]]
name = "word"
print = { lines = ["(?i)gr[ea]y"], once = true }
[[goal]]
name = "both"
all = ["there", "path"]
[[goal]]
name = "finish"
finish = true
before = 60
"""


def places(data: Any) -> Iterator[Place]:
    """Yield where each value in nested data is."""
    for key, value in list(data.items() if isinstance(data, dict) else enumerate(data)):
        yield data, key
        if isinstance(value, dict | list):
            yield from places(value)


def _misspelt(r: Random, key: str) -> str:
    at = r.randrange(max(len(key), 1))
    match r.randrange(5):
        case 0:
            return key[:at] + key[at + 1 :]
        case 1:
            return key[:at] + key[at : at + 1] * 2 + key[at + 1 :]
        case 2:
            return key[:at] + key[at + 1 : at + 2] + key[at : at + 1] + key[at + 2 :]
        case 3:
            return key.upper()
        case _:
            return r.choice(
                [key.removesuffix("_mm"), f"{key}s", key.replace("_", "-"), r.choice(KEYS)]
            )


def spoilt(r: Random, table: Table) -> Table:
    """Return a copy of a table in which one thing is wrong, or two."""
    table = copy.deepcopy(table)
    for _ in range(r.choice([1, 1, 1, 2])):
        found = list(places(table))
        data, key = r.choice(found) if found else (table, "x")
        value = data[key] if found else None
        match r.randrange(10):
            case 0 | 1 if isinstance(data, dict):
                data[_misspelt(r, key)] = data.pop(key, 1)
            case 2 | 3 | 4:
                data[key] = copy.deepcopy(r.choice(ODD))
            case 5 | 6 if isinstance(value, int | float) and not isinstance(value, bool):
                data[key] = r.choice(
                    [value + 20_000, -value - 20_000, value * 1000 + 0.5, str(value)]
                )
            case 5 | 6 if isinstance(value, str):
                data[key] = _misspelt(r, value)
            case 7:
                data[key] = r.choice([[value], {"value": value}, [[value], value]])
            case 8 if isinstance(data, dict):
                data[r.choice(KEYS)] = copy.deepcopy(r.choice(ODD))
            case 9 if isinstance(data, dict):
                more = r.choice(sorted(TOO_MANY))
                data[more] = copy.deepcopy(TOO_MANY[more])
            case _ if isinstance(data, dict):
                data.pop(key, None)
            case _:
                data[key] = None
    return table


NOT_TOML = ("= 3", "[a", "x = ", "a b = 1", "x = [1,", "'", "x == 2")
OTHER_TEXTS = (
    "",
    "  \n",
    "x = " + "[" * 300 + "]" * 300,
    "# only this\n",
    "x = '" + "y" * 1100 + "'",
    "[]",
)


def garbled(r: Random, text: str) -> str | bytes:
    """Return a text that is no longer TOML, or says something twice."""
    lines = text.split("\n")
    at = r.randrange(len(lines))
    match r.randrange(8):
        case 0:
            return text[: r.randrange(len(text) + 1)]
        case 1:
            return "\n".join([*lines[: at + 1], lines[at], *lines[at + 1 :]])
        case 2:
            return "\n".join([*lines[:at], r.choice(NOT_TOML), *lines[at:]])
        case 3:
            return text.encode() + r.choice([b"\xff", b"# \xe4\n", b"\x00"])
        case 4:
            return r.choice(OTHER_TEXTS)
        case 5:
            return text.replace("=", ":", 1)
        case 6:
            return text.replace('"', "", 1) + "x = 1\nx = 2\n"
        case _:
            return text.replace(" = ", ' = "', 1)


ACROSS: tuple[Table, ...] = (
    {"robot": {"gyro": {"port": "in1"}}},
    {"robot": {"left_port": "outC"}},
    {"robot": {"left_port": "none"}},
    {"robot": {"left_port": "none", "right_port": "none", "motors": {"outB": "large"}}},
    {"robot": {"motors": {"outB": False}}},
    {"robot": {"motors": {"outB": {"low_deg": -90}}}},
    {"robot": {"motors": {"outA": {"low_deg": -2, "high_deg": 2}}}},
    {"robot": {"motors": {"outA": {"low_deg": 5}}}},
    {"robot": {"infrared": {}}},
    {"robot": {"touch_sensors": {"bumper": {}}}},
    {"robot": {"ultrasonic": False, "touch_sensors": {"left": {"port": "in1"}}}},
    {"robot": {"ultrasonic": False, "touch_sensors": {"b": {"port": "in1", "pressed_by": "outA"}}}},
    {"robot": {"ultrasonic": False, "touch_sensors": {"b": {"port": "in1", "pressed_by": "outB"}}}},
    {
        "robot": {
            "ultrasonic": False,
            "motors": {"outA": {"high_deg": 90}},
            "touch_sensors": {"b": {"port": "in1", "pressed_by": "outA"}},
        }
    },
    {"robot": {"color_sensors": {"2nd": {"port": "in1", "x_mm": 0, "y_mm": 0}}}},
    {"robot": {"color_sensors": {"eye": {"x_mm": 0, "y_mm": 0}}}},
    {"obstacles": "Wall", "obstacle": []},
    {"profile": {"color_read_ms": 1, "color_read_ns": 1}},
    {"profile": {"name": "ev3"}},
    {"profile": {"base": "ev4"}},
    {"remote": [{"buttons": ["beacon", "top_left"]}]},
    {"remote": [{"buttons": []}]},
    {"remote": [{"buttons": ["top_left"], "from_s": 3, "until_s": 2}]},
    {"beacon": {"x_mm": 1}},
    {"beacon": {"x_mm": 1, "y_mm": 2, "channel": 5}},
    {"world": "w.toml"},
    {"world": "other.toml"},
    {"batch": {}},
    {"robot": "r.toml"},
    {"robot": "Explrer"},
    {"robot": "./Explorer"},
    {"profile": "nbev3"},
    {"background": "Gray_bands"},
    {"background": "mat.png"},
    {"background": "./Loop"},
    {"obstacles": "Walls"},
    {"program": "q.py"},
    {"mats": "nowhere"},
    {"title": 3, "goal": []},
    {"arguments": ["a\0b"]},
    {"panels": ["graph"]},
)
"""Tables that break rules across values, or name what is not there."""
BATCHES: tuple[Table, ...] = (
    {"program": "p.py", "seeds": "0..3", "set": {"seed": [1]}},
    {"program": "p.py", "seeds": "3..0"},
    {"program": "p.py", "seeds": [1, 1]},
    {"program": "p.py", "seeds": [-1]},
    {"program": "p.py", "set": {"noise": {"motor": []}}},
    {"program": "p.py", "set": {"noise.motor": [0, "x"]}},
    {"program": "p.py", "set": {"noise.motor": "0,501"}},
    {"program": "p.py", "set": {"nose.motor": [1]}},
    {"program": "p.py", "set": {"title": ["a"]}},
    {"program": "p.py", "set": {"robot": ["Explorer", "Rovr"]}},
    {"program": "p.py", "set": {"robot.left_port": ["outC"]}},
    {"program": "p.py", "set": {"start": [3]}},
    {"program": "p.py", "set": {"start": [3], "start.x_mm": [4]}},
    {"program": "p.py", "set": {"start.x_mm": "latin(0, 1, 3)", "start.y_mm": "latin(0, 1, 4)"}},
    {"program": "p.py", "set": {"noise.motor": "random(0.2, 0.8, 3)"}},
    {"program": "p.py", "set": {"noise.motor": "random(0, 8)"}},
    {"program": "p.py", "set": {"noise.motor": "0..2000000"}},
    {"program": "p.py", "set": {"beacon.x_mm": [3]}},
    {"program": "p.py", "set": {"arguments": ["'"]}},
    {"program": "p.py", "jobs": 0},
    {"program": "p.py", "keep": "some"},
    {"program": "p.py", "out": "x.doc"},
    {"program": "p.py", "expressions": {"far": "hypot(x"}},
    {"program": "p.py", "goals": "nothing.toml"},
    {"program": "p.py", "world": "nothing.toml"},
    {"program": "q.py", "seeds": 1},
    {"seeds": 1},
)
WORDS: tuple[tuple[str, ...], ...] = (
    ("--solidd",),
    ("-x",),
    ("-x", "abc"),
    ("-x", "1e9"),
    ("-x", "nan"),
    ("-N", "129"),
    ("-N", "3.5"),
    ("-M", "-1"),
    ("-P", "gren"),
    ("-P", "#12"),
    ("--walls", "yes"),
    ("--background-fit", "tile"),
    ("-b", "Grey"),
    ("-b", ""),
    ("-b", "no.png"),
    ("-r", "Explorr"),
    ("-r", "no.toml"),
    ("-r", "p.py"),
    ("-o", "Wal"),
    ("-o", "no.json"),
    ("--profile", "ev4"),
    ("--profile", "no.toml"),
    ("--profile", "no.json"),
    ("--seed", "-1"),
    ("--seed", "1.5"),
    ("--speed", "0"),
    ("--speed", "fast"),
    ("--preload", "all"),
    ("--fps", "0"),
    ("--colors", "9"),
    ("--cells", "x"),
    ("--pixels", "x"),
    ("-x", "-y", "3"),
    ("--pen-width", "0"),
    ("--mats", "nowhere", "-b", "x"),
    ("--world", "no.toml"),
    ("-r",),
    ("--robotsetup", "x"),
    ("--x=",),
    ("--timeout", "0"),
    ("--press", "ok@1"),
    ("--break", "line x"),
)
SPOILT_ROBOTS = (
    made.robot,
    lambda r: {"color_sensors": {"left": {"x_mm": 3, "diameter_mm": 9}}, "weight": "light"},
)


def _table_case(r: Random, name: str) -> Case:
    kind = r.choice(
        [
            "world",
            "world",
            "world",
            "robot",
            "robot",
            "profile",
            "obstacles",
            "batch",
            "defaults",
            "goals",
        ]
    )
    files: dict[str, str | bytes] = {"p.py": PROGRAM}
    if kind == "goals":
        return _goals(r, name)
    if kind == "defaults":
        table = made.defaults(r, 0.5) or {"simulation": {"robot": "Explorer"}}
        text = toml(spoilt(r, table))
        return Case(
            name, r.choice([("config", "--json"), ("run", "p.py"), ("open", "p.py")]), files, text
        )
    make: Callable[[], Table] = {
        "world": lambda: made.world(r, 0.3),
        "robot": lambda: r.choice(SPOILT_ROBOTS)(r),
        "profile": lambda: made.profile(r),
        "obstacles": lambda: {"obstacle": made.boxes(r)},
        "batch": lambda: {"batch": batch_table(r), **made.world(r, 0.1)},
    }[kind]
    files["t.toml"] = toml(spoilt(r, make())) if r.random() < 0.85 else garbled(r, toml(make()))
    run = ("run", "p.py")
    words: dict[str, tuple[str, ...]] = {
        "world": ("run", "t.toml", "p.py"),
        "robot": (*run, "-r", "t.toml"),
        "batch": ("batch", "t.toml"),
        "profile": (*run, "--profile", "t.toml"),
        "obstacles": (*run, "-o", "t.toml"),
    }
    return Case(name, words[kind], files)


def _goals(r: Random, name: str) -> Case:
    import tomllib

    table = tomllib.loads(GOALS)
    text = garbled(r, GOALS) if r.random() < 0.2 else toml(spoilt(r, table))
    return Case(
        name,
        ("batch", "--goals", "t.toml", "p.py", "--seeds", "0"),
        {"p.py": PROGRAM, "t.toml": text},
    )


def _json_case(r: Random, name: str) -> Case:
    files: dict[str, str | bytes] = {"p.py": PROGRAM}
    if r.random() < 0.3:
        sides = {"o": [[1, 2, 3, 4], [5, 6, 7, 8]]}
        files["t.json"] = json.dumps(spoilt(r, sides).get("o"))
        return Case(name, ("run", "p.py", "-o", "t.json"), files)
    text = json.dumps(spoilt(r, made.json_robot(r) or {"back": -3}))
    files["t.json"] = garbled(r, text) if r.random() < 0.2 else text
    return Case(name, ("run", "p.py", "-r", "t.json"), files)


def _magic_case(r: Random, name: str) -> Case:
    words = option_words(r, 3)
    at = r.randrange(len(words) + 1)
    words[at:at] = r.choice(WORDS)
    line = f"# %%{r.choice(['sim_magic', 'sim_magic_preloaded', 'sim_magics'])} {' '.join(words)}\n"
    return Case(name, ("run", "p.py"), {"p.py": line + r.choice([PROGRAM, *BRICK_PROGRAMS])})


def broken_cases() -> Iterator[Case]:
    """Yield all cases with something wrong."""
    listed = list(_listed())
    yield from listed
    for index in range(COUNT - len(listed)):
        name = f"broken {index}"
        r = Random(name)
        pick = r.random()
        yield (_json_case if pick < 0.15 else _magic_case if pick < 0.22 else _table_case)(r, name)


def _listed() -> Iterator[Case]:
    files: dict[str, str | bytes] = {"p.py": PROGRAM}
    for index, words in enumerate(WORDS):
        yield Case(f"broken words {index}", ("run", "p.py", *words), files)
        yield Case(f"broken words of a batch {index}", ("batch", "p.py", *words), files)
        yield Case(f"broken cell {index}", (" ".join(words),), how="cells")
    for index, table in enumerate(ACROSS):
        yield Case(
            f"broken rule {index}", ("run", "w.toml", "p.py"), {**files, "w.toml": toml(table)}
        )
        if isinstance(table.get("robot"), dict):
            robot = {**files, "r.toml": toml(table["robot"])}
            yield Case(f"broken rule of a robot {index}", ("run", "p.py", "-r", "r.toml"), robot)
    for index, table in enumerate(BATCHES):
        yield Case(
            f"broken batch {index}",
            ("batch", "b.toml"),
            {**files, "b.toml": toml({"batch": table})},
        )
        for key, values in table.get("set", {}).items():
            text = ",".join(map(str, values)) if isinstance(values, list) else str(values)
            yield Case(
                f"broken parameter {index} {key}",
                ("batch", "p.py", "--set", f"{key}={text}"),
                files,
            )
