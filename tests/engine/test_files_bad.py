"""Bad robot, obstacle, profile and world files: one clear line with file and key, and nothing changed."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.cases import cases, for_each
from tests.conftest import Command
from tuisim.base.errors import ConfigError, ObstacleError, ProfileError, RobotError
from tuisim.engine.core.profile import PROFILES
from tuisim.engine.files import MAX_FILE_BYTES, Location, convert
from tuisim.settings.build import build_run_spec
from tuisim.settings.options import Settings
from tuisim.settings.shared_options import parse_words
from tuisim.settings.worlds import WorldFile

KINDS: dict[str, type[ConfigError]] = {
    "-r": RobotError,
    "-o": ObstacleError,
    "--profile": ProfileError,
    "--world": ConfigError,
}
"""The switch that names a file of each kind, and the class of errors about it."""


def folder(path: Path) -> None:
    path.mkdir()


def loop(path: Path) -> None:
    path.symlink_to(path.name)


def pipe(path: Path) -> None:
    os.mkfifo(path)


def unreadable(path: Path) -> None:
    # No mode keeps the superuser out, but nobody can read the memory at 0.
    path.symlink_to("/proc/self/mem")


def large(path: Path) -> None:
    with path.open("wb") as file:
        file.truncate(100 << 20)


def missing(path: Path) -> None:
    """Nothing."""


def deep(opening: str, closing: str) -> str:
    return opening * 50_000 + closing * 50_000


Content = str | bytes | Callable[[Path], None]

# What is wrong with a file whatever it describes, and what must be said.
BROKEN: dict[str, tuple[Content, str]] = {
    "missing": (missing, "there is no such file"),
    "folder": (folder, "is a folder, not a file"),
    "symlink loop": (loop, "cannot be read: Too many levels of symbolic links"),
    "pipe": (pipe, "is not a regular file"),
    "unreadable": (unreadable, "cannot be read: "),
    "100 MB": (large, f"is too large (at most {MAX_FILE_BYTES:,} bytes)".replace(",", " ")),
    "empty": ("", "is empty"),
    "blank": ("\n  \n", "is empty"),
    "binary": (bytes(range(256)) * 9, "line 2 is not UTF-8 text (save it as UTF-8)"),
    "latin-1": ("# Länge\n".encode("latin-1"), "line 1 is not UTF-8 text"),
    "null": ("a = 1\n\0", "is not TOML: "),
    "syntax": ("seed = 1\nrobot = \n", "is not TOML: Invalid value (at line 2, column 9)"),
    "twice": ("seed = 1\nseed = 2\n", "is not TOML: Cannot overwrite a value (at line 2"),
    "deep": ("a = " + "\n".join(deep("[", "]")), "is nested too deeply"),
    "long line": ("a" + ".a" * 100_000 + " = 1", "line 1 is too long (at most 1000 characters)"),
    "huge number": ("seed = " + "9" * 900 + "\n" + "a = 1" * 9, "is not TOML: "),
    "unknown key": ("zzzz = 1", "zzzz: no such key (one of "),
}

EYE = "[color_sensors.left]\n"
BOX = "[[obstacle]]\nx_mm = 0\ny_mm = 0\nwidth_mm = 9\n"

FILES = {
    "robot": ("-r", "a.toml"),
    "json robot": ("-r", "a.json"),
    "obstacle": ("-o", "a.toml"),
    "json obstacles": ("-o", "a.json"),
    "profile": ("--profile", "a.toml"),
    "json profile": ("--profile", "a.json"),
    "world": ("--world", "a.toml"),
    "json world": ("--world", "a.json"),
}
"""By the first words of a case: the switch and the file's name."""

