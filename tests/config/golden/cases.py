"""The cases: command lines, magic lines and files that users could write, made up from a seed.

Each case has a kind and a number, which are all that it depends on: the same case for ever, on any machine.
"""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from random import Random
from typing import Any

from tests.config.golden import documents as made
from tests.config.golden.documents import Table, number, some, toml, truth, whole


@dataclass(frozen=True, slots=True)
class Case:
    """What a user does."""

    name: str
    """Its kind and number."""
    words: tuple[str, ...] = ()
    """The command line, or the magic lines of a notebook's cells."""
    files: Mapping[str, str | bytes] = field(default_factory=dict)
    """Files in the folder where it is done, and their contents."""
    defaults: str = ""
    """The user's `config.toml`."""
    how: str = "command"
    """`command`, `choices`, `cells`, `world`, `robot` or `obstacles`: see `outside`."""
    choices: Mapping[str, Any] = field(default_factory=dict)
    """Keyword arguments of Python's interface."""


PROGRAM = "print(1)\n"
IMAGE = bytes.fromhex(
    "89504e470d0a1a0a0000000d4948445200000004000000020802000000f0caea34000000124944415478da6338c1c000470c"
    "27e41008005aa606b992c847b10000000049454e44ae426082"
)
"""An image of 4 × 2 pixels."""
BRICK_PROGRAMS = (
    "from ev3dev2.motor import MoveTank, OUTPUT_A, OUTPUT_D\ntank = MoveTank(OUTPUT_A, OUTPUT_D)\n",
    "from ev3dev2.motor import LargeMotor, OUTPUT_C\nfrom ev3dev2.sensor.lego import TouchSensor\n"
    "from ev3dev2.sensor import INPUT_2\nm = LargeMotor(OUTPUT_C)\nts = TouchSensor(INPUT_2)\n",
    "from ev3dev2.sensor.lego import ColorSensor, GyroSensor, InfraredSensor\nfrom ev3dev2.sensor import *\n"
    "cs = ColorSensor(INPUT_4)\ngy = GyroSensor(INPUT_3)\nir = InfraredSensor('in1')\n",
    "from ev3dev2.motor import *\nd = MoveDifferential(OUTPUT_B, OUTPUT_C, EV3Tire, 118)\nm = MediumMotor(OUTPUT_A)\n",
)
FLAGS: Mapping[str, Callable[[Random], list[str]]] = {
    "background": lambda r: [r.choice(["-b", "--background"]), r.choice(made.MATS[:21])],
    "fit": lambda r: ["--background-fit", r.choice(made.FITS)],
    "robot": lambda r: [r.choice(["-r", "--robot", "--robotSetup"]), r.choice(made.ROBOTS)],
    "obstacles": lambda r: [r.choice(["-o", "--obstacles"]), r.choice(made.SETS)],
    "walls": lambda r: ["--walls", r.choice(["on", "off"])],
    "solid": lambda r: [r.choice(["--solid", "--no-solid"])],
    "x": lambda r: [r.choice(["-x", "--x", "--xpos"]), _text(number(r, -10_000, 10_000))],
    "y": lambda r: [f"-y={_text(number(r, 0, 1143))}"],
    "angle": lambda r: [r.choice(["-a", "--angle"]), _text(number(r, -36_000, 36_000))],
    "light": lambda r: [r.choice(["-N", "--sensornoise"]), _text(whole(r, 0, 128))],
    "motor": lambda r: [r.choice(["-M", "--motornoise"]), _text(whole(r, 0, 500))],
    "down": lambda r: [r.choice(["-p", "--pendown"])],
    "color": lambda r: [r.choice(["-P", "--pencolor"]), r.choice(made.COLORS)],
    "width": lambda r: ["--pen-width", _text(number(r, 0.1, 200))],
    "marks": lambda r: ["--pen-marks"],
    "profile": lambda r: ["--profile", r.choice(made.PROFILES)],
    "seed": lambda r: ["--seed", _text(whole(r, 0, 99))],
    "speed": lambda r: ["--speed", r.choice(["max", "1", "0.01", "1000", "2.5", "1e2"])],
    "preload": lambda r: ["--preload", r.choice(["none", "imports", "preloaded"])],
    "app": lambda r: [
        r.choice(["-C", "-u", "-q", "-O", "-A", "-c", "-i", "-z", "-Z", "-X", "-D", "-W", "-H"])
    ],
}
"""Options by what they set."""
LONG: Mapping[str, Callable[[Random], Any]] = {
    "background": lambda r: r.choice(made.MATS[:21]),
    "background_fit": lambda r: r.choice(made.FITS),
    "robot": lambda r: r.choice(made.ROBOTS),
    "robotSetup": lambda r: r.choice(made.ROBOTS),
    "obstacles": lambda r: r.choice(made.SETS),
    "walls": lambda r: r.choice([True, False, "on", "off", "yes"]),
    "solid": lambda r: r.choice([True, False]),
    "no_solid": lambda r: r.choice([True, False, 1]),
    "x": lambda r: r.choice([number(r, -10_000, 10_000), "12", True]),
    "ypos": lambda r: number(r, 0, 1143),
    "angle": lambda r: number(r, -36_000, 36_000),
    "sensornoise": lambda r: r.choice([whole(r, 0, 128), 3.0]),
    "motornoise": lambda r: whole(r, 0, 500),
    "pendown": lambda r: truth(r),
    "pencolor": lambda r: r.choice([*made.COLORS, "gren"]),
    "pen_width": lambda r: number(r, 0.1, 200),
    "pen_marks": lambda r: truth(r),
    "profile": lambda r: r.choice([*made.PROFILES, "ev4"]),
    "seed": lambda r: r.choice([whole(r, 0, 99), 2**63 - 1, -1]),
    "preload": lambda r: r.choice(["none", "imports"]),
}
"""Keyword arguments of Python's interface."""
VARIED: Mapping[str, Callable[[Random], str]] = {
    "noise.motor": lambda r: r.choice(["0,20", "0:50:25", "7", "random(0, 50, 3)"]),
    "noise.light": lambda r: r.choice(["0,128", "latin(0, 50, 4)", "3"]),
    "start.x_mm": lambda r: r.choice(["100,200.5", "latin(0, 500, 4)", "0..3", "-1e3"]),
    "start.heading_deg": lambda r: r.choice(["-90,90", "random(0, 360, 2, seed=3)"]),
    "background": lambda r: ",".join(r.sample(made.MATS[:15], 2)),
    "robot": lambda r: ",".join(r.sample(made.ROBOTS, 2)),
    "robot.wheel_diameter_mm": lambda r: r.choice(["54:58:2", "60", "random(50, 60, 2)"]),
    "robot.color_sensors.left.diameter_mm": lambda r: r.choice(["20,30", "random(2, 100, 3)"]),
    "robot.weight": lambda r: r.choice(["light,heavy", "3.5"]),
    "robot.pen.width_mm": lambda r: "1,2",
    "profile": lambda r: r.choice(["ev3,robolab", "nbev3devsim"]),
    "profile.color_read_ms": lambda r: r.choice(["5,10", "0.5"]),
    "profile.tick_hz": lambda r: r.choice(["50,100", "30"]),
    "walls": lambda r: "on,off",
    "solid": lambda r: "true,false",
    "obstacles": lambda r: r.choice(["None,Wall", "Square_posts"]),
    "seed": lambda r: r.choice(["0..3", "5,1"]),
    "pen.color": lambda r: "red,'#00ff00'",
    "arguments": lambda r: "'a b',c",
    "beacon.x_mm": lambda r: "3,4",
}
"""Parameters of a batch."""


