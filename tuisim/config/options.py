"""The options shared by the command line and a program's magic line, and the settings that they set.

To add an option: add a line to `OPTIONS`, and its field to `Settings`.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, TypeVar

from tuisim.core.profile import ProfileSpec
from tuisim.core.spec import (
    BACKGROUND_FITS,
    MAX_LIGHT_NOISE,
    MAX_MOTOR_NOISE,
    BeaconSpec,
    Obstacle,
    RemotePress,
    RobotSpec,
)
from tuisim.errors import ConfigError
from tuisim.source import PRELUDE_TEXTS

_Number = TypeVar("_Number", int, float)

PRELOADS = tuple(PRELUDE_TEXTS)
COLOR_DEPTHS = ("auto", "truecolor", "256", "16", "8", "none")


class CellSet(StrEnum):
    """The glyphs that pictures are drawn with, by the points in a cell (columns × rows)."""

    HALF = "half"
    """1 × 2"""
    QUADRANT = "quadrant"
    """2 × 2"""
    SEXTANT = "sextant"
    """2 × 3"""
    OCTANT = "octant"
    """2 × 4, Unicode 16"""
    BRAILLE = "braille"
    """2 × 4, as dots"""
    ASCII = "ascii"
    """Letters and signs"""


AUTO = "auto"
CELLS = (AUTO, *CellSet)
"""What `--cells` accepts."""


class Protocol(StrEnum):
    """How a terminal is told to draw pixels."""

    KITTY = "kitty"
    ITERM = "iterm"
    SIXEL = "sixel"


NO_PIXELS = "none"
PIXELS = (AUTO, *Protocol, NO_PIXELS)
"""What `--pixels` accepts."""
MAX_POSITION_MM = 10_000
MAX_ANGLE_DEG = 36_000
MAX_SEED = 2**63 - 1
MIN_PEN_MM, MAX_PEN_MM = 0.1, 200.0
MIN_SPEED, MAX_SPEED = 0.01, 1000.0
MAX_SPEED_WORD = "max"
DEFAULT_FPS = 20


@dataclass(frozen=True, slots=True)
class RobotChoice:
    """A robot read from a file, and the other settings in that file."""

    spec: RobotSpec
    motor_noise: int | None = None
    """The default motor noise of a run."""
    own_places: bool = True
    """Whether its colour sensors keep their positions on a mat that defines its own."""
    light_noise: int | None = None
    """The default light noise of a run."""
    notes: tuple[str, ...] = ()
    """Warnings about the file, to be shown to the user."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The settings made by options and a world file. None: the mat, robot, profile or program decides."""

    background: str = "Empty_Map"
    """The name of a mat, or the path of an image."""
    mats: str | None = None
    """A folder with the user's own mats."""
    background_fit: str | None = None
    robot: str | RobotChoice = "Default_Robot"
    """Its name or file, or the object itself."""
    obstacles: str | tuple[Obstacle, ...] | None = None
    """Their name or file, or the objects themselves."""
    walls: bool = True
    solid: bool | None = None
    x_mm: float | None = None
    y_mm: float | None = None
    heading_deg: float | None = None
    light_noise: int | None = None
    motor_noise: int | None = None
    pen_down: bool | None = None
    pen_color: str | None = None
    pen_width_mm: float | None = None
    pen_marks: bool = False
    beacon: BeaconSpec | None = None
    """An infrared beacon on the field."""
    remote: tuple[RemotePress, ...] = ()
    """Buttons pressed on the infrared remote control."""
    profile: str | ProfileSpec = "robolab"
    """Its name or file, or the object itself."""
    seed: int = 0
    arguments: tuple[str, ...] = ()
    """The program's `sys.argv[1:]`: the words after `--`."""
    preload: str | None = None
    speed: float | None = None
    """A multiple of real time, 0 for as fast as possible; None: real time in the app, else as fast as possible."""
    autorun: bool = False
    clear_trace: bool = False
    quiet: bool = False
    rays: bool = False
    panels_on: tuple[str, ...] = ()
    panels_off: tuple[str, ...] = ()
    fps: int = DEFAULT_FPS
    colors: str = "auto"
    cells: str | None = None
    """One of `CELLS`; None: what was chosen in the app, else auto."""
    pixels: str = AUTO
    """One of `PIXELS`."""