# What is wrong with what a file says, and what must be said after the file's name.
WRONG: dict[str, tuple[str, str]] = {
    "robot: misspelt key": (
        "weel_diameter_mm = 3",
        "weel_diameter_mm: no such key (did you mean wheel_d",
    ),
    "robot: text": ("back_mm = 'far'", "back_mm: must be a number from -1000 to 0, got 'far'"),
    "robot: truth": ("back_mm = true", "back_mm: must be a number from -1000 to 0, got true"),
    "robot: NaN": ("back_mm = nan", "back_mm: must be a number from -1000 to 0, got nan"),
    "robot: negative": (
        "wheel_spacing_mm = -5",
        "wheel_spacing_mm: must be a number from 1 to 1000, got -5",
    ),
    "robot: weight": ("weight = 'hevy'", "weight: must be weightless, light, medium, heavy, or a"),
    "robot: base": ("base = 'Big'", "base: no such value 'Big' (one of Default_Robot, Small_Robot"),
    "robot: name": ('name = "a\\nb"', "name: must be one line of 1 to 100 characters, got 'a\\nb'"),
    "robot: long name": (
        f"name = '{'a' * 101}'",
        "name: must be one line of 1 to 100 characters, got 'aa",
    ),
    "robot: motor port": (
        "left_port = 'outE'",
        "left_port: no such port 'outE' (one of outA, outB",
    ),
    "robot: one wheel": ("left_port = 'none'", "left_port: no such port 'none' (one of outA, outB"),
    "robot: motors": (
        "left_port = 'outC'",
        "right_port: both motors are on outC (give each its own port)",
    ),
    "robot: sensors": (
        EYE + "port = 'in3'",
        "right.port: two sensors are on in3 (give each its own port, or remove",
    ),
    "robot: half a pixel": (
        EYE + "diameter_mm = 2.5",
        "color_sensors.left.diameter_mm: must be a whole number",
    ),
    "robot: strategy": (
        EYE + "strategy = 'max'",
        "color_sensors.left.strategy: no such strategy 'max' (one of",
    ),
    "robot: third eye": (
        "[color_sensors.up]\nx_mm = 0\ny_mm = 0",
        "color_sensors.up.port: is missing",
    ),
    "robot: eye's name": (
        "[color_sensors.'a b']",
        "color_sensors.a b: is not a valid sensor name (letters",
    ),
    "robot: eyes listed": (
        "color_sensors = ['left']",
        "color_sensors: must be a table of keys and values, got",
    ),
    "robot: no rays": (
        "[ultrasonic]\nray_angles_deg = []",
        "ultrasonic.ray_angles_deg: must be 1 to 100 numbers",
    ),
    "robot: ray": (
        "[ultrasonic]\nray_angles_deg = [0, 'x']",
        "ultrasonic.ray_angles_deg[2]: must be a number",
    ),
    "robot: gyro": ("gyro = 3", "gyro: must be a table of keys and values, got 3"),
    "robot: pen": ("[pen]\ncolor = 'reed'", "pen.color: no such colour 'reed' (did you mean red"),
    "robot: huge whole number": (
        "back_mm = -1" + "0" * 400,
        "back_mm: must be a number from -1000 to 0, got -10000",
    ),
    "robot: huge diameter": (
        EYE + "diameter_mm = " + "9" * 400,
        "color_sensors.left.diameter_mm: must be a whole num",
    ),
    "robot: date": (
        "back_mm = 2026-11-22",
        "back_mm: must be a number from -1000 to 0, got datetime",
    ),
    "robot: truth as a diameter": (
        EYE + "diameter_mm = true",
        "color_sensors.left.diameter_mm: must be a whole num",
    ),
    "robot: eye renamed": (
        EYE + "name = 'x'",
        "color_sensors.left.name: no such key (one of port, x_mm",
    ),
    "robot: escape in a key": ('"a\\u001b[31m" = 1', "a\\x1b[31m: no such key (one of base, name"),
    "robot: motor taken from a wheel": (
        "[motors]\noutB = false",
        "motors.outB: drives a wheel (it cannot be removed;",
    ),
    "robot: kind of motor": (
        "[motors]\noutA = 'huge'",
        "motors.outA: no such value 'huge' (one of large, medium",
    ),
    "robot: motor on an input": ("[motors]\nin1 = 'large'", "motors.in1: no such key"),
    "robot: infrared port": ("[infrared]\nport = 'in9'", "infrared.port: no such port 'in9'"),
    "robot: key of a touch sensor": (
        "[touch_sensors.nose]\nport = 'in1'\ndepth = 3",
        "touch_sensors.nose.depth: no such key",
    ),
    "json robot: half a surrogate pair": (
        '{"back": "\\ud800"}',
        r"back: must be a number from -1000 to 0, got '\u",
    ),
    "json robot: colour": (
        '{"pen": {"color": "reed"}}',
        "pen.color: no such colour 'reed' (did you mean red",
    ),
    "json robot: not text": (
        '{"sensorNoise": "3"}',
        "sensorNoise: must be a whole number from 0 to 128, got '3'",
    ),
    "robot: deep value": (
        "back_mm = " + "[" * 90 + "]" * 90,
        "back_mm: must be a number from -1000 to 0, got [",
    ),
    "json robot: type": (
        '{"sensor1": {"x": "3"}}',
        "sensor1.x: must be a number from -500 to 500, got '3'",
    ),
    "json robot: enabled": (
        '{"gyro": {"enabled": 1}}',
        "gyro.enabled: must be true or false, got 1",
    ),
    "json robot: twice": ('{"back": -1, "back": -2}', "back: is given twice"),
    "json robot: a list": ("[]", "must be a table of keys and values, got []"),
    "json robot: syntax": (
        '{"back":\n -1,}',
        "is not JSON: Expecting property name enclosed in double quotes: line 2",
    ),
    "json obstacles: deep": (deep("[", "]"), "is nested too deeply"),
    "json obstacles: NaN": (
        "[[0, 0, NaN, 1]]",
        "[1].width_mm: must be a number from -10000 to 10000, got nan",
    ),
    "json obstacles: three sides": (
        "[[0, 0, 5, 5], [1, 2, 3]]",
        "[2]: must be [x, y, width, height], got [1, 2, 3]",
    ),
    "json obstacles: no list": (
        '{"x": 1}',
        "must be a list of [x, y, width, height], got {'x': 1}",
    ),
    "obstacle: key missing": (BOX, "obstacle[1].height_mm: is missing"),
    "obstacle: flat": (BOX + "height_mm = 0", "obstacle[1].height_mm: must be above 0, got 0.0"),
    "obstacle: 1e9": (
        BOX + "height_mm = 1e9",
        "obstacle[1].height_mm: must be a number from -10000",
    ),
    "obstacle: unknown key": (
        BOX + "hight_mm = 3",
        "obstacle[1].hight_mm: no such key (did you mean height_mm",
    ),
    "obstacle: no table": (
        "obstacle = [3]",
        "obstacle[1]: must be a table of keys and values, got 3",
    ),
    "json obstacles: too many": (str([[0, 0, 1, 1]] * 1001), "has 1001 obstacles (at most 1000)"),
    "profile: name": (
        "name = 'ev3'",
        "name: 'ev3' is the name of a built-in profile (choose another",
    ),
    "profile: base": ("base = 'ev4'", f"base: no such value 'ev4' (one of {', '.join(PROFILES)})"),
    "profile: no ticks": ("tick_hz = 0", "tick_hz: must be a whole number from 1 to 1000, got 0"),
    "profile: half ticks": (
        "tick_hz = 30.5",
        "tick_hz: must be a whole number from 1 to 1000, got 30.5",
    ),
    "profile: negative": (
        "color_read_ms = -1",
        "color_read_ms: must be a number from 0 to 60000, got -1",
    ),
    "profile: both": (
        "gyro_read_ms = 1\ngyro_read_ns = 1",
        "gyro_read_ms: cannot be combined with gyro_read_ns",
    ),
    "world: mat": (
        "background = 'Grey_band'",
        "background: no such mat 'Grey_band' (did you mean Grey_bands",
    ),
    "world: fit": (
        "background_fit = 'tile'",
        "background_fit: no such value 'tile' (one of stretch, fit",
    ),
    "world: robot": (
        "robot = 'Smal_Robot'",
        "robot: no such robot 'Smal_Robot' (did you mean Small_Robot",
    ),
    "world: robot inside": (
        "[robot.pen]\nx_mm = 900",
        "robot.pen.x_mm: must be a number from -500 to 500, got 900",
    ),
    "world: obstacles": (
        "obstacles = 'Posts'",
        "obstacles: no such obstacles 'Posts' (did you mean Square_posts",
    ),
    "world: obstacle inside": (
        BOX + "height_mm = 'a'",
        "obstacle[1].height_mm: must be a number from -10000",
    ),
    "world: two sets": (
        "obstacles = 'Wall'\nobstacle = []",
        "obstacle: cannot be combined with obstacles (give",
    ),
    "world: profile": ("profile = 'ev4'", "profile: no such profile 'ev4' (did you mean ev3?"),
    "world: profile inside": (
        "[profile]\ntick_hz = '30'",
        "profile.tick_hz: must be a whole number from 1 to 1000",
    ),
    "world: noise": (
        "[noise]\nlight = 129",
        "noise.light: must be a whole number from 0 to 128, got 129",
    ),
    "world: seed": (
        "seed = -1",
        "seed: must be a whole number from 0 to 9223372036854775807, got -1",
    ),
    "world: colour": (
        "[pen]\ncolor = '#12345'",
        "pen.color: no such colour '#12345' (any CSS colour name",
    ),
    "world: walls": ("walls = 'on'", "walls: must be true or false, got 'on'"),
    "world: panel": (
        "panels = ['chart', 'char']",
        "panels[2]: no such value 'char' (one of output",
    ),
    "world: robot's type": (
        "robot = 3",
        "robot: must be text or a table of keys and values, got 3",
    ),
    "world: no text": ("robot = ''", "robot: must be one line of text, got ''"),
    "world: argument": (
        "arguments = [5]",
        'arguments[1]: must be text, got 5 (in quotes, such as "5")',
    ),
    "world: beacon": ("[beacon]\nx_mm = 1", "beacon.y_mm: is missing"),
    "world: channel": (
        "[beacon]\nx_mm = 1\ny_mm = 1\nchannel = 5",
        "beacon.channel: no such channel 5 (one of 1, 2",
    ),
    "world: no button": (
        "[[remote]]\nbuttons = []",
        "remote[1].buttons: the sensor does not report no button (one or",
    ),
    "world: button": (
        "[[remote]]\nbuttons = ['x']",
        "remote[1].buttons[1]: no such button 'x' (one of top_left",
    ),
    "world: press ends": (
        "[[remote]]\nbuttons = ['beacon']\nfrom_s = 3\nuntil_s = 1",
        "remote[1].until_s: ends before it begins",
    ),
    "world: presses": (
        "remote = [" + "{buttons = []},\n" * 10_001 + "]",
        "remote: has 10001 presses (at most 10000)",
    ),
    "json profile: at all": ("{}", "is not a .toml file"),
    "json world: at all": ("{}", "is not a .toml file (a world file is TOML)"),
}