def _text(value: float) -> str:
    return repr(value)


def option_words(r: Random, most: int) -> list[str]:
    """Return some options of the command line."""
    return [word for key in r.sample(sorted(FLAGS), r.randint(0, most)) for word in FLAGS[key](r)]


def magic_line(r: Random, most: int, magic: str = "") -> str:
    """Return a magic line as the comment of a program."""
    name = magic or r.choice(["sim_magic", "sim_magic_imports", "sim_magic_preloaded"])
    return f"# %%{name} {shlex.join(option_words(r, most))}".rstrip() + "\n"


def _program(r: Random, most: int = 3) -> str:
    if r.random() < 0.15:
        return r.choice(BRICK_PROGRAMS)
    return (magic_line(r, most) if most else "") + PROGRAM


def _options(r: Random, name: str) -> Case:
    command = "open" if r.random() < 0.25 else "run"
    arguments = r.choice([[], [], [], ["--", "a", "b c"]])
    return Case(name, (command, "p.py", *option_words(r, 7), *arguments), {"p.py": _program(r, 0)})


def _magic(r: Random, name: str) -> Case:
    return Case(name, ("run", "p.py", *option_words(r, 2)), {"p.py": _program(r, 6)})


def _cells(r: Random, name: str) -> Case:
    return Case(
        name, tuple(shlex.join(option_words(r, 4)) for _ in range(r.randint(1, 3))), how="cells"
    )