FileValue = bool | int | float | str
"""The value of a setting in `config.toml`."""


@dataclass(frozen=True, slots=True)
class InFile:
    """An option as one of the user's settings, in `config.toml`."""

    usual: FileValue
    """Its value without the file; an empty text where the mat or the robot decides."""
    allowed: str
    """What it accepts, in words."""
    choices: tuple[str, ...] = ()
    """The words that it accepts, if there are only these, or besides numbers."""
    is_live: bool = True
    """Whether the app applies a change at once; else from its next start on."""


@dataclass(frozen=True, slots=True)
class Option:
    """One line of `OPTIONS`."""

    group: str
    flags: tuple[str, ...]
    field: str
    """The field of `Settings` that it sets."""
    help: str
    metavar: str = ""
    """The name of its value in the help; empty for an option without a value."""
    convert: Callable[[str, str], Any] | None = None
    """Convert the value's text to the value of the field; the second argument is the flag, for errors."""
    panel: str = ""
    """The panel that an option without a value shows or hides; empty if the option sets its field to `value`."""
    value: bool = True
    magic_flags: tuple[str, ...] = ()
    """Further names in a magic line only, because they mean something else on the command line."""
    in_file: InFile | None = None
    """How `config.toml` sets it; None if it cannot."""

    @property
    def name(self) -> str:
        """Its long name as a key: without dashes."""
        return next(flag for flag in self.flags if flag.startswith("--"))[2:].replace("-", "_")

    def converted(self, value: object, key: str) -> Any:
        """Return a value of Python or of a file as the value of the field.

        Raises:
            ConfigError: it is wrong; `key` is to blame.
        """
        if self.convert is None:
            if not isinstance(value, bool):
                raise ConfigError(f"must be True or False, got {value!r}", key=key)
            return self.value if value else not self.value
        text = ("on" if value else "off") if isinstance(value, bool) else str(value)
        return self.convert(text, key)


def number(low: float, high: float) -> Callable[[str, str], float]:
    """Return a converter from the text after a flag to a number in a range; it raises ConfigError for other texts."""
    return _ranged(float, low, high, f"a number from {low:g} to {high:g}")


def whole(low: int, high: int) -> Callable[[str, str], int]:
    """Return a converter from the text after a flag to an integer in a range; it raises ConfigError for other texts."""
    return _ranged(int, low, high, f"a whole number from {low} to {high}")


def _ranged(kind: Callable[[str], _Number], low: float, high: float, allowed: str) -> Callable[[str, str], _Number]:
    def convert(text: str, flag: str) -> _Number:
        with suppress(ValueError):
            if low <= (value := kind(text)) <= high:
                return value
        raise ConfigError(f"must be {allowed}, got {text!r}", key=flag)

    return convert


def _one_of(allowed: Sequence[str]) -> Callable[[str, str], str]:
    def convert(text: str, flag: str) -> str:
        if text not in allowed:
            raise ConfigError(f"no such value {text!r}", f"one of {', '.join(allowed)}", key=flag)
        return text

    return convert


def _name(text: str, flag: str) -> str:
    if not text.strip():
        raise ConfigError("a name is missing", key=flag)
    return text


def _on_off(text: str, flag: str) -> bool:
    return _one_of(("on", "off"))(text, flag) == "on"


def pen_color(text: str, flag: str) -> str:
    """Return a colour in lower case.

    Raises:
        ConfigError: it is neither a CSS colour name nor `#rrggbb`.
    """
    from tuisim.core.css_colors import css_names, css_rgb

    if css_rgb(text) is None:
        near = difflib.get_close_matches(text.lower(), css_names(), 3)
        guess = f"did you mean {' or '.join(near)}? " if near else ""
        raise ConfigError(f"no such colour {text!r}", f"{guess}any CSS colour name, or #rrggbb", key=flag)
    return text.lower()


