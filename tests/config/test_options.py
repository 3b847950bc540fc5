"""Options on the command line and in a magic line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tuisim.config.options import OPTIONS, RUN_VALUES, Settings, settings_of
from tuisim.config.program_file import MAX_PROGRAM_BYTES, find_magic, parse_program, read_program
from tuisim.config.shared_options import parse_words
from tuisim.errors import ConfigError


@pytest.mark.parametrize(
    "words, fields",
    [
        ("", {}),
        ("-b Grey_bands", {"background": "Grey_bands"}),
        ("-bGrey_bands", {"background": "Grey_bands"}),
        (
            "-x -100 -y 2.5 -a -90",
            {"start.x_mm": -100.0, "start.y_mm": 2.5, "start.heading_deg": -90.0},
        ),
        ("-N 128 -M 500", {"noise.light": 128, "noise.motor": 500}),
        ("-OHR", {"panels_on": ("output",), "panels_off": ("controls",), "autorun": True}),
        ("-pP green", {"pen.down": True, "pen.color": "green"}),
        ("-P DarkOrange", {"pen.color": "darkorange"}),
        ("--pen-width 2.5 --pen-marks", {"pen.width_mm": 2.5, "pen_marks": True}),
        ("-P #FFaa00", {"pen.color": "#ffaa00"}),
        ("--solid --walls off", {"solid": True, "walls": False}),
        ("--solid --no-solid --walls on", {"solid": False, "walls": True}),
        ("--background-fit centre", {"background_fit": "centre"}),
        ("-r my.toml -o box.json", {"robot": "my.toml", "obstacles": "box.json"}),
        ("--profile own.toml", {"profile": "own.toml"}),
        (
            "-AcizZXD",
            {
                "panels_on": (
                    "arrays",
                    "chart",
                    "instrumentation",
                    "noise",
                    "settings",
                    "positioning",
                    "code",
                )
            },
        ),
        (
            "--xpos 5 --ypos 6 --world --hide",
            {"start.x_mm": 5.0, "start.y_mm": 6.0, "panels_off": ("world", "controls")},
        ),
        ("-WqCu", {"panels_off": ("world",), "quiet": True, "clear_trace": True, "rays": True}),
        ("--speed max", {"speed": 0.0}),
        ("--speed 0.25 --fps 10 --colors 16", {"speed": 0.25, "fps": 10, "colors": "16"}),
        (
            "-r Small_Robot -o None --preload none",
            {"robot": "Small_Robot", "obstacles": "None", "preload": "none"},
        ),
    ],
    ids=lambda value: value or "nothing" if isinstance(value, str) else "",
)
def test_options(words: str, fields: dict[str, Any]) -> None:
    assert parse_words(words.split()) == fields


@pytest.mark.parametrize(
    "words, said",
    [
        ("-x abc", r"^-x: must be a number from .*'abc'"),
        ("-x nan", "^-x: must be a number"),
        ("-y inf", "^-y: must be a number"),
        ("-a 1e9", "^-a: must be a number"),
        ("-N 1.5", "^-N: must be a whole number"),
        ("-M -1", "^-M: must be a whole number from 0 to 500"),
        (
            "-P pinq",
            r"^-P: no such colour 'pinq' .did you mean .*pink.* any CSS colour name, or #rrggbb",
        ),
        ("-P #12345", "^-P: no such colour '#12345'"),
        ("--walls no", r"^--walls: no such value 'no' .one of on, off"),
        ("--background-fit fill", r"^--background-fit: .*stretch, fit, centre"),
        ("--pen-width 0", r"^--pen-width: must be a number from 0\.1 to 200"),
        ("--speed 0", r"^--speed: .*max"),
        ("--speed fast", r"^--speed: .*max"),
        ("--seed -1", "^--seed: "),
        ("--fps 0", "^--fps: "),
        ("-b", "^option '-b' requires an argument"),
        ("-Q", "no such option: -Q"),
        ("--frob 3", "no such option: --frob"),
    ],
    ids=lambda value: value if value.startswith("-") else "",
)
def test_wrong_options_say_what_is_allowed(words: str, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        parse_words(words.split())


def test_every_value_of_the_world_has_an_option_and_no_flag_is_used_twice() -> None:
    # Programs and world files decide whether there is a floor.
    assert RUN_VALUES.keys() - {"floor"} <= {option.path for option in OPTIONS}
    flags = [flag for option in OPTIONS for flag in (*option.flags, *option.magic_flags)]
    assert len(flags) == len(set(flags))


def test_later_layers_win_and_panels_add_up() -> None:
    settings = settings_of(
        parse_words(["-b", "Loop", "-x", "5", "-O"]), parse_words(["-b", "Square", "-cO"])
    )
    assert settings == Settings(
        {"background": "Square", "start.x_mm": 5.0, "panels_on": ("output", "chart")}
    )


PLAIN = "import time\nprint(1)\n"


@pytest.mark.parametrize(
    "text, line, prelude, comment",
    [
        ("%%sim_magic_preloaded -b Loop -OHR\n" + PLAIN, 1, "preloaded", False),
        ("%%sim_magic_imports\n" + PLAIN, 1, "imports", False),
        ("%sim_magic -R\n" + PLAIN, 1, "none", False),
        ("# %%sim_magic -b Loop\n" + PLAIN, 1, "none", True),
        ("#%%sim_magic_preloaded\n" + PLAIN, 1, "preloaded", True),
        ('"""Title."""\n# %%sim_magic_preloaded\n' + PLAIN, 2, "preloaded", True),
        ('"""Title.\n\n%%sim_magic\n"""\n\n# %%sim_magic_imports\n' + PLAIN, 6, "imports", True),
        (
            "#!/usr/bin/env python3\n# -*- coding: utf-8 -*-\n\n# %%sim_magic_imports\n" + PLAIN,
            4,
            "imports",
            True,
        ),
    ],
    ids=[
        "raw",
        "raw imports",
        "one percent",
        "comment",
        "no blank",
        "after a docstring",
        "long docstring",
        "shebang",
    ],
)
def test_magic_line_is_found(text: str, line: int, prelude: str, comment: bool) -> None:
    magic = find_magic(text, "a.py")
    assert magic is not None
    assert (magic.line, magic.prelude, magic.comment) == (line, prelude, comment)


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN + "# %%sim_magic -b Loop\n",
        '"""\n%%sim_magic\n"""\n',
        "# about %%sim_magic\n",
        "",
    ],
    ids=["none", "too late", "in the docstring", "in a sentence", "empty"],
)
def test_no_magic_line(text: str) -> None:
    assert find_magic(text, "a.py") is None


@pytest.mark.parametrize("end", ["\n", ""], ids=["newline", "end of file"])
def test_raw_magic_line_becomes_a_comment_so_that_it_is_seen_and_lines_keep_their_numbers(
    end: str,
) -> None:
    program = parse_program(f"\n%%sim_magic_preloaded -b Grey_bands -OHR{end}", "a.py")
    assert program.program.text == f"\n# %%sim_magic_preloaded -b Grey_bands -OHR{end}"
    assert program.options["background"] == "Grey_bands"


@pytest.mark.parametrize(
    "text, prelude",
    [
        ("from ev3dev2.motor import MoveTank\n", "none"),
        ("import ev3dev2.sensor as s\n", "none"),
        ("def f():\n    from ev3dev2 import motor\n", "none"),
        ("from ev3dev2.motor import (\n", "none"),
        ("print('import ev3dev2')\n", "none"),
        ("from ev3dev2_glue import get_clock\nprint(get_clock())\n", "none"),
        ("from lib import go\ngo()\n", "none"),
        ("tank_drive.on(10, 10)\n", "preloaded"),
        ("from lib import *\ntank_drive.on(10, 10)\n", "preloaded"),
        ("def f():\n    return [colorLeft.color for _ in range(3)]\n", "preloaded"),
        ("def f(gyro):\n    return gyro.angle\n", "none"),
        ("class Team:\n    gyro = 3\n    print(gyro)\n", "none"),
        ("def f():\n    global gyro\n    gyro = 3\nf()\nprint(gyro)\n", "none"),
        ("def say(text):\n    print(text)\nsay('hello')\n", "none"),
        ("# tank_drive\nprint('tank_drive')\n", "none"),
        ("print(eval(input()))\n", "preloaded"),
        ("tank_drive.on(10, 10\n", "preloaded"),
        ("# %%sim_magic_imports --preload none\n", "none"),
    ],
    ids=[
        "from",
        "import",
        "inside",
        "broken import",
        "in a text",
        "glue",
        "own module",
        "used",
        "all of a module",
        "used in a function",
        "argument",
        "attribute",
        "global",
        "own function",
        "comment",
        "eval",
        "broken",
        "switch in the magic",
    ],
)
def test_prelude(text: str, prelude: str) -> None:
    assert parse_program(text, "a.py").program.prelude == prelude


@pytest.mark.parametrize(
    "line, said",
    [
        ("%%sim_magic_preloded -b Loop", r"^a\.py, line 1: no such magic .*sim_magic_preloaded"),
        ("# %%sim_magic -x abc", r"^a\.py, line 1: -x: must be a number"),
        ("# %%sim_magic -b 'Loop", r"^a\.py, line 1: cannot be split"),
        ("# %%sim_magic -s other", r"^a\.py, line 1: no such option"),
    ],
    ids=["name", "value", "quote", "switch"],
)
def test_wrong_magic_lines_say_where(line: str, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        parse_program(line + "\n", "a.py")


@pytest.mark.parametrize(
    "data, said",
    [
        (b"\xff\xfe\x00", "is not Python text"),
        (b"x = '\x00'\n", "null characters"),
        (b"# coding: klingon\n", "is not Python text"),
        (b"#" * (MAX_PROGRAM_BYTES + 1), "is larger than 4 MiB"),
    ],
    ids=["binary", "null", "coding", "huge"],
)
def test_files_that_are_no_programs(tmp_path: Path, data: bytes, said: str) -> None:
    file = tmp_path / "a.py"
    file.write_bytes(data)
    with pytest.raises(ConfigError, match=said):
        read_program(file)


def test_missing_program_names_its_neighbour(tmp_path: Path) -> None:
    (tmp_path / "follow.py").touch()
    with pytest.raises(ConfigError, match=r"no such program \(did you mean follow\.py\?\)"):
        read_program(tmp_path / "folow.py")


def test_other_encodings_and_line_ends_are_read(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    file.write_bytes("# coding: latin-1\r\nx = 'ä'\r\n".encode("latin-1"))
    assert read_program(file).program.text == "# coding: latin-1\nx = 'ä'\n"


@pytest.mark.parametrize(
    "name, metavar",
    [("solid", ""), ("walls", "on|off"), ("seed", "N"), ("output", ""), ("background", "MAT")],
)
def test_the_help_says_what_stands_for_a_value(name: str, metavar: str) -> None:
    assert next(option.metavar for option in OPTIONS if option.name == name) == metavar