def _choices(r: Random, name: str) -> Case:
    chosen = {key: LONG[key](r) for key in r.sample(sorted(LONG), r.randint(1, 4))}
    files = {"p.py": _program(r, 2)}
    if r.random() < 0.3:
        files["w.toml"] = toml(made.world(r))
        chosen["world"] = "w.toml"
    return Case(name, ("p.py",), files, how="choices", choices=chosen)


def _experiment(r: Random, name: str) -> Case:
    varied: Table = {}
    for key in r.sample(sorted(VARIED), r.randint(1, 2)):
        varied[key] = VARIED[key](r) if truth(r) else _listed(VARIED[key](r))
    chosen = {key: LONG[key](r) for key in r.sample(sorted(LONG), r.randint(0, 2))}
    chosen |= some(r, 0.4, seeds=lambda: r.choice(["0..2", [4, 5], range(3)]), goals="square")
    return Case(
        name,
        ("p.py",),
        {"p.py": _program(r, 1)},
        how="choices",
        choices=chosen | {"parameters": varied},
    )


def _own_places(r: Random, name: str) -> Case:
    """A mat moves the sensors of a robot, unless they have places of their own; in cells, one mat follows another."""
    robot = made.some(r, 0.5, base=r.choice(made.ROBOTS), weight="light")
    robot["color_sensors"] = {
        side: made.some(
            r, 0.5, x_mm=lambda: r.randint(-50, 50), diameter_mm=lambda: r.randint(5, 30)
        )
        for side in r.sample(["left", "right"], r.randint(1, 2))
    }
    mats = r.sample(
        ["Radial_grey", "Obstacles_Test", "Sensor_Diameter_Test", "Line_Following_Test", "Loop"], 2
    )
    words = ["-x", "7"] if truth(r) else ["-o", "Wall"]
    files: dict[str, str | bytes] = {"p.py": PROGRAM, "r.toml": toml(robot)}
    match r.randrange(3):
        case 0:
            return Case(name, ("run", "p.py", "-r", "r.toml", "-b", mats[0]), files)
        case 1:
            files["w.toml"] = toml({"background": mats[0], "robot": robot})
            return Case(name, ("run", "w.toml", "p.py", "-p", *words), files)
        case _:
            lines = [
                ["-b", mats[0], "-r", "r.toml", *words],
                ["-N", "3", *option_words(r, 1)],
                ["-b", mats[1]],
                ["-p"],
            ]
            return Case(name, tuple(map(shlex.join, lines[: r.randint(2, 4)])), files, how="cells")


def _world(r: Random, name: str) -> Case:
    table = made.world(r)
    files: dict[str, str | bytes] = {"p.py": _program(r, 1)}
    if r.random() < 0.1:
        files["base.toml"] = toml(made.world(r))
        table = {"world": "base.toml"} | table
    for key, make in (("robot", made.robot), ("profile", made.profile)):
        if r.random() < 0.05:
            files[f"{key}.toml"] = toml(make(r))
            table = (
                {key: value for key, value in table.items() if key != key}
                | table
                | {key: f"./{key}.toml"}
            )
    if "robot" not in table and r.random() < 0.03:
        files["saved.json"] = json.dumps(made.json_robot(r))
        table["robot"] = "saved.json"
    named = r.random() < 0.5
    if named:
        table["program"] = "p.py"
    files["w.toml"] = toml(table)
    command = "open" if r.random() < 0.15 else "run"
    return Case(name, (command, "w.toml", *([] if named else ["p.py"]), *option_words(r, 1)), files)


def _robot(r: Random, name: str) -> Case:
    files = {"p.py": PROGRAM, "r.toml": toml(made.robot(r))}
    if r.random() < 0.25:
        return Case(name, ("robots", "r.toml"), files)
    words = [
        word
        for key in r.sample(["background", "light", "color", "down"], 1)
        for word in FLAGS[key](r)
    ]
    return Case(name, ("run", "p.py", "-r", "r.toml", *words), files)


def _json_robot(r: Random, name: str) -> Case:
    files = {"p.py": PROGRAM, "r.json": json.dumps(made.json_robot(r), indent=1)}
    words = option_words(r, 1) if r.random() < 0.3 else []
    return Case(name, ("run", "p.py", "-r", "r.json", *words), files)