def put(content: Content, path: Path) -> None:
    match content:
        case str():
            path.write_text(content, encoding="utf-8")
        case bytes():
            path.write_bytes(content)
        case make:
            make(path)


def build(switch: str, file: Path) -> None:
    """Do with a file what the command does before it runs anything."""
    if switch == "--world":
        build_run_spec(Settings.merge(WorldFile.load(file).settings))
    else:
        build_run_spec(Settings.merge(parse_words([switch, str(file)])))


def state(root: Path) -> list[tuple[str, float, int]]:
    """Every name in a folder with when it was changed and how large it is."""
    entries = [(path, path.lstat()) for path in sorted(root.rglob("*"))]
    return [(path.name, found.st_mtime, found.st_size) for path, found in entries]


def check(switch: str, path: Path, content: Content, said: str) -> None:
    put(content, path)
    before = state(path.parent)
    with pytest.raises(KINDS[switch]) as caught:
        build(switch, path)
    error = caught.value
    assert str(error).startswith(f"{path}: {said}")
    assert "\n" not in str(error)
    assert len(str(error)) < 600 + len(str(path))
    assert (error.exit_code, error.file) == (2, str(path))
    assert state(path.parent) == before


@pytest.mark.parametrize("switch", KINDS)
@cases("content, said", BROKEN)
def test_a_broken_settings_file_is_refused_with_the_reason(
    content: Content, said: str, switch: str, tmp_path: Path
) -> None:
    check(switch, tmp_path / "broken.toml", content, said)


