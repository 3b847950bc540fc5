"""The switches that the command line and a program's magic line share, and the settings they make.

To add a switch: add a line to `SWITCHES`, and its field to `Settings`.
"""

from __future__ import annotations

import argparse
import difflib
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NoReturn

from tuisim.core.profile import PROFILES
from tuisim.core.spec import MAX_LIGHT_NOISE, MAX_MOTOR_NOISE
from tuisim.errors import ConfigError, ProfileError

PRELOADS = ("none", "imports", "preloaded")
PEN_COLORS = ("red", "orange", "green")
COLOR_DEPTHS = ("auto", "truecolor", "256", "16", "none")
MAX_POSITION_MM = 10_000
MAX_ANGLE_DEG = 36_000
MAX_SEED = 2**63 - 1
MIN_SPEED, MAX_SPEED = 0.01, 1000.0
MAX_SPEED_WORD = "max"


@dataclass(frozen=True, slots=True)
class Settings:
    """What the switches decide. None leaves the choice to the mat or the program."""

    background: str = "Empty_Map"
    robot: str = "Default_Robot"
    obstacles: str | None = None
    x_mm: float | None = None
    y_mm: float | None = None
    heading_deg: float | None = None
    light_noise: int = 0
    motor_noise: int = 0
    pen_down: bool = False
    pen_color: str = "red"
    profile: str = "robolab"
    seed: int = 0
    preload: str | None = None
    speed: float | None = None
    """1.0 real time, 0 as fast as possible; None: real time in the app, as fast as possible headless."""
    autorun: bool = False
    clear_trace: bool = False
    quiet: bool = False
    rays: bool = False
    panels_on: tuple[str, ...] = ()
    panels_off: tuple[str, ...] = ()
    fps: int = 20
    colors: str = "auto"


@dataclass(frozen=True, slots=True)
class Switch:
    """One line of `SWITCHES`."""

    group: str
    flags: tuple[str, ...]
    field: str
    """The field of `Settings` that it sets."""
    help: str
    metavar: str = ""
    """How its value is called; empty for a switch without a value."""
    convert: Callable[[str, str], Any] | None = None
    """From the value's text and the first flag to the value of the field."""
    panel: str = ""
    """The panel that a switch without a value puts on or off; otherwise it sets its field to True."""


def nearest(name: str, allowed: Iterable[str]) -> str:
    """Return the hint for a wrong name: the nearest ones, else all of them."""
    names = list(allowed)
    by_lower = {known.lower(): known for known in names}
    close = [by_lower[lower] for lower in difflib.get_close_matches(name.lower(), by_lower, 3, 0.5)]
    return f"did you mean {' or '.join(close)}?" if close else f"one of {', '.join(names)}"