def _obstacles(r: Random, name: str) -> Case:
    found = made.boxes(r)
    if r.random() < 0.3:
        files = {"p.py": PROGRAM, "o.json": json.dumps([list(box.values()) for box in found])}
        return Case(name, ("run", "p.py", "-o", "o.json"), files)
    files = {"p.py": PROGRAM, "o.toml": toml({"obstacle": found})}
    return Case(
        name, ("obstacles", "o.toml") if truth(r) else ("run", "p.py", "-o", "o.toml"), files
    )


def _profile(r: Random, name: str) -> Case:
    files = {"p.py": PROGRAM, "f.toml": toml(made.profile(r))}
    words = (
        ("profiles", "f.toml", "--json")
        if r.random() < 0.2
        else ("run", "p.py", "--profile", "f.toml")
    )
    return Case(name, words, files)


def _defaults(r: Random, name: str) -> Case:
    text = toml(made.defaults(r))
    if r.random() < 0.2:
        return Case(name, ("config", "--json"), defaults=text)
    command = "open" if r.random() < 0.4 else "run"
    return Case(name, (command, "p.py", *option_words(r, 2)), {"p.py": _program(r)}, text)


def _layers(r: Random, name: str) -> Case:
    """Everything says something about the same few values: who takes precedence?"""
    table = made.world(r, 0.4, tables=False) if truth(r) else {}
    files: dict[str, str | bytes] = {"r.toml": toml(made.robot(r)), "f.toml": toml(made.profile(r))}
    files["p.py"] = magic_line(r, 8) + PROGRAM
    words = [
        *(["-r", "r.toml"] if truth(r) else []),
        *(["--profile", "f.toml"] if r.random() < 0.3 else []),
    ]
    if table:
        files["w.toml"] = toml(table)
    named = (["w.toml"] if table else []) + ["p.py"]
    return Case(
        name,
        (r.choice(["run", "open"]), *named, *words, *option_words(r, 3)),
        files,
        toml(made.defaults(r)),
    )


def batch_table(r: Random) -> Table:
    """Return the table `[batch]` of a batch file."""
    table: Table = {"program": r.choice(["p.py", ["p.py"], "square.py"])}
    varied: Table = {}
    for key in r.sample(sorted(VARIED), r.randint(1, 3)):
        varied[key] = VARIED[key](r) if r.random() < 0.7 else _listed(VARIED[key](r))
    table["set"] = varied
    seeds: Table = {} if "seed" in varied else {"seeds": lambda: r.choice(["0..3", [1, 2], 7])}
    return table | some(
        r,
        0.4,
        **seeds,
        jobs=lambda: whole(r, 1, 8),
        expressions={"far": "hypot(x_mm, y_mm)"},
        keep=lambda: r.choice(["all", "failed", "none"]),
    )


def _listed(text: str) -> Any:
    values = []
    for part in text.split(","):
        try:
            values.append(json.loads(part))
        except ValueError:
            values.append(part.strip("'"))
    return values


def _batch(r: Random, name: str) -> Case:
    files: dict[str, str | bytes] = {"p.py": _program(r, 2)}
    if truth(r):
        table = {"batch": batch_table(r)}
        if r.random() < 0.4:
            table |= made.world(r, 0.15)
        files["b.toml"] = toml(table)
        return Case(name, ("batch", "b.toml", *option_words(r, 1)), files)
    words = [
        word
        for key in r.sample(sorted(VARIED), r.randint(1, 3))
        for word in ("--set", f"{key}={VARIED[key](r)}")
    ]
    if r.random() < 0.3:
        files["w.toml"] = toml(made.world(r, 0.15))
        words = ["--world", "w.toml", *words]
    return Case(name, ("batch", "p.py", *words, *option_words(r, 1)), files)


WORLD_BEFORE = """\
# Lesson 3
rays = true            # to see them
panels = ["chart"]     # the log
seed = 3
robot = "Small_Robot"  # a small one
[noise]
light = 5              # a dark room
"""
ROBOT_BEFORE = "# Ours.\nname = 'x'\nback_mm = -70 # so\n[pen]\ncolor='blue'\n[color_sensors.left]\ny_mm = 45 # ahead\n"
BOX_BEFORE = (
    "# Posts.\n[[obstacle]]  # left\nx_mm = 1\ny_mm = 2\nwidth_mm = 3  # thin\nheight_mm = 4\n"
)