def _speed(text: str, flag: str) -> float:
    if text == MAX_SPEED_WORD:
        return 0.0
    try:
        return number(MIN_SPEED, MAX_SPEED)(text, flag)
    except ConfigError:
        allowed = f"{MAX_SPEED_WORD}, or a number from {MIN_SPEED:g} to {MAX_SPEED:g}"
        raise ConfigError(f"no such speed {text!r}", allowed, key=flag) from None


_position = number(-MAX_POSITION_MM, MAX_POSITION_MM)
_angle = number(-MAX_ANGLE_DEG, MAX_ANGLE_DEG)

TRUE_FALSE = "true or false"


def _words(allowed: Sequence[str]) -> str:
    return f"one of {', '.join(allowed)}"


WORLD, RUN, APP, PANEL = "World", "Run", "App", "Panels of the app"

OPTIONS: tuple[Option, ...] = (
    Option(
        WORLD,
        ("-b", "--background"),
        "background",
        "A mat from `tuisim backgrounds`, or an image file.",
        "MAT",
        _name,
        in_file=InFile("Empty_Map", "the name of a mat, or an image file"),
    ),
    Option(
        WORLD,
        ("--mats",),
        "mats",
        "Folder of images that `-b` finds by name.",
        "FOLDER",
        _name,
        in_file=InFile("", "a folder"),
    ),
    Option(
        WORLD,
        ("--background-fit",),
        "background_fit",
        "How an image is placed on the field.",
        "|".join(BACKGROUND_FITS),
        _one_of(BACKGROUND_FITS),
    ),
    Option(
        WORLD,
        ("-r", "--robot", "--robotSetup"),
        "robot",
        "A robot from `tuisim robots`, or a file.",
        "ROBOT",
        _name,
        in_file=InFile("Default_Robot", "the name of a robot, or a file"),
    ),
    Option(
        WORLD,
        ("-o", "--obstacles"),
        "obstacles",
        "A set from `tuisim obstacles`, or a file.",
        "NAME",
        _name,
        in_file=InFile("", "the name of a set, or a file"),
    ),
    Option(
        WORLD,
        ("--walls",),
        "walls",
        "Walls on the edges of the field.",
        "on|off",
        _on_off,
        in_file=InFile(True, TRUE_FALSE),
    ),
    Option(WORLD, ("--solid",), "solid", "Obstacles and walls stop the robot."),
    Option(WORLD, ("--no-solid",), "solid", "The robot drives through obstacles and walls.", value=False),
    Option(WORLD, ("-x", "--x", "--xpos"), "x_mm", "Start x in mm.", "MM", _position),
    Option(WORLD, ("-y", "--y", "--ypos"), "y_mm", "Start y in mm.", "MM", _position),
    Option(WORLD, ("-a", "--angle"), "heading_deg", "Start heading, counter-clockwise from +x.", "DEG", _angle),
    Option(
        WORLD,
        ("-N", "--sensornoise"),
        "light_noise",
        "Light noise, 0 … 128.",
        "N",
        whole(0, MAX_LIGHT_NOISE),
        in_file=InFile(0, f"a whole number from 0 to {MAX_LIGHT_NOISE}"),
    ),
    Option(
        WORLD,
        ("-M", "--motornoise"),
        "motor_noise",
        "Motor noise, 0 … 500.",
        "N",
        whole(0, MAX_MOTOR_NOISE),
        in_file=InFile(0, f"a whole number from 0 to {MAX_MOTOR_NOISE}"),
    ),
    Option(WORLD, ("-p", "--pendown"), "pen_down", "Start with the pen down."),
    Option(
        WORLD,
        ("-P", "--pencolor"),
        "pen_color",
        "Colour of the pen: a CSS name, or #rrggbb.",
        "COLOUR",
        pen_color,
        in_file=InFile("", "a CSS colour name, or #rrggbb"),
    ),
    Option(WORLD, ("--pen-width",), "pen_width_mm", "Width of the trace.", "MM", number(MIN_PEN_MM, MAX_PEN_MM)),
    Option(WORLD, ("--pen-marks",), "pen_marks", "The sensors see what the pen draws."),
    Option(
        RUN,
        ("--profile",),
        "profile",
        "A profile from `tuisim profiles`, or a file.",
        "NAME",
        _name,
        in_file=InFile("robolab", "the name of a profile, or a file"),
    ),
    Option(RUN, ("--seed",), "seed", "Seed for noise and `random`.", "N", whole(0, MAX_SEED)),
    Option(
        RUN,
        ("--speed",),
        "speed",
        "A multiple of real time, or max.",
        "N",
        _speed,
        in_file=InFile(1, f"{MAX_SPEED_WORD}, or a number from {MIN_SPEED:g} to {MAX_SPEED:g}", (MAX_SPEED_WORD,)),
    ),
    Option(RUN, ("--preload",), "preload", "Names predefined for the program.", "|".join(PRELOADS), _one_of(PRELOADS)),
    Option(APP, ("-R", "--autorun"), "autorun", "Run at once."),
    Option(APP, ("-C", "--clear"), "clear_trace", "Clear the trace at the start."),
    Option(APP, ("-u", "--ultrasound"), "rays", "Show the ultrasonic rays.", in_file=InFile(False, TRUE_FALSE)),
    Option(APP, ("-q", "--quiet"), "quiet", "Make no sound.", in_file=InFile(False, TRUE_FALSE, is_live=False)),
    Option(
        APP,
        ("--fps",),
        "fps",
        "Maximum frames per second, 1 … 60.",
        "N",
        whole(1, 60),
        in_file=InFile(DEFAULT_FPS, "a whole number from 1 to 60", is_live=False),
    ),
    Option(
        APP,
        ("--colors",),
        "colors",
        f"Colours: {', '.join(COLOR_DEPTHS)}.",
        "DEPTH",
        _one_of(COLOR_DEPTHS),
        in_file=InFile(AUTO, _words(COLOR_DEPTHS), COLOR_DEPTHS, is_live=False),
    ),
    Option(
        APP,
        ("--cells",),
        "cells",
        f"Glyphs of the world: {', '.join(CELLS)}.",
        "SET",
        _one_of(CELLS),
        in_file=InFile(AUTO, _words(CELLS), CELLS),
    ),
    Option(
        APP,
        ("--pixels",),
        "pixels",
        f"Draw real pixels: {', '.join(PIXELS)}.",
        "HOW",
        _one_of(PIXELS),
        in_file=InFile(AUTO, _words(PIXELS), PIXELS),
    ),
    Option(PANEL, ("-O", "--output"), "panels_on", "Show the output.", panel="output"),
    Option(PANEL, ("-A", "--array"), "panels_on", "Show the sensor arrays.", panel="arrays"),
    Option(PANEL, ("-c", "--chart"), "panels_on", "Show the chart.", panel="chart"),
    Option(PANEL, ("-i", "--instrumentation"), "panels_on", "Show the instrumentation.", panel="instrumentation"),
    Option(PANEL, ("-z", "--noisecontrols"), "panels_on", "Show the noise controls.", panel="noise"),
    Option(PANEL, ("-Z", "--settings"), "panels_on", "Show the settings.", panel="settings"),
    Option(PANEL, ("-X", "--positioning"), "panels_on", "Show the positioning controls.", panel="positioning"),
    Option(PANEL, ("-D", "--code"), "panels_on", "Show the code.", panel="code"),
    Option(PANEL, ("-W", "--hideworld"), "panels_off", "Hide the world.", panel="world", magic_flags=("--world",)),
    Option(PANEL, ("-H", "--hidecontrols", "--hide"), "panels_off", "Hide the simulator controls.", panel="controls"),
)
"""Every shared option, in the order of the help."""

OF_THE_APP = frozenset({"panels_on", "panels_off", "quiet", "rays", "speed", "fps", "colors", "cells", "pixels"})
"""Fields of `Settings` that do not affect the run."""

PANELS = tuple(option.panel for option in OPTIONS if option.panel)
"""Every panel that an option shows or hides."""


def settings_of(*layers: Mapping[str, Any]) -> Settings:
    """Merge layers of given options: a later layer takes precedence, panels accumulate."""
    settings = Settings()
    for layer in layers:
        panels = {
            key: tuple(dict.fromkeys((*getattr(settings, key), *layer.get(key, ()))))
            for key in ("panels_on", "panels_off")
        }
        settings = replace(settings, **{**layer, **panels})
    return settings