@for_each(case=WRONG)
def test_a_wrong_value_in_a_settings_file_is_told_with_its_key(case: str, tmp_path: Path) -> None:
    switch, name = FILES[case.partition(":")[0]]
    text, said = WRONG[case]
    check(switch, tmp_path / name, text, said)


def test_a_missing_file_names_its_neighbour(tmp_path: Path) -> None:
    (tmp_path / "robot.toml").touch()
    with pytest.raises(
        RobotError, match=r"robt\.toml: there is no such file \(did you mean robot\.toml\?\)"
    ):
        build("-r", tmp_path / "robt.toml")


def test_a_missing_file_names_no_neighbour_that_shares_only_its_suffix(tmp_path: Path) -> None:
    (tmp_path / "w.toml").touch()
    with pytest.raises(RobotError, match=r"none\.toml: there is no such file$"):
        build("-r", tmp_path / "none.toml")


@pytest.mark.parametrize("key", ["robot", "obstacles", "profile"])
def test_a_mistake_in_a_file_that_a_world_names_is_told_with_that_file(
    key: str, tmp_path: Path
) -> None:
    (tmp_path / "lab.toml").write_text(f"{key} = 'sub/part.toml'")
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "part.toml").write_text("frobnicate = 1")
    with pytest.raises(ConfigError) as caught:
        build("--world", tmp_path / "lab.toml")
    assert str(caught.value).startswith(f"{tmp_path}/sub/part.toml: frobnicate: no such key")


@pytest.mark.parametrize("case", ["json robot: syntax", "world: mat", "binary"])
def test_run_refuses_a_broken_settings_file_in_one_line_and_runs_nothing(
    case: str, home: Path, tmp_path: Path, here: Command
) -> None:
    switch, name = FILES[case.partition(":")[0] if ":" in case else "world"]
    content, said = {**BROKEN, **WRONG}[case]
    put(content, tmp_path / name)
    (tmp_path / "prog.py").write_text("print('Number: 1')\n")
    before = state(tmp_path)
    done = here("run", "prog.py", switch, name, "--export", "rows.csv")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"tuisim: {name}: {said}")
    assert (done.returncode, done.stdout) == (2, "")
    assert state(tmp_path) == before


def test_a_list_where_a_text_is_allowed_too_is_checked_as_a_list() -> None:
    where = Location("lesson.md", ConfigError, "answer")
    assert convert("a", str | tuple[str, ...], where) == "a"  # type: ignore[arg-type]
    with pytest.raises(ConfigError, match=r"answer\[2\]: must be one line of text"):
        convert(["a", "b\nc"], str | tuple[str, ...], where)  # type: ignore[arg-type]