def _saved(r: Random, name: str) -> Case:
    """A run is saved as a file, often into one that exists and has comments."""
    what, before = r.choice(
        [("world", WORLD_BEFORE)] * 3 + [("robot", ROBOT_BEFORE), ("obstacles", BOX_BEFORE)]
    )
    files = {"p.py": PROGRAM, "w.toml": toml(made.world(r))}
    if r.random() < 0.6:
        files["saved.toml"] = before
    return Case(name, ("run", "w.toml", "p.py", *option_words(r, 1), "--", "a b"), files, how=what)


def _own_mat(r: Random, name: str) -> Case:
    """The mat is the user's own image, named in one place or another."""
    folder = r.choice(["mats", "backgrounds"])
    files: dict[str, str | bytes] = {
        f"{folder}/Loop.png": IMAGE,
        f"{folder}/ours.png": IMAGE,
        "p.py": _program(r, 1),
    }
    mat = r.choice(["Loop", "ours", f"./{folder}/ours.png"])
    fit = ["--background-fit", r.choice(made.FITS)] if truth(r) else []
    match r.choice(["words", "magic", "world", "defaults"]):
        case "words":
            return Case(name, ("run", "p.py", "--mats", folder, "-b", mat, *fit), files)
        case "magic":
            files["p.py"] = f"# %%sim_magic --mats {folder} -b {mat} {' '.join(fit)}\n" + PROGRAM
            return Case(name, ("run", "p.py"), files)
        case "world":
            files["w.toml"] = toml({"mats": folder, "background": mat} | made.world(r, 0.2))
            return Case(name, ("run", "w.toml", "p.py", *fit), files)
        case _:
            named = {"mats": f"../{folder}", "background": mat.replace("./", "../")}
            return Case(name, ("run", "p.py", *fit), files, toml({"simulation": named}))


KINDS: Mapping[str, tuple[int, Callable[[Random, str], Case]]] = {
    "options": (1760, _options),
    "magic line": (1300, _magic),
    "cells": (400, _cells),
    "choices": (400, _choices),
    "world": (1900, _world),
    "robot": (1200, _robot),
    "JSON robot": (500, _json_robot),
    "obstacles": (300, _obstacles),
    "profile": (500, _profile),
    "defaults": (600, _defaults),
    "layers": (500, _layers),
    "batch": (400, _batch),
    "saved": (200, _saved),
    "own mat": (40, _own_mat),
    "experiment": (200, _experiment),
    "own places": (200, _own_places),
}
"""By kind: how many cases there are, and what makes one."""


def random_cases() -> Iterator[Case]:
    """Yield all cases that should mostly be right."""
    for kind, (count, make) in KINDS.items():
        for index in range(count):
            name = f"{kind} {index}"
            yield make(Random(name), name)


def built_in_cases() -> Iterator[Case]:
    """Yield cases of everything that comes with the package: robots, mats, obstacles, profiles, goals, lessons."""
    for words in ("robots", "obstacles", "profiles", "backgrounds", "config", "programs"):
        yield Case(f"built in {words}", (words, "--json"))
    yield Case("built in profiles as a table", ("profiles",))
    yield Case("built in defaults as a table", ("config",))
    files = {"p.py": PROGRAM}
    for robot in made.ROBOTS:
        yield Case(f"built in {robot} as a file", ("robots", robot))
        for mat in made.MATS:
            yield Case(f"built in {robot} on {mat}", ("run", "p.py", "-r", robot, "-b", mat), files)
    for name in made.SETS:
        yield Case(f"built in {name} as a file", ("obstacles", name))
    for profile in made.PROFILES:
        for name in made.SETS:
            yield Case(
                f"built in {name} by {profile}",
                ("run", "p.py", "--profile", profile, "-o", name),
                files,
            )
    for program in (
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
    ):
        for command in ("run", "open"):
            yield Case(f"built in {program} by {command}", (command, program))
    for task in ("follow_line", "log_greys", "square", "stop_at_wall"):
        yield Case(f"built in goals of {task}", ("batch", "--goals", task, task, "--seeds", "0"))
        yield Case(f"built in world of {task}", ("run", f"{task}_goals.toml"))
    for at, program in enumerate(BRICK_PROGRAMS):
        for more in ((), ("--json",), ("--out", "r.toml")):
            yield Case(
                f"built in {at} of a brick {more}",
                ("robots", "--from", "p.py", *more),
                {"p.py": program},
            )
    for lesson in range(1, 17):
        yield Case(f"built in lesson {lesson}", ("learn", "open", str(lesson)))