def number(low: float, high: float) -> Callable[[str, str], float]:
    """Return a converter from the text after a flag to a number in a range."""

    def convert(text: str, flag: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not low <= value <= high:
            raise ConfigError(f"must be a number from {low:g} to {high:g}, got {text!r}", key=flag)
        return value

    return convert


def whole(low: int, high: int) -> Callable[[str, str], int]:
    """Return a converter from the text after a flag to a whole number in a range."""

    def convert(text: str, flag: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise ConfigError(f"must be a whole number from {low} to {high}, got {text!r}", key=flag)
        return value

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


def _profile(text: str, flag: str) -> str:
    if text not in PROFILES:
        raise ProfileError(f"no such profile {text!r}", nearest(text, PROFILES), key=flag)
    return text


def _speed(text: str, flag: str) -> float:
    if text == MAX_SPEED_WORD:
        return 0.0
    try:
        return number(MIN_SPEED, MAX_SPEED)(text, flag)
    except ConfigError:
        allowed = f"{MAX_SPEED_WORD}, or a number from {MIN_SPEED:g} to {MAX_SPEED:g}"
        raise ConfigError(f"no such speed {text!r}", allowed, key=flag) from None


def _not_solid(text: str, flag: str) -> NoReturn:
    raise ConfigError("obstacles cannot be made solid yet", "leave the switch out", key=flag)


_position = number(-MAX_POSITION_MM, MAX_POSITION_MM)
_angle = number(-MAX_ANGLE_DEG, MAX_ANGLE_DEG)

WORLD, RUN, APP, PANEL = "world", "run", "app", "panels (app)"

SWITCHES: tuple[Switch, ...] = (
    Switch(WORLD, ("-b", "--background"), "background", "mat, see `tuisim backgrounds`", "MAT", _name),
    Switch(WORLD, ("-r", "--robot", "--robotSetup"), "robot", "robot, such as Small_Robot", "ROBOT", _name),
    Switch(WORLD, ("-o", "--obstacles"), "obstacles", "None, Central_post, Square_posts or Wall", "PRESET", _name),
    Switch(WORLD, ("-x", "--x"), "x_mm", "start x in mm", "MM", _position),
    Switch(WORLD, ("-y", "--y"), "y_mm", "start y in mm", "MM", _position),
    Switch(WORLD, ("-a", "--angle"), "heading_deg", "start heading, counter-clockwise from +x", "DEG", _angle),
    Switch(WORLD, ("-N", "--sensornoise"), "light_noise", "light noise, 0 … 128", "N", whole(0, MAX_LIGHT_NOISE)),
    Switch(WORLD, ("-M", "--motornoise"), "motor_noise", "motor noise, 0 … 500", "N", whole(0, MAX_MOTOR_NOISE)),
    Switch(WORLD, ("-p", "--pendown"), "pen_down", "start with the pen down"),
    Switch(WORLD, ("-P", "--pencolor"), "pen_color", "red, orange or green", "COLOUR", _one_of(PEN_COLORS)),
    Switch(RUN, ("--profile",), "profile", "rules of the brick, see `tuisim profiles`", "NAME", _profile),
    Switch(RUN, ("--seed",), "seed", "seed of noise and of `random`", "N", whole(0, MAX_SEED)),
    Switch(RUN, ("--speed",), "speed", "max, or times real time", "N", _speed),
    Switch(RUN, ("--preload",), "preload", "names given to the program", "|".join(PRELOADS), _one_of(PRELOADS)),
    Switch(RUN, ("--solid",), "solid", argparse.SUPPRESS, "", _not_solid),
    Switch(APP, ("-R", "--autorun"), "autorun", "run at once"),
    Switch(APP, ("-C", "--clear"), "clear_trace", "start with a clear trace"),
    Switch(APP, ("-u", "--ultrasound"), "rays", "show the ultrasonic rays"),
    Switch(APP, ("-q", "--quiet"), "quiet", "never speak aloud"),
    Switch(APP, ("--fps",), "fps", "most frames a second, 1 … 60", "N", whole(1, 60)),
    Switch(APP, ("--colors",), "colors", "auto, truecolor, 256, 16 or none", "DEPTH", _one_of(COLOR_DEPTHS)),
    Switch(PANEL, ("-O", "--output"), "panels_on", "show the output", panel="output"),
    Switch(PANEL, ("-A", "--array"), "panels_on", "show the sensor arrays", panel="arrays"),
    Switch(PANEL, ("-c", "--chart"), "panels_on", "show the chart", panel="chart"),
    Switch(PANEL, ("-i", "--instrumentation"), "panels_on", "show the instrumentation", panel="instrumentation"),
    Switch(PANEL, ("-z", "--noisecontrols"), "panels_on", "accepted; there is no such panel yet", panel="noise"),
    Switch(PANEL, ("-Z", "--settings"), "panels_on", "accepted; there is no such panel yet", panel="settings"),
    Switch(PANEL, ("-X", "--positioning"), "panels_on", "show the positioning", panel="positioning"),
    Switch(PANEL, ("-D", "--code"), "panels_on", "show the code", panel="code"),
    Switch(PANEL, ("-W", "--hideworld"), "panels_off", "hide the world", panel="world"),
    Switch(PANEL, ("-H", "--hidecontrols"), "panels_off", "hide the simulator controls", panel="controls"),
)
"""Every shared switch, in the order of the help."""


class SwitchParser(argparse.ArgumentParser):
    """An argument parser whose complaints are ConfigErrors, and which knows `SWITCHES` on request."""

    def error(self, message: str) -> NoReturn:
        """Raise a ConfigError instead of printing the usage.

        Raises:
            ConfigError: always.
        """
        text = message.removeprefix("argument ").replace("unrecognized arguments:", "no such switch or argument:")
        raise ConfigError(text, f"see `{self.prog} --help`" if self.add_help else "")

    def add_switches(self) -> None:
        """Add every shared switch; one that is not given leaves no trace in the namespace."""
        groups = {group: self.add_argument_group(group) for group in dict.fromkeys(s.group for s in SWITCHES)}
        for switch in SWITCHES:
            how: dict[str, Any] = {"dest": switch.field, "default": argparse.SUPPRESS, "help": switch.help}
            if switch.panel:
                how |= {"action": "append_const", "const": switch.panel}
            elif switch.metavar:
                how |= {"type": _converter(switch), "metavar": switch.metavar}
            elif switch.convert is not None:
                how |= {"nargs": 0, "action": _Refuse, "const": switch}
            else:
                how |= {"action": "store_true"}
            groups[switch.group].add_argument(*switch.flags, **how)


class _Refuse(argparse.Action):
    """A switch whose `convert` says why it cannot be used."""

    def __call__(self, *_: object) -> None:
        switch: Switch = self.const
        assert switch.convert is not None
        switch.convert("", switch.flags[0])


def _converter(switch: Switch) -> Callable[[str], Any]:
    convert, flag = switch.convert, switch.flags[0]
    assert convert is not None
    return lambda text: convert(text, flag)


_FIELDS = frozenset(switch.field for switch in SWITCHES)


def given(namespace: argparse.Namespace) -> dict[str, Any]:
    """Return the shared switches that were given, by field of `Settings`."""
    found = {field: value for field, value in vars(namespace).items() if field in _FIELDS}
    return {field: tuple(value) if isinstance(value, list) else value for field, value in found.items()}


def parse_words(words: Sequence[str]) -> dict[str, Any]:
    """Return the switches in `words`, by field of `Settings`.

    Raises:
        ConfigError: a word is no switch, or a value is wrong.
    """
    parser = SwitchParser(prog="tuisim", add_help=False, allow_abbrev=False)
    parser.add_switches()
    return given(parser.parse_args(list(words)))


def settings_of(*layers: Mapping[str, Any]) -> Settings:
    """Return the settings that layers of given switches make; a later layer wins, panels add up."""
    settings = Settings()
    for layer in layers:
        panels = {
            key: tuple(dict.fromkeys((*getattr(settings, key), *layer.get(key, ()))))
            for key in ("panels_on", "panels_off")
        }
        settings = replace(settings, **{**layer, **panels})
    return settings
