"""Options on the command line and in a magic line."""

from __future__ import annotations

from typing import Any

import pytest

from tests.cases import for_rows
from tuisim.base.errors import ConfigError
from tuisim.settings.options import OPTIONS, RUN_VALUES, Settings
from tuisim.settings.shared_options import parse_words


@for_rows(
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
)
def test_words_of_options_are_parsed_to_their_values(words: str, fields: dict[str, Any]) -> None:
    assert parse_words(words.split()) == fields


@for_rows(
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
)
def test_wrong_values_of_options_are_refused_with_what_is_allowed(words: str, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        parse_words(words.split())


def test_every_value_of_the_world_has_an_option_and_no_flag_is_used_twice() -> None:
    # Programs and world files decide whether there is a floor.
    assert RUN_VALUES.keys() - {"floor"} <= {option.path for option in OPTIONS}
    flags = [flag for option in OPTIONS for flag in (*option.flags, *option.magic_flags)]
    assert len(flags) == len(set(flags))


def test_later_layers_of_settings_win_and_panels_add_up() -> None:
    settings = Settings.merge(
        parse_words(["-b", "Loop", "-x", "5", "-O"]), parse_words(["-b", "Square", "-cO"])
    )
    assert settings == Settings(
        {"background": "Square", "start.x_mm": 5.0, "panels_on": ("output", "chart")}
    )


@pytest.mark.parametrize(
    "name, metavar",
    [("solid", ""), ("walls", "on|off"), ("seed", "N"), ("output", ""), ("background", "MAT")],
)
def test_the_help_of_an_option_names_its_kind_of_value(name: str, metavar: str) -> None:
    assert next(option.metavar for option in OPTIONS if option.name == name) == metavar
